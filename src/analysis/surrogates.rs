//! Surrogate estimates of the outputs of a run, with low-fidelity models if there are any.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::finished_run::{FinishedRun, LowFidelityTotals, outputs_kept};
use super::output_indices::{IntervalOptions, output_indices};
use super::plain::PlainOutputs;
use super::rare_levels::rare_levels;
use super::stages::points_of_stages;
use crate::correction::SurrogateEstimates;
use crate::correction::surrogates_together;
use crate::correction::{LowFidelityOutputs, low_fidelity_estimates};
use crate::design::Design;
use crate::estimate::{MomentParts, PointOutputs};
use crate::result::{RareLevel, SurrogateTrial};
use crate::run::Totals;
use crate::study::{Study, SurrogateChoice};
use crate::surrogate::{CrossFitted, families};

/// Number of rows on which surrogates of a fast model are tried.
const TRIAL_ROWS: u64 = 1 << 13;

/// Minimum ratio of the errors without and with surrogates: their residual is estimated less accurately from few rows
/// than from all, and a correction of a million runs takes seconds.
const MIN_GAIN: f64 = 4.0;

/// Returns the options for intervals and probabilities of `study`.
pub(crate) fn interval_options(study: &Study) -> IntervalOptions<'static> {
    let (analysis, seed) = (&study.analysis, study.design.settings().seed);
    let (method, threshold, resamples) = (analysis.intervals, analysis.threshold, analysis.resamples);
    IntervalOptions { method, threshold, seed, resamples, points: None, ranks: true, unread: &[], surrogate: None }
}

