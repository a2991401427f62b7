//! Screening by elementary effects, which finds the important ones of many factors with a few runs each.
//!
//! An elementary effect of factor j at a point of the unit cube is the change of the output over the step of this
//! factor, EE_j = (f(.., b_j, ..) - f(.., a_j, ..)) / (b_j - a_j) (Morris 1991, Technometrics 33, 161-174). Since the
//! step is a part of the unit interval, effects are in units of the output per full range of the factor, and factors of
//! different units can be compared. For a factor that is not uniform, sigma includes the curvature of its quantile
//! function, even if the model is linear in it. A discrete factor steps by its rank among its values, between two
//! different ones drawn by their probabilities: one rank is 1 / (number of values - 1) of its range.
//!
//! In a study whose indices are those of groups all factors of a group step at once, and the effect is over the root mean
//! square of their steps; its sign means nothing, so that a group has mu* alone (Campolongo, Cariboni and Saltelli 2007).
//! Constants do not step.
//!
//! r trajectories of d + 1 runs give r effects of each of d factors; [`ScreenedFactor`] summarises them, [`Reading`]
//! interprets them. A factor could be fixed if its upper bound of mu* is below [`Screening::FIXABLE`] times the largest.
//!
//! In the radial design a step shorter than [`ScreeningSettings::MIN_STEP`] is replaced by one to the auxiliary coordinate half a range
//! further on, modulo the range: tiny steps would divide the noise and the jumps of the output by nearly 0.

mod measures;
mod points;
mod run;
mod settings;
mod table;

#[cfg(test)]
mod tests;

pub use measures::Reading;
use points::{Move, Trajectories};
use run::Outcome;
use serde::{Deserialize, Serialize};
use serde_json::json;
pub use settings::{ScreeningDesign, ScreeningError, ScreeningSettings};
pub use table::screen_table;

use crate::analysis::named_inputs;
use crate::model::{Model, RunContext};
use crate::result::FailureCount;
use crate::run::{Store, TableRun};
use crate::runner::Runner;
use crate::space::{Group, Space};
use crate::study::Study;
use crate::uncertainty::{Estimate, Interval, RULE_OF_THREE};
use apportion_base::quantity::Unlikely;
use apportion_base::sum::mean;

/// The results of a screening.
#[derive(Debug, Clone, PartialEq)]
pub struct Screening {
    /// The settings, with the number of trajectories rounded up.
    pub settings: ScreeningSettings,
    /// Number of independent parts used for the intervals.
    pub parts: u64,
    /// Number of model runs.
    pub runs: u64,
    /// Number of model runs that failed in at least one output.
    pub failed: u64,
    /// For each validity flag of the model: runs that raised it.
    pub flags: Vec<u64>,
    /// One entry per output of the model.
    pub outputs: Vec<ScreenedOutput>,
}

impl Screening {
    /// A factor could be fixed if the upper bound of mu* is below this part of the largest mu*.
    pub const FIXABLE: f64 = 0.05;
}

/// The results of a screening for one output.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScreenedOutput {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// One entry per factor that is not a constant, in the order of the space; or per group in place of its factors.
    pub factors: Vec<ScreenedFactor>,
    /// Why runs failed.
    pub failures: Vec<FailureCount>,
    /// Warnings, in sentences.
    pub warnings: Vec<String>,
}

/// The results of a screening for one factor, or group, and one output. Measures are in the output's unit per full range
/// of the factor; they are `None` with fewer than two effects, or if they overflow, and those but mu* for a group.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScreenedFactor {
    /// The factor or group.
    pub factor: String,
    /// Rank by mu*, from 1; factors without measures come last.
    pub rank: usize,
    /// mu*: the mean of the absolute elementary effects (Campolongo, Cariboni and Saltelli 2007).
    pub mu_star: Option<Estimate>,
    /// mu: the mean of the elementary effects (Morris 1991). Effects of both signs cancel in it.
    pub mu: Option<Estimate>,
    /// sigma: their standard deviation, with n - 1.
    pub sigma: Option<Estimate>,
    /// sigma / mu*; `None` if mu* is 0.
    pub ratio: Option<Estimate>,
    /// The interpretation of the ratio; `None` without measures, or if every effect is 0.
    pub reading: Option<Reading>,
    /// Whether the upper bound of mu* is below [`Screening::FIXABLE`] times the largest mu*, by at least half of the effects.
    /// `None` if this is unknown: without measures or an interval, or if no factor has any effect.
    pub could_be_fixed: Option<bool>,
    /// Number of elementary effects used.
    pub effects: u64,
    /// Number of effects dropped because a run at either end failed.
    pub dropped: u64,
    /// Number of steps that did not change its value; their effect is 0.
    pub idle_steps: u64,
}

