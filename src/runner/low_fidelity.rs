//! The runs of low-fidelity models: at the model's rows (shared), and at separate points (independent).

use std::path::Path;
use std::sync::Arc;

use super::Runner;
use super::journal::{self, RunJournal};
use crate::analysis::{LowFidelityTotals, outputs_kept};
use crate::correction::ErrorShares;
use crate::correction::IndependentOutputs;
use crate::design::{Design, DesignSettings};
use crate::model::{Messages, Model, RunContext};
use crate::run::journal::with_ending;
use crate::run::{GrowingRun, Job, RunError};
use crate::study::{LowFidelity, Study, SurrogateChoice, Target};
use crate::surrogate::families;
use apportion_base::clock::Instant;

/// XORed with the study's seed, so that the low-fidelity model's independent design differs from any user's.
const SEED: u64 = 0x6c6f_7720_6669_6465;

/// Default base samples of the low-fidelity model's independent design, if the run has a fixed size.
const BASE_SAMPLES: u64 = 1 << 14;

/// Maximum of base samples at the start of a run that chooses its size, and minimum of base points of each replicate.
const FIRST_BASE_SAMPLES: u64 = 1 << 10;
const FIRST_POINTS: u64 = 4;

/// Maximum number of rows of the independent design: their outputs are kept.
const MAX_ROWS: u64 = 1 << 22;

/// Largest cost of a run, relative to the model itself, of a model that counts as cheaper.
const CHEAPER: f64 = 0.5;

/// Squared error by the runs of a low-fidelity model, relative to that by the rows of the model, that needs no more runs.
const MIN_ERROR_SHARE: f64 = 1.0 / 16.0;

/// The studies of a low-fidelity model.
pub(super) struct LowFidelityStudy<'a> {
    low: &'a LowFidelity,
    /// At the model's rows.
    shared: LowPart,
    /// At separate points.
    independent: LowPart,
}

struct LowPart {
    study: Study,
    model: Arc<dyn Model>,
    longest: Design,
    journal: RunJournal,
}

impl<'a> LowFidelityStudy<'a> {
    /// Prepares a low-fidelity model of the study that `runner` runs.
    pub fn new(runner: &Runner<'_>, low: &'a LowFidelity, messages: &Messages) -> Result<Self, RunError> {
        let study = runner.study;
        let settings = study.design.settings();
        let base_samples = match low.base_samples {
            Some(base_samples) => base_samples,
            None if study.target.grows() => FIRST_POINTS * settings.replicates,
            None => BASE_SAMPLES,
        };
        let settings = DesignSettings { base_samples, seed: settings.seed ^ SEED, ..settings.clone() };
        let rows = study.design.requested().clone();
        let design = Design::new(settings, study.design.factors(), rows).map_err(RunError::Design)?;
        Ok(Self {
            low,
            shared: runner.low_part(low, study.design.clone(), "shared", messages)?,
            independent: runner.low_part(low, design, "own", messages)?,
        })
    }
}

impl Runner<'_> {
    /// Creates the study of a low-fidelity model with `design`; the name of its journal ends with `kind`.
    fn low_part(
        &self,
        low: &LowFidelity,
        design: Design,
        kind: &str,
        messages: &Messages,
    ) -> Result<LowPart, RunError> {
        let mut study = self.study.clone();
        study.subject = low.subject.clone();
        study.design = design;
        study.target = Target::default();
        study.low_fidelities = Vec::new();
        study.analysis.surrogate = SurrogateChoice::On;
        let (model, longest) = (study.model(), study.design.longest());
        // The runs of a program have a journal next to that of the study, if there is one.
        let journal = match self.journal.as_deref().filter(|_| model.concurrency().is_some()) {
            None => RunJournal::none(&study),
            Some(path) => {
                let path = sibling_path(path, &format!("{}-{kind}", apportion_base::names::file_part(&low.name)));
                let part = Runner { study: &study, resume: self.resume.of_part(), ..self.clone() };
                journal::open(&part, &path, None, messages)?
            }
        };
        Ok(LowPart { study, model, longest, journal })
    }
}

/// Returns `NAME-KIND.journal` for `NAME.journal`, and `NAME-KIND` for a name with another ending or none.
pub(super) fn sibling_path(path: &Path, kind: &str) -> std::path::PathBuf {
    match path.extension() {
        Some(ending) if ending == "journal" => with_ending(&path.with_extension(""), &format!("-{kind}.journal")),
        _ => with_ending(path, &format!("-{kind}")),
    }
}

/// The runs of a low-fidelity model.
pub(super) struct LowFidelityRun<'a> {
    low: &'a LowFidelity,
    /// At the model's rows.
    pub shared: TimedRun<'a>,
    /// At separate points.
    independent: TimedRun<'a>,
    /// The independent design as far as evaluated.
    design: Design,
    /// Every output at its rows.
    outputs: Vec<Option<IndependentOutputs>>,
}

/// A run, and the seconds that it took so far.
pub(super) struct TimedRun<'a> {
    part: &'a LowPart,
    run: GrowingRun<'a>,
    seconds: f64,
}

