//! From the totals of one output to its part of the result file.

use serde_json::{Map, Value};

use super::build::FinishedRun;
use super::distribution::OutputDistribution;
use super::records::{estimate_record, input_value};
use super::result::{
    DistributionRecord, EffectRecord, EstimatorRecord, FailureRecord, GroupRecord, IndexRecord, IntervalRecord,
    OtherIndexRecord, OutputRecord, PairRecord, StageIndexRecord, StageRecord, SubsetRecord,
};
use super::warnings;
use crate::design::Design;
use crate::estimate::{CentralMoments, FirstOrder, MomentParts, PointOutputs, Total, merged};
use crate::model::{Output, RowFailure};
use crate::quantity::Unit;
use crate::run::{Place, Tally, Totals};
use crate::study::Study;
use crate::uncertainty::{
    EffectEstimates, Estimate, Interval, Judgement, KeptPoints, OtherEstimates, OutputIndices, OutputMoments, Stage,
    output_indices, output_moments, stages,
};

/// The record of output number `number`; `whole` holds the counts over all replicates.
pub(super) fn output_record(run: &FinishedRun<'_>, output: &Output, number: usize, whole: &Totals) -> OutputRecord {
    let study = run.study;
    let totals = &whole.outputs[number];
    let parts: Vec<MomentParts> = run.replicates.iter().map(|t| t.outputs[number].moments.clone()).collect();
    let unit = &output.unit;
    let kept: Vec<&PointOutputs> = run.replicates.iter().map(|t| &t.outputs[number].kept).collect();
    let judgement = Judgement { points: KeptPoints::all(run.design, &kept), ..judgement(study) };
    let used = merged(&parts.iter().map(MomentParts::whole).collect::<Vec<_>>());
    let (mean, variance) = moments_of_all_rows(&totals.values, output_moments(&parts, &judgement), used.count());
    let squared = |x: f64| unit.span_from_si(unit.span_from_si(x));
    let in_unit = |x: f64| unit.from_si(x);
    let failure = |(failure, tally): (&RowFailure, &Tally)| failure_record(run, failure, *tally);
    let mut record = OutputRecord {
        name: output.name.to_string(),
        unit: unit.to_string(),
        mean: mean.map(|mean| in_unit(mean.estimate)),
        variance: variance.map(|variance| squared(variance.estimate)),
        mean_interval: mean.and_then(|mean| interval_record(mean.interval, &in_unit)),
        variance_interval: variance.and_then(|variance| interval_record(variance.interval, &squared)),
        runs_ok: run.design.rows() - totals.runs_failed,
        runs_failed: totals.runs_failed,
        base_points_used: used.fewest(),
        failures: totals.failures.iter().map(failure).collect(),
        sum_first_order: None,
        sum_total: None,
        indices: None,
        groups: None,
        subsets: None,
        dummy: None,
        second_order: None,
        estimators: Vec::new(),
        convergence: Vec::new(),
        distribution: distribution_record(run.replicates, number, (&totals.values, unit)),
        scatter: None,
        reason: None,
        warnings: Vec::new(),
    };
    record.warnings = warnings::of_runs(run, &record);
    record.warnings.extend(warnings::of_flags(run.model, whole));
    let failed_share = totals.runs_failed as f64 / run.design.rows() as f64;
    if failed_share > study.analysis.max_failed {
        record.reason = Some(format!(
            "{:.3} % of the runs failed, more than max_failed = {} allows: what is left would not stand for the whole",
            100.0 * failed_share,
            study.analysis.max_failed
        ));
        return record;
    }
    let layout = study.layout();
    match output_indices(&parts, &layout, &judgement) {
        Err(undefined) => record.reason = Some(undefined.to_string()),
        Ok(indices) => {
            record.warnings.extend(warnings::of_values(&totals.values));
            record.warnings.extend(warnings::of_indices(study, &indices));
            add_indices(&mut record, study, &indices);
            let runs = run.design.rows_per_point();
            record.convergence =
                stages(&parts, &layout, &judgement).iter().map(|stage| stage_record(study, stage, runs)).collect();
        }
    }
    record
}