/// Computes the surrogate estimates of every output of the runs of `design`, the first of `replicates`, if the study
/// requests them and the outputs have been kept: for each those with the smallest errors. `longer` is the estimates of
/// a longer run of the same points, if there was one: the same outputs are corrected, by the same surrogates.
pub(crate) fn surrogates(
    study: &Study,
    design: &Design,
    replicates: &[Totals],
    low_fidelity: &[LowFidelityTotals<'_>],
    longer: &[Option<SurrogateEstimates>],
) -> Vec<Option<SurrogateEstimates>> {
    surrogates_and_trials(study, design, replicates, low_fidelity, longer).0
}

/// Returns the same, and the trial of each output that had one.
fn surrogates_and_trials(
    study: &Study,
    design: &Design,
    replicates: &[Totals],
    low_fidelity: &[LowFidelityTotals<'_>],
    longer: &[Option<SurrogateEstimates>],
) -> (Vec<Option<SurrogateEstimates>>, Vec<Option<SurrogateTrial>>) {
    let outputs = replicates.first().map_or(0, |totals| totals.outputs.len());
    let points = design.points_per_replicate();
    let kept: Vec<Vec<PointOutputs>> = (0..outputs).map(|number| first_points(replicates, number, points)).collect();
    if design.is_plain() || !study.uses_surrogate(design) || kept.iter().flatten().all(|outputs| outputs.points() == 0)
    {
        return (vec![None; outputs], vec![None; outputs]);
    }
    let kept: Vec<Vec<&PointOutputs>> = kept.iter().map(|replicates| replicates.iter().collect()).collect();
    let (families, layout) = (families(&study.space), study.layout());
    let (trials, of_trials) =
        if longer.is_empty() { trials(study, design, replicates, &kept) } else { (vec![None; outputs], Vec::new()) };
    let others = if longer.is_empty() { &of_trials } else { longer };
    // The outputs that are corrected. Polynomials continue where runs fail, but the numbers are those of the part of the
    // space where they succeed.
    let mut numbers = Vec::new();
    for (number, replicates) in kept.iter().enumerate() {
        let gains = match longer {
            [] => trials[number].is_none_or(|trial| trial.gain > MIN_GAIN),
            longer => longer[number].is_some(),
        };
        let is_on = study.analysis.surrogate == SurrogateChoice::On;
        if gains && (is_on || !replicates.iter().any(|outputs| outputs.has_failures())) {
            numbers.push(number);
        }
    }
    let all: Vec<Vec<&PointOutputs>> = numbers.iter().map(|&number| kept[number].clone()).collect();
    let known = numbers.iter().map(|&number| others.get(number)?.as_ref()?.fitted.as_ref());
    let known: Vec<Option<&CrossFitted>> = known.collect();
    let misses_levels = rare_levels(&study.space, design).iter().any(RareLevel::is_missed);
    let mut best = vec![None; outputs];
    let alone = surrogates_together(design, &families, &layout, &all, &known);
    for (alone, number) in alone.into_iter().zip(numbers) {
        let mut all: Vec<SurrogateEstimates> = alone.into_iter().collect();
        for low in low_fidelity.iter().filter(|low| low.refusal(number, design).is_none()) {
            if let Some(Some(independent)) = low.outputs.get(number) {
                let shared = first_points(low.shared, number, points);
                let low = LowFidelityOutputs { name: low.name, shared: shared.iter().collect(), independent };
                all.extend(low_fidelity_estimates(design, &families, &layout, &kept[number], &low));
            }
        }
        let least = all.into_iter().min_by(|a, b| a.squared_error().total_cmp(&b.squared_error()));
        best[number] = least.map(|of| SurrogateEstimates { misses_levels, ..of });
    }
    (best, trials)
}

/// Returns output number `number` at the first `points` base points of each replicate.
fn first_points(replicates: &[Totals], number: usize, points: u64) -> Vec<PointOutputs> {
    outputs_kept(replicates, number).into_iter().map(|outputs| outputs.prefix(points)).collect()
}

/// Returns the gain by surrogates of each output, if it is not known beforehand that they are worth their time, by a
/// fit to some of the base points, and the estimates from these.
fn trials(
    study: &Study,
    design: &Design,
    replicates: &[Totals],
    kept: &[Vec<&PointOutputs>],
) -> (Vec<Option<SurrogateTrial>>, Vec<Option<SurrogateEstimates>>) {
    let none = (vec![None; kept.len()], Vec::new());
    if !study.tries_surrogates(design) {
        return none;
    }
    let points = parts_of_trial(replicates, 0, design).iter().map(MomentParts::points).min().unwrap_or(0);
    let Ok(trial) = design.with_points(points) else { return none };
    let first: Vec<Vec<PointOutputs>> =
        kept.iter().map(|replicates| replicates.iter().map(|kept| kept.prefix(points)).collect()).collect();
    let first: Vec<Vec<&PointOutputs>> = first.iter().map(|replicates| replicates.iter().collect()).collect();
    let estimates =
        surrogates_together(&trial, &families(&study.space), &study.layout(), &first, &vec![None; kept.len()]);
    let mut trials = Vec::with_capacity(estimates.len());
    for (number, surrogate) in estimates.iter().enumerate() {
        let parts = parts_of_trial(replicates, number, design);
        let options = IntervalOptions { surrogate: surrogate.as_ref(), ranks: false, ..interval_options(study) };
        let used = output_indices(&parts, &study.layout(), &options).ok().and_then(|indices| indices.surrogate);
        let gains = used.map(|used| [used.gain_first_order, used.gain_total].map(|gain| gain.unwrap_or(0.0).sqrt()));
        let gain = gains.map_or(0.0, |[first_order, total]| first_order.min(total));
        trials.push(Some(SurrogateTrial { runs: trial.rows(), gain, needed: MIN_GAIN }));
    }
    (trials, estimates)
}

/// Returns the parts of every replicate of output number `number` that the trial uses.
fn parts_of_trial(replicates: &[Totals], number: usize, design: &Design) -> Vec<MomentParts> {
    let mut prefixes = Vec::with_capacity(replicates.len());
    for totals in replicates {
        let all = &totals.outputs[number].moments;
        let parts = all.parts().len() as u64;
        let wanted = (TRIAL_ROWS * parts).div_ceil(design.rows()).next_power_of_two();
        prefixes.push(all.prefix(wanted.min(parts) as usize));
    }
    prefixes
}

/// The surrogate estimates of every output, at the end and at every stage of the run.
pub(super) struct Corrections {
    pub of_run: Vec<Option<SurrogateEstimates>>,
    /// By the base points of a replicate.
    pub stages: BTreeMap<u64, Vec<Option<SurrogateEstimates>>>,
    /// The surrogates of a run of plain rows.
    pub plain: Option<Arc<PlainOutputs>>,
    /// The gains by surrogates in trials of the outputs; empty for a run that grew.
    pub trials: Vec<Option<SurrogateTrial>>,
    /// The levels that are rare among the rows.
    pub rare: Vec<RareLevel>,
}

impl Corrections {
    pub fn new(run: &FinishedRun<'_>) -> Self {
        let FinishedRun { study, design, replicates, low_fidelity, .. } = *run;
        let known = run.surrogates.map(|known| (known.to_vec(), Vec::new()));
        let (of_run, trials) =
            known.unwrap_or_else(|| surrogates_and_trials(study, design, replicates, low_fidelity, &[]));
        let mut stages = BTreeMap::new();
        if study.analysis.convergence && of_run.iter().any(Option::is_some) {
            // All outputs have the same parts.
            let parts: Vec<&MomentParts> =
                replicates.iter().filter_map(|totals| Some(&totals.outputs.first()?.moments)).collect();
            for points in points_of_stages(&parts) {
                if let Ok(design) = design.with_points(points) {
                    stages.insert(points, surrogates(study, &design, replicates, low_fidelity, &of_run));
                }
            }
        }
        let plain = run.plain.cloned().or_else(|| PlainOutputs::new(study, design, replicates));
        Self { of_run, stages, plain, trials, rare: rare_levels(&study.space, design) }
    }
}
