use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use super::*;
use crate::model::{FunctionModel, Model, Output, RowFailure, RunContext, Worker};
use apportion_base::quantity::Unit;

/// A function evaluated by several workers, until it gives up at a value.
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

    fn worker<'a>(&'a self, context: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        Box::new(SlowWorker(self.inner.worker(context), self))
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
    let mut expected = Batch::new(&alone);
    expected.reset(x.len());
    alone.inner.worker(&RunContext::default()).run(&[&x], &mut expected);
    expected.settle();
    for workers in [1, 2, 3, 16, 1024] {
        let model = slow(workers, -1.0);
        let context = RunContext::default();
        let (table, mut batch) = (TableRun::new(&model, &context, 0), Batch::new(&model));
        for _ in 0..2 {
            batch.reset(x.len());
            table.run(&[&x], &mut batch).unwrap();
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
    let mut batch = Batch::new(&model);
    batch.reset(0);
    TableRun::new(&model, &RunContext::default(), 0).run(&[&[]], &mut batch).unwrap();
    assert!(batch.failures().is_empty());
}

#[test]
fn a_model_that_gives_up_ends_the_work() {
    let x = rows(1000);
    let model = slow(3, 500.0);
    let mut batch = Batch::new(&model);
    batch.reset(x.len());
    let context = RunContext::default();
    let halt = TableRun::new(&model, &context, 0).run(&[&x], &mut batch).unwrap_err();
    assert!(matches!(halt, RunError::GaveUp(give_up) if give_up == RowFailure::new("enough").into()));
}

#[test]
fn a_stop_ends_the_work() {
    let (x, stop) = (rows(100_000), AtomicBool::new(false));
    let model = slow(2, -1.0);
    let mut batch = Batch::new(&model);
    batch.reset(x.len());
    let context = RunContext::new(Some(&stop), |_| ());
    let workers = TableRun::new(&model, &context, 0);
    stop.store(true, Ordering::Relaxed);
    assert!(matches!(workers.run(&[&x], &mut batch), Err(RunError::Interrupted { done: 0, total: None })));
    assert!(model.threads.lock().unwrap().is_empty());
}
