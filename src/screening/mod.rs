//! Screening by elementary effects: which of many factors matter, for a few runs each.
//!
//! An elementary effect of factor j at a point of the unit cube is the change of the output over the step of the
//! factor alone, EE_j = (f(.., b_j, ..) - f(.., a_j, ..)) / (b_j - a_j) (Morris 1991, Technometrics 33, 161-174). Since
//! the step is a part of the unit interval, effects are in units of the output per full range of the factor, and
//! factors of different units compare. A factor that is not uniform has the bend of its quantile function in sigma,
//! even where the model is linear in it. A discrete factor steps by its rank among its values, between two
//! different ones drawn by their probabilities: one rank is 1 / (number of values - 1) of its range.
//!
//! In the derivative design the steps are short, and effects are derivatives times the range of the factor: beside the other measures
//! stands the mean square of the derivative, and the bound on the total index that follows from it ([`DerivativeMeasures`]).
//!
//! r trajectories of d + 1 runs give r effects of each of d factors; [`Measures`] sums them up, [`Reading`] says what
//! they mean, and a factor whose mu* with its error stays below [`FIXABLE`] times the largest mu* could be fixed.
//!
//! In the radial design a step shorter than [`MIN_STEP`] is replaced by one to the auxiliary coordinate half a range
//! further on, round the ends: tiny steps would divide the noise and the jumps of the output by next to nothing.

mod derivative;
mod measures;
mod points;
mod run;
mod settings;

#[cfg(test)]
mod tests;

pub use derivative::{DerivativeMeasures, poincare_constant};
#[doc(hidden)]
pub use measures::FIXABLE;
pub use measures::{Measures, Reading};
#[doc(hidden)]
pub use points::TAIL;
#[doc(hidden)]
pub use settings::{DERIVATIVE_STEP, MAX_LEVELS, MAX_RUNS, MIN_STEP, MIN_TRAJECTORIES};
pub use settings::{ScreeningDesign, ScreeningError, ScreeningSettings};

use crate::model::{Model, Output, RowFailure, RunContext};
use crate::run::Progress;
use crate::space::{Factor, Space};
use derivative::{derivative_measures, range, sum_of_bounds};
use points::Trajectories;

/// What is screened.
#[derive(Clone, Copy)]
pub struct ScreeningJob<'a> {
    /// The factors.
    pub space: &'a Space,
    /// What is evaluated, over as many inputs as there are factors.
    pub model: &'a dyn Model,
    /// How.
    pub settings: ScreeningSettings,
}

/// A screening that has taken place.
#[derive(Debug, Clone, PartialEq)]
pub struct Screening {
    /// The settings in force.
    pub settings: ScreeningSettings,
    /// Independent parts that the intervals rest on.
    pub parts: u64,
    /// Model runs.
    pub runs: u64,
    /// Model runs that failed in at least one output.
    pub failed: u64,
    /// For each factor: steps that did not change its value, as those of a constant; their effect is 0.
    pub idle: Vec<u64>,
    /// For each validity flag of the model: runs that raised it.
    pub flags: Vec<u64>,
    /// One entry per output of the model.
    pub outputs: Vec<ScreenedOutput>,
}

/// What a screening says of one output.
#[derive(Debug, Clone, PartialEq)]
pub struct ScreenedOutput {
    /// One entry per factor, in the order of the space.
    pub factors: Vec<ScreenedFactor>,
    /// Of a derivative design: the sum of the upper ends of what total indices are at most, if it is below 1. Total indices of
    /// independent factors sum to at least that, so that the derivatives have missed what the output varies by.
    pub missed: Option<f64>,
    /// Why runs failed.
    pub failures: Vec<ScreeningFailure>,
}

/// What a screening says of one factor and one output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScreenedFactor {
    /// Elementary effects that the measures rest on.
    pub effects: u64,
    /// Effects dropped because a run at either end failed.
    pub dropped: u64,
    /// Mean and spread of the effects in the output's unit per full range of the factor; `None` with fewer than two, or if they
    /// overflow.
    pub measures: Option<Measures>,
    /// What the spread says; `None` without measures, or where every effect is 0.
    pub reading: Option<Reading>,
    /// Place by mu*, from 1; factors without measures come last.
    pub rank: usize,
    /// Whether the upper bound of mu* is below [`FIXABLE`] times the largest mu*, by at least half of the effects.
    /// `None` where nothing can be said: without measures or an interval, where no factor has any effect, or where the derivatives
    /// have [missed something](ScreenedOutput::missed).
    pub could_be_fixed: Option<bool>,
    /// What its derivatives say; `None` in other designs than that of derivatives, with fewer than two effects, or if they overflow.
    pub derivative: Option<DerivativeMeasures>,
}

/// Runs of a screening that failed for one reason.
#[derive(Debug, Clone, PartialEq)]
pub struct ScreeningFailure {
    /// The reason.
    pub reason: RowFailure,
    /// The number of runs.
    pub runs: u64,
    /// The first one's factor values, in the units of the factors.
    pub first: Vec<f64>,
}

