//! The results of a run for one output.

use super::finished_run::{FinishedRun, named_inputs, outputs_kept, row_inputs};
use super::first_rows::FirstRows;
use super::indices::{add_indices, stage_record};
use super::measures::MeasuredRows;
use super::output_indices::{IntervalOptions, OutputIndices, output_indices, output_moments};
use super::rare_levels::withdraw;
use super::scatter::scatter_record;
use super::stages::stages;
use super::surrogates::{Corrections, interval_options};
use super::{unlikely, warnings};
use crate::effect::IndexPair;
use crate::estimate::{CentralMoments, MomentParts, Moments, Undefined, merged};
use crate::model::{Model, Output, RowFailure};
use crate::result::{FailureCount, OutputDistribution, OutputResult, ScatterRecord, Warning};
use crate::run::{Tally, Totals};
use crate::space::IndicesOf;
use crate::study::Study;
use crate::uncertainty::{Estimate, KeptPoints, OutputMoments};
use apportion_base::quantity::Unit;

/// Number of outputs above which none has a scatter plot or stages: they are ten times everything else in a result.
pub(super) const MAX_PICTURED: usize = 100;

/// The first rows of the design, for results that need individual values.
pub(super) struct OutputRows {
    /// Rows for scatter plots; `None` for neither these nor distributions.
    pub scatter: Option<FirstRows>,
    /// Rows for other measures than indices, if requested.
    pub measured: Option<MeasuredRows>,
}

/// Returns the result for output number `number`; `counts` holds the counts over all replicates.
pub(super) fn output_result(
    run: &FinishedRun<'_>,
    output: &Output,
    number: usize,
    counts: &Totals,
    corrected: &Corrections,
    rows: &OutputRows,
) -> OutputResult {
    let (study, totals, unit) = (run.study, &counts.outputs[number], &output.unit);
    let parts: Vec<&MomentParts> = run.replicates.iter().map(|t| &t.outputs[number].moments).collect();
    let kept = outputs_kept(run.replicates, number);
    let surrogate = corrected.of_run.get(number).and_then(Option::as_ref);
    let (points, unread) = (KeptPoints::all(run.design, &kept), study.unread(run.model, number));
    let options = IntervalOptions { points, unread: &unread, surrogate, ..interval_options(study) };
    let used = merged(&parts.iter().map(|of| of.sum()).collect::<Vec<_>>());
    let layout = study.layout();
    let share = totals.runs_failed as f64 / run.design.rows() as f64;
    let mut indices = match (share > study.analysis.max_failed, &corrected.plain) {
        (true, _) => Err(Undefined::TooManyFailed { share, allowed: study.analysis.max_failed }),
        (false, Some(plain)) => plain.indices(study, run.model, number, true),
        (false, None) => output_indices(&parts, &layout, &options),
    };
    if let Ok(indices) = &mut indices {
        set_everything(indices, study, run.model, number);
    }
    let is_refused = indices.as_ref().is_ok_and(|of| of.surrogate.as_ref().is_some_and(|used| used.refusal.is_some()));
    let of_moments = IntervalOptions { surrogate: surrogate.filter(|_| !is_refused), ..options };
    let of_plain = corrected.plain.as_ref().and_then(|plain| plain.moments(number, run.replicates));
    let (mean, variance) = match of_plain {
        Some(moments) => (Some(moments.mean), Some(moments.variance)),
        None => moments_of_all_rows(&totals.values, output_moments(&parts, &of_moments), used.count()),
    };
    let samples: Vec<&Vec<f64>> = run.replicates.iter().map(|totals| &totals.outputs[number].sample).collect();
    let mut sorted: Vec<f64> = samples.iter().copied().flatten().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let warnings = output_warnings(run, number, counts, &used, indices.as_mut().ok(), corrected, (&samples, &sorted));
    let mut convergence = Vec::new();
    if let (Ok(indices), true) = (&indices, has_stages(run) && corrected.plain.is_none()) {
        let stages = stages(&parts, &layout, &options, indices, &|points| {
            corrected.stages.get(&points).filter(|_| surrogate.is_some())?.get(number)?.as_ref()
        });
        convergence = stages.iter().map(|stage| stage_record(study, stage, run.design.rows_per_point())).collect();
    }
    let squared = |x: f64| unit.span_from_si(unit.span_from_si(x));
    let mut result = OutputResult {
        name: output.name.to_string(),
        unit: unit.to_string(),
        mean: mean.map(|mean| unit.from_si(mean.estimate)).filter(|mean| mean.is_finite()),
        variance: variance.map(|variance| squared(variance.estimate)).filter(|variance| variance.is_finite()),
        mean_interval: mean.and_then(|mean| mean.interval?.map(|x| unit.from_si(x))),
        variance_interval: variance.and_then(|variance| variance.interval?.map(squared)),
        runs_ok: run.design.rows() - totals.runs_failed,
        runs_failed: totals.runs_failed,
        base_points_used: used.fewest(),
        failures: totals.failures.iter().map(|(failure, tally)| failure_count(run, &failure, tally)).collect(),
        measures: rows.measured.as_ref().and_then(|rows| rows.measures(&study.analysis.measures, number, &samples)),
        convergence,
        reason: indices.as_ref().err().copied(),
        warnings,
        ..OutputResult::default()
    };
    if let Ok(indices) = &indices {
        add_indices(&mut result, study, indices);
    }
    if let Some(rows) = &rows.scatter {
        let is_item = run.model.series().iter().any(|series| series.places().contains(&number));
        result.distribution = distribution_record(&totals.values, &sorted, unit, is_item);
        if !is_item && run.model.outputs().len() <= MAX_PICTURED {
            result.scatter = scatter(study, &result, rows, &samples, unit);
        }
    }
    result
}

