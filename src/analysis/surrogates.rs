//! Surrogate estimates of the outputs of a run, with low-fidelity models if there are any.

use std::collections::BTreeMap;

use super::finished_run::{FinishedRun, LowTotals, outputs_kept};
use super::output_indices::{IntervalOptions, output_indices};
use super::rare_levels::rare_levels;
use super::stages::points_of_stages;
use crate::correction::SurrogateEstimates;
use crate::design::Design;
use crate::estimate::{MomentParts, PointOutputs};
use crate::result::{RareLevel, SurrogateTrial};
use crate::run::Totals;
use crate::study::{Study, SurrogateChoice};
use crate::surrogate::low_fidelity::{LowOutputs, low_fidelity_estimates};
use crate::surrogate::{families, surrogates_together};

/// Number of rows on which surrogates of a fast model are tried.
const TRIAL_ROWS: u64 = 1 << 13;

/// Minimum ratio of the errors without and with surrogates: their residual is estimated less accurately from few rows
/// than from all, and a correction of a million runs takes seconds.
const MIN_GAIN: f64 = 4.0;

/// Returns the options for intervals and probabilities of `study`.
pub(crate) fn interval_options(study: &Study) -> IntervalOptions<'static> {
    let (analysis, seed) = (&study.analysis, study.design.settings().seed);
    let (method, threshold, resamples) = (analysis.intervals, analysis.threshold, analysis.resamples);
    IntervalOptions {
        method,
        threshold,
        seed,
        resamples,
        points: None,
        ranks: true,
        correlations: &[],
        surrogate: None,
    }
}

/// Computes the surrogate estimates of every output of the runs of `design`, the first of `replicates`, if the study
/// requests them and the outputs have been kept: for each those with the smallest errors. `longer` is the estimates of
/// a longer run of the same points, if there was one: the same outputs are corrected, in the same terms.
pub(crate) fn surrogates(
    study: &Study,
    design: &Design,
    replicates: &[Totals],
    lows: &[LowTotals<'_>],
    longer: &[Option<SurrogateEstimates>],
) -> Vec<Option<SurrogateEstimates>> {
    surrogates_and_trials(study, design, replicates, lows, longer).0
}

/// Returns the same, and the trial of each output that had one.
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
    // Polynomials continue where runs fail, but the numbers are those of the part of the space where they succeed.
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

/// Returns the gain by surrogates of each output, if it is not known beforehand that they are worth their time, by a
/// fit to some of the base points.
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

/// Returns the number of parts of a replicate that the trial uses.
fn parts_of_trial(all: &MomentParts, design: &Design) -> usize {
    let parts = all.parts().len() as u64;
    let wanted = (TRIAL_ROWS * parts).div_ceil(design.rows()).next_power_of_two();
    wanted.min(parts) as usize
}

/// The surrogate estimates of every output, at the end and at every stage of the run.
pub(super) struct Corrections {
    pub whole: Vec<Option<SurrogateEstimates>>,
    /// By the base points of a replicate.
    pub stages: BTreeMap<u64, Vec<Option<SurrogateEstimates>>>,
    /// The gains by surrogates in trials of the outputs; empty for a run that grew.
    pub trials: Vec<Option<SurrogateTrial>>,
    /// The levels that are rare among the rows.
    pub rare: Vec<RareLevel>,
    /// The [`Design::column_correlations`].
    pub correlations: Vec<f64>,
}

impl Corrections {
    pub fn new(run: &FinishedRun<'_>) -> Self {
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
        Self {
            whole,
            stages,
            trials,
            rare: rare_levels(&study.space, design),
            correlations: design.column_correlations(),
        }
    }
}
