//! Studies: read, sampled, run, analysed.

use std::path::PathBuf;
use std::sync::mpsc::channel;
use std::sync::{Arc, Mutex, PoisonError};

use apportion::given::Column;
use apportion::result::RunFacts;
use apportion::run::{RowBlock, Store, threads_in_force};
use apportion::screening::{ScreeningDesign, ScreeningError, ScreeningSettings};
use apportion::sweep::{SweepError, find};
use apportion::{Batch, Distribution, Resume, RowFailure, RunContext, Runner};
use apportion_report::screening::{build_screening, screening_document};
use apportion_report::sweep::{build_sweep, sweep_document};
use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;

use crate::document::Document;
use crate::errors::{failed, input, run as run_error, study as study_error};
use crate::function::{Caller, PythonModel, Stop};
use crate::run::{Duty, Listeners, ProgressState, attend};

/// A checked study.
#[pyclass(frozen)]
pub struct Study {
    study: apportion::Study,
}

/// How a function of Python is asked.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Function {
    call: Py<PyAny>,
    version: String,
    /// Calls at a time from threads of the run; 0 to call it in this thread.
    workers: usize,
    is_slow: bool,
}

#[pymethods]
impl Study {
    /// The study of a text in the format of study files; `path` is for messages and names the study.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, path: PathBuf, overrides: Vec<String>) -> PyResult<Self> {
        let study = apportion_files::parse_study(text, &path, &overrides);
        study.map(|study| Self { study }).map_err(|error| study_error(py, &error))
    }

    /// The study of a file.
    #[staticmethod]
    fn load(path: PathBuf, overrides: Vec<String>) -> PyResult<Self> {
        apportion_files::load_study(&path, &overrides).map(|study| Self { study }).map_err(input)
    }

    #[getter]
    fn name(&self) -> &str {
        self.study.name()
    }

    #[getter]
    fn source(&self) -> &str {
        self.study.source()
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.study.notes().to_vec()
    }

    /// (name, unit) of every factor.
    #[getter]
    fn factors(&self) -> Vec<(String, String)> {
        let factors = self.study.space().factors().iter();
        factors.map(|factor| (factor.name.clone(), factor.unit().to_string())).collect()
    }

    /// (name, unit) of every output.
    #[getter]
    fn outputs(&self) -> Vec<(String, String)> {
        self.study.model().outputs().iter().map(|o| (o.name.to_string(), o.unit.to_string())).collect()
    }

    #[getter]
    fn runs(&self) -> u64 {
        self.study.design().rows()
    }

    #[getter]
    fn rows_per_point(&self) -> u64 {
        self.study.design().rows_per_point()
    }

    #[getter]
    fn base_samples(&self) -> u64 {
        self.study.design().settings().base_samples
    }

    #[getter]
    fn replicates(&self) -> u64 {
        self.study.design().settings().replicates
    }

    /// Whether the number of runs is decided as they go on.
    #[getter]
    fn grows(&self) -> bool {
        self.study.target().grows()
    }

    #[getter]
    fn is_external(&self) -> bool {
        self.study.subject().is_external()
    }

    /// Every `step`-th of the rows `first` to `last` of the design: an array of (rows, factors) in the units of the factors.
    /// `MemoryError` if there is no room for them.
    fn sample<'py>(&self, py: Python<'py>, first: u64, last: u64, step: u64) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (space, design) = (self.study.space(), self.study.design());
        let factors = space.factors().len();
        let last = last.min(design.rows());
        let step = step.max(1);
        let count = last.saturating_sub(first).div_ceil(step);
        let mut rows: Vec<f64> = Vec::new();
        let numbers = usize::try_from(count).unwrap_or(usize::MAX).saturating_mul(factors);
        rows.try_reserve_exact(numbers).map_err(|_| {
            let gigabytes = 8e-9 * count as f64 * factors as f64;
            PyMemoryError::new_err(format!(
                "{count} points of {factors} factors need {gigabytes:.0} GB: lower base_samples"
            ))
        })?;
        let rows = py.detach(|| {
            let mut u = vec![0.0; factors];
            for row in (first..last).step_by(step as usize) {
                design.point(row, &mut u);
                rows.extend(space.values_at(&u));
            }
            rows
        });
        let count = rows.len() / factors.max(1);
        numpy::PyArray1::from_vec(py, rows).reshape([count, factors])
    }

    /// The outputs of the model at `points`, an array of (rows, factors) in the units of the factors: an array of (rows,
    /// outputs), NaN where there is none, and (row, output, reason) of these.
    #[expect(clippy::type_complexity, reason = "as Python sees it")]
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Vec<(usize, String, String)>)> {
        let (factors, model) = (self.study.space().factors(), self.study.model());
        let array = points.as_array();
        if array.ncols() != factors.len() {
            return Err(input(format!(
                "points have {} columns, the study has {} factors",
                array.ncols(),
                factors.len()
            )));
        }
        let in_si = |(column, factor): (numpy::ndarray::ArrayView1<'_, f64>, &apportion::Factor)| -> Vec<f64> {
            column.iter().map(|x| factor.unit().to_si(*x)).collect()
        };
        let columns: Vec<Vec<f64>> = array.columns().into_iter().zip(factors).map(in_si).collect();
        let rows = array.nrows();
        let mut batch = Batch::new(model.as_ref());
        batch.reset(rows);
        py.detach(|| {
            let slices: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
            model.worker(&RunContext::default()).run(&slices, &mut batch);
            batch.settle();
        });
        if let Some(reason) = batch.given_up() {
            return Err(failed(format!("the model cannot continue: {reason}")));
        }
        let outputs = model.outputs();
        let value = |row: usize, output: usize| outputs[output].unit.from_si(batch.column(output)[row]);
        let values = (0..rows).flat_map(|row| (0..outputs.len()).map(move |output| (row, output)));
        let values: Vec<f64> = values.map(|(row, output)| value(row, output)).collect();
        let failures = batch.failures().iter();
        let failures = failures.map(|(output, row, why)| (*row, outputs[*output].name.to_string(), why.to_string()));
        let failures = failures.collect();
        Ok((numpy::PyArray1::from_vec(py, values).reshape([rows, outputs.len()])?, failures))
    }

    /// Runs the study, with `function` as its model if there is one.
    #[pyo3(signature = (function, stop, *, threads, journal, resume, progress, message))]
    #[expect(clippy::too_many_arguments, reason = "by name")]
    fn run(
        &self,
        py: Python<'_>,
        function: Option<Function>,
        stop: &Stop,
        threads: usize,
        journal: Option<PathBuf>,
        resume: &str,
        progress: Option<Py<PyAny>>,
        message: Option<Py<PyAny>>,
    ) -> PyResult<Document> {
        let keywords =
            Keywords { threads, journal, resume: resumed(resume)?, listeners: Listeners { progress, message } };
        self.with_function(py, function, stop, keywords, |_, runner| {
            let result = runner.run().map_err(|error| run_error(&error))?;
            Ok(result.into())
        })
    }

    /// The result from `outputs`, an array of (rows, outputs) in the order of [`sample`](Self::sample), NaN where there is none.
    fn analyse(&self, py: Python<'_>, outputs: PyReadonlyArray2<'_, f64>) -> PyResult<Document> {
        let (study, design, model) = (&self.study, self.study.design(), self.study.model());
        let array = outputs.as_array();
        let expected = (design.rows() as usize, model.outputs().len());
        if array.dim() != expected {
            return Err(input(format!(
                "outputs of shape {:?}: the design has {expected:?} (rows, outputs)",
                array.dim()
            )));
        }
        if study.target().grows() {
            return Err(input(
                "a study with an accuracy or limits chooses its rows during the run: set base_samples instead",
            ));
        }
        let store = Store::new(model.as_ref());
        let replicates = design.settings().replicates;
        let rows = design.rows() / replicates;
        let missing = RowFailure::new("there is no output");
        for replicate in 0..replicates {
            let mut batch = Batch::new(model.as_ref());
            batch.reset(rows as usize);
            for row in 0..rows as usize {
                for (output, of) in model.outputs().iter().enumerate() {
                    let value = of.unit.to_si(array[[replicate as usize * rows as usize + row, output]]);
                    batch.set(row, output, value);
                    if value.is_nan() {
                        batch.fail(row, output, missing.clone());
                    }
                }
            }
            batch.settle();
            store.insert(RowBlock::from_batches(replicate, 0, std::slice::from_ref(&batch)));
        }
        py.detach(|| {
            let result = study.runner().store(&store).run().map_err(|error| run_error(&error))?;
            Ok(result.into())
        })
    }

    /// Elementary effects; `levels` is `None` for the radial design.
    #[pyo3(signature = (function, stop, *, trajectories, levels, seed, threads, journal, resume, progress, message))]
    #[expect(clippy::too_many_arguments, reason = "by name")]
    fn screen(
        &self,
        py: Python<'_>,
        function: Option<Function>,
        stop: &Stop,
        trajectories: u64,
        levels: Option<u32>,
        seed: Option<u64>,
        threads: usize,
        journal: Option<PathBuf>,
        resume: &str,
        progress: Option<Py<PyAny>>,
        message: Option<Py<PyAny>>,
    ) -> PyResult<Document> {
        let keywords =
            Keywords { threads, journal, resume: resumed(resume)?, listeners: Listeners { progress, message } };
        self.with_function(py, function, stop, keywords, |study, runner| {
            let in_study = study.design().settings();
            let design = match levels {
                None => ScreeningDesign::Radial { sampler: in_study.sampler },
                Some(levels) => ScreeningDesign::Trajectory { levels },
            };
            let settings = ScreeningSettings { design, trajectories, seed: seed.unwrap_or(in_study.seed) };
            let begun = std::time::Instant::now();
            let screening = runner.screen(settings).map_err(|error| match error {
                ScreeningError::Run(error) => run_error(&error),
                error => failed(error),
            })?;
            let facts = RunFacts { threads: threads_in_force(threads), wall_seconds: begun.elapsed().as_secs_f64() };
            let file = build_screening(study, study.model().as_ref(), &screening, facts);
            Ok(Document::new(screening_document(&file)))
        })
    }

    /// One factor at a time over its range; all factors if none is named.
    #[pyo3(signature = (function, stop, factors, points, *, journal, resume, progress, message))]
    #[expect(clippy::too_many_arguments, reason = "by name")]
    fn sweep(
        &self,
        py: Python<'_>,
        function: Option<Function>,
        stop: &Stop,
        factors: Vec<String>,
        points: usize,
        journal: Option<PathBuf>,
        resume: &str,
        progress: Option<Py<PyAny>>,
        message: Option<Py<PyAny>>,
    ) -> PyResult<Document> {
        let factors = find(self.study.space(), &factors).map_err(input)?;
        let listeners = Listeners { progress, message };
        let keywords = Keywords { threads: 0, journal, resume: resumed(resume)?, listeners };
        self.with_function(py, function, stop, keywords, |study, runner| {
            let sweeps = runner.sweep(&factors, points).map_err(|error| match error {
                SweepError::Run(error) => run_error(&error),
                error => failed(error),
            })?;
            Ok(Document::new(sweep_document(&build_sweep(study, study.model().as_ref(), sweeps))))
        })
    }
}