/// Sets the indices of what is everything that changes the output, such as a factor alone: they are exactly 1.
fn set_everything(indices: &mut OutputIndices, study: &Study, model: &dyn Model, number: usize) {
    let one = Estimate::exact(1.0);
    for (effect, of) in study.effects().iter().zip(&mut indices.effects) {
        if !study.is_everything(effect, model, number) {
            continue;
        }
        let estimates = &mut of.estimates;
        (estimates.first_order, estimates.total) = (one, one);
        estimates.interaction = estimates.interaction.map(|_| Estimate::exact(0.0));
        estimates.shapley = estimates.shapley.map(|_| one);
        if effect.effect.is_input() {
            indices.sums = IndexPair { first_order: one, total: one };
        }
    }
}

/// Returns whether the indices at the stages of `run` are computed.
pub(super) fn has_stages(run: &FinishedRun<'_>) -> bool {
    run.study.analysis.convergence && run.model.outputs().len() <= MAX_PICTURED
}

/// Returns the warnings on output number `number`, and withdraws what its `indices` do not hold.
fn output_warnings(
    run: &FinishedRun<'_>,
    number: usize,
    counts: &Totals,
    used: &Moments,
    indices: Option<&mut OutputIndices>,
    corrected: &Corrections,
    (samples, sorted): (&[&Vec<f64>], &[f64]),
) -> Vec<Warning> {
    let (study, totals) = (run.study, &counts.outputs[number]);
    let mut warnings = warnings::of_runs(run, totals.runs_failed, used);
    warnings.extend(warnings::of_flags(run.model, counts));
    warnings.extend(corrected.rare.iter().cloned().map(Warning::RareLevel));
    if let Some(indices) = indices {
        withdraw(indices, &corrected.rare, &study.effects());
        warnings.extend(warnings::of_digits(&totals.values));
        warnings.extend(warnings::of_values(&totals.values));
        warnings.extend(run.low_fidelity.iter().filter_map(|low| low.refusal(number, run.design)));
        warnings.extend(warnings::of_indices(study, indices));
        warnings::without_consequences(&mut warnings);
    }
    // All rows of a table are checked when it is read.
    if !study.subject.is_external() {
        warnings.extend(unlikely::of_samples(run.design, &run.model.outputs()[number], samples, sorted));
    }
    warnings
}

