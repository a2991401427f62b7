//! A study in a worker process.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::model::{Model, RunContext};
use crate::run::{RemoteServer, Request, Requests, refusal};
use crate::study::Study;

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
        if study.lows.is_empty() {
            study.lows = study.subject.cheaper();
        }
        let lows = study.lows.iter().map(|low| low.subject.model(&study.space));
        let models = std::iter::once(study.model()).chain(lows).collect();
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
                    let new = || RemoteServer::new(&self.study.space, model.as_ref(), context);
                    servers.entry(request.subject).or_insert_with(new).reply(&self.study.design, &request)
                }
            };
            requests.reply(reply.write());
        }
        context.messages().finish();
    }
}