impl<'a> TimedRun<'a> {
    /// Creates an empty run of the model with index `subject`.
    fn new(runner: &Runner<'a>, subject: usize, part: &'a LowPart, context: &'a RunContext) -> Result<Self, RunError> {
        let job = Job { design: &part.longest, space: &part.study.space, model: part.model.as_ref() };
        let mut run = GrowingRun::new(job, context, runner.threads).with_remote(runner.remote_for(subject));
        run.keeps_outputs = true;
        run.journal = Some(&part.journal.open);
        let is_stored = part.model.is_slow() || part.journal.open.get().is_some() || runner.remote.is_some();
        run.store = is_stored.then_some(&part.journal.store);
        Ok(Self { part, run, seconds: 0.0 })
    }

    pub fn grow_to(&mut self, points: u64) -> Result<(), RunError> {
        let start = Instant::now();
        self.run.grow_to(points, &|_| ())?;
        self.seconds += start.elapsed().as_secs_f64();
        self.part.journal.finish()
    }
}

impl<'a> LowFidelityRun<'a> {
    /// Creates the runs; none is evaluated.
    pub fn all(
        runner: &Runner<'a>,
        studies: &'a [LowFidelityStudy<'_>],
        context: &'a RunContext<'a>,
    ) -> Result<Vec<Self>, RunError> {
        let mut runs = Vec::new();
        for (study, subject) in studies.iter().zip(1..) {
            runs.push(Self {
                low: study.low,
                shared: TimedRun::new(runner, subject, &study.shared, context)?,
                independent: TimedRun::new(runner, subject, &study.independent, context)?,
                design: study.independent.study.design.clone(),
                outputs: Vec::new(),
            });
        }
        Ok(runs)
    }

    /// Starts the independent runs, which cost at most `seconds` if their number is to be chosen.
    pub fn begin(&mut self, seconds: f64) -> Result<(), RunError> {
        let design = &self.independent.part.study.design;
        let (mut points, replicates) = (design.points_per_replicate(), design.settings().replicates);
        if self.low.base_samples.is_none() && points <= FIRST_POINTS {
            let TimedRun { run, seconds: shared_seconds, .. } = &self.shared;
            let rows = run.points_per_replicate() * replicates * run.design().rows_per_point();
            let seconds_per_run = shared_seconds / rows.max(1) as f64;
            let rows_per_point = replicates * design.rows_per_point();
            while points * 2 * replicates <= FIRST_BASE_SAMPLES
                && (points * 2 * rows_per_point) as f64 * seconds_per_run <= seconds
            {
                points *= 2;
            }
        }
        self.grow_independent(points)
    }

    /// Evaluates the independent design for `points` base points of every replicate.
    pub fn grow_independent(&mut self, points: u64) -> Result<(), RunError> {
        self.independent.grow_to(points)?;
        let TimedRun { part, run, .. } = &self.independent;
        let design = run.design().with_points(run.points_per_replicate()).unwrap_or_else(|_| run.design().clone());
        let families = families(&part.study.space);
        let count = run.totals().first().map_or(0, |totals| totals.outputs.len());
        self.outputs = run.install(|| {
            let outputs = (0..count).map(|number| outputs_kept(run.totals(), number));
            outputs.map(|kept| IndependentOutputs::new(&design, &families, &kept)).collect()
        });
        self.design = design;
        Ok(())
    }

    /// Returns twice the base points of the independent design, if more of them are possible and pay: if they reduce the
    /// squared error by more for their time than more of the model's rows, which took `seconds`.
    pub fn next_points(&self, errors: ErrorShares, seconds: f64) -> Option<u64> {
        let TimedRun { part: LowPart { longest, .. }, run, seconds: low_seconds } = &self.independent;
        let points = run.points_per_replicate() * 2;
        let rows = points * longest.settings().replicates * longest.rows_per_point();
        let is_possible =
            self.low.base_samples.is_none() && rows <= MAX_ROWS && points <= longest.points_per_replicate();
        let pays = errors.low_fidelity * (seconds + self.shared.seconds) > errors.model * low_seconds
            && errors.low_fidelity > MIN_ERROR_SHARE * errors.model;
        (is_possible && pays).then_some(points)
    }

    /// Returns the relative cost of an accuracy, given `errors` and that the model's rows took `seconds`.
    pub fn expected_cost(&self, errors: ErrorShares, seconds: f64) -> f64 {
        let model = errors.model * (seconds + self.shared.seconds);
        (model.sqrt() + (errors.low_fidelity * self.independent.seconds).sqrt()).powi(2)
    }

    /// Returns whether its runs are clearly faster than those of the model, which took `seconds` at the same rows.
    pub fn is_cheaper(&self, seconds: f64) -> bool {
        self.shared.seconds <= CHEAPER * seconds
    }

    /// Returns the seconds of all its runs.
    pub fn seconds(&self) -> f64 {
        self.shared.seconds + self.independent.seconds
    }

    /// Returns its totals.
    pub fn totals(&self) -> LowFidelityTotals<'_> {
        LowFidelityTotals {
            name: &self.low.name,
            shared: self.shared.run.totals(),
            design: &self.design,
            own: self.independent.run.totals(),
            outputs: &self.outputs,
        }
    }
}

#[cfg(test)]
#[path = "tests/low_fidelity.rs"]
mod tests;
