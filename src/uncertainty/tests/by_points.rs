use super::*;
use crate::design::{Design, DesignSettings, Rows, Sampler};
use crate::effect::{Layout, Quantities};
use crate::estimate;
use crate::estimate::{BlockOutputs, Estimator, PointOutputs, Workspace};
use crate::uncertainty::bootstrap::counts_of;

/// Returns all quantities in one list.
fn quantities(layout: &Layout, moments: &Moments) -> Option<Vec<f64>> {
    estimate::quantities(layout, moments).map(Quantities::into_list)
}

/// Outputs of a made-up model at the rows of a design of three factors.
struct Sample {
    design: Design,
    /// A column for each unique run.
    columns: Vec<Vec<f64>>,
    layout: Layout,
}

impl Sample {
    /// x0 + 2 x1 + 3 x0 x1 + `offset`: the last factor has no effect.
    fn new(points: u64, ba: bool, offset: f64) -> Self {
        Self::from_rows(points, Rows { ba, second_order: ba, ..Rows::default() }, offset)
    }

    fn from_rows(points: u64, rows: Rows, offset: f64) -> Self {
        let (has_ba, second_order) = (rows.ba, rows.second_order);
        let settings = DesignSettings { sampler: Sampler::Random, base_samples: points, replicates: 1, seed: 5 };
        let design = Design::new(settings, 3, Rows { swaps: vec![vec![0], vec![1], vec![2]], ..rows }).unwrap();
        let runs = design.rows_per_point();
        let mut u = [0.0; 3];
        let mut output = |point: u64, run: u64| {
            design.point(point * runs + run, &mut u);
            u[0] + 2.0 * u[1] + 3.0 * u[0] * u[1] + offset
        };
        let columns = (0..runs).map(|run| (0..points).map(|point| output(point, run)).collect()).collect();
        let estimators = Estimator::ALL.into_iter().filter(|estimator| has_ba || !estimator.needs_ba()).collect();
        let layout = Layout { estimators, second_order, ..Layout::plain(3) };
        Self { design, columns, layout }
    }

    fn with_failures(mut self) -> Self {
        for (run, column) in self.columns.iter_mut().enumerate() {
            column.iter_mut().skip(3 * run).step_by(37).take(2).for_each(|y| *y = f64::NAN);
        }
        self
    }

    fn kept(&self) -> PointOutputs {
        // Blocks of 256 and a shorter one, as a run leaves them.
        let mut kept = PointOutputs::default();
        let points = self.columns[0].len();
        for first in (0..points).step_by(256) {
            let end = (first + 256).min(points);
            let columns: Vec<&[f64]> = self.columns.iter().map(|column| &column[first..end]).collect();
            kept.append(PointOutputs::of_block(&columns));
        }
        kept
    }

    /// Moments of the points, each repeated according to `counts`, computed as in a run.
    fn moments(&self, counts: &[u8]) -> Moments {
        let repeated = |column: &Vec<f64>| -> Vec<f64> {
            column.iter().zip(counts).flat_map(|(y, count)| std::iter::repeat_n(*y, usize::from(*count))).collect()
        };
        let columns: Vec<Vec<f64>> = self.columns.iter().map(repeated).collect();
        let rows = |runs: &[usize]| runs.iter().map(|run| &columns[*run][..]).collect::<Vec<&[f64]>>();
        let design = &self.design;
        let (ab, ba) = (rows(design.ab_runs()), rows(design.ba_runs()));
        let (a, b) = (&columns[0], &columns[1]);
        let block = BlockOutputs { a, b, ab: &ab, ba: &ba, paired: design.paired() };
        Moments::of_block(block, &mut Workspace::default())
    }

    fn all(&self) -> Moments {
        self.moments(&vec![1; self.columns[0].len()])
    }

