//! The runs of low-fidelity models: at the rows of the model, and at points of their own.

use std::path::Path;
use std::sync::Arc;

use super::journal::{self, RunJournal};
use super::{Resume, Runner};
use crate::analysis::{LowTotals, outputs_kept};
use crate::design::{Design, DesignSettings, Rows};
use crate::model::{Model, RunContext};
use crate::run::journal::with_ending;
use crate::run::{GrowingRun, Job, OutputSink as _, RunError};
use crate::study::{LowFidelity, Study, SurrogateChoice, Target};
use crate::surrogate::families;
use crate::surrogate::low_fidelity::IndependentOutputs;
use apportion_base::clock::Instant;

/// Combined with the seed of the model's design, it seeds the own points of low-fidelity models unlike any user does.
const OWN_SEED: u64 = 0x6c6f_7720_6669_6465;

/// Default number of base samples of the own design where the size is not to be chosen.
const OWN_BASE_SAMPLES: u64 = 1 << 14;

/// Maximum number at the start of a run that chooses its size, and minimum of base points of each replicate.
const FIRST_OWN_BASE_SAMPLES: u64 = 1 << 10;
const FIRST_OWN_POINTS: u64 = 4;

/// Maximum number of rows of the own design: their outputs are kept.
const MAX_OWN_ROWS: u64 = 1 << 22;

/// Largest cost of a run, relative to the model itself, of a model that counts as cheaper.
const CHEAPER: f64 = 0.5;

/// A low-fidelity model's study, and its journal.
pub(super) struct LowStudy {
    name: String,
    /// Number of its base samples, if not to be chosen.
    base_samples: Option<u64>,
    /// At the rows of the model, and at its own.
    parts: [LowPart; 2],
}

struct LowPart {
    study: Study,
    model: Arc<dyn Model>,
    longest: Design,
    journal: RunJournal,
}