/// Returns the relation of the `samples` of an output to its most influential factors; `None` without indices of
/// factors.
fn scatter(
    study: &Study,
    result: &OutputResult,
    rows: &FirstRows,
    samples: &[&Vec<f64>],
    unit: &Unit,
) -> Option<ScatterRecord> {
    let is_of_factors = study.analysis.indices_of == IndicesOf::Factors;
    let indices = result.indices.as_deref().filter(|_| is_of_factors)?;
    scatter_record(rows, &study.space, (unit, samples), indices)
}

/// Computes mean and variance of all successful rows A and B. The indices use the `points` base points at which both
/// rows succeeded, and so do the `moments` with their intervals; if some succeeded alone, the interval of the mean is
/// moved to the mean of all, and that of the variance is scaled to theirs.
fn moments_of_all_rows(
    values: &CentralMoments,
    moments: Option<OutputMoments>,
    points: u64,
) -> (Option<Estimate>, Option<Estimate>) {
    let (Some(mean), Some(variance)) = (values.mean(), values.variance()) else { return (None, None) };
    let Some(moments) = moments else { return (Some(Estimate::alone(mean)), Some(Estimate::alone(variance))) };
    if values.count() == 2 * points {
        return (Some(moments.mean), Some(moments.variance));
    }
    let shift = mean - moments.mean.estimate;
    let ratio = variance / moments.variance.estimate;
    let of_mean = moments.mean.interval.and_then(|interval| interval.map(|bound| bound + shift));
    let of_variance = moments.variance.interval.and_then(|interval| interval.map(|bound| bound * ratio));
    (Some(Estimate { estimate: mean, interval: of_mean }), Some(Estimate { estimate: variance, interval: of_variance }))
}

fn failure_count(run: &FinishedRun<'_>, failure: &RowFailure, tally: Tally) -> FailureCount {
    FailureCount {
        reason: failure.to_string(),
        runs: tally.count,
        first_row: Some(tally.first.row(run.design)),
        first_inputs: named_inputs(&run.study.space, &row_inputs(run.study, run.design, tally.first)),
    }
}

/// Computes moments and range from all values of the rows A and B, the rest from the kept ones, which are `sorted`. `None` without values,
/// and if a number exceeds double precision in the unit. A value of a series has neither histogram nor density.
fn distribution_record(
    values: &CentralMoments,
    sorted: &[f64],
    unit: &Unit,
    is_item: bool,
) -> Option<OutputDistribution> {
    let mut sample = OutputDistribution::from_values(sorted, unit)?;
    let (min, max) = values.range()?;
    (sample.mean, sample.min, sample.max) = (unit.from_si(values.mean()?), unit.from_si(min), unit.from_si(max));
    let n = values.count();
    let variance = values.variance()?;
    let sd = (variance * (n as f64 / (n as f64 - 1.0))).sqrt();
    // The variance of values that vary by 1e-160 underflows; that of the kept ones is scaled.
    if variance.is_normal() || min == max {
        sample.sd = (n > 1).then(|| unit.span_from_si(sd)).filter(|sd| sd.is_finite());
    }
    if is_item {
        sample.histogram = None;
    }
    (sample.skewness, sample.excess_kurtosis) = (values.skewness(), values.excess_kurtosis());
    let quantiles = sample.quantiles.iter().map(|quantile| quantile.value);
    let edges = sample.histogram.iter().flat_map(|histogram| histogram.edges.iter().copied());
    let all = [sample.mean, sample.min, sample.max].into_iter().chain(quantiles).chain(edges);
    let representable = all.into_iter().all(f64::is_finite);
    sample.values = n;
    representable.then_some(sample)
}
