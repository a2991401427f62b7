//! From the totals of a run to its result.

use super::finished_run::{FinishedRun, row_inputs};
use super::result::{Aggregate, Analysis, FailureCount, NoIndices, OutputAnalysis, Stopped};
use super::warnings;
use crate::design::Design;
use crate::estimate::{CentralMoments, MomentParts, PointOutputs, Scaling, merged};
use crate::model::{Model, Output, RowFailure};
use crate::run::{Tally, Totals};
use crate::study::Study;
use crate::surrogate::{families, surrogate_estimates};
use crate::uncertainty::{
    Estimate, Interval, IntervalOptions, KeptPoints, OutputMoments, SurrogateEstimates, aggregate_indices,
    output_indices, output_moments, stages,
};

/// The result of a run; `stopped` tells why a growing one ended.
pub(crate) fn analysis(run: &FinishedRun<'_>, stopped: Option<Stopped>) -> Analysis {
    let FinishedRun { study, model, replicates, .. } = *run;
    let mut whole = Totals::none(model);
    replicates.iter().for_each(|totals| whole.add_counts(totals));
    let outputs = model.outputs().iter().enumerate();
    Analysis {
        design: run.design.clone(),
        outputs: outputs.map(|(number, output)| output_analysis(run, output, number, &whole)).collect(),
        flags: model.flags().iter().cloned().zip(whole.flags).collect(),
        counts: model.counters().iter().cloned().zip(whole.counts.values()).collect(),
        aggregate: aggregate(study, model, replicates),
        stopped,
        threads: run.threads,
        wall_seconds: run.wall_seconds,
        mixed_models: Vec::new(),
    }
}

/// How the intervals and probabilities of `study` are found.
pub(crate) fn interval_options(study: &Study) -> IntervalOptions<'static> {
    let (analysis, seed) = (&study.analysis, study.design.settings().seed);
    let (method, threshold, resamples) = (analysis.intervals, analysis.threshold, analysis.resamples);
    IntervalOptions { method, threshold, seed, resamples, points: None, surrogate: None }
}

/// What a surrogate makes of the outputs of all runs, if the study asks for one and they have been kept.
pub(crate) fn surrogate(study: &Study, design: &Design, kept: &[&PointOutputs]) -> Option<SurrogateEstimates> {
    if !study.uses_surrogate(design) || kept.iter().all(|outputs| outputs.points() == 0) {
        return None;
    }
    surrogate_estimates(design, &families(&study.space), &study.layout(), kept)
}

/// The result for output number `number`; `whole` holds the counts over all replicates.
fn output_analysis(run: &FinishedRun<'_>, output: &Output, number: usize, whole: &Totals) -> OutputAnalysis {
    let study = run.study;
    let totals = &whole.outputs[number];
    let parts: Vec<MomentParts> = run.replicates.iter().map(|t| t.outputs[number].moments.clone()).collect();
    let kept: Vec<&PointOutputs> = run.replicates.iter().map(|t| &t.outputs[number].point_outputs).collect();
    let surrogate = surrogate(study, run.design, &kept);
    let options = IntervalOptions {
        points: KeptPoints::all(run.design, &kept),
        surrogate: surrogate.as_ref(),
        ..interval_options(study)
    };
    let used = merged(&parts.iter().map(MomentParts::whole).collect::<Vec<_>>());
    let (mean, variance) = moments_of_all_rows(&totals.values, output_moments(&parts, &options), used.count());
    let failure = |(failure, tally): (&RowFailure, &Tally)| failure_count(run, failure, *tally);
    let share = totals.runs_failed as f64 / run.design.rows() as f64;
    let layout = study.layout();
    let indices = if share > study.analysis.max_failed {
        Err(NoIndices::TooManyFailed { share, allowed: study.analysis.max_failed })
    } else {
        output_indices(&parts, &layout, &options).map_err(NoIndices::from)
    };
    let mut warnings = warnings::of_runs(run, totals.runs_failed, used.fewest());
    warnings.extend(warnings::of_flags(run.model, whole));
    if let Ok(indices) = &indices {
        warnings.extend(warnings::of_values(&totals.values));
        warnings.extend(warnings::of_indices(study, indices));
    }
    let factors = study.space.factors().iter().map(|factor| factor.name.clone()).collect();
    OutputAnalysis {
        name: output.name.to_string(),
        unit: output.unit.clone(),
        mean,
        variance,
        runs_ok: run.design.rows() - totals.runs_failed,
        runs_failed: totals.runs_failed,
        base_points_used: used.fewest(),
        failures: totals.failures.iter().map(failure).collect(),
        convergence: if indices.is_ok() { stages(&parts, &layout, &options) } else { Vec::new() },
        indices,
        values: totals.values,
        samples: run.replicates.iter().map(|totals| totals.outputs[number].sample.clone()).collect(),
        warnings,
        names: [factors, study.space.groups().into_iter().map(|group| group.name).collect()],
    }
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

fn failure_count(run: &FinishedRun<'_>, failure: &RowFailure, tally: Tally) -> FailureCount {
    FailureCount {
        reason: failure.to_string(),
        runs: tally.count,
        first_row: tally.first.row(run.design),
        first_inputs: row_inputs(run.study, run.design, tally.first),
    }
}

fn aggregate(study: &Study, model: &dyn Model, replicates: &[Totals]) -> Option<Aggregate> {
    let outputs = model.outputs();
    if !study.analysis.aggregate || outputs.len() < 2 {
        return None;
    }
    let same_unit = outputs.iter().all(|output| output.unit.compatible(&outputs[0].unit));
    let scaling = if same_unit { Scaling::Plain } else { Scaling::Standardised };
    let parts: Vec<Vec<MomentParts>> = (0..outputs.len())
        .map(|number| replicates.iter().map(|totals| totals.outputs[number].moments.clone()).collect())
        .collect();
    let parts: Vec<&[MomentParts]> = parts.iter().map(Vec::as_slice).collect();
    Some(Aggregate { scaling, indices: aggregate_indices(&parts, scaling, study.analysis.intervals) })
}
