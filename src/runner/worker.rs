//! A study in a worker process.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use crate::model::{Model, RunContext};
use crate::run::{RemoteServer, Request, Requests, refusal};
use crate::study::Study;

/// A study whose rows are evaluated for a run in another process, which uses it through its
/// [`RemoteWorkers`](crate::run::RemoteWorkers).
pub struct WorkerStudy {
    study: Study,
    /// The model of the study, then its low-fidelity models, each created on first use.
    models: Vec<OnceLock<Arc<dyn Model>>>,
}

impl std::fmt::Debug for WorkerStudy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("WorkerStudy").field("study", &self.study.name).finish_non_exhaustive()
    }
}

impl WorkerStudy {
    /// Creates the models of `study`, which must be the same as that of the run in the other process.
    pub fn new(mut study: Study) -> Self {
        if study.lows.is_empty() {
            study.lows = study.subject.cheaper();
        }
        let models = (0..=study.lows.len()).map(|_| OnceLock::new()).collect();
        Self { study, models }
    }

    /// Replies to the requests to one worker until there are no more. Its programs live as long.
    pub fn serve(&self, context: &RunContext<'_>, requests: &mut dyn Requests) {
        let mut servers: BTreeMap<u64, RemoteServer<'_>> = BTreeMap::new();
        while let Some(bytes) = requests.next() {
            let reply = match Request::read(&bytes).and_then(|request| Some((self.model(request.subject)?, request))) {
                None => refusal("a model that is not in the study"),
                Some((model, request)) => {
                    let new = || RemoteServer::new(&self.study.space, model, context);
                    servers.entry(request.subject).or_insert_with(new).reply(&self.study.design, &request)
                }
            };
            requests.reply(reply.write());
        }
        context.messages().finish();
    }

    fn model(&self, number: u64) -> Option<&dyn Model> {
        let number = usize::try_from(number).ok()?;
        let made = self.models.get(number)?;
        let make = || match number.checked_sub(1).and_then(|low| self.study.lows.get(low)) {
            None => self.study.model(),
            Some(low) => low.subject.model(&self.study.space),
        };
        Some(made.get_or_init(make).as_ref())
    }
}
