//! From the totals of a run to its result.

use std::collections::BTreeMap;

use rayon::prelude::*;
use serde_json::Map;

use super::finished_run::{FinishedRun, LowTotals, named_inputs, outputs_kept, row_inputs};
use super::measures::MeasuredRows;
use super::output::{FailureCount, NoIndices, OutputAnalysis, SurrogateTrial};
use super::rare_levels::{RareLevel, rare_levels, withdraw};
use super::result::{Aggregate, Analysis, LowRuns, Stopped};
use super::series::{series, single_outputs, together};
use super::unlikely;
use super::warning::Warning;
use super::warnings;
use crate::design::Design;
use crate::estimate::{CentralMoments, MomentParts, PointOutputs, Scaling, merged};
use crate::model::{MANY_OUTPUTS, Output, RowFailure};
use crate::run::{Tally, Totals};
use crate::study::{Study, SurrogateChoice};
use crate::surrogate::low_fidelity::{LowOutputs, low_fidelity_estimates};
use crate::surrogate::{families, surrogates_together};
use crate::uncertainty::{
    Estimate, IntervalOptions, KeptPoints, OutputMoments, SurrogateEstimates, output_indices, output_moments,
    points_of_stages, stages,
};

/// Rows on which surrogates of a quick model are tried.
const TRIAL_ROWS: u64 = 1 << 13;

/// How many times smaller errors must be there with surrogates than without: what they leave is known less well from few rows than from
/// all, and a correction of a million runs takes seconds.
const MIN_GAIN: f64 = 4.0;

/// The result of a run; `stopped` tells why a growing one ended.
pub(crate) fn analysis(run: &FinishedRun<'_>, stopped: Option<Stopped>) -> Analysis {
    let FinishedRun { model, replicates, .. } = *run;
    let mut whole = Totals::none(model);
    replicates.iter().for_each(|totals| whole.add_counts(totals));
    let corrected = Corrections::of(run);
    let series = series(run, &whole, &corrected.whole);
    Analysis {
        design: run.design.clone(),
        outputs: output_analyses(run, &whole, &corrected),
        flags: model.flags().iter().cloned().zip(whole.flags).collect(),
        counts: model.counters().iter().cloned().zip(whole.counts.values()).collect(),
        aggregate: aggregate(run),
        series,
        stopped,
        threads: run.threads,
        wall_seconds: run.wall_seconds,
        lows: run.lows.iter().map(low_runs).collect(),
        spending: None,
    }
}

/// The results for all outputs; `whole` holds the counts over all replicates.
fn output_analyses(run: &FinishedRun<'_>, whole: &Totals, corrected: &Corrections) -> Vec<OutputAnalysis> {
    let outputs = run.model.outputs().par_iter().enumerate();
    let mut analyses: Vec<OutputAnalysis> =
        outputs.map(|(number, output)| output_analysis(run, output, number, whole, corrected)).collect();
    let wanted = &run.study.analysis.measures;
    if !wanted.is_empty() {
        let rows = MeasuredRows::of(run.design, &run.study.space);
        for (number, output) in analyses.iter_mut().enumerate() {
            output.measures = rows.measures(wanted, number, &output.samples);
        }
    }
    analyses
}

fn low_runs(low: &LowTotals<'_>) -> LowRuns {
    let runs = |replicates: &[Totals]| replicates.iter().map(|totals| totals.runs).sum();
    LowRuns {
        name: low.name.to_owned(),
        shared_runs: runs(low.shared),
        own_base_samples: low.design.settings().base_samples,
        own_runs: runs(low.own),
    }
}

/// How the intervals and probabilities of `study` are found.
pub(crate) fn interval_options(study: &Study) -> IntervalOptions<'static> {
    let (analysis, seed) = (&study.analysis, study.design.settings().seed);
    let (method, threshold, resamples) = (analysis.intervals, analysis.threshold, analysis.resamples);
    IntervalOptions { method, threshold, seed, resamples, points: None, ranks: true, surrogate: None }
}

