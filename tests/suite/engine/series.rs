//! Outputs that are series: known indices of single values and of the whole series.

use std::f64::consts::TAU;

use apportion::{
    CorrelationMeasure, Dependence, Distribution, FunctionModel, RowFailure, SeriesAxis, Study, StudyBuilder,
    StudyResult, SurrogateChoice, Unit,
};
use apportion_report::run_document;

/// A study of a series of `f` at `positions`, of factors between -1 and 1.
fn study(
    factors: &[&str],
    positions: Vec<f64>,
    f: impl Fn(&[f64], f64) -> Option<f64> + Send + Sync + 'static,
) -> StudyBuilder {
    let axis = SeriesAxis::new("t", "s", positions.clone()).unwrap();
    let model = FunctionModel::new(Vec::new(), move |x: &[f64], y: &mut [f64]| {
        for (y, t) in y.iter_mut().zip(&positions) {
            *y = f(x, *t).ok_or_else(|| RowFailure::new("none"))?;
        }
        Ok(())
    });
    let model = model.with_series("y", Unit::dimensionless(), axis);
    let uniform = || Distribution::uniform(-1.0, 1.0).unwrap();
    factors.iter().fold(Study::builder("series", model), |study, name| study.factor(name, uniform()))
}

/// Even positions of a whole turn: there the sine and the cosine are orthogonal, and the sum of squares of each is half their
/// number.
fn turn(count: usize) -> Vec<f64> {
    (0..count).map(|k| TAU * k as f64 / count as f64).collect()
}

#[track_caller]
fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() < tolerance, "{found} is not {expected}");
}

/// First-order and total indices of the whole series.
fn whole(analysis: &StudyResult) -> (Vec<f64>, Vec<f64>) {
    let indices = analysis.series("y").unwrap().indices.as_ref().unwrap();
    indices.iter().map(|index| (index.effect.first_order.estimate, index.effect.total.estimate)).unzip()
}

#[test]
fn two_factors_with_a_direction_each() {
    // y(t) = 2 x1 sin t + x2 cos t, where V(x) = 1/3: variances 4/3 sin^2 t and 1/3 cos^2 t.
    for (count, base_samples) in [(16, 4096), (600, 64)] {
        let wave = |x: &[f64], t: f64| Some(2.0 * x[0] * t.sin() + x[1] * t.cos());
        let analysis =
            study(&["x1", "x2"], turn(count), wave).base_samples(base_samples).build().unwrap().run().unwrap();
        let exact = base_samples == 4096;
        let tolerance = if exact { 2e-3 } else { 0.12 };
        for (k, t) in turn(count).into_iter().enumerate().step_by(count / 16) {
            let (a, b) = (4.0 * t.sin().powi(2), t.cos().powi(2));
            let index = analysis.output(&format!("y[{k}]")).unwrap().factor("x1").unwrap();
            near(index.first_order.estimate, a / (a + b), tolerance);
            near(index.total.estimate, a / (a + b), tolerance);
        }
        // Over a whole turn both squares have the mean 1/2.
        let (first_order, total) = whole(&analysis);
        for (found, expected) in first_order.iter().chain(&total).zip([0.8, 0.2, 0.8, 0.2]) {
            near(*found, expected, tolerance);
        }
        let series = analysis.series("y").unwrap();
        assert!(series.indices.iter().flatten().all(|index| index.effect.total.interval.is_some()));
    }
}

#[test]
fn interactions_along_a_series() {
    // y(t) = 2 x1 sin t + sqrt(3) x1 x2 cos t: V(x1 x2) = 1/9, so the interaction has a fifth of the variance.
    let wave = |x: &[f64], t: f64| Some(2.0 * x[0] * t.sin() + 3.0_f64.sqrt() * x[0] * x[1] * t.cos());
    let analysis = study(&["x1", "x2"], turn(16), wave).base_samples(4096).build().unwrap().run().unwrap();
    let (first_order, total) = whole(&analysis);
    for (found, expected) in first_order.iter().chain(&total).zip([0.8, 0.0, 1.0, 0.2]) {
        near(*found, expected, 0.01);
    }
}