/// Mean and variance of all successful rows A and B. The indices rest on the `points` base points at which both rows
/// succeeded, and so do the `moments` with their intervals; where some succeeded alone, the interval of the mean is moved to the
/// mean of all, and that of the variance is scaled to theirs.
fn moments_of_all_rows(
    values: &CentralMoments,
    moments: Option<OutputMoments>,
    points: u64,
) -> (Option<Estimate>, Option<Estimate>) {
    let (Some(mean), Some(variance)) = (values.mean(), values.variance()) else { return (None, None) };
    let unknown = |estimate| Some(Estimate { estimate, interval: None });
    let Some(moments) = moments else { return (unknown(mean), unknown(variance)) };
    if values.count() == 2 * points {
        return (Some(moments.mean), Some(moments.variance));
    }
    let changed = |of: Estimate, estimate: f64, change: &dyn Fn(f64) -> f64| {
        let interval = of.interval.map(|Interval { low, high }| Interval { low: change(low), high: change(high) });
        Some(Estimate { estimate, interval: interval.filter(|i| i.low.is_finite() && i.high.is_finite()) })
    };
    let shift = mean - moments.mean.estimate;
    let ratio = variance / moments.variance.estimate;
    (changed(moments.mean, mean, &|bound| bound + shift), changed(moments.variance, variance, &|bound| bound * ratio))
}

/// How the intervals and probabilities of `study` are found.
pub fn judgement(study: &Study) -> Judgement<'static> {
    let (analysis, seed) = (&study.analysis, study.design.settings().seed);
    let (method, threshold, resamples) = (analysis.intervals, analysis.threshold, analysis.resamples);
    Judgement { method, threshold, seed, resamples, points: None }
}

fn add_indices(record: &mut OutputRecord, study: &Study, indices: &OutputIndices) {
    let factors = study.space.factors();
    let names = |numbers: &[usize]| numbers.iter().map(|&number| factors[number].name.clone()).collect::<Vec<_>>();
    record.sum_first_order = Some(estimate_record(indices.sum_first_order));
    record.sum_total = Some(estimate_record(indices.sum_total));
    let of_factor = |(factor, effect): (&crate::space::Factor, &EffectEstimates)| IndexRecord {
        factor: factor.name.clone(),
        effect: effect_record(effect),
    };
    record.indices = Some(factors.iter().zip(&indices.factors).map(of_factor).collect());
    let of_group = |(group, effect): (crate::space::Group, &EffectEstimates)| GroupRecord {
        factors: names(&group.factors),
        group: group.name,
        effect: effect_record(effect),
    };
    record.groups = Some(study.space.groups().into_iter().zip(&indices.groups).map(of_group).collect());
    let subsets = study.analysis.subsets.iter().zip(&indices.subsets);
    let of_subset = |(numbers, effect): (&Vec<usize>, &EffectEstimates)| SubsetRecord {
        factors: names(numbers),
        effect: effect_record(effect),
    };
    record.subsets = Some(subsets.map(of_subset).collect());
    record.dummy = indices.dummy.as_ref().map(effect_record);
    if study.analysis.second_order {
        let of_pair = |((j, k), index): ((usize, usize), &Estimate)| PairRecord {
            factors: [j, k].map(|number| factors[number].name.clone()),
            index: estimate_record(*index),
        };
        let pairs = study.layout().pair_list();
        record.second_order = Some(pairs.into_iter().zip(&indices.second_order).map(of_pair).collect());
    }
    record.estimators = estimator_records(study, indices);
}

/// Names of everything that has indices, in the order of the swaps: factors, groups, subsets, dummy.
pub(super) fn names_of_swaps(study: &Study) -> Vec<String> {
    let factors = study.space.factors();
    let subset = |numbers: &Vec<usize>| {
        numbers.iter().map(|&number| factors[number].name.as_str()).collect::<Vec<_>>().join(" + ")
    };
    let names = factors.iter().map(|factor| factor.name.clone());
    let names = names.chain(study.space.groups().into_iter().map(|group| group.name));
    let names = names.chain(study.analysis.subsets.iter().map(subset));
    names.chain(study.analysis.dummy.then(|| "dummy".to_owned())).collect()
}

/// All effects of an output in the order of the swaps.
pub(super) fn effects(indices: &OutputIndices) -> impl Iterator<Item = &EffectEstimates> {
    indices.factors.iter().chain(&indices.groups).chain(&indices.subsets).chain(&indices.dummy)
}

fn estimator_records(study: &Study, indices: &OutputIndices) -> Vec<EstimatorRecord> {
    let names = names_of_swaps(study);
    let estimators = study.analysis.estimators.iter().enumerate();
    let record = |(number, estimator): (usize, &crate::estimate::Estimator)| {
        let (first_order, total) = estimator.formulas();
        let of_swap = |(name, effect): (&String, &EffectEstimates)| {
            let OtherEstimates { first_order, total, .. } = effect.others[number];
            OtherIndexRecord {
                name: name.clone(),
                first_order: first_order.map(estimate_record),
                total: total.map(estimate_record),
            }
        };
        EstimatorRecord {
            estimator: estimator.name().to_owned(),
            first_order_source: first_order.map(FirstOrder::source).map(str::to_owned),
            total_source: total.map(Total::source).map(str::to_owned),
            indices: names.iter().zip(effects(indices)).map(of_swap).collect(),
        }
    };
    estimators.map(record).collect()
}

