//! Evaluating the rows that a store lacks: in pieces of any size, by workers that take the next one when they are free.

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::held::Held;
use super::rows::RowRunner;
use super::store::{Piece, Store};
use super::{FailurePolicy, Job, Keep, PIECE_SECONDS, Place, Progress, RunError};
use crate::model::{RowFailure, Standing};

/// Most rows of a piece.
const MOST_ROWS: u64 = 4096;

/// Time between looks at whether the run is to end.
const LOOK: Duration = Duration::from_millis(20);

/// What evaluates the missing rows of a store.
pub(super) struct Filling<'a> {
    pub job: Job<'a>,
    pub store: &'a Store,
    /// Told of every piece, before it counts as done.
    pub keep: Option<Keep<'a>>,
    pub failures: FailurePolicy,
    pub workers: usize,
    pub stop: Option<&'a AtomicBool>,
    pub on_progress: &'a (dyn Fn(Progress) + Sync),
    pub start: Instant,
}

/// What the workers share.
struct Shared {
    /// Rows that nobody has taken yet, as (replicate, rows).
    waiting: VecDeque<(u64, Range<u64>)>,
    rows_waiting: u64,
    /// Rows evaluated that do not stand yet.
    rows_pending: u64,
    progress: Progress,
    end: Option<RunError>,
    /// The first failed row seen, if the run ends at failures.
    failed: Option<(Place, RowFailure)>,
    working: usize,
}

impl Filling<'_> {
    /// Evaluates what the store lacks of `rows` of the replicates, in the order given.
    ///
    /// # Errors
    /// [`RunError`] if the run is to end: what was evaluated by then is in the store, and was kept.
    pub fn fill(&self, rows: &[(u64, Range<u64>)]) -> Result<(), RunError> {
        let mut progress = Progress { done: 0, recalled: 0, total: 0, failed: 0, elapsed: Duration::default() };
        let mut waiting = VecDeque::new();
        for (replicate, rows) in rows {
            let (present, failed) = self.store.count(*replicate, rows.clone());
            progress.total += rows.end - rows.start;
            progress.done += present;
            progress.failed += failed;
            waiting.extend(self.store.missing(*replicate, rows.clone()).into_iter().map(|range| (*replicate, range)));
        }
        progress.recalled = progress.done;
        let rows_waiting = progress.total - progress.done;
        if rows_waiting == 0 {
            return Ok(());
        }
        let workers = self.workers.min(usize::try_from(rows_waiting).unwrap_or(usize::MAX)).max(1);
        let shared =
            Shared { waiting, rows_waiting, rows_pending: 0, progress, end: None, failed: None, working: workers };
        let shared = Mutex::new(shared);
        std::thread::scope(|scope| {
            for _ in 0..workers {
                scope.spawn(|| {
                    let _leaving = Leaving(&shared);
                    self.work(&shared);
                });
            }
            self.watch(&shared);
        });
        let shared = shared.into_inner().unwrap_or_else(PoisonError::into_inner);
        match (shared.failed, shared.end) {
            (Some((row, reason)), _) => Err(RunError::RowFailed { row, reason }),
            // Rows that were pending may have come to stand since.
            (None, Some(RunError::Interrupted { total, .. })) => {
                Err(RunError::Interrupted { done: shared.progress.done, total })
            }
            (None, Some(end)) => Err(end),
            (None, None) => Ok(()),
        }
    }

    /// Waits for the workers to end, and passes on to the model that they should.
    fn watch(&self, shared: &Mutex<Shared>) {
        let mut told = false;
        loop {
            let ended = {
                let mut shared = lock(shared);
                if shared.working == 0 {
                    return;
                }
                if self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
                    let Progress { done, total, .. } = shared.progress;
                    shared.end.get_or_insert(RunError::Interrupted { done, total });
                }
                shared.end.is_some() || shared.failed.is_some()
            };
            if ended && !told {
                self.job.model.interrupt();
                told = true;
            }
            std::thread::sleep(LOOK);
        }
    }

    fn work(&self, shared: &Mutex<Shared>) {
        let mut runner = RowRunner::new(self.job);
        let mut most = 1;
        let mut held = Held::new();
        loop {
            let again = if is_ended(shared) { None } else { held.next_again() };
            let Some((replicate, range)) = again.or_else(|| take(shared, most, self.workers)) else {
                if held.is_empty() || !self.hand_over(shared, &mut held, runner.confirm()) {
                    return;
                }
                continue;
            };
            let began = Instant::now();
            let (batch, mut standing) = runner.run(self.job, replicate, range.clone());
            let seconds = began.elapsed().as_secs_f64();
            let given_up = batch.given_up().cloned();
            let rows = range.end - range.start;
            let piece = Piece::of_batch(replicate, range.start, batch);
            if standing == Standing::Pending && self.failures == FailurePolicy::Fail && !piece.failures.is_empty() {
                standing = runner.confirm();
            }
            held.push((replicate, range), answered(piece, given_up.as_ref(), self.store.outputs()));
            lock(shared).rows_pending += rows;
            if standing == Standing::Pending {
                (self.on_progress)(lock(shared).seen(self.start));
            }
            if !self.hand_over(shared, &mut held, standing) {
                return;
            }
            if let Some(reason) = given_up {
                lock(shared).end.get_or_insert(RunError::GaveUp { reason });
                return;
            }
            let fitting = (PIECE_SECONDS * rows as f64 / seconds.max(1e-9)) as u64;
            most = fitting.clamp(1, (8 * rows).min(MOST_ROWS));
        }
    }

    /// Puts into the store what stands; whether that could be kept.
    fn hand_over(
        &self,
        shared: &Mutex<Shared>,
        held: &mut Held<(u64, Range<u64>), Vec<Piece>>,
        standing: Standing,
    ) -> bool {
        if standing == Standing::Revoked {
            let rows: u64 = held.pending().map(|(_, rows)| rows.end - rows.start).sum();
            lock(shared).rows_pending -= rows;
        }
        for piece in held.settle(standing).iter().flatten() {
            if let Err(source) = self.keep.map_or(Ok(()), |keep| keep(piece)) {
                lock(shared).end.get_or_insert(RunError::NotKept { source });
                return false;
            }
            self.store.insert(piece);
            self.note(shared, piece);
        }
        true
    }

    fn note(&self, shared: &Mutex<Shared>, piece: &Piece) {
        let mut failed: Vec<u32> = piece.failures.iter().map(|(row, ..)| *row).collect();
        failed.dedup();
        let progress = {
            let mut shared = lock(shared);
            let rows = piece.rows(self.store.outputs());
            shared.progress.done += rows;
            shared.rows_pending -= rows;
            shared.progress.failed += failed.len() as u64;
            if let (FailurePolicy::Fail, Some((row, _, why))) = (self.failures, piece.failures.first()) {
                let (row, per_point) = (piece.first + u64::from(*row), self.job.design.rows_per_point());
                let place = Place { replicate: piece.replicate, point: row / per_point, run: row % per_point };
                if shared.failed.as_ref().is_none_or(|(first, _)| place < *first) {
                    shared.failed = Some((place, why.clone()));
                }
            }
            shared.seen(self.start)
        };
        (self.on_progress)(progress);
    }
}