impl LowStudy {
    /// Prepares a low-fidelity model of the study that `runner` runs.
    pub fn new(runner: &Runner<'_>, low: &LowFidelity, context: &RunContext<'_>) -> Result<Self, RunError> {
        let study = runner.study;
        let settings = study.design.settings();
        let base_samples = match low.base_samples {
            Some(base_samples) => base_samples,
            None if study.target.grows() => FIRST_OWN_POINTS * settings.replicates,
            None => OWN_BASE_SAMPLES,
        };
        let own = DesignSettings { base_samples, seed: settings.seed ^ OWN_SEED, ..settings.clone() };
        let rows = Rows { plain_rows: 0, ..study.design.requested().clone() };
        let own = Design::new(own, study.design.factors(), rows).map_err(RunError::Design)?;
        let part = |design: Design, kind: &str| {
            let mut of_low = study.clone();
            of_low.subject = low.subject.clone();
            of_low.design = design;
            of_low.target = Target::default();
            of_low.lows = Vec::new();
            of_low.analysis.surrogate = SurrogateChoice::On;
            let (model, longest) = (of_low.model(), of_low.design.longest());
            // The runs of a program have a journal next to that of the study, if there is one.
            let journal = match runner.journal.as_deref().filter(|_| model.concurrency().is_some()) {
                None => RunJournal::none(&of_low),
                Some(path) => {
                    let resume = if runner.resume == Resume::Require { Resume::IfThere } else { runner.resume };
                    let path = sibling_path(path, &format!("{}-{kind}", apportion_base::names::file_part(&low.name)));
                    let part = Runner { study: &of_low, resume, ..runner.clone() };
                    journal::open(&part, &path, None, context.messages())?
                }
            };
            Ok::<_, RunError>(LowPart { study: of_low, model, longest, journal })
        };
        let parts = [part(study.design.clone(), "shared")?, part(own, "own")?];
        Ok(Self { name: low.name.clone(), base_samples: low.base_samples, parts })
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
pub(super) struct LowRun<'a> {
    study: &'a LowStudy,
    /// At the rows of the model, and at its own, each with its duration in seconds.
    runs: [(GrowingRun<'a>, f64); 2],
    /// Its own design as far as evaluated, and every output at its rows.
    own: (Design, Vec<Option<IndependentOutputs>>),
}

impl<'a> LowRun<'a> {
    /// Creates the runs; none is evaluated.
    pub fn all(
        runner: &Runner<'a>,
        studies: &'a [LowStudy],
        context: &'a RunContext<'a>,
    ) -> Result<Vec<Self>, RunError> {
        let run = |subject: usize, part: &'a LowPart| {
            let job = Job { design: &part.longest, space: &part.study.space, model: part.model.as_ref() };
            let mut run = GrowingRun::new(job, context, runner.threads)?.with_remote(runner.remote_for(subject));
            run.keeps_outputs = true;
            run.sink = Some(&part.journal);
            let is_stored = part.model.is_slow() || part.journal.is_open() || runner.remote.is_some();
            run.store = is_stored.then_some(&part.journal.store);
            Ok::<_, RunError>((run, 0.0))
        };
        let of_study = |(number, study): (usize, &'a LowStudy)| {
            let subject = number + 1;
            let [shared, own] = &study.parts;
            let runs = [run(subject, shared)?, run(subject, own)?];
            Ok(Self { study, runs, own: (own.study.design.clone(), Vec::new()) })
        };
        studies.iter().enumerate().map(of_study).collect()
    }

    fn grow(&mut self, part: usize, points: u64) -> Result<(), RunError> {
        let (run, seconds) = &mut self.runs[part];
        let start = Instant::now();
        run.grow_to(points, &|_| ())?;
        *seconds += start.elapsed().as_secs_f64();
        self.study.parts[part].journal.sync()
    }

    /// Runs the model at the rows of the model for `points` base points of every replicate.
    pub fn follow(&mut self, points: u64) -> Result<(), RunError> {
        self.grow(0, points)
    }

    /// Starts its own runs, which cost at most `seconds` if their number is to be chosen.
    pub fn begin(&mut self, seconds: f64) -> Result<(), RunError> {
        let design = &self.study.parts[1].study.design;
        let (points, replicates) = (design.points_per_replicate(), design.settings().replicates);
        if self.study.base_samples.is_some() || points > FIRST_OWN_POINTS {
            return self.grow_own(points);
        }
        let affordable = |points: u64| {
            let rows = points * replicates * design.rows_per_point();
            rows as f64 * self.seconds_per_run() <= seconds && points * replicates <= FIRST_OWN_BASE_SAMPLES
        };
        let mut points = points;
        while affordable(points * 2) {
            points *= 2;
        }
        self.grow_own(points)
    }

    /// Evaluates its own runs for `points` base points of every replicate.
    pub fn grow_own(&mut self, points: u64) -> Result<(), RunError> {
        self.grow(1, points)?;
        let (run, study) = (&self.runs[1].0, &self.study.parts[1].study);
        let design = run.design().with_points(run.points_per_replicate()).unwrap_or_else(|_| run.design().clone());
        let families = families(&study.space);
        let count = run.totals().first().map_or(0, |totals| totals.outputs.len());
        let output = |number| IndependentOutputs::new(&design, &families, &outputs_kept(run.totals(), number));
        let outputs = run.install(|| (0..count).map(output).collect());
        self.own = (design, outputs);
        Ok(())
    }

    /// Returns twice the base points of its own runs, if these can be doubled.
    pub fn doubled(&self) -> Option<u64> {
        let points = self.runs[1].0.points_per_replicate() * 2;
        let design = &self.study.parts[1].longest;
        let rows = points * design.settings().replicates * design.rows_per_point();
        let is_possible = rows <= MAX_OWN_ROWS && points <= design.points_per_replicate();
        (self.study.base_samples.is_none() && is_possible).then_some(points)
    }

    /// Returns the seconds of a run at the rows of the model; 0 before any.
    fn seconds_per_run(&self) -> f64 {
        let (run, seconds) = &self.runs[0];
        let design = run.design();
        let rows = run.points_per_replicate() * design.settings().replicates * design.rows_per_point();
        seconds / rows.max(1) as f64
    }

    /// Returns whether its runs are clearly faster than those of the model, which took `seconds` at the same rows.
    pub fn is_cheaper(&self, seconds: f64) -> bool {
        self.runs[0].1 <= CHEAPER * seconds
    }

    /// Returns the seconds that another doubling takes of its runs at the rows of the model, and of its own.
    pub fn seconds(&self) -> [f64; 2] {
        [self.runs[0].1, self.runs[1].1]
    }

    /// Returns its totals.
    pub fn totals(&self) -> LowTotals<'_> {
        let [(shared, _), (own, _)] = &self.runs;
        let (design, outputs) = &self.own;
        LowTotals { name: &self.study.name, shared: shared.totals(), design, own: own.totals(), outputs }
    }
}

#[cfg(test)]
mod tests;
