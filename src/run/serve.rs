//! The worker's side of remote evaluation: reads requests and evaluates their rows.

use super::remote::{DesignKey, Reply, Request};
use super::rows::{RowValues, answered};
use crate::clock::Instant;
use crate::design::Design;
use crate::model::{Batch, Model, RowFailure, RunContext, Worker};
use crate::space::Space;

/// The source of requests and the receiver of replies.
pub trait Requests {
    /// Returns the next request; `None` if there are no more.
    fn next(&mut self) -> Option<Vec<u8>>;

    /// Sends the reply to the last request.
    fn reply(&mut self, reply: Vec<u8>);
}

/// A worker of one model, which evaluates rows for other processes.
pub(crate) struct RemoteServer<'a> {
    space: &'a Space,
    worker: Box<dyn Worker + 'a>,
    batch: Batch,
    /// The design of the last request, and its computed points.
    current: Option<(DesignKey, Design, RowValues)>,
}

impl<'a> RemoteServer<'a> {
    pub fn new(space: &'a Space, model: &'a dyn Model, context: &'a RunContext<'a>) -> Self {
        Self { space, worker: model.worker(context), batch: Batch::new(model), current: None }
    }

    /// Evaluates the rows of a request, of a design that differs from `design` by its key.
    pub fn reply(&mut self, design: &Design, request: &Request) -> Reply {
        if self.current.as_ref().is_none_or(|(key, ..)| *key != request.design) {
            let Some(design) = request.design.design(design) else { return refusal("an unknown design") };
            self.current = Some((request.design.clone(), design, RowValues::default()));
        }
        let Some((_, design, values)) = &mut self.current else { return refusal("no design") };
        let (Request { range, .. }, rows) = (request, design.points_per_replicate() * design.rows_per_point());
        if range.replicate >= design.settings().replicates || range.rows.is_empty() || range.rows.end > rows {
            return refusal("rows that are not in the design");
        }
        let begun = Instant::now();
        let inputs = values.values(self.space, design, range.replicate, range.rows.clone());
        self.batch.reset(range.count() as usize);
        self.worker.run(&inputs.iter().map(Vec::as_slice).collect::<Vec<_>>(), &mut self.batch);
        self.batch.settle();
        let seconds = begun.elapsed().as_secs_f64();
        Reply { seconds, given_up: self.batch.given_up().cloned(), pieces: answered(range, &self.batch) }
    }
}

/// Returns the reply to a request that cannot be met.
pub(crate) fn refusal(what: &str) -> Reply {
    let given_up = Some(RowFailure::new(&format!("a worker in another process was asked for {what}")).into());
    Reply { seconds: 0.0, given_up, pieces: Vec::new() }
}