#[test]
fn the_whole_is_the_mean_of_values() {
    let wave = |x: &[f64], t: f64| Some((x[0] * t).sin() + x[1] * x[2] * t + x[2].exp() * t.cos());
    let positions: Vec<f64> = (0..5).map(f64::from).collect();
    let mut options = apportion::AnalysisOptions::for_sampler(apportion::Sampler::Sobol);
    options.surrogate = SurrogateChoice::Off;
    let study = study(&["a", "b", "c"], positions, wave).base_samples(1024).analysis(options).build().unwrap();
    let analysis = study.run().unwrap();
    let (_, total) = whole(&analysis);
    let variances: Vec<f64> = analysis.outputs.iter().map(|output| output.variance.unwrap()).collect();
    let all: f64 = variances.iter().sum();
    for (place, name) in ["a", "b", "c"].into_iter().enumerate() {
        let of_value = |(output, variance): (&apportion::OutputResult, &f64)| {
            variance / all * output.factor(name).unwrap().total.estimate
        };
        let by_values: f64 = analysis.outputs.iter().zip(&variances).map(of_value).sum();
        near(total[place], by_values, 1e-12);
    }
}

#[test]
fn runs_that_fail_are_left_out_and_threads_do_not_matter() {
    let wave = |x: &[f64], t: f64| (x[0] < 0.9).then(|| x[0] * t.sin() + 0.3 * x[1] * t.cos());
    let study = |threads| {
        let mut options = apportion::AnalysisOptions::for_sampler(apportion::Sampler::Sobol);
        options.max_failed = 0.2;
        let study = study(&["x1", "x2"], turn(7), wave).base_samples(2048).analysis(options).build().unwrap();
        study.runner().threads(threads).run().unwrap()
    };
    let (one, two) = (study(1), study(2));
    assert_eq!(format!("{:?}", one.series), format!("{:?}", two.series));
    assert!(one.outputs[0].runs_failed > 0);
}

#[test]
fn a_series_without_variance_has_no_indices() {
    let still = study(&["x1"], turn(4), |_, _| Some(1.0)).base_samples(64).build().unwrap().run().unwrap();
    assert!(still.series("y").unwrap().indices.is_none());
    assert!(still.series("z").is_err());
}

#[test]
fn surrogates_of_the_values_correct_the_whole() {
    // y(t) = t x1 + (1 - t) x1 x2: over t = 0, 1/2, 1 the variances are 5/4 of x1 alone and 5/4 of the product, with the
    // interaction of a ninth against a third.
    let wave = |x: &[f64], t: f64| Some(t * x[0] + (1.0 - t) * x[0] * x[1]);
    let run = |surrogate| {
        let mut options = apportion::AnalysisOptions::for_sampler(apportion::Sampler::Sobol);
        options.surrogate = surrogate;
        let study =
            study(&["x1", "x2"], vec![0.0, 0.5, 1.0], wave).base_samples(256).analysis(options).build().unwrap();
        study.run().unwrap()
    };
    let width = |analysis: &StudyResult| {
        let indices = analysis.series("y").unwrap().indices.iter().flatten();
        let all = indices.flat_map(|index| [index.effect.first_order, index.effect.total]);
        all.map(|index| index.interval.map(|interval| interval.high - interval.low).unwrap()).fold(0.0, f64::max)
    };
    let (off, on) = (run(SurrogateChoice::Off), run(SurrogateChoice::On));
    // S of x1 is 3/4, and the product has the rest.
    let (first_order, total) = whole(&on);
    for (found, expected) in first_order.iter().chain(&total).zip([0.75, 0.0, 1.0, 0.25]) {
        near(*found, expected, 1e-6);
    }
    assert!(width(&on) < 1e-3 * width(&off), "{} {}", width(&on), width(&off));
}