impl Runner<'_> {
    /// Screens the factors of the study. The result has the same bits on any number of threads.
    ///
    /// ```
    /// use std::f64::consts::PI;
    ///
    /// use apportion::screening::{Reading, ScreeningSettings};
    /// use apportion::{Distribution, Study, function_model};
    ///
    /// // Ishigami's function.
    /// let y = |x: &[f64]| x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin();
    /// let angle = || Distribution::uniform(-PI, PI);
    /// let study = Study::builder("ishigami", function_model("y", y))
    ///     .factor("x1", angle()?)
    ///     .factor("x2", angle()?)
    ///     .factor("x3", angle()?)
    ///     .build()?;
    /// let screening = study.runner().screen(ScreeningSettings::default())?;
    /// assert_eq!(screening.runs, 32 * 4);
    /// assert!(screening.outputs[0].factors.iter().all(|x| x.reading == Some(Reading::NonLinearOrInteracting)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ScreeningError`] if the settings are invalid, the model gives up, the run is to stop, or the journal cannot be
    /// used or written. Failed runs are part of the result.
    pub fn screen(self, settings: ScreeningSettings) -> Result<Screening, ScreeningError> {
        let (study, movers) = (self.study, movers(self.study));
        let (settings, _) = settings.in_force(movers.len())?;
        let runs = settings.trajectories * (movers.len() as u64 + 1);
        self.run_table(json!(settings), Some(runs), |run| screen_by(run, study.space(), movers, settings))
    }
}

/// Returns what steps in a screening of `study`: the factors but constants, or groups in place of theirs.
pub fn movers(study: &Study) -> Vec<Group> {
    stepping(study.space(), study.analysis().members(study.space()))
}

/// Returns `members` without constants.
fn stepping(space: &Space, mut members: Vec<Group>) -> Vec<Group> {
    let constants = space.constants();
    members.iter_mut().for_each(|member| member.factors.retain(|factor| !constants.contains(factor)));
    members.retain(|member| !member.factors.is_empty());
    members
}

/// Returns the [`points`] of `study` as a screening with the outputs of `store`, which has all of their rows.
///
/// # Errors
/// [`ScreeningError`] if the settings are invalid.
pub fn screen_stored(study: &Study, settings: ScreeningSettings, store: &Store) -> Result<Screening, ScreeningError> {
    let (model, context) = (study.model(), RunContext::default());
    let mut run = TableRun::new(model.as_ref(), &context, 1);
    run.store = Some(store);
    screen_by(&run, study.space(), movers(study), settings)
}

/// Returns the points of a screening, trajectory by trajectory: for each factor of `study` a column of SI values.
///
/// # Errors
/// [`ScreeningError`] if the settings are invalid or the factors depend on each other.
pub fn points(study: &Study, settings: ScreeningSettings) -> Result<Vec<Vec<f64>>, ScreeningError> {
    let (space, movers) = (study.space(), movers(study));
    let mut idle = vec![0; movers.len()];
    let (settings, _, points) = prepared(space, movers, settings)?;
    let moves: Vec<Vec<Move>> = (0..settings.trajectories).map(|number| points.moves(number)).collect();
    Ok(points.columns(space.factors(), &moves, &mut idle))
}

/// Returns the settings in force, the number of parts and the trajectories.
fn prepared(
    space: &Space,
    movers: Vec<Group>,
    settings: ScreeningSettings,
) -> Result<(ScreeningSettings, u64, Trajectories), ScreeningError> {
    if space.copula().is_some() {
        return Err(ScreeningError::Dependent);
    }
    let (settings, parts) = settings.in_force(movers.len())?;
    Ok((settings, parts, Trajectories::new(space, movers, &settings, parts)?))
}

fn screen_by(
    run: &TableRun<'_>,
    space: &Space,
    movers: Vec<Group>,
    settings: ScreeningSettings,
) -> Result<Screening, ScreeningError> {
    let (settings, parts, points) = prepared(space, movers, settings)?;
    let outcome = run::run(space, &points, settings.trajectories, run)?;
    Ok(summary(space, &points.movers, run.model(), (settings, parts), &outcome))
}

/// Returns the measures of all outputs, from effects in this number of parts.
fn summary(
    space: &Space,
    movers: &[Group],
    model: &dyn Model,
    (settings, parts): (ScreeningSettings, u64),
    outcome: &Outcome,
) -> Screening {
    let mut outputs = Vec::with_capacity(model.outputs().len());
    for (number, output) in model.outputs().iter().enumerate() {
        let screened = screened(model, number, outcome, movers, parts as usize);
        let values: Vec<f64> = outcome.values[number].iter().map(|y| output.unit.from_si(*y)).collect();
        let unlikely = Unlikely::find(&values).map(|value| value.in_runs(value.first + 1));
        outputs.push(ScreenedOutput {
            name: output.name.to_string(),
            unit: output.unit.to_string(),
            warnings: unlikely.into_iter().chain(dropped_effects(&screened)).collect(),
            factors: screened,
            failures: failures(number, outcome, space),
        });
    }
    let runs = outcome.values.first().map_or(0, Vec::len) as u64;
    Screening { settings, parts, runs, failed: outcome.failed, outputs, flags: outcome.flags.clone() }
}

