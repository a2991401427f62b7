//! A study in a worker process: reads requests and evaluates their rows.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde_json::Value;

use crate::design::Design;
use crate::model::{Model, RowFailure, RunContext};
use crate::run::{DesignKey, Reply, Request, RowValues, RowWorker, RunError, answered, differing};
use crate::study::Study;

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
    /// Creates the models of `study`, which must be the same as that of the run in the other process, where its files
    /// have these [digests](Study::data_digests).
    ///
    /// # Errors
    /// [`RunError::OtherFiles`] if the files here are other ones.
    pub fn new(mut study: Study, digests: &Value) -> Result<Self, RunError> {
        if let Some(files) = differing(digests, &study.data_digests()) {
            return Err(RunError::OtherFiles { files });
        }
        if study.low_fidelities.is_empty() {
            study.low_fidelities = study.subject.cheaper();
        }
        let low_fidelity = study.low_fidelities.iter().map(|low| low.subject.model(&study.space));
        let models = std::iter::once(study.model()).chain(low_fidelity).collect();
        Ok(Self { study, models })
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
                    let server = server.or_insert_with(|| RemoteServer {
                        study: &self.study,
                        worker: RowWorker::new(model.as_ref(), context),
                        current: None,
                    });
                    server.reply(request)
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
    worker: RowWorker<'a>,
    /// The design of the last request.
    current: Option<(DesignKey, Design)>,
}

impl RemoteServer<'_> {
    /// Evaluates the rows of a request, of a design that differs from that of the study by its key.
    fn reply(&mut self, Request { design: key, range, .. }: Request) -> Reply {
        if self.current.as_ref().is_none_or(|(current, _)| *current != key) {
            self.current = key.design(&self.study.design).map(|design| (key, design));
            self.worker.values = RowValues::default();
        }
        let Some((_, design)) = &self.current else { return refusal("an unknown design") };
        let rows = design.points_per_replicate() * design.rows_per_point();
        if range.replicate >= design.settings().replicates || range.rows.is_empty() || range.rows.end > rows {
            return refusal("rows that are not in the design");
        }
        let seconds = self.worker.run(&self.study.space, design, &range);
        let batch = &self.worker.batch;
        Reply { seconds, given_up: batch.given_up().cloned(), blocks: answered(&range, batch) }
    }
}

/// Returns the reply to a request that cannot be met.
fn refusal(what: &str) -> Reply {
    let given_up = Some(RowFailure::new(&format!("a worker in another process was asked for {what}")).into());
    Reply { seconds: 0.0, given_up, blocks: Vec::new() }
}