/// What surrogates and cheaper models make of every output of the runs of `design`, the first of `replicates`, if the study
/// asks for it and the outputs have been kept: of each the one with the smallest errors. `longer` has what they made of a longer run
/// of the same points, if there was one: of its outputs the same ones are corrected, in the same terms.
pub(crate) fn surrogates(
    study: &Study,
    design: &Design,
    replicates: &[Totals],
    lows: &[LowTotals<'_>],
    longer: &[Option<SurrogateEstimates>],
) -> Vec<Option<SurrogateEstimates>> {
    surrogates_and_trials(study, design, replicates, lows, longer).0
}

/// The same, and the trial of each output that had one.
fn surrogates_and_trials(
    study: &Study,
    design: &Design,
    replicates: &[Totals],
    lows: &[LowTotals<'_>],
    longer: &[Option<SurrogateEstimates>],
) -> (Vec<Option<SurrogateEstimates>>, Vec<Option<SurrogateTrial>>) {
    let outputs = replicates.first().map_or(0, |totals| totals.outputs.len());
    let first = |replicates: &[Totals], number: usize| -> Vec<PointOutputs> {
        let kept = outputs_kept(replicates, number).into_iter();
        kept.map(|outputs| outputs.prefix(design.points_per_replicate())).collect()
    };
    let kept: Vec<Vec<PointOutputs>> = (0..outputs).map(|number| first(replicates, number)).collect();
    if !study.uses_surrogate(design) || kept.iter().flatten().all(|outputs| outputs.points() == 0) {
        return (vec![None; outputs], vec![None; outputs]);
    }
    let kept: Vec<Vec<&PointOutputs>> = kept.iter().map(|replicates| replicates.iter().collect()).collect();
    let (families, layout) = (families(&study.space), study.layout());
    let trials = match longer {
        [] => trials(study, design, replicates, &kept),
        _ => vec![None; outputs],
    };
    let gains: Vec<bool> = match longer {
        [] => trials.iter().map(|trial| trial.is_none_or(|trial| trial.gain > MIN_GAIN)).collect(),
        longer => longer.iter().map(Option::is_some).collect(),
    };
    // Polynomials go on where runs fail, and the numbers are those of the part of the space where they succeed.
    let is_left_out = |(outputs, gains): (&Vec<&PointOutputs>, &bool)| {
        !gains
            || study.analysis.surrogate != SurrogateChoice::On && outputs.iter().any(|outputs| outputs.has_failures())
    };
    let left_out: Vec<bool> = kept.iter().zip(&gains).map(is_left_out).collect();
    let whole: Vec<Vec<&PointOutputs>> =
        kept.iter().zip(&left_out).filter(|(_, left_out)| !**left_out).map(|(outputs, _)| outputs.clone()).collect();
    let longer: Vec<Option<SurrogateEstimates>> =
        longer.iter().zip(&left_out).filter(|(_, left_out)| !**left_out).map(|(of, _)| of.clone()).collect();
    let mut of_whole = surrogates_together(design, &families, &layout, &whole, &longer).into_iter();
    let alone: Vec<Option<SurrogateEstimates>> =
        left_out.iter().map(|left_out| if *left_out { None } else { of_whole.next().flatten() }).collect();
    let best = |(number, alone): (usize, Option<SurrogateEstimates>)| {
        if left_out[number] {
            return None;
        }
        let of_low = |low: &LowTotals<'_>| {
            let own = low.outputs.get(number)?.as_ref()?;
            let shared = first(low.shared, number);
            let low = LowOutputs { name: low.name, shared: shared.iter().collect(), own };
            low_fidelity_estimates(design, &families, &layout, &kept[number], &low)
        };
        let all = alone.into_iter().chain(lows.iter().filter_map(of_low));
        all.min_by(|a, b| a.squared_error().total_cmp(&b.squared_error()))
    };
    let misses_levels = rare_levels(&study.space, design).iter().any(RareLevel::is_missed);
    let of_rows = |of: SurrogateEstimates| SurrogateEstimates { misses_levels, ..of };
    (alone.into_iter().enumerate().map(|place| best(place).map(of_rows)).collect(), trials)
}

/// What surrogates of each output gain, where it is not known beforehand that they are worth their time, by a fit to some of the base
/// points.
fn trials(
    study: &Study,
    design: &Design,
    replicates: &[Totals],
    kept: &[Vec<&PointOutputs>],
) -> Vec<Option<SurrogateTrial>> {
    if !study.tries_surrogates(design) {
        return vec![None; kept.len()];
    }
    let moments = |number: usize| replicates.iter().map(move |totals| &totals.outputs[number].moments);
    let parts = moments(0).map(|all| all.prefix(parts_of_trial(all, design)));
    let points = parts.map(|parts| parts.points()).min().unwrap_or(0);
    let Ok(trial) = design.with_points(points) else { return vec![None; kept.len()] };
    let first: Vec<Vec<PointOutputs>> =
        kept.iter().map(|replicates| replicates.iter().map(|kept| kept.prefix(points)).collect()).collect();
    let first: Vec<Vec<&PointOutputs>> = first.iter().map(|replicates| replicates.iter().collect()).collect();
    let found = surrogates_together(&trial, &families(&study.space), &study.layout(), &first, &[]);
    let gains = |(number, of): (usize, &Option<SurrogateEstimates>)| {
        let parts: Vec<MomentParts> = moments(number).map(|all| all.prefix(parts_of_trial(all, design))).collect();
        let options = IntervalOptions { surrogate: of.as_ref(), ranks: false, ..interval_options(study) };
        let used = output_indices(&parts, &study.layout(), &options).ok().and_then(|indices| indices.surrogate);
        let gains = used.map(|used| [used.gain_first_order, used.gain_total].map(|gain| gain.unwrap_or(0.0).sqrt()));
        let gain = gains.map_or(0.0, |[first_order, total]| first_order.min(total));
        Some(SurrogateTrial { runs: trial.rows(), gain, needed: MIN_GAIN })
    };
    found.iter().enumerate().map(gains).collect()
}

/// How many of the parts of a replicate the trial takes.
fn parts_of_trial(all: &MomentParts, design: &Design) -> usize {
    let parts = all.parts().len() as u64;
    let wanted = (TRIAL_ROWS * parts).div_ceil(design.rows()).next_power_of_two();
    wanted.min(parts) as usize
}

/// What surrogates and cheaper models make of every output, in the end and at every stage of the run.
struct Corrections {
    whole: Vec<Option<SurrogateEstimates>>,
    /// By the base points of a replicate.
    stages: BTreeMap<u64, Vec<Option<SurrogateEstimates>>>,
    /// What surrogates gained in trials of the outputs; none of a run that grew.
    trials: Vec<Option<SurrogateTrial>>,
    /// What the rows hardly met.
    rare: Vec<RareLevel>,
}

impl Corrections {
    fn of(run: &FinishedRun<'_>) -> Self {
        let FinishedRun { study, design, replicates, lows, .. } = *run;
        let known = run.surrogates.map(|known| (known.to_vec(), Vec::new()));
        let (whole, trials) = known.unwrap_or_else(|| surrogates_and_trials(study, design, replicates, lows, &[]));
        let mut stages = BTreeMap::new();
        if study.analysis.convergence && whole.iter().any(Option::is_some) {
            // All outputs have the same parts.
            let parts: Vec<&MomentParts> =
                replicates.iter().filter_map(|totals| Some(&totals.outputs.first()?.moments)).collect();
            for points in points_of_stages(&parts) {
                if let Ok(design) = design.with_points(points) {
                    stages.insert(points, surrogates(study, &design, replicates, lows, &whole));
                }
            }
        }
        Self { whole, stages, trials, rare: rare_levels(&study.space, design) }
    }
}

/// The result for output number `number`; `whole` holds the counts over all replicates.
fn output_analysis(
    run: &FinishedRun<'_>,
    output: &Output,
    number: usize,
    whole: &Totals,
    corrected: &Corrections,
) -> OutputAnalysis {
    let study = run.study;
    let totals = &whole.outputs[number];
    let parts: Vec<MomentParts> = run.replicates.iter().map(|t| t.outputs[number].moments.clone()).collect();
    let kept = outputs_kept(run.replicates, number);
    let surrogate = corrected.whole.get(number).and_then(Option::as_ref);
    let options = IntervalOptions { points: KeptPoints::all(run.design, &kept), surrogate, ..interval_options(study) };
    let used = merged(&parts.iter().map(MomentParts::whole).collect::<Vec<_>>());
    let failure = |(failure, tally): (RowFailure, Tally)| failure_count(run, &failure, tally);
    let share = totals.runs_failed as f64 / run.design.rows() as f64;
    let layout = study.layout();
    let mut indices = if share > study.analysis.max_failed {
        Err(NoIndices::TooManyFailed { share, allowed: study.analysis.max_failed })
    } else {
        output_indices(&parts, &layout, &options).map_err(NoIndices::from)
    };
    let is_refused = indices.as_ref().is_ok_and(|of| of.surrogate.as_ref().is_some_and(|used| used.refusal.is_some()));
    let of_moments = IntervalOptions { surrogate: surrogate.filter(|_| !is_refused), ..options };
    let (mean, variance) = moments_of_all_rows(&totals.values, output_moments(&parts, &of_moments), used.count());
    let mut warnings = warnings::of_runs(run, totals.runs_failed, &used);
    warnings.extend(warnings::of_flags(run.model, whole));
    warnings.extend(corrected.rare.iter().cloned().map(Warning::RareLevel));
    if let Ok(indices) = &mut indices {
        withdraw(indices, &corrected.rare);
        warnings.extend(warnings::of_digits(&totals.values));
        warnings.extend(warnings::of_values(&totals.values));
        warnings.extend(warnings::of_indices(study, indices));
        warnings::without_consequences(&mut warnings);
    }
    let samples: Vec<Vec<f64>> = run.replicates.iter().map(|totals| totals.outputs[number].sample.clone()).collect();
    // Of a table all rows are looked at when it is read.
    if !study.subject.is_external() {
        warnings.extend(unlikely::of_samples(run.design, output, &samples));
    }
    let factors = study.space.factors().iter().map(|factor| factor.name.clone()).collect();
    let of_stage = |points: u64| corrected.stages.get(&points).filter(|_| surrogate.is_some())?.get(number)?.as_ref();
    let asked = indices.as_ref().ok().filter(|_| study.analysis.convergence);
    let convergence = asked.map(|indices| stages(&parts, &layout, &options, indices, &of_stage));
    OutputAnalysis {
        name: output.name.to_string(),
        unit: output.unit.clone(),
        mean,
        variance,
        runs_ok: run.design.rows() - totals.runs_failed,
        runs_failed: totals.runs_failed,
        base_points_used: used.fewest(),
        failures: totals.failures.iter().map(failure).collect(),
        convergence: convergence.unwrap_or_default(),
        indices,
        trial: corrected.trials.get(number).copied().flatten(),
        values: totals.values,
        samples,
        measures: None,
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
    let Some(moments) = moments else { return (Some(Estimate::alone(mean)), Some(Estimate::alone(variance))) };
    if values.count() == 2 * points {
        return (Some(moments.mean), Some(moments.variance));
    }
    let changed = |of: Estimate, estimate: f64, change: &dyn Fn(f64) -> f64| {
        Some(Estimate { estimate, interval: of.interval.and_then(|interval| interval.map(change)) })
    };
    let shift = mean - moments.mean.estimate;
    let ratio = variance / moments.variance.estimate;
    (changed(moments.mean, mean, &|bound| bound + shift), changed(moments.variance, variance, &|bound| bound * ratio))
}

fn failure_count(run: &FinishedRun<'_>, failure: &RowFailure, tally: Tally) -> FailureCount {
    let inputs = || named_inputs(&run.study.space, &row_inputs(run.study, run.design, tally.first));
    FailureCount {
        reason: failure.to_string(),
        runs: tally.count,
        first_row: tally.first.row(run.design),
        first_inputs: if run.study.analysis.salib { Map::new() } else { inputs() },
    }
}

/// Over all outputs if the study asks for it, else over those that belong to no series, if they are many.
fn aggregate(run: &FinishedRun<'_>) -> Option<Aggregate> {
    let FinishedRun { study, model, replicates, .. } = *run;
    let (outputs, single) = (model.outputs(), single_outputs(model));
    let places = if study.analysis.aggregate { (0..outputs.len()).collect() } else { single };
    if places.len() < 2 || !study.analysis.aggregate && places.len() < MANY_OUTPUTS {
        return None;
    }
    let same_unit = places.iter().all(|&place| outputs[place].unit.compatible(&outputs[places[0]].unit));
    let scaling = if same_unit { Scaling::Plain } else { Scaling::Standardised };
    let names = places.iter().map(|&place| outputs[place].name.to_string()).collect();
    Some(Aggregate { outputs: names, scaling, indices: together(replicates, places.into_iter(), scaling, run) })
}