    fn bounds(&self, method: IntervalMethod) -> (Vec<f64>, Vec<Bounds>) {
        let kept = self.kept();
        let points = KeptPoints::all(&self.design, &[&kept]).unwrap().count();
        let replicates = [&kept];
        let points = KeptPoints { design: &self.design, replicates: &replicates, per_replicate: points };
        let by_points = ByPoints { method, points, seed: 1, resamples: 200 };
        let estimates = quantities(&self.layout, &self.all()).unwrap();
        let bounds = by_points.bounds(self.all(), &estimates, &|moments| quantities(&self.layout, moments));
        (estimates, bounds)
    }
}

/// All of the numbers, NaN equal to NaN.
fn assert_near(got: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(got.len(), expected.len());
    for (q, (got, expected)) in got.iter().zip(expected).enumerate() {
        let near = (got - expected).abs() <= tolerance * expected.abs().max(1.0);
        assert!(near || got.is_nan() && expected.is_nan(), "quantity {q}: {got} is not {expected}");
    }
}

#[test]
fn resampled_moments_are_those_of_resampled_rows() {
    // 10,000 points: two chunks, the second shorter. An offset costs the digits that the means of the outputs do not have.
    let samples = [
        (Sample::new(700, false, 0.0), 1e-11),
        (Sample::new(700, true, 0.0), 1e-11),
        (Sample::new(700, true, 0.0).with_failures(), 1e-11),
        (Sample::new(10_000, false, 0.0).with_failures(), 1e-11),
        (Sample::new(700, true, 0.0), 1e-11),
    ];
    for (sample, tolerance) in samples {
        let kept = sample.kept();
        let replicates = [&kept];
        let points = KeptPoints::all(&sample.design, &replicates).unwrap();
        let products = Products::new(sample.all());
        let list = |moments: &Moments| quantities(&sample.layout, moments);
        let got = resampled(points, &products, 9, 40, &list);
        assert_eq!(got.len(), 40);
        for (resample, got) in got.iter().enumerate() {
            let counts = counts_of(points, 9, resample);
            assert_eq!(counts.iter().map(|count| usize::from(*count)).sum::<usize>(), sample.columns[0].len());
            let expected = list(&sample.moments(&counts)).unwrap();
            assert_near(got.as_ref().unwrap(), &expected, tolerance);
        }
    }
}

#[test]
fn influences_are_what_another_copy_of_the_point_does() {
    // The influence of a point is the slope of the estimate in its weight: power sums against those from the jackknife,
    // which agree to first order in 1/n.
    let plain = || Sample::new(2000, true, 0.0);
    for sample in [plain(), plain().with_failures()] {
        let kept = sample.kept();
        let replicates = [&kept];
        let points = KeptPoints::all(&sample.design, &replicates).unwrap();
        let list = |moments: &Moments| quantities(&sample.layout, moments);
        let errors = delta_errors(points, &Products::new(sample.all()), &list).unwrap();
        let all = list(&sample.all()).unwrap();
        let n = sample.columns[0].len();
        let without = |point: usize| {
            let mut counts = vec![1; n];
            counts[point] = 0;
            list(&sample.moments(&counts)).unwrap()
        };
        let without: Vec<Vec<f64>> = (0..n).map(without).collect();
        for q in 0..all.len() {
            let deviations: Vec<f64> = without.iter().map(|values| values[q] - all[q]).collect();
            let mean = deviations.iter().sum::<f64>() / n as f64;
            let squares: f64 = deviations.iter().map(|d| (d - mean).powi(2)).sum();
            let expected = (squares * (n as f64 - 1.0) / n as f64).sqrt();
            let got = errors[q];
            if expected.is_nan() {
                assert!(got.error.is_nan(), "{q}");
            } else {
                assert!((got.error - expected).abs() <= 0.02 * expected + 1e-12, "{q}: {} {expected}", got.error);
            }
        }
    }
}

