//! The progress of a run, and why it ends early.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use super::{Progress, RunError};
use crate::model::RunContext;
use apportion_base::clock::Instant;

/// The finished rows of a run, counted by its threads.
pub(super) struct Tracker<'r> {
    context: &'r RunContext<'r>,
    before: Progress,
    start: Instant,
    on_progress: &'r (dyn Fn(Progress) + Sync),
    done: AtomicU64,
    failed: AtomicU64,
    error: Mutex<Option<RunError>>,
}

impl<'r> Tracker<'r> {
    /// Creates a tracker that starts at `before`, whose total is that of all rows of the run.
    pub fn new(
        context: &'r RunContext<'r>,
        before: Progress,
        start: Instant,
        on_progress: &'r (dyn Fn(Progress) + Sync),
    ) -> Self {
        let [done, failed] = [before.done, before.failed].map(AtomicU64::new);
        Self { context, before, start, on_progress, done, failed, error: Mutex::new(None) }
    }

    /// Returns whether the run continues.
    pub fn goes_on(&self) -> bool {
        !self.context.is_stopped()
    }

    /// Counts finished rows, some of which may have failed.
    pub fn add(&self, rows: u64, failed: u64) {
        let done = self.done.fetch_add(rows, Ordering::Relaxed) + rows;
        let failed = self.failed.fetch_add(failed, Ordering::Relaxed) + failed;
        (self.on_progress)(Progress { done, failed, elapsed: self.start.elapsed(), ..self.before });
    }

    /// Ends the run with an error. The first error counts; of rows that failed, the first in the design.
    pub fn end(&self, error: RunError) {
        let mut first = self.error.lock().unwrap_or_else(PoisonError::into_inner);
        let replaces = match (&*first, &error) {
            (Some(RunError::RowFailed { row: first, .. }), RunError::RowFailed { row, .. }) => row < first,
            (first, _) => first.is_none(),
        };
        if replaces {
            *first = Some(error);
        }
        self.context.end();
    }

    /// Returns a guard that ends the other threads if this one panics: they may wait for it.
    pub fn end_if_panicking(&self) -> impl Drop + 'r {
        struct Guard<'r>(&'r RunContext<'r>);
        impl Drop for Guard<'_> {
            fn drop(&mut self) {
                if std::thread::panicking() {
                    self.0.end();
                }
            }
        }
        Guard(self.context)
    }

    /// Returns the error if the run ended early. A worker gives up its rows when the run is interrupted.
    pub fn finish(self) -> Result<(), RunError> {
        let (done, total) = (self.done.into_inner(), self.before.total);
        match self.error.into_inner().unwrap_or_else(PoisonError::into_inner) {
            None | Some(RunError::GaveUp(_)) if done < total && self.context.is_interrupted() => {
                Err(RunError::Interrupted { done, total: Some(total) })
            }
            error => error.map_or(Ok(()), Err),
        }
    }
}
