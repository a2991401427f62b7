//! Functions that stand for programs.

use std::sync::Arc;

use apportion::model::{Batch, Model, Output, RunContext, Worker};

/// A model that says that it takes its time, as programs do.
pub struct Slow(pub Arc<dyn Model>);

impl Model for Slow {
    fn outputs(&self) -> &[Output] {
        self.0.outputs()
    }

    fn concurrency(&self) -> Option<usize> {
        Some(1)
    }

    fn worker<'a>(&'a self, context: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        Box::new(SlowWorker(self.0.worker(context)))
    }
}

struct SlowWorker<'a>(Box<dyn Worker + 'a>);

impl Worker for SlowWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        self.0.run(inputs, batch);
    }
}
