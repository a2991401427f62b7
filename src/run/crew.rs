//! Rows at once through all workers of a model: for those that no design and no record stands behind.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use thiserror::Error;

use super::PIECE_SECONDS;
use super::held::Held;
use crate::model::{Batch, Model, RowFailure, Standing, Worker};

/// Why rows were not evaluated to their end.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Halt {
    /// The model cannot go on.
    #[error("the model cannot go on: {0}")]
    GaveUp(RowFailure),
    /// It was asked to end.
    #[error("interrupted")]
    Interrupted,
}

/// Workers of a model who share out the rows of a batch among them: as many as it asks for by its
/// [concurrency](Model::concurrency), else one, which does them by itself.
pub(crate) struct Crew<'a> {
    model: &'a dyn Model,
    members: Vec<Member<'a>>,
    takes_its_time: bool,
    stop: Option<&'a AtomicBool>,
}

struct Member<'a> {
    worker: Box<dyn Worker + 'a>,
    /// Most rows of its next piece.
    most: usize,
}

/// Time between looks at whether the work is to end.
const LOOK: Duration = Duration::from_millis(20);

impl<'a> Crew<'a> {
    /// The workers of `model`, which end their work when `stop` is set.
    pub fn new(model: &'a dyn Model, stop: Option<&'a AtomicBool>) -> Self {
        let concurrency = model.concurrency();
        let member = |_| Member { worker: model.worker(), most: 1 };
        let members = (0..concurrency.unwrap_or(1).max(1)).map(member).collect();
        Self { model, members, takes_its_time: concurrency.is_some(), stop }
    }

    /// The same crew with at most `workers` workers, if that is not 0.
    #[must_use]
    pub fn at_most(mut self, workers: usize) -> Self {
        if workers > 0 {
            self.members.truncate(workers);
        }
        self
    }

    /// How many rows of `model` are best handed over at once.
    pub fn rows_at_once(model: &dyn Model) -> usize {
        if model.concurrency().is_some() { 1 << 16 } else { 1024 }
    }

    /// Evaluates rows as [`Worker::run`] does, and settles the batch. It is the same for any number of workers.
    ///
    /// # Errors
    /// [`Halt`] if the model gave up or `stop` was set; the batch then has no meaning.
    pub fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) -> Result<(), Halt> {
        if self.is_stopped() {
            return Err(Halt::Interrupted);
        }
        if self.takes_its_time {
            self.share_out(inputs, batch)?;
        } else if let Some(member) = self.members.first_mut() {
            member.worker.run(inputs, batch);
            if let Some(reason) = batch.given_up() {
                return Err(Halt::GaveUp(reason.clone()));
            }
        }
        batch.settle();
        Ok(())
    }

    fn is_stopped(&self) -> bool {
        self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }

    fn share_out(&mut self, inputs: &[&[f64]], batch: &mut Batch) -> Result<(), Halt> {
        let (model, stop, rows, workers) = (self.model, self.stop, batch.rows(), self.members.len());
        let (next, ended) = (AtomicUsize::new(0), AtomicBool::new(false));
        let (tell, parts) = mpsc::channel();
        let mut halt = None;
        thread::scope(|scope| {
            for member in self.members.iter_mut().take(rows) {
                let (tell, next, ended) = (tell.clone(), &next, &ended);
                scope.spawn(move || {
                    let mut held = Held::new();
                    while !ended.load(Ordering::Relaxed) {
                        let piece = held.next_again().or_else(|| take(next, rows, (member.most, workers)));
                        let standing = match piece {
                            Some(piece) => {
                                let (part, standing) = member.run(model, inputs, piece.clone());
                                if part.given_up().is_some() {
                                    return drop(tell.send((piece.start, part)));
                                }
                                held.push(piece.clone(), (piece.start, part));
                                standing
                            }
                            None if held.is_empty() => return,
                            None => member.worker.confirm(),
                        };
                        if held.settle(standing).into_iter().any(|part| tell.send(part).is_err()) {
                            return;
                        }
                    }
                });
            }
            drop(tell);
            loop {
                match parts.recv_timeout(LOOK) {
                    Ok((first, part)) => match part.given_up() {
                        Some(reason) => drop(halt.get_or_insert(Halt::GaveUp(reason.clone()))),
                        None => batch.take_over(first, &part),
                    },
                    Err(RecvTimeoutError::Timeout) => (),
                    Err(RecvTimeoutError::Disconnected) => break,
                }
                if stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
                    halt.get_or_insert(Halt::Interrupted);
                }
                if halt.is_some() && !ended.swap(true, Ordering::Relaxed) {
                    model.interrupt();
                }
            }
        });
        halt.map_or(Ok(()), Err)
    }
}