/// The noise of a stochastic model is first here, and is not one of the factors of the result.
#[test]
fn a_series_of_a_stochastic_model_names_its_factors_correctly() {
    let wave = |x: &[f64], t: f64| Some(2.0 * x[1] * t.sin() + x[2] * t.cos() + 1e-12 * x[0]);
    let mut builder = study(&[], turn(8), wave).factor("seed", Distribution::seed()).base_samples(256);
    for name in ["x1", "x2"] {
        builder = builder.factor(name, Distribution::uniform(-1.0, 1.0).unwrap());
    }
    let study = builder.build().unwrap();
    let result = study.run().unwrap();
    let indices = result.series[0].indices.as_ref().unwrap();
    assert_eq!(indices.iter().map(|index| index.name.as_str()).collect::<Vec<_>>(), ["x1", "x2"]);
    near(indices[0].effect.total.estimate, 0.8, 0.02);
}

/// Var(2 a sin t + b cos t) = (4 sin^2 t + cos^2 t + 4 r sin t cos t)/3, whose last term a whole turn takes away.
#[test]
fn a_series_of_dependent_factors_has_their_indices() {
    let (wave, r) = (|x: &[f64], t: f64| Some(2.0 * x[0] * t.sin() + x[1] * t.cos()), 0.6);
    let dependence = Dependence::pair("a", "b", r).measure(CorrelationMeasure::Normal);
    let mut builder = study(&[], turn(8), wave).dependence(dependence).base_samples(4096);
    for name in ["a", "b"] {
        builder = builder.factor(name, Distribution::normal(0.0, 1.0).unwrap());
    }
    let study = builder.build().unwrap();
    let result = study.run().unwrap();
    let indices = result.series[0].indices.as_ref().unwrap();
    // E(y | a) = a (2 sin t + r cos t); a given b varies by 1 - r^2.
    for (index, (first, total)) in indices.iter().zip([(4.0 + r * r, 4.0), (1.0 + 4.0 * r * r, 1.0)]) {
        near(index.effect.first_order.estimate, first / 5.0, 0.02);
        near(index.effect.total.estimate, total * (1.0 - r * r) / 5.0, 0.02);
    }
}

/// Histories of the nanoparticle: as long as all particles stick their position is V t, which the velocity alone decides; when all
/// have slipped the force is the critical force.
#[test]
fn the_push_against_time() {
    let text = "model = \"afm\"\noutputs = [\"position_history\", \"critical_force\", \"force_history\"]\n\
                afm = { fidelity = \"quasi-static\", history = { duration = \"2 s\", points = 100 } }\n\
                design = { base_samples = 1024 }\nanalysis = { surrogate = \"off\" }\n\
                [factors.velocity]\nmin = 80\nmax = 120\nunit = \"nm/s\"\n[factors.thickness]\nmin = 0.9\nmax = 1.1\nunit = \"um\"\n";
    let study = apportion_files::parse_study(text, "push.toml".as_ref(), &[]).unwrap();
    let analysis = study.run().unwrap();
    let position = analysis.series("position_history").unwrap();
    assert_eq!((&*position.axis, &*position.axis_unit), ("time", "s"));
    near(position.positions[99], 2.0, 1e-12);
    let index = |output: &str, factor: &str| *analysis.output(output).unwrap().factor(factor).unwrap();
    near(index("position_history[0]", "velocity").first_order.estimate, 1.0, 1e-6);
    near(index("position_history[0]", "thickness").total.estimate, 0.0, 1e-9);
    for factor in ["velocity", "thickness"] {
        let (at_end, critical) = (index("force_history[99]", factor), index("critical_force", factor));
        near(at_end.total.estimate, critical.total.estimate, 1e-6);
        near(at_end.first_order.estimate, critical.first_order.estimate, 1e-6);
    }
    let document = run_document(&analysis).text();
    assert!(document.contains("force_history") || document.contains("force history"), "{document}");
    let mut messages = crate::messages::messages!();
    for history in ["{ duration = \"2 um\" }", "{ points = 1 }", "{ point = 10 }", "0.4"] {
        messages.unparsed(history, &text.replace("{ duration = \"2 s\", points = 100 }", history), "3:46");
    }
    let idle = text.replace("\"position_history\", \"critical_force\", \"force_history\"", "\"critical_force\"");
    let notes = apportion_files::parse_study(&idle, "push.toml".as_ref(), &[]).unwrap();
    messages.add("no history among the outputs", &notes.notes().join("\n"));
}