fn stage_record(study: &Study, stage: &Stage, runs_per_point: u64) -> StageRecord {
    let of_factor = |(factor, effect): (&crate::space::Factor, &EffectEstimates)| StageIndexRecord {
        factor: factor.name.clone(),
        first_order: estimate_record(effect.first_order),
        total: estimate_record(effect.total),
    };
    StageRecord {
        base_samples: stage.base_samples,
        model_runs: stage.base_samples * runs_per_point,
        largest_half_width: stage.indices.largest_half_width(),
        indices: study.space.factors().iter().zip(&stage.indices.factors).map(of_factor).collect(),
    }
}

fn effect_record(effect: &EffectEstimates) -> EffectRecord {
    let same = |x: f64| x;
    let interval = |share: Option<Estimate>| share.and_then(|s| interval_record(s.interval, &same));
    EffectRecord {
        first_order: estimate_record(effect.first_order),
        total: estimate_record(effect.total),
        share_first_order: effect.share_first_order.map(|share| share.estimate),
        share_total: effect.share_total.map(|share| share.estimate),
        share_first_order_interval: interval(effect.share_first_order),
        share_total_interval: interval(effect.share_total),
        interaction: Some(estimate_record(effect.interaction)),
        probability_first: effect.probability_first,
        probability_above_threshold: effect.probability_above,
    }
}

fn interval_record(interval: Option<Interval>, convert: &dyn Fn(f64) -> f64) -> Option<IntervalRecord> {
    interval.map(|i| IntervalRecord { low: convert(i.low), high: convert(i.high) })
}

/// Moments and range from all values of the rows A and B, the rest from those that were kept. `None` without values, and
/// where a number is beyond double precision in the unit.
fn distribution_record(
    replicates: &[Totals],
    number: usize,
    (values, unit): (&CentralMoments, &Unit),
) -> Option<DistributionRecord> {
    let kept = replicates.iter().flat_map(|totals| &totals.outputs[number].sample).copied();
    let kept: Vec<f64> = kept.filter(|value| value.is_finite()).collect();
    let mut sample = OutputDistribution::of(&kept, unit).ok()?;
    let (min, max) = values.range()?;
    (sample.mean, sample.min, sample.max) = (unit.from_si(values.mean()?), unit.from_si(min), unit.from_si(max));
    let n = values.count();
    let sd = (values.variance()? * (n as f64 / (n as f64 - 1.0))).sqrt();
    sample.sd = (n > 1).then(|| unit.span_from_si(sd)).filter(|sd| sd.is_finite());
    (sample.skewness, sample.excess_kurtosis) = (values.skewness(), values.excess_kurtosis());
    let quantiles = sample.quantiles.iter().map(|quantile| quantile.value);
    let edges = sample.histogram.iter().flat_map(|histogram| histogram.edges.iter().copied());
    let all = [sample.mean, sample.min, sample.max].into_iter().chain(quantiles).chain(edges);
    let representable = all.into_iter().all(f64::is_finite);
    representable.then_some(DistributionRecord { values: n, sample })
}

fn failure_record(run: &FinishedRun<'_>, failure: &RowFailure, tally: Tally) -> FailureRecord {
    let first_row = tally.first.row(run.design);
    let values = row_inputs(run.study, run.design, tally.first);
    let named = |(factor, value): (&crate::space::Factor, f64)| (factor.name.clone(), input_value(factor, value));
    let first_inputs: Map<String, Value> = run.study.space.factors().iter().zip(values).map(named).collect();
    FailureRecord { reason: failure.to_string(), runs: tally.count, first_row, first_inputs }
}

/// The values of the factors at `place` of `design`, in their units.
fn row_inputs(study: &Study, design: &Design, place: Place) -> Vec<f64> {
    let mut u = vec![0.0; design.factors()];
    design.point(place.row(design), &mut u);
    study.space.values_at(&u)
}

/// The inputs of a row of `study` in words, such as `length = 300 um, velocity = 0 nm/s`; `place` may lie beyond the
/// study's own design, where a growing run has gone.
pub fn inputs_in_words(study: &Study, place: Place) -> String {
    let points = place.point.checked_add(1).and_then(u64::checked_next_power_of_two);
    let longer = points.filter(|points| *points > study.design.points_per_replicate());
    let longer = longer.and_then(|points| study.design.with_points(points).ok());
    let values = row_inputs(study, longer.as_ref().unwrap_or(&study.design), place);
    let words = study.space.factors().iter().zip(values).map(|(factor, value)| {
        let unit = factor.unit().to_string();
        if unit == "1" { format!("{} = {value}", factor.name) } else { format!("{} = {value} {unit}", factor.name) }
    });
    words.collect::<Vec<_>>().join(", ")
}