impl Member<'_> {
    fn run(&mut self, model: &dyn Model, inputs: &[&[f64]], piece: Range<usize>) -> (Batch, Standing) {
        let began = Instant::now();
        let rows = piece.len();
        let inputs: Vec<&[f64]> = inputs.iter().map(|column| &column[piece.clone()]).collect();
        let mut batch = Batch::of(model);
        batch.reset(rows);
        let standing = self.worker.run_ahead(&inputs, &mut batch);
        batch.settle();
        let fitting = (PIECE_SECONDS * rows as f64 / began.elapsed().as_secs_f64().max(1e-9)) as usize;
        self.most = fitting.clamp(1, 8 * rows);
        (batch, standing)
    }
}

/// The next rows to evaluate: `most`, or fewer so that all `workers` have some to the end.
fn take(next: &AtomicUsize, rows: usize, (most, workers): (usize, usize)) -> Option<Range<usize>> {
    let length = |first: usize| most.min(((rows - first) / (2 * workers)).max(1));
    let taken = |first: usize| (first < rows).then(|| first + length(first));
    let first = next.fetch_update(Ordering::Relaxed, Ordering::Relaxed, taken).ok()?;
    Some(first..first + length(first))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{FunctionModel, Output};
    use crate::quantity::Unit;
    use std::sync::Mutex;

    /// A function of which several workers are asked for, until it gives up at a value.
    struct Slow<M> {
        inner: M,
        workers: usize,
        gives_up_at: f64,
        threads: Mutex<Vec<thread::ThreadId>>,
    }

    struct SlowWorker<'a, M>(Box<dyn Worker + 'a>, &'a Slow<M>);

    impl<M: Model> Model for Slow<M> {
        fn outputs(&self) -> &[Output] {
            self.inner.outputs()
        }

        fn concurrency(&self) -> Option<usize> {
            Some(self.workers)
        }

        fn worker(&self) -> Box<dyn Worker + '_> {
            Box::new(SlowWorker(self.inner.worker(), self))
        }
    }

    impl<M: Model> Worker for SlowWorker<'_, M> {
        fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
            self.1.threads.lock().unwrap().push(thread::current().id());
            thread::sleep(Duration::from_millis(1));
            self.0.run(inputs, batch);
            if inputs[0].contains(&self.1.gives_up_at) {
                batch.give_up(RowFailure::new("enough"));
            }
        }
    }

    fn slow(workers: usize, gives_up_at: f64) -> Slow<impl Model> {
        let output = Output::new("y", Unit::dimensionless(), "");
        let inner = FunctionModel::new(vec![output], |x: &[f64], y: &mut [f64]| {
            if x[0] % 7.0 == 3.0 {
                return Err(RowFailure::new("three"));
            }
            y[0] = if x[0] % 11.0 == 5.0 { f64::NAN } else { x[0] * 2.0 };
            Ok(())
        });
        Slow { inner, workers, gives_up_at, threads: Mutex::default() }
    }

    fn rows(count: usize) -> Vec<f64> {
        (0..count).map(|row| row as f64).collect()
    }

    #[test]
    fn rows_keep_their_places_and_failures_for_any_number_of_workers() {
        let x = rows(1000);
        let alone = slow(1, -1.0);
        let mut expected = Batch::of(&alone);
        expected.reset(x.len());
        alone.inner.worker().run(&[&x], &mut expected);
        expected.settle();
        for workers in [1, 2, 3, 16, 1024] {
            let model = slow(workers, -1.0);
            let (mut crew, mut batch) = (Crew::new(&model, None), Batch::of(&model));
            for _ in 0..2 {
                batch.reset(x.len());
                crew.run(&[&x], &mut batch).unwrap();
                assert_eq!(batch.failures(), expected.failures());
                assert!(batch.column(0).iter().zip(expected.column(0)).all(|(a, b)| a.to_bits() == b.to_bits()));
            }
            let mut threads = std::mem::take(&mut *model.threads.lock().unwrap());
            threads.sort_by_key(|id| format!("{id:?}"));
            threads.dedup();
            assert!(workers == 1 || threads.len() > 1);
        }
    }

    #[test]
    fn no_rows_are_no_work() {
        let model = slow(4, -1.0);
        let mut batch = Batch::of(&model);
        batch.reset(0);
        Crew::new(&model, None).run(&[&[]], &mut batch).unwrap();
        assert!(batch.failures().is_empty());
    }

    #[test]
    fn a_model_that_gives_up_ends_the_work() {
        let x = rows(1000);
        let model = slow(3, 500.0);
        let mut batch = Batch::of(&model);
        batch.reset(x.len());
        let halt = Crew::new(&model, None).run(&[&x], &mut batch).unwrap_err();
        assert_eq!(halt, Halt::GaveUp(RowFailure::new("enough")));
    }

    #[test]
    fn a_stop_ends_the_work() {
        let (x, stop) = (rows(100_000), AtomicBool::new(false));
        let model = slow(2, -1.0);
        let mut batch = Batch::of(&model);
        batch.reset(x.len());
        let mut crew = Crew::new(&model, Some(&stop));
        stop.store(true, Ordering::Relaxed);
        assert_eq!(crew.run(&[&x], &mut batch), Err(Halt::Interrupted));
        assert!(model.threads.lock().unwrap().is_empty());
    }
}
