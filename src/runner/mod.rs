//! Running a study: from the points to the result in one call.

mod growth;
mod journal;
mod low_fidelity;
mod merge;
mod once;
mod plain_growth;
mod search;
mod worker;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use serde_json::{Value, json};
pub use worker::{Requests, WorkerStudy};

use crate::model::RunContext;
use crate::result::StudyResult;
use crate::run::{Job, Progress, Remote, RemoteWorkers, RunError, Shard, Store, TableRun};
use crate::study::Study;

impl Study {
    /// Runs the study on all cores and estimates its indices.
    ///
    /// ```
    /// use std::f64::consts::PI;
    ///
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
    /// let result = study.run()?;
    /// assert!((result.output("y")?.factor("x1")?.first_order.estimate - 0.3139).abs() < 0.003);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As for [`Runner::run`].
    pub fn run(&self) -> Result<StudyResult, RunError> {
        self.runner().run()
    }

    /// Creates a run of the study, to be configured and started.
    pub fn runner(&self) -> Runner<'_> {
        Runner {
            study: self,
            threads: 0,
            remote: None,
            on_progress: Arc::new(|_| ()),
            on_message: Arc::new(|_: &str| ()),
            stop: None,
            journal: None,
            only_if_long: false,
            resume: Resume::IfThere,
            store: None,
            points: Value::Null,
        }
    }
}

/// What to do with the runs recorded in a journal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Resume {
    /// Use them if they are of this study, or otherwise move the journal aside.
    #[default]
    IfThere,
    /// Fail without them.
    Require,
    /// The same, but evaluate failed runs again.
    RetryFailed,
    /// Move the journal aside.
    Restart,
}

impl Resume {
    fn is_required(self) -> bool {
        matches!(self, Self::Require | Self::RetryFailed)
    }

    /// Returns what to do with the journal of a part of the run, which may be missing.
    fn of_part(self) -> Self {
        if self == Self::Require { Self::IfThere } else { self }
    }
}

/// A run of a study and its configuration.
///
/// ```
/// use apportion::{Distribution, Study, function_model};
///
/// let study = Study::builder("product", function_model("y", |x| x[0] * x[1]))
///     .factor("a", Distribution::uniform(1.0, 2.0)?)
///     .factor("b", Distribution::uniform(1.0, 5.0)?)
///     .version("1")
///     .base_samples(1024)
///     .build()?;
/// let folder = tempfile::tempdir()?;
/// let journal = folder.path().join("product.journal");
/// let first = study.runner().threads(2).on_progress(|progress| eprintln!("{}", progress.done)).journal(&journal).run()?;
/// // The second time nothing is evaluated; twice the points would evaluate the second half of them alone.
/// let second = study.runner().journal(&journal).run()?;
/// assert_eq!(first.output("y")?.indices, second.output("y")?.indices);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
#[derive(Clone)]
pub struct Runner<'a> {
    pub(crate) study: &'a Study,
    threads: usize,
    remote: Option<&'a dyn RemoteWorkers>,
    on_progress: Arc<dyn Fn(Progress) + Send + Sync + 'a>,
    on_message: Arc<dyn Fn(&str) + Send + Sync>,
    stop: Option<&'a AtomicBool>,
    journal: Option<PathBuf>,
    only_if_long: bool,
    resume: Resume,
    store: Option<&'a Store>,
    /// What identifies the points, if they are not those of the design.
    points: Value,
}

impl<'a> Runner<'a> {
    /// Sets the number of threads, up to 1024 (default 0: one per core). The result has the same bits for any number.
    pub fn threads(self, threads: usize) -> Self {
        Self { threads, ..self }
    }

    /// Adds workers in other processes, which have the [same study](WorkerStudy). The result has the same bits.
    pub fn remote_workers(self, workers: &'a dyn RemoteWorkers) -> Self {
        Self { remote: Some(workers), ..self }
    }

    /// Calls `on_progress` from time to time, from any thread: calls may overtake each other.
    pub fn on_progress(self, on_progress: impl Fn(Progress) + Send + Sync + 'a) -> Self {
        Self { on_progress: Arc::new(on_progress), ..self }
    }

    /// Passes notes and warnings, a line each, to `on_message`: about the journal, and messages of programs.
    pub fn on_message(self, on_message: impl Fn(&str) + Send + Sync + 'static) -> Self {
        Self { on_message: Arc::new(on_message), ..self }
    }

    /// Stops the run soon after `stop` is set.
    pub fn stop(self, stop: &'a AtomicBool) -> Self {
        Self { stop: Some(stop), ..self }
    }

    /// Records the outputs of every run in a file, and reuses those that it contains.
    pub fn journal(self, path: impl Into<PathBuf>) -> Self {
        Self { journal: Some(path.into()), only_if_long: false, ..self }
    }

    /// Does the same, but creates a new journal only for a slow model (programs, functions of Python row by row,
    /// equations of motion that are integrated step by step), or once the run is expected to take longer than 10 s.
    pub fn journal_if_long(self, path: impl Into<PathBuf>) -> Self {
        Self { journal: Some(path.into()), only_if_long: true, ..self }
    }