impl Shared {
    /// How far the run has come, rows that do not stand yet included.
    fn seen(&self, start: Instant) -> Progress {
        let done = (self.progress.done + self.rows_pending).min(self.progress.total);
        Progress { done, elapsed: start.elapsed(), ..self.progress }
    }
}

fn is_ended(shared: &Mutex<Shared>) -> bool {
    let shared = lock(shared);
    shared.end.is_some() || shared.failed.is_some()
}

/// A worker that leaves, in whatever way.
struct Leaving<'a>(&'a Mutex<Shared>);

impl Drop for Leaving<'_> {
    fn drop(&mut self) {
        lock(self.0).working -= 1;
    }
}

fn lock(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    // A worker that panicked ends the run when the threads are joined.
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The next rows to evaluate: `most`, or fewer so that all `workers` have some to the end; `None` if none are left, or the
/// run is to end.
fn take(shared: &Mutex<Shared>, most: u64, workers: usize) -> Option<(u64, Range<u64>)> {
    let mut shared = lock(shared);
    if shared.end.is_some() || shared.failed.is_some() {
        return None;
    }
    let share = (shared.rows_waiting / (2 * workers as u64)).max(1);
    let (replicate, rows) = shared.waiting.front_mut()?;
    let taken = rows.start..rows.end.min(rows.start + most.min(share));
    rows.start = taken.end;
    let replicate = *replicate;
    if rows.is_empty() {
        shared.waiting.pop_front();
    }
    shared.rows_waiting -= taken.end - taken.start;
    Some((replicate, taken))
}

/// The rows of a piece that were answered: all, unless the model has given up for `reason`.
fn answered(piece: Piece, reason: Option<&RowFailure>, outputs: usize) -> Vec<Piece> {
    let Some(reason) = reason else { return vec![piece] };
    let open: Vec<u32> = piece.failures.iter().filter(|(.., why)| why == reason).map(|(row, ..)| *row).collect();
    let mut pieces: Vec<Piece> = Vec::new();
    let mut counts = Some((piece.flags, piece.effort));
    for row in (0..piece.values.len() / outputs.max(1)).filter(|row| !open.contains(&(*row as u32))) {
        let at = piece.first + row as u64;
        if pieces.last().is_none_or(|last| last.first + last.rows(outputs) != at) {
            let (flags, effort) = counts.take().unwrap_or_default();
            let (replicate, first) = (piece.replicate, at);
            pieces.push(Piece { replicate, first, flags, effort, ..Piece::default() });
        }
        let Some(last) = pieces.last_mut() else { continue };
        let here = last.rows(outputs) as u32;
        last.values.extend_from_slice(&piece.values[row * outputs..][..outputs]);
        let of_row = piece.failures.iter().filter(|(failed, ..)| *failed == row as u32);
        last.failures.extend(of_row.map(|(_, output, why)| (here, *output, why.clone())));
    }
    pieces
}

#[cfg(test)]
mod tests;
