//! A study in a worker process: reads requests and evaluates their rows.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::design::Design;
use crate::model::{Batch, Model, RowFailure, RunContext, Worker};
use crate::run::{DesignKey, Reply, Request, RowValues, answered};
use crate::study::Study;
use apportion_base::clock::Instant;

/// The source of requests and the receiver of replies.
pub trait Requests {
    /// Returns the next request; `None` if there are no more.
    fn next(&mut self) -> Option<Vec<u8>>;

    /// Sends the reply to the last request.
    fn reply(&mut self, reply: Vec<u8>);
}

/// A study whose rows are evaluated for a run in another process, which uses it through its
/// [`RemoteWorkers`](crate::run::RemoteWorkers).
pub struct WorkerStudy {
    study: Study,
    /// The model of the study, then its low-fidelity models.
    models: Vec<Arc<dyn Model>>,
}

impl WorkerStudy {
    /// Creates the models of `study`, which must be the same as that of the run in the other process.
    pub fn new(mut study: Study) -> Self {
        if study.low_fidelity.is_empty() {
            study.low_fidelity = study.subject.cheaper();
        }
        let low_fidelity = study.low_fidelity.iter().map(|low| low.subject.model(&study.space));
        let models = std::iter::once(study.model()).chain(low_fidelity).collect();
        Self { study, models }
    }

    /// Replies to the requests to one worker until there are no more. Its programs live as long.
    pub fn serve(&self, context: &RunContext<'_>, requests: &mut dyn Requests) {
        let mut servers: BTreeMap<usize, RemoteServer<'_>> = BTreeMap::new();
        while let Some(bytes) = requests.next() {
            let request = serde_json::from_slice::<Request>(&bytes).ok();
            let reply = match request.and_then(|request| Some((self.models.get(request.subject)?, request))) {
                None => refusal("a model that is not in the study"),
                Some((model, request)) => {
                    let server = servers.entry(request.subject);
                    server.or_insert_with(|| RemoteServer::new(&self.study, model.as_ref(), context)).reply(request)
                }
            };
            requests.reply(reply.write());
        }
        context.messages().finish();
    }
}

/// A worker of one model, which evaluates rows for other processes.
struct RemoteServer<'a> {
    study: &'a Study,
    worker: Box<dyn Worker + 'a>,
    batch: Batch,
    /// The design of the last request, and its computed points.
    current: Option<(DesignKey, Design, RowValues)>,
}

impl<'a> RemoteServer<'a> {
    fn new(study: &'a Study, model: &'a dyn Model, context: &'a RunContext<'a>) -> Self {
        Self { study, worker: model.worker(context), batch: Batch::new(model), current: None }
    }

    /// Evaluates the rows of a request, of a design that differs from that of the study by its key.
    fn reply(&mut self, Request { design: key, range, .. }: Request) -> Reply {
        let previous = self.current.take().filter(|(previous, ..)| *previous == key);
        self.current = previous.or_else(|| {
            let design = key.design(&self.study.design)?;
            Some((key, design, RowValues::default()))
        });
        let Some((_, design, values)) = &mut self.current else { return refusal("an unknown design") };
        let rows = design.points_per_replicate() * design.rows_per_point();
        if range.replicate >= design.settings().replicates || range.rows.is_empty() || range.rows.end > rows {
            return refusal("rows that are not in the design");
        }
        let begun = Instant::now();
        let inputs = values.values(&self.study.space, design, range.replicate, range.rows.clone());
        self.batch.reset(range.count() as usize);
        self.worker.run(&inputs.iter().map(Vec::as_slice).collect::<Vec<_>>(), &mut self.batch);
        self.batch.settle();
        let seconds = begun.elapsed().as_secs_f64();
        Reply { seconds, given_up: self.batch.given_up().cloned(), blocks: answered(&range, &self.batch) }
    }
}

/// Returns the reply to a request that cannot be met.
fn refusal(what: &str) -> Reply {
    let given_up = Some(RowFailure::new(&format!("a worker in another process was asked for {what}")).into());
    Reply { seconds: 0.0, given_up, blocks: Vec::new() }
}