#[test]
fn the_error_of_a_mean_is_the_textbook_one() {
    // Mean over A and B of independent columns: sd of (y_A + y_B)/2 over sqrt(n), for any offset.
    for offset in [0.0, 1e6] {
        let sample = Sample::new(1000, false, offset);
        let kept = sample.kept();
        let replicates = [&kept];
        let points = KeptPoints::all(&sample.design, &replicates).unwrap();
        let mean = |moments: &Moments| Some(vec![moments.mean()]);
        let all = sample.all().without_swaps();
        let got = delta_errors(points, &Products::new(all), &mean).unwrap()[0];
        let halves: Vec<f64> = sample.columns[0].iter().zip(&sample.columns[1]).map(|(a, b)| (a + b) / 2.0).collect();
        let centre = halves.iter().sum::<f64>() / 1000.0;
        let variance = halves.iter().map(|y| (y - centre).powi(2)).sum::<f64>() / 999.0;
        let expected = (variance / 1000.0).sqrt();
        // The mean is a number near 1e6 with 16 digits, and the steps are 1e-3 of the spread: 1e-7.
        assert!((got.error / expected - 1.0).abs() < 1e-6, "{offset}: {} {expected}", got.error);
        assert_eq!(got.freedom, 999.0);
    }
}

#[test]
fn the_inert_factor_has_intervals_of_no_width() {
    let sample = Sample::new(300, false, 0.0);
    for method in [IntervalMethod::Delta, IntervalMethod::Percentile] {
        let (_, bounds) = sample.bounds(method);
        let judged = estimate::quantities(&sample.layout, &sample.all()).unwrap().zip(bounds);
        let indices = |factor: usize| [judged.effects[factor].first_order, judged.effects[factor].total];
        for (estimate, bounds) in indices(2) {
            assert_eq!(estimate, 0.0);
            assert_eq!(bounds.1, Some(Interval { low: 0.0, high: 0.0 }), "{method:?}");
        }
        for (estimate, bounds) in indices(0) {
            let Interval { low, high } = bounds.1.unwrap();
            assert!(low < estimate && estimate < high && high - low < 0.5, "{method:?}: {low} {high}");
        }
    }
}

#[test]
fn the_same_bits_on_any_number_of_threads() {
    let sample = Sample::new(9000, true, 0.0).with_failures();
    for method in [IntervalMethod::Delta, IntervalMethod::Percentile] {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let (_, bounds) = pool.install(|| sample.bounds(method));
            let bits = |x: f64| x.to_bits();
            let interval = |i: Option<Interval>| i.map(|i| (bits(i.low), bits(i.high)));
            bounds.into_iter().map(|(e, i)| (bits(e.error), interval(i))).collect::<Vec<_>>()
        };
        let one = on(1);
        assert!(one.iter().filter(|(_, interval)| interval.is_some()).count() > 20);
        for threads in [2, 5] {
            assert!(on(threads) == one, "{method:?}, {threads} threads");
        }
    }
}

#[test]
fn two_points_give_what_they_can() {
    let sample = Sample::new(2, false, 0.0);
    for method in [IntervalMethod::Delta, IntervalMethod::Percentile] {
        let (estimates, bounds) = sample.bounds(method);
        assert_eq!(estimates.len(), bounds.len());
        for (_, interval) in bounds {
            assert!(interval.is_none_or(|i| i.low.is_finite() && i.low <= i.high), "{method:?}: {interval:?}");
        }
    }
}

#[test]
fn scale_of_the_output_does_not_matter() {
    let base = Sample::new(300, false, 0.0);
    for scale in [1e-120, 1e-18, 1e120] {
        let mut scaled = Sample::new(300, false, 0.0);
        scaled.columns.iter_mut().flatten().for_each(|y| *y *= scale);
        for method in [IntervalMethod::Delta, IntervalMethod::Percentile] {
            let (expected, got) = (base.bounds(method).1, scaled.bounds(method).1);
            let lows =
                |bounds: &[Bounds]| bounds[2..].iter().map(|b| b.1.map_or(f64::NAN, |i| i.low)).collect::<Vec<_>>();
            // Uncentred estimators carry rounding of the size of the mean.
            assert_near(&lows(&got), &lows(&expected), 1e-9);
        }
    }
}

