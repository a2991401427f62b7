//! The user's own program as a model: kept alive and asked row by row over its standard input and output, or started
//! anew for each row in a directory of its own, with an input file made from a template.
//!
//! No shell is involved. A program is the leader of a process group, which is ended with it; whatever it does wrong has a
//! reason in the result, and never costs a row that it answered.

mod json_answer;
mod kept_alive;
mod per_run;
mod pick;
mod process;
mod program;
mod program_files;
mod protocol;
mod row;
mod standard_error;
mod template;

use std::process::ExitStatus;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicI64, AtomicU32, Ordering};
use std::time::Duration;

pub use per_run::PerRun;
pub use pick::{Match, Pick, PickError, Source, Way};
pub use program::Program;
pub use program_files::program_files;
pub use protocol::{Answer, Protocol, parse_answer, parse_numbered_answer};
pub use template::{InputTemplate, TemplateError, TemplateProblem};

use super::{Flag, Messages, Model, Output, OutputSeries, RowFailure, RunContext, Worker};
use crate::quantity::Unit;
use crate::space::Factor;
use kept_alive::KeptAliveWorker;
use per_run::PerRunWorker;

/// How a program is asked.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// It is kept alive, and reads rows and writes answers.
    KeptAlive(KeptAlive),
    /// It runs once for each row.
    PerRun(PerRun),
}

/// How a program that is kept alive is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KeptAlive {
    /// How rows and answers are written.
    pub protocol: Protocol,
    /// Whether each row has a number, which the program writes before its answer. Without numbers answers count only once
    /// the program has ended and has written one for each row.
    pub row_numbers: bool,
}

/// An output that a program gives.
#[derive(Debug, Clone, PartialEq)]
pub struct CommandOutput {
    /// Its name.
    pub name: String,
    /// The unit of the program's numbers, in which it is reported too.
    pub unit: Unit,
    /// Where it stands after a run, of a program that runs once for each row.
    pub pick: Option<Pick>,
}

/// A program as a model, with all that is said of it.
#[derive(Debug, Clone, PartialEq)]
pub struct CommandSettings {
    /// What is started.
    pub program: Program,
    /// How it is asked.
    pub form: Form,
    /// All outputs that it gives, in its order.
    pub outputs: Vec<CommandOutput>,
    /// Those of them that are series.
    pub series: Vec<OutputSeries>,
    /// Places of those that are asked for.
    pub asked: Vec<usize>,
    /// Processes at once; as many as there are cores if not said.
    pub workers: Option<usize>,
    /// How long the answer to a row may take; as long as it takes if not said.
    pub timeout: Option<Duration>,
    /// How often a row is tried again on which the program died, hung, or answered what is no answer.
    pub retries: u32,
}

/// A program as a model.
///
/// ```
/// use apportion::{Form, KeptAlive, Program, Protocol};
/// use apportion::{CommandModel, CommandOutput, CommandSettings, Model};
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
///     form: Form::KeptAlive(KeptAlive { protocol: Protocol::Csv, row_numbers: true }),
///     outputs: vec![CommandOutput { name: "force".to_owned(), unit: Unit::parse("nN")?, pick: None }],
///     series: Vec::new(),
///     asked: vec![0],
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
/// `examples/own_program.rs` writes such a program, studies it by [`Study::builder`](crate::study::Study::builder) and
/// compares the result with that of a function.
pub struct CommandModel {
    settings: CommandSettings,
    factors: Vec<Factor>,
    outputs: Vec<Output>,
    series: Vec<OutputSeries>,
    /// The names of all outputs of the program.
    names: Vec<String>,
    /// How long it may be silent at its first row without a hint.
    silence: Duration,
    flags: Vec<Flag>,
    state: State,
}

/// What the workers of a model share.
#[derive(Debug, Default)]
struct State {
    /// Whether the program has ever answered.
    has_answered: AtomicBool,
    /// Rows that failed before it ever did.
    barren: AtomicU32,
    /// Whether it has printed more or fewer answers than it had rows: without numbers every row goes by itself then.
    out_of_step: AtomicBool,
    /// Microseconds that processes took to start, and how many they were; how often answers have been confirmed.
    startup: AtomicI64,
    started: AtomicU32,
    confirmed: AtomicU32,
    /// Whether its silence, lines that are no answers, and a process that did not end have been spoken of.
    hinted: AtomicBool,
    strayed: AtomicBool,
    stayed: AtomicBool,
    /// How a process ends that gets no row, once that was asked.
    usual_end: Mutex<Option<Option<ExitStatus>>>,
}

