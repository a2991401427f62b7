//! A worker that runs a program once for each row, each time in a separate directory.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::sync::Mutex;
use std::time::{Duration, Instant, UNIX_EPOCH};

use apportion::model::{Batch, RowFailure, RunContext, Worker};
use apportion_base::digest::sha256;
use apportion_base::files::{TEMPORARY, remove_left_overs};
use apportion_base::text::seconds;

use super::pick::{MAX_BYTES, STDOUT, Source, Texts};
use super::process::listen;
use super::program::{Running, ended_in_words, too_many_files};
use super::protocol::{Column, columns, table};
use super::template::InputTemplate;
use super::{CommandModel, not_a_value};

/// How a program runs once for each row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PerRun {
    /// The template of the input file.
    pub template_file: PathBuf,
    /// The parsed template.
    pub template: InputTemplate,
    /// The name of the input file in the directory of a run.
    pub input: String,
    /// Files that are copied there too.
    pub files: Vec<PathBuf>,
    /// The folder in which the directories of runs are kept; `None` removes them.
    pub keep: Option<PathBuf>,
}

/// Name of the file in the directory of a run with the standard error of the program.
const STDERR: &str = "stderr.txt";

/// Modification time set for files that are copied for a run, if outputs are read from them: a run that has not written
/// them has no output. No program sets this time, in seconds since 1970.
const BEFORE: Duration = Duration::from_secs(97_446);

pub(super) struct PerRunWorker<'a> {
    model: &'a CommandModel,
    context: &'a RunContext<'a>,
    form: &'a PerRun,
    columns: Vec<Column>,
}

/// Why a run has no outputs.
enum Fault {
    /// Every run fails.
    Fatal(RowFailure),
    /// This run failed; a retry may succeed.
    Run(String),
}

impl<'a> PerRunWorker<'a> {
    pub(super) fn new(model: &'a CommandModel, context: &'a RunContext<'a>, form: &'a PerRun) -> Self {
        Self { model, context, form, columns: columns(&model.factors, &str::to_owned) }
    }

    /// Runs the program on one row, retries if it fails, and sets its outputs.
    fn row(&self, inputs: &[&[f64]], row: usize, batch: &mut Batch) -> Result<(), RowFailure> {
        let mut tries = 0;
        let reason = loop {
            let (directory, _temporary) = self.directory(inputs, row).map_err(|error| self.unwritable(&error))?;
            match self.run_in(&directory, inputs, row) {
                Ok(()) => return self.pick(&directory, row, batch),
                Err(Fault::Fatal(reason)) => return Err(reason),
                Err(Fault::Run(reason)) if tries == self.model.settings.retries => break reason,
                Err(Fault::Run(_)) => tries += 1,
            }
        };
        batch.fail_row(row, &RowFailure::new(&reason));
        self.model.state.note_failure(&reason)
    }

    fn unwritable(&self, error: &io::Error) -> RowFailure {
        let place = self.form.keep.clone().unwrap_or_else(std::env::temp_dir);
        let advice = too_many_files(error).map_or_else(String::new, |advice| format!("; {advice}"));
        RowFailure::new(&format!("cannot prepare the directory of a run in {}: {error}{advice}", place.display()))
    }

    /// Creates a directory for a run; unless it is kept, it is removed with its contents when the second value is dropped.
    fn directory(&self, inputs: &[&[f64]], row: usize) -> io::Result<(PathBuf, impl Sized)> {
        let Some(keep) = &self.form.keep else {
            let (prefix, suffix, random) = TEMPORARY;
            self.model.state.cleared.get_or_init(|| remove_left_overs(&std::env::temp_dir()));
            let temporary = tempfile::Builder::new().prefix(prefix).suffix(suffix).rand_bytes(random).tempdir()?;
            // The lock tells other processes that it is in use; some file systems have no locks.
            let lock = File::open(temporary.path()).inspect(|folder| drop(folder.try_lock())).ok();
            return Ok((temporary.path().to_owned(), Some((temporary, lock))));
        };
        let text = table(&self.columns, inputs, row);
        // The same point has the same directory in any order of runs.
        let path = keep.join(format!("run-{}", &sha256(text.as_bytes())[..16]));
        match std::fs::remove_dir_all(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => std::fs::create_dir_all(&path)?,
        }
        std::fs::write(path.join("factors.csv"), text)?;
        Ok((path, None))
    }