    /// Sets what happens to the runs recorded in the journal.
    pub fn resume(self, resume: Resume) -> Self {
        Self { resume, ..self }
    }

    /// Uses the outputs in `store`, and saves all others there.
    pub fn store(self, store: &'a Store) -> Self {
        Self { store: Some(store), ..self }
    }

    /// Runs the study and estimates its indices. The result has the same bits for any number of threads and any source
    /// of outputs, except for the fields about time and threads (and for a study with a time budget, which ends when it
    /// is spent).
    ///
    /// # Errors
    /// [`RunError`] if the threads cannot be started, a row fails in a study that is to stop then, intervals need more
    /// outputs at once than fit in memory, the model gives up, the journal cannot be used or written, or the run is
    /// interrupted. Otherwise failed rows are part of the result.
    pub fn run(self) -> Result<StudyResult, RunError> {
        let context = self.context();
        // Other rows than those of the study are not in a store.
        let has_plain_rows = self.study.design.is_plain() && self.store.is_none();
        let result = if self.study.target.accuracy.is_some() || has_plain_rows {
            search::run_cheaply(&self, &context)
        } else {
            self.open(None, context.messages()).and_then(|journal| Ok(self.analyse(&context, journal)?.0))
        };
        context.messages().finish();
        result
    }

    /// Evaluates only the rows of `shard` missing in the journal, without estimates; returns the shard's row count.
    ///
    /// # Errors
    /// As for [`run`](Self::run); [`RunError::NoJournal`] without a journal, and [`RunError::NoSize`] for a study that
    /// chooses its size.
    pub fn run_shard(self, shard: Shard) -> Result<u64, RunError> {
        if self.study.target.grows() {
            return Err(RunError::NoSize);
        }
        let context = self.context();
        self.journal_for("a shard of a run")?;
        let journal = self.open(Some(shard), context.messages())?;
        let (study, model) = (self.study, self.study.model());
        let rows = shard.rows(&study.design);
        let job = Job { design: &study.design, space: &study.space, model: model.as_ref() };
        let run = self.set_up(job, &context, &journal)?;
        let filled = run.run_missing(&rows, &journal.store, &*self.on_progress);
        context.messages().finish();
        filled?;
        journal.finish()?;
        Ok(rows.iter().map(|(_, rows)| rows.end - rows.start).sum())
    }

    /// Evaluates, by `work`, `total` points that are not those of the study's design, and that `points` identifies in the
    /// journal.
    ///
    /// # Errors
    /// Those of `work`, and as for [`run`](Self::run) if the journal cannot be used or written.
    pub fn run_table<T, E: From<RunError>>(
        self,
        points: Value,
        total: Option<u64>,
        work: impl FnOnce(&TableRun<'_>) -> Result<T, E>,
    ) -> Result<T, E> {
        let (context, model) = (self.context(), self.study.model());
        let nominal: Vec<f64> = self.study.space.factors().iter().map(|factor| factor.nominal).collect();
        let runner = Self { points: json!({ "of": points, "nominal": nominal }), ..self };
        let journal = runner.open(None, context.messages())?;
        let on_progress = |progress: Progress| {
            journal.watch(progress, model.outputs().len(), context.messages());
            (runner.on_progress)(progress);
        };
        let mut run = TableRun::new(model.as_ref(), &context, runner.threads);
        run.store = journal.open.get().map(|_| &journal.store);
        run.journal = Some(&journal.open);
        (run.on_progress, run.total) = (&on_progress, total);
        let done = work(&run);
        context.messages().finish();
        let done = done?;
        journal.finish()?;
        Ok(done)
    }

    /// Merges the parts of a run, the `journals` of shards, in the journal of this run, and estimates the indices. The
    /// merged runs are always recorded: they may have cost much elsewhere.
    /// # Errors
    /// As for [`run`](Self::run), and [`RunError::Journal`] if a part is of another study or model;
    /// [`RunError::Incomplete`] if runs are missing.
    pub fn merge(self, journals: &[PathBuf]) -> Result<StudyResult, RunError> {
        let context = self.context();
        let path = self.journal_for("a run that is merged from shards")?;
        let journal = merge::merged(self.study, path, journals, context.messages())?;
        Ok(self.analyse(&context, journal)?.0)
    }

    /// Counts the runs recorded in the journal that a run would use; nothing is locked or written.
    ///
    /// # Errors
    /// As for [`run`](Self::run), if there is no journal, or it cannot be used.
    pub fn recorded_runs(&self) -> Result<u64, RunError> {
        journal::recorded_runs(self.study, self.journal_for("a number of recorded runs")?)
    }

    fn context(&self) -> RunContext<'a> {
        let on_message = Arc::clone(&self.on_message);
        RunContext::new(self.stop, move |line| on_message(line))
    }

    fn journal_for(&self, what: &'static str) -> Result<&Path, RunError> {
        self.journal.as_deref().ok_or(RunError::NoJournal { what })
    }

    /// Returns the remote workers for the model with that index: see [`Remote::subject`].
    fn remote_for(&self, subject: usize) -> Option<Remote<'a>> {
        self.remote.map(|workers| Remote { workers, subject })
    }
}