/// Screens the factors of `job` on `threads` threads (0: one per core). `on_progress` is called from time to time, from
/// any thread. The result is the same on any number of threads, in every bit.
///
/// ```
/// use std::path::Path;
/// use apportion::screening::{Reading, ScreeningJob, ScreeningSettings, screen};
/// use apportion::Study;
///
/// let study = Study::parse(include_str!("../../studies/ishigami.toml"), Path::new("ishigami.toml"), &[])?;
/// let model = study.model();
/// let settings = ScreeningSettings::default();
/// let job = ScreeningJob { space: study.space(), model: model.as_ref(), settings };
/// let screening = screen(job, 0, &|_| ())?;
/// assert_eq!(screening.runs, 32 * 4);
/// assert!(screening.outputs[0].factors.iter().all(|x| x.reading == Some(Reading::NonLinearOrInteracting)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ScreeningError`] if the settings make no sense, the threads cannot be started or the model gives up. Runs
/// that fail are part of the result.
pub fn screen(
    job: ScreeningJob<'_>,
    threads: usize,
    on_progress: &(dyn Fn(Progress) + Sync),
) -> Result<Screening, ScreeningError> {
    screen_in(job, threads, on_progress, &RunContext::default())
}

/// The same as the run of `context`, which may end it.
///
/// # Errors
/// As for [`screen`], and [`RunError::Interrupted`](crate::run::RunError::Interrupted) if the run is to end.
pub fn screen_in(
    job: ScreeningJob<'_>,
    threads: usize,
    on_progress: &(dyn Fn(Progress) + Sync),
    context: &RunContext<'_>,
) -> Result<Screening, ScreeningError> {
    let factors = job.space.factors();
    if job.space.copula().is_some() {
        return Err(ScreeningError::Dependent);
    }
    let is_derivative = matches!(job.settings.design, ScreeningDesign::Derivative { .. });
    let separate = |factor: &&Factor| factor.distribution().levels().is_some() || factor.distribution().is_noise();
    if let Some(factor) = factors.iter().find(separate).filter(|_| is_derivative) {
        return Err(ScreeningError::Separate { factor: factor.name.clone() });
    }
    let (settings, parts) = job.settings.in_force(factors.len())?;
    let points = Trajectories::new(job.space, &settings, parts)?;
    let outcome = run::run(job, &points, settings.trajectories, threads, context, on_progress)?;
    context.messages().finish();
    let failures = |number: usize| {
        let of_output = outcome.failures.iter().filter(|((output, _), _)| *output == number);
        let in_units = |first: &[f64]| first.iter().zip(factors).map(|(x, factor)| factor.unit().from_si(*x)).collect();
        of_output
            .map(|((_, reason), (runs, first))| ScreeningFailure {
                reason: reason.clone(),
                runs: *runs,
                first: in_units(first),
            })
            .collect()
    };
    let outputs = job.model.outputs().iter().zip(&outcome.effects).enumerate();
    let outputs = outputs.map(|(number, (output, effects))| {
        let mut screened = screened(output, effects, &outcome.base[number], factors, parts as usize);
        let missed = sum_of_bounds(&screened).filter(|sum| *sum < 1.0);
        if missed.is_some() {
            screened.iter_mut().for_each(|factor| factor.could_be_fixed = None);
        }
        ScreenedOutput { factors: screened, missed, failures: failures(number) }
    });
    Ok(Screening {
        settings,
        parts,
        runs: settings.trajectories * (factors.len() as u64 + 1),
        failed: outcome.failed,
        outputs: outputs.collect(),
        idle: outcome.idle,
        flags: outcome.flags,
    })
}

/// The factors of one output, from its effects in SI units, factor by factor within each trajectory.
fn screened(output: &Output, effects: &[f64], base: &[f64], space: &[Factor], parts: usize) -> Vec<ScreenedFactor> {
    let factors = space.len();
    let base: Vec<f64> = base.iter().map(|y| output.unit.span_from_si(*y)).collect();
    let of_factor = |j: usize| -> Vec<f64> {
        effects.iter().skip(j).step_by(factors).map(|effect| output.unit.span_from_si(*effect)).collect()
    };
    let mut screened: Vec<ScreenedFactor> = (0..factors)
        .map(|j| {
            let own = of_factor(j);
            let effects = own.iter().filter(|effect| effect.is_finite()).count() as u64;
            let measures = measures::measures(&own, parts);
            let reading = measures.and_then(|m| m.ratio).map(|ratio| Reading::of(ratio.estimate));
            let dropped = own.len() as u64 - effects;
            let distribution = space[j].distribution();
            let derivative = (!base.is_empty())
                .then(|| derivative_measures(&own, &base, parts, range(distribution), poincare_constant(distribution)))
                .flatten();
            ScreenedFactor { effects, dropped, measures, reading, rank: 0, could_be_fixed: None, derivative }
        })
        .collect();
    let size = |factor: &ScreenedFactor| factor.measures.map_or(f64::NEG_INFINITY, |m| m.mu_star.estimate);
    let mut order: Vec<usize> = (0..factors).collect();
    order.sort_by(|&i, &j| size(&screened[j]).total_cmp(&size(&screened[i])));
    let largest = order.first().map_or(0.0, |&first| size(&screened[first]));
    for (place, &j) in order.iter().enumerate() {
        screened[j].rank = place + 1;
    }
    for factor in &mut screened {
        let high = factor.measures.and_then(|m| m.mu_star.interval).map(|interval| interval.high);
        factor.could_be_fixed =
            high.filter(|_| largest > 0.0).map(|high| high < FIXABLE * largest && factor.effects >= factor.dropped);
    }
    screened
}