/// The keywords of a run.
struct Keywords {
    threads: usize,
    journal: Option<PathBuf>,
    resume: Resume,
    listeners: Listeners,
}

/// What becomes of runs in a journal.
fn resumed(keyword: &str) -> PyResult<Resume> {
    match keyword {
        "if-there" => Ok(Resume::IfThere),
        "require" => Ok(Resume::Require),
        "retry-failed" => Ok(Resume::RetryFailed),
        "never" => Ok(Resume::Restart),
        _ => Err(input("resume: expected \"if-there\", \"require\", \"retry-failed\" or \"never\"")),
    }
}

impl Study {
    /// The distributions of the factors that have the names of `columns`.
    pub fn distributions_of(&self, columns: &[Column]) -> PyResult<Vec<Distribution>> {
        let of = |column: &Column| {
            let factor = self.study.space().factors().iter().find(|factor| factor.name == column.name);
            factor.map(|factor| factor.distribution().clone())
        };
        let all = columns
            .iter()
            .map(|column| of(column).ok_or_else(|| input(format!("`{}` has no distribution", column.name))));
        all.collect()
    }

    /// What `work` makes of the study with `function` as its model, and of a runner of it.
    fn with_function(
        &self,
        py: Python<'_>,
        function: Option<Function>,
        stop: &Stop,
        keywords: Keywords,
        work: impl FnOnce(&apportion::Study, Runner<'_>) -> PyResult<Document> + Send,
    ) -> PyResult<Document> {
        let (finished, events) = channel();
        let told = Arc::new(ProgressState::default());
        let first_error = Arc::new(Mutex::new(None));
        let (study, model) = match function {
            None => (self.study.clone(), None),
            Some(Function { call, version, workers, is_slow }) => {
                let caller = match workers {
                    0 => Caller::There(finished.clone()),
                    workers => Caller::Here { workers, first_error: Arc::clone(&first_error), stop: stop.clone() },
                };
                let model = Arc::new(PythonModel {
                    function: call,
                    outputs: self.study.model().outputs().to_vec(),
                    series: self.study.model().series().to_vec(),
                    factor_units: PythonModel::units(self.study.space()),
                    caller,
                    is_slow,
                });
                (self.study.clone().with_model(model.clone(), &version).map_err(input)?, Some(model))
            }
        };
        let duty = Duty { events, finished, model, stop: stop.clone() };
        // An interruption is told before what came of it elsewhere.
        let Keywords { threads, journal, resume, listeners } = keywords;
        let result = attend(py, duty, &told, &listeners, || {
            let (progress, messages) = (Arc::clone(&told), Arc::clone(&told));
            let mut runner = study.runner().threads(threads).resume(resume).stop(stop.flag());
            runner = runner.on_progress(move |now| progress.progress(now));
            runner = runner.on_message(move |line| messages.message(line));
            if let Some(journal) = journal {
                runner = runner.journal(journal);
            }
            work(&study, runner)
        })?;
        let first_error = first_error.lock().unwrap_or_else(PoisonError::into_inner).take();
        first_error.map_or(result, Err)
    }
}