/// How long a program that has never answered may be silent without a hint.
const SILENCE: Duration = Duration::from_secs(10);

/// Rows that may fail before there has been any answer.
const MOST_BARREN: u32 = 5;

impl State {
    fn has_answered(&self) -> bool {
        self.has_answered.load(Ordering::Relaxed)
    }

    fn note_answer(&self) {
        self.has_answered.store(true, Ordering::Relaxed);
    }

    fn is_out_of_step(&self) -> bool {
        self.out_of_step.load(Ordering::Relaxed)
    }

    /// What the start of a process takes on average; nothing before it has been measured.
    fn startup(&self) -> Option<Duration> {
        let processes = self.started.load(Ordering::Relaxed);
        let micros = self.startup.load(Ordering::Relaxed).max(0) as u64;
        (processes > 0).then(|| Duration::from_micros(micros / u64::from(processes)))
    }

    /// A measurement may be below zero, where the first row was a short one.
    fn note_startup(&self, seconds: f64) {
        self.startup.fetch_add((seconds * 1e6) as i64, Ordering::Relaxed);
        self.started.fetch_add(1, Ordering::Relaxed);
    }

    /// Counts a row that failed without an answer; why the program is given up, if that has happened too often.
    fn note_barren(&self, reason: &str) -> Result<(), RowFailure> {
        if self.has_answered() || self.barren.fetch_add(1, Ordering::Relaxed) + 1 < MOST_BARREN {
            return Ok(());
        }
        Err(RowFailure::new(&format!("the program has answered none of its first {MOST_BARREN} rows: {reason}")))
    }

    /// Sends `line` if `sent` says that nobody has.
    fn send_once(sent: &AtomicBool, messages: &Messages, line: &str) {
        if !sent.swap(true, Ordering::Relaxed) {
            messages.send(line);
        }
    }
}

impl CommandModel {
    /// The model whose inputs are `factors`, in their order, each in its unit.
    ///
    /// # Panics
    /// If `asked` names an output that is not there.
    pub fn new(settings: CommandSettings, factors: Vec<Factor>) -> Self {
        let output = |place: &usize| {
            let CommandOutput { name, unit, .. } = &settings.outputs[*place];
            Output::new(name.clone(), unit.clone(), "of the program")
        };
        let outputs = settings.asked.iter().map(output).collect();
        let names = settings.outputs.iter().map(|output| output.name.clone()).collect();
        let series = OutputSeries::chosen(&settings.series, &settings.asked);
        let is_numbered = !matches!(settings.form, Form::KeptAlive(KeptAlive { row_numbers: false, .. }));
        let flags = if is_numbered { Vec::new() } else { vec![alone()] };
        Self { settings, factors, outputs, series, names, silence: SILENCE, flags, state: State::default() }
    }
}

impl Model for CommandModel {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn series(&self) -> &[OutputSeries] {
        &self.series
    }

    fn flags(&self) -> &[Flag] {
        &self.flags
    }

    fn concurrency(&self) -> Option<usize> {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        Some(self.settings.workers.unwrap_or_else(cores))
    }

    fn worker<'a>(&'a self, context: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        match &self.settings.form {
            Form::KeptAlive(form) => Box::new(KeptAliveWorker::new(self, context, *form)),
            Form::PerRun(form) => Box::new(PerRunWorker::new(self, context, form)),
        }
    }
}

/// The flag of rows asked by a process of their own.
fn alone() -> Flag {
    Flag {
        name: "asked-alone".into(),
        description: "the program was out of step: it printed more or fewer answers than it had rows, or died after as \
                      many; those since it was last known to be in step were asked again, and all that followed asked, each by a process of its \
                      own; row numbers avoid this (row_numbers = true, see docs/worker-protocol.md)"
            .into(),
        warns: true,
    }
}

/// A value that is none.
fn not_a_value(value: f64) -> RowFailure {
    RowFailure::new(if value.is_nan() {
        "the program gave no value (an empty cell, nan or null)"
    } else {
        "the program gave an infinite value"
    })
}