impl ScreenedFactor {
    fn has_no_effect(&self) -> bool {
        self.mu_star.is_some_and(|mu_star| mu_star.estimate == 0.0)
    }

    /// Sets the intervals of a factor all of whose effects are 0: by the rule of three, fewer than 3 in n effects of the
    /// usual `size` were missed, at 95 %.
    fn allow_for_unseen(&mut self, size: f64) {
        let share = (RULE_OF_THREE / self.effects as f64).min(1.0);
        let between = |low: f64, high: f64| Estimate { estimate: 0.0, interval: Some(Interval { low, high }) };
        self.mu = self.mu.map(|_| between(-share * size, share * size));
        self.mu_star = Some(between(0.0, share * size));
        self.sigma = self.sigma.map(|_| between(0.0, share.sqrt() * size));
    }
}

/// Returns why runs failed in output number `number`.
fn failures(number: usize, outcome: &Outcome, space: &Space) -> Vec<FailureCount> {
    let mut failures = Vec::new();
    for ((_, reason), (runs, first)) in outcome.failures.iter().filter(|((output, _), _)| *output == number) {
        let first = first.iter().zip(space.factors()).map(|(x, factor)| factor.unit().from_si(*x));
        let first_inputs = named_inputs(space, &first.collect::<Vec<f64>>());
        failures.push(FailureCount { reason: reason.to_string(), runs: *runs, first_row: None, first_inputs });
    }
    failures
}

/// Warns of the dropped effects of an output, if there are any.
fn dropped_effects(factors: &[ScreenedFactor]) -> Option<String> {
    let dropped: u64 = factors.iter().map(|factor| factor.dropped).sum();
    let all = dropped + factors.iter().map(|factor| factor.effects).sum::<u64>();
    (dropped > 0).then(|| {
        format!(
            "{dropped} of {all} elementary effects are dropped because a run failed: the measures describe the part of the \
             factor space where runs succeed"
        )
    })
}

/// Returns the results for `movers` and output number `number`, from its effects in SI units, mover by mover
/// within each trajectory, in `parts` independent parts.
fn screened(
    model: &dyn Model,
    number: usize,
    outcome: &Outcome,
    movers: &[Group],
    parts: usize,
) -> Vec<ScreenedFactor> {
    let output = &model.outputs()[number];
    let mut screened = Vec::with_capacity(movers.len());
    for (j, mover) in movers.iter().enumerate() {
        let effects = outcome.effects[number].iter().skip(j).step_by(movers.len());
        let effects: Vec<f64> = effects.map(|effect| output.unit.span_from_si(*effect)).collect();
        let finite = effects.iter().filter(|effect| effect.is_finite()).count() as u64;
        let measures = measures::measures(&effects, parts);
        let mu_star = measures.map(|measures| measures[1]);
        let of_factor = measures.filter(|_| mover.factors.len() == 1);
        let [mu, sigma, ratio] = [0, 2, 3].map(|place| of_factor.map(|measures| measures[place]));
        let ratio = ratio.filter(|ratio: &Estimate| ratio.estimate.is_finite());
        screened.push(ScreenedFactor {
            factor: mover.name.clone(),
            rank: 0,
            mu_star,
            mu,
            sigma,
            ratio,
            reading: ratio.map(|ratio| Reading::from_ratio(ratio.estimate)),
            could_be_fixed: None,
            effects: finite,
            dropped: effects.len() as u64 - finite,
            idle_steps: outcome.idle[j],
        });
    }
    let changes: Vec<f64> =
        outcome.effects[number].iter().filter(|effect| effect.abs() > 0.0).map(|effect| effect.abs()).collect();
    let size = output.unit.span_from_si(mean(&changes));
    for (j, factor) in screened.iter_mut().enumerate().filter(|(_, factor)| factor.has_no_effect()) {
        if movers[j].factors.iter().any(|&factor| model.reads(number, factor)) && size.is_finite() {
            factor.allow_for_unseen(size);
        }
    }
    let sizes: Vec<f64> =
        screened.iter().map(|factor| factor.mu_star.map_or(f64::NEG_INFINITY, |mu_star| mu_star.estimate)).collect();
    let mut order: Vec<usize> = (0..movers.len()).collect();
    order.sort_by(|&i, &j| sizes[j].total_cmp(&sizes[i]));
    let largest = order.first().map_or(0.0, |&first| sizes[first]);
    for (place, &j) in order.iter().enumerate() {
        screened[j].rank = place + 1;
    }
    for factor in &mut screened {
        let high = factor.mu_star.and_then(|mu_star| mu_star.interval).map(|interval| interval.high);
        factor.could_be_fixed = high
            .filter(|_| largest > 0.0)
            .map(|high| high < Screening::FIXABLE * largest && factor.effects >= factor.dropped);
    }
    screened
}
