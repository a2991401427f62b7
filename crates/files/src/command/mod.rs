//! The user's program as a model: kept alive and sent rows over its standard input and output, or started again for
//! each row in a directory of its own, with an input file made from a template.
//!
//! No shell is involved. A program is the leader of a process group, which is ended with it; its errors are reported
//! with a reason in the result, and never lose a row that it has answered.

mod json_answer;
mod kept_alive;
mod per_run;
mod pick;
mod process;
mod program;
mod protocol;
mod template;

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};
use std::time::Duration;

use apportion::model::{Model, Output, OutputSeries, RowFailure, RunContext, Worker};
use apportion::space::Factor;
use apportion_base::quantity::Unit;
use kept_alive::KeptAliveWorker;
pub use per_run::PerRun;
use per_run::PerRunWorker;
pub use pick::{Match, Pick, PickMethod, Source};
pub(crate) use program::program_files;
pub use program::{Program, end_all_programs};
pub use protocol::{Protocol, parse_answer};
pub(crate) use template::TemplateProblem;
pub use template::{InputTemplate, TemplateError};

/// How a program receives rows.
#[derive(Debug, Clone)]
pub enum Form {
    /// It is kept alive, reads rows and writes replies, each with the number of its row.
    KeptAlive(Protocol),
    /// It runs once for each row.
    PerRun(PerRun),
}

/// An output of a program.
#[derive(Debug, Clone)]
pub struct CommandOutput {
    /// Its name.
    pub name: String,
    /// The unit of the program's numbers, also used in reports.
    pub unit: Unit,
    /// Where its number is after a run, for a program that runs once for each row.
    pub pick: Option<Pick>,
}

/// The settings of a program as a model.
#[derive(Debug, Clone)]
pub struct CommandSettings {
    /// The program.
    pub program: Program,
    /// How it receives rows.
    pub form: Form,
    /// All outputs of the program, in its order.
    pub outputs: Vec<CommandOutput>,
    /// The outputs that are series.
    pub series: Vec<OutputSeries>,
    /// Positions of the requested outputs.
    pub requested: Vec<usize>,
    /// Number of processes at once; the number of cores by default.
    pub workers: Option<usize>,
    /// Time limit for the reply to a row; none by default.
    pub timeout: Option<Duration>,
    /// Number of retries of a row on which the program ended, hung, or printed an invalid reply.
    pub retries: u32,
}

/// A program as a model.
///
/// ```
/// use apportion_files::{Form, Program, Protocol};
/// use apportion_files::{CommandModel, CommandOutput, CommandSettings};
/// use apportion::Model;
/// use apportion::Unit;
/// use apportion::{Distribution, Factor};
///
/// let program = Program {
///     arguments: ["python3", "my_model.py"].map(str::to_owned).to_vec(),
///     directory: std::env::current_dir()?,
///     environment: Vec::new(),
/// };
/// let settings = CommandSettings {
///     program,
///     form: Form::KeptAlive(Protocol::Csv),
///     outputs: vec![CommandOutput { name: "force".to_owned(), unit: Unit::parse("nN")?, pick: None }],
///     series: Vec::new(),
///     requested: vec![0],
///     workers: Some(2),
///     timeout: None,
///     retries: 1,
/// };
/// let factor = Factor::new("length", Unit::parse("um")?, Distribution::uniform(1.0, 2.0)?)?;
/// let model = CommandModel::new(settings, vec![factor]);
/// assert_eq!(model.concurrency(), Some(2));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// `examples/own_program.rs` writes such a program, studies it by [`Study::builder`](apportion::study::Study::builder)
/// and compares the result with that of a function.
pub struct CommandModel {
    settings: CommandSettings,
    factors: Vec<Factor>,
    outputs: Vec<Output>,
    series: Vec<OutputSeries>,
    /// The names of all outputs of the program.
    names: Vec<String>,
    state: State,
}

/// The state that the workers of a model share.
#[derive(Debug, Default)]
struct State {
    /// Whether the program has ever answered.
    has_answered: AtomicBool,
    /// Number of rows that failed before the first reply.
    failed_first: AtomicU32,
    /// The longest time to a reply, the start of its process included, in microseconds.
    slowest: AtomicU64,
    /// Whether hints on its silence, and on lines that are not replies, have been given.
    hinted: OnceLock<()>,
    strayed: OnceLock<()>,
    /// Whether the directories of killed runs have been removed.
    cleared: OnceLock<()>,
}

/// Maximum number of rows that may fail before the first reply.
const MAX_FAILED_FIRST: u32 = 5;

impl State {
    fn has_answered(&self) -> bool {
        self.has_answered.load(Ordering::Relaxed)
    }

    /// Records a reply of the program after the time `took`.
    fn note_answer(&self, took: Duration) {
        self.has_answered.store(true, Ordering::Relaxed);
        self.slowest.fetch_max(took.as_micros() as u64, Ordering::Relaxed);
    }

    /// Counts a row that failed without a reply. If all of the first rows fail, the error ends the run.
    fn note_failure(&self, reason: &str) -> Result<(), RowFailure> {
        if self.has_answered() || self.failed_first.fetch_add(1, Ordering::Relaxed) + 1 < MAX_FAILED_FIRST {
            return Ok(());
        }
        Err(RowFailure::new(&format!("the program has answered none of its first {MAX_FAILED_FIRST} rows: {reason}")))
    }
}

impl CommandModel {
    /// Creates the model whose inputs are `factors`, in their order, each in its unit.
    ///
    /// # Panics
    /// If `requested` names a missing output.
    pub fn new(settings: CommandSettings, factors: Vec<Factor>) -> Self {
        let outputs = settings.requested.iter().map(|place| {
            let CommandOutput { name, unit, .. } = &settings.outputs[*place];
            Output::new(name.clone(), unit.clone(), "of the program")
        });
        let outputs = outputs.collect();
        let names = settings.outputs.iter().map(|output| output.name.clone()).collect();
        let series = OutputSeries::chosen(&settings.series, &settings.requested);
        Self { settings, factors, outputs, series, names, state: State::default() }
    }
}

impl Model for CommandModel {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn series(&self) -> &[OutputSeries] {
        &self.series
    }

    fn concurrency(&self) -> Option<usize> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        Some(self.settings.workers.unwrap_or(cores))
    }

    fn may_be_random(&self) -> bool {
        true
    }

    fn worker<'a>(&'a self, context: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        match &self.settings.form {
            Form::KeptAlive(protocol) => Box::new(KeptAliveWorker::new(self, context, *protocol)),
            Form::PerRun(form) => Box::new(PerRunWorker::new(self, context, form)),
        }
    }
}

/// Returns the failure for an invalid value.
fn not_a_value(value: f64) -> RowFailure {
    RowFailure::new(if value.is_nan() {
        "the program gave no value (an empty cell, nan or null)"
    } else {
        "the program gave an infinite value"
    })
}