#[test]
fn constant_outputs_have_a_certain_mean_and_no_indices() {
    let mut sample = Sample::new(50, false, 0.0);
    sample.columns.iter_mut().flatten().for_each(|y| *y = 0.1);
    let kept = sample.kept();
    let replicates = [&kept];
    let points = KeptPoints::all(&sample.design, &replicates).unwrap();
    let moments = |moments: &Moments| Some(vec![moments.mean(), moments.variance()]);
    for method in [IntervalMethod::Delta, IntervalMethod::Percentile] {
        let by_points = ByPoints { method, points, seed: 0, resamples: 100 };
        let bounds = by_points.bounds(sample.all().without_swaps(), &[0.1, 0.0], &moments);
        assert_eq!(bounds[0].1, Some(Interval { low: 0.1, high: 0.1 }), "{method:?}");
        assert_eq!(bounds[1].1, Some(Interval { low: 0.0, high: 0.0 }), "{method:?}");
        let none = by_points.bounds(sample.all(), &[0.5], &|moments| quantities(&sample.layout, moments));
        assert_eq!(none[0].1, None, "{method:?}");
    }
}

/// Share of intervals, over the first-order and total indices of active factors, that hold the exact index.
fn coverage(function: &str, method: IntervalMethod) -> f64 {
    use crate::design::Sampler;
    use crate::model::{KnownAnswer, function_model};
    use crate::study::{AnalysisOptions, Study};
    const SEEDS: u64 = 100;
    let function = KnownAnswer::from_name(function).unwrap().default_function();
    let exact = function.exact().indices.unwrap();
    let options = AnalysisOptions { intervals: method, ..AnalysisOptions::for_sampler(Sampler::Random) };
    let (mut held, mut count) = (0.0, 0.0);
    for seed in 0..SEEDS {
        let model = function.clone();
        let study = Study::builder("coverage", function_model("y", move |x| model.value(x)));
        let study = study.sampler(Sampler::Random).base_samples(512).seed(seed).analysis(options.clone());
        let inputs = function.inputs().iter().cloned();
        let study = inputs.fold(study, |study, input| study.factor(&input.name, input.distribution)).build().unwrap();
        let analysis = study.run().unwrap();
        let exact = exact.first_order.iter().zip(&exact.total);
        // An inert factor has intervals of width 0, which always contain the exact value.
        let effects = analysis.outputs[0].indices.iter().flatten().map(|index| index.effect).zip(exact);
        for (effect, (first, total)) in effects.filter(|(_, (_, total))| **total > 0.0) {
            for (estimate, exact) in [(effect.first_order, *first), (effect.total, *total)] {
                let interval = estimate.interval.unwrap();
                held += f64::from(u8::from(interval.low <= exact && exact <= interval.high));
                count += 1.0;
            }
        }
    }
    held / count
}

#[test]
fn ninety_five_percent_is_about_that() {
    // 600 intervals or more, in groups that come from one sample: the standard error of the share is about 1.4 %.
    let mut shares = Vec::new();
    for method in [IntervalMethod::Delta, IntervalMethod::Percentile] {
        for function in ["ishigami", "linear"] {
            let share = coverage(function, method);
            shares.push((function, method, share));
        }
    }
    assert!(shares.iter().all(|(_, _, share)| (0.92..=0.98).contains(share)), "{shares:?}");
}

#[test]
fn quantiles_and_tails_by_hand() {
    let values: Vec<f64> = (1..=39).map(f64::from).collect();
    assert_eq!(quantile(&values, 0.025), 1.0);
    assert_eq!(quantile(&values, 0.975), 39.0);
    assert_eq!(quantile(&values, 0.5), 20.0);
    assert_eq!(quantile(&values, 0.0), 1.0);
    assert_eq!(quantile(&values, 1.0), 39.0);
}
