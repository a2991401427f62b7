//! A Python function as a model.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};

use apportion::{Batch, Model, Output, OutputSeries, RowFailure, RunContext, Space, Unit, Worker};
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

/// Whether the run is to end, for Python code that waits.
#[pyclass(frozen)]
#[derive(Clone, Default)]
pub struct Stop(Arc<AtomicBool>);

#[pymethods]
impl Stop {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Whether it is.
    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl Stop {
    pub fn set(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    pub fn flag(&self) -> &AtomicBool {
        &self.0
    }
}

/// Values that a call of the function should return at least: it takes as long as some thousand of them.
const VALUES_PER_CALL: usize = 1 << 14;

/// Values and failures of a block of rows: an array of (rows, outputs), and (row, reason) of every row that failed.
type Answer = (Vec<f64>, Vec<(usize, String)>);

/// Why the function is not asked again.
#[derive(Clone, Copy)]
pub struct Ended;

/// A block of rows that waits for its answer.
pub struct Request {
    columns: Vec<Vec<f64>>,
    /// Room for the values of the answer.
    values: Vec<f64>,
    answer: SyncSender<Result<Answer, Ended>>,
}

/// What the thread that started the run is told.
pub enum Event {
    Request(Request),
    Finished,
}

/// Where the function is called.
pub enum Caller {
    /// In the thread that started the run, one block at a time.
    There(Sender<Event>),
    /// In the threads of the run, so many at a time: the function hands the block to others and waits for them.
    Here { workers: usize, first_error: Arc<Mutex<Option<PyErr>>>, stop: Stop },
}

/// How a function is asked: `function(columns)` of an array of (factors, rows) returns an array of (rows, outputs) and a list
/// of (row, reason); `is_slow` where rows are better shared out in pieces that fit their cost.
pub struct PythonModel {
    pub function: Py<PyAny>,
    pub outputs: Vec<Output>,
    pub series: Vec<OutputSeries>,
    pub factor_units: Vec<Unit>,
    pub caller: Caller,
    pub is_slow: bool,
}

impl PythonModel {
    pub fn units(space: &Space) -> Vec<Unit> {
        space.factors().iter().map(|factor| factor.unit().clone()).collect()
    }

    /// What the function answers to `columns`.
    fn call(&self, py: Python<'_>, columns: &[Vec<f64>], mut into: Vec<f64>) -> PyResult<Answer> {
        let rows = columns.first().map_or(0, Vec::len);
        let array = PyArray2::from_vec2(py, columns)?;
        let answer = self.function.bind(py).call1((array,))?;
        let (values, failures): (PyReadonlyArray2<'_, f64>, Vec<(usize, String)>) = answer.extract()?;
        let shape = values.as_array().dim();
        assert_shape(shape, (rows, self.outputs.len()))?;
        into.clear();
        match values.as_slice() {
            Ok(values) => into.extend_from_slice(values),
            Err(_) => into.extend(values.as_array().iter()),
        }
        Ok((into, failures))
    }

    /// Answers `request`, in the thread that started the run.
    pub fn serve(&self, py: Python<'_>, request: Request) -> PyResult<()> {
        let (answer, outcome) = match self.call(py, &request.columns, request.values) {
            Ok(answer) => (Ok(answer), Ok(())),
            Err(error) => (Err(Ended), Err(error)),
        };
        // Nobody waits any more if the run has ended.
        drop(request.answer.send(answer));
        outcome
    }
}

impl Request {
    /// The run is to end.
    pub fn refuse(self) {
        drop(self.answer.send(Err(Ended)));
    }
}

fn assert_shape(found: (usize, usize), expected: (usize, usize)) -> PyResult<()> {
    if found == expected {
        return Ok(());
    }
    Err(crate::errors::failed(format!("the function returned an array of shape {found:?}, expected {expected:?}")))
}

impl Model for PythonModel {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn series(&self) -> &[OutputSeries] {
        &self.series
    }

    fn concurrency(&self) -> Option<usize> {
        match self.caller {
            Caller::Here { workers, .. } => Some(workers),
            Caller::There(_) => self.is_slow.then_some(1),
        }
    }

    fn may_be_random(&self) -> bool {
        true
    }

    fn rows_per_call(&self) -> usize {
        VALUES_PER_CALL / self.outputs.len().max(1)
    }

    fn worker<'a>(&'a self, context: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        Box::new(PythonWorker { model: self, context, values: Vec::new() })
    }
}

struct PythonWorker<'a> {
    model: &'a PythonModel,
    context: &'a RunContext<'a>,
    /// The values of the last answer.
    values: Vec<f64>,
}

impl PythonWorker<'_> {
    fn answer(&mut self, columns: Vec<Vec<f64>>) -> Result<Answer, Ended> {
        if self.context.is_stopped() {
            return Err(Ended);
        }
        let values = std::mem::take(&mut self.values);
        match &self.model.caller {
            Caller::There(sender) => {
                let (answer, answered) = sync_channel(1);
                sender.send(Event::Request(Request { columns, values, answer })).map_err(|_| Ended)?;
                answered.recv().unwrap_or(Err(Ended))
            }
            Caller::Here { first_error, stop, .. } => Python::attach(|py| {
                self.model.call(py, &columns, values).map_err(|error| {
                    stop.set();
                    first_error.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                    Ended
                })
            }),
        }
    }
}

impl Worker for PythonWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        let in_units = |(column, unit): (&&[f64], &Unit)| column.iter().map(|x| unit.from_si(*x)).collect();
        let columns = inputs.iter().zip(&self.model.factor_units).map(in_units).collect();
        let Ok((values, failures)) = self.answer(columns) else {
            return batch.give_up(RowFailure::interrupted());
        };
        let outputs = &self.model.outputs;
        batch.set_rows(0, &values, outputs.len());
        for (place, Output { unit, .. }) in outputs.iter().enumerate().filter(|(_, output)| !output.unit.is_si()) {
            batch.column_mut(place).iter_mut().for_each(|value| *value = unit.to_si(*value));
        }
        for (row, reason) in failures {
            if row < batch.rows() {
                batch.fail_row(row, &RowFailure::new(&reason));
            }
        }
        self.values = values;
    }
}
