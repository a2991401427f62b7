//! Work of a caller's own through the workers of a model, piece by piece.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use super::executor::Executor;
use super::task::{Evaluated, Finished, Task};
use super::{Progress, RunError};
use crate::clock::Instant;
use crate::model::{Model, RunContext, Worker};

/// What `evaluate` makes of every number below `count` with a worker of `model`, in order, on so many threads (0: one per
/// core).
///
/// # Errors
/// None but those of the workers' run.
pub fn run_each<T: Send>(
    model: &dyn Model,
    threads: usize,
    count: u64,
    evaluate: impl Fn(&mut dyn Worker, u64) -> T + Sync,
) -> Result<Vec<T>, RunError> {
    run_each_in(model, threads, &RunContext::default(), count, evaluate, &|_| ())
}

/// The same in the run of a context, which may be ended; `on_progress` is told of it.
///
/// # Errors
/// [`RunError::Interrupted`] if the run is asked to end.
pub fn run_each_in<T: Send>(
    model: &dyn Model,
    threads: usize,
    context: &RunContext<'_>,
    count: u64,
    evaluate: impl Fn(&mut dyn Worker, u64) -> T + Sync,
    on_progress: &(dyn Fn(Progress) + Sync),
) -> Result<Vec<T>, RunError> {
    let sink = (0..count).map(|_| None).collect();
    let each = Each { evaluate, count, sink: Mutex::new((0, sink)) };
    let before = Progress { done: 0, recalled: 0, total: count, failed: 0, elapsed: Duration::ZERO };
    Executor::new(model, context, threads).execute(&each, before, Instant::now(), on_progress)?;
    let (_, outputs) = each.sink.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok(outputs.into_iter().flatten().collect())
}

struct Each<F, T> {
    evaluate: F,
    count: u64,
    /// The next number, and what has come of those before.
    sink: Mutex<(u64, Vec<Option<T>>)>,
}

impl<T: Send, F: Fn(&mut dyn Worker, u64) -> T + Sync> Task for Each<F, T> {
    type Piece = u64;
    type Output = T;
    type Scratch = ();

    fn scratch(&self) {}

    fn next(&self, _: u64, _: usize) -> Option<u64> {
        let mut sink = self.sink.lock().unwrap_or_else(PoisonError::into_inner);
        sink.0 += 1;
        Some(sink.0 - 1).filter(|number| *number < self.count)
    }

    fn rows(&self, _: &u64) -> u64 {
        1
    }

    fn evaluate(&self, worker: &mut dyn Worker, (): &mut (), number: &u64, _: &dyn Fn(u64)) -> Evaluated<T> {
        let output = Some((self.evaluate)(worker, *number));
        Evaluated { output, given_up: None }
    }

    fn accept(&self, number: &u64, output: T) -> Result<Finished, RunError> {
        let mut sink = self.sink.lock().unwrap_or_else(PoisonError::into_inner);
        sink.1[*number as usize] = Some(output);
        Ok(Finished { rows: 1, failed: 0 })
    }
}