    fn prepare(&self, directory: &Path, inputs: &[&[f64]], row: usize) -> io::Result<(File, File)> {
        for file in &self.form.files {
            let name = file.file_name().ok_or(io::ErrorKind::InvalidFilename)?;
            let copy = directory.join(name);
            std::fs::copy(file, &copy)?;
            if self.is_read(name) {
                // If that is refused, an unchanged file counts as written by the run.
                let _ = File::options().write(true).open(&copy).and_then(|file| file.set_modified(UNIX_EPOCH + BEFORE));
            }
        }
        let text = self.form.template.fill(|factor, out| self.columns[factor].write(inputs[factor][row], out));
        std::fs::write(directory.join(&self.form.input), text)?;
        Ok((File::create(directory.join(STDOUT))?, File::create(directory.join(STDERR))?))
    }

    /// Returns whether some output is read from the file of that name.
    fn is_read(&self, name: &std::ffi::OsStr) -> bool {
        let mut picks = self.model.settings.outputs.iter().filter_map(|output| output.pick.as_ref());
        picks.any(|pick| matches!(&pick.source, Source::File(file) if name == file.as_str()))
    }

    fn run_in(&self, directory: &Path, inputs: &[&[f64]], row: usize) -> Result<(), Fault> {
        let CommandModel { settings, .. } = self.model;
        let prepared = self.prepare(directory, inputs, row);
        let (stdout, stderr) = prepared.map_err(|error| Fault::Fatal(self.unwritable(&error)))?;
        let mut command = settings.program.command(directory);
        command.stdin(Stdio::null()).stdout(stdout).stderr(stderr);
        let child =
            command.spawn().map_err(|error| Fault::Fatal(RowFailure::new(&settings.program.refusal(&error))))?;
        let mut running = Running::new(child);
        let cut = self.wait(&mut running, directory);
        let status = running.end();
        let last_words = Mutex::new(String::new());
        if let Ok(file) = File::open(directory.join(STDERR)) {
            listen(self.context.messages(), file, &last_words);
        }
        cut?;
        if status.is_some_and(|status| status.success()) {
            return Ok(());
        }
        Err(Fault::Run(ended_in_words(status, &last_words.into_inner().unwrap_or_default())))
    }

    /// Waits until the program has ended, or must be stopped.
    fn wait(&self, running: &mut Running, directory: &Path) -> Result<(), Fault> {
        let (start, mut pause) = (Instant::now(), Duration::from_millis(1));
        while !running.ends_within(pause) {
            if self.context.is_stopped() {
                return Err(Fault::Fatal(RowFailure::interrupted()));
            }
            if let Some(timeout) = self.model.settings.timeout.filter(|timeout| start.elapsed() >= *timeout) {
                return Err(Fault::Run(format!("the program took longer than {}", seconds(timeout))));
            }
            let mut files = [STDOUT, STDERR].iter().map(|name| std::fs::metadata(directory.join(name)));
            if files.any(|file| file.is_ok_and(|file| file.len() > MAX_BYTES)) {
                return Err(Fault::Run("the program printed more than 256 MiB".to_owned()));
            }
            pause = (pause * 2).min(Duration::from_millis(50));
        }
        Ok(())
    }

    /// Sets the outputs of a successful run.
    fn pick(&self, directory: &Path, row: usize, batch: &mut Batch) -> Result<(), RowFailure> {
        let settings = &self.model.settings;
        let (mut missing, mut has_value) = (None, false);
        let mut texts = Texts::new();
        for (column, place) in settings.requested.iter().enumerate() {
            let output = &settings.outputs[*place];
            let Some(pick) = &output.pick else { continue };
            let number = match &pick.source {
                Source::File(name) if is_from_before(&directory.join(name)) => {
                    Err(format!("the run did not change `{name}`"))
                }
                _ => pick.number(directory, &mut texts),
            };
            match number {
                Ok(value) if value.is_finite() => {
                    has_value = true;
                    batch.set(row, column, output.unit.to_si(value));
                }
                Ok(value) => batch.fail(row, column, not_a_value(value)),
                Err(reason) => {
                    batch.fail(row, column, RowFailure::new(&reason));
                    missing = Some(reason);
                }
            }
        }
        if has_value {
            self.model.state.note_answer(Duration::ZERO);
        }
        missing.map_or(Ok(()), |reason| self.model.state.note_failure(&reason))
    }
}

impl Worker for PerRunWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        for row in 0..batch.rows() {
            let outcome = match self.context.is_stopped() {
                true => Err(RowFailure::interrupted()),
                false => self.row(inputs, row, batch),
            };
            if let Err(reason) = outcome {
                return batch.give_up(reason);
            }
        }
    }
}

/// Returns whether a run has not written a file that was copied for it.
fn is_from_before(path: &Path) -> bool {
    std::fs::metadata(path).and_then(|data| data.modified()).is_ok_and(|time| time == UNIX_EPOCH + BEFORE)
}
