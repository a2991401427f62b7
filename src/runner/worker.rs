//! A study in a process that works for another one.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use crate::model::{Model, RunContext, Worker};
use crate::run::{Job, Request, Requests, refuse, serve};
use crate::study::Study;

/// A study whose rows are evaluated for a run in another process, which has it as its
/// [`RemoteWorkers`](crate::run::RemoteWorkers).
pub struct WorkerStudy {
    study: Study,
    /// The model of the study, then its cheaper ones, each made when it is asked for.
    models: Vec<OnceLock<Box<dyn Model>>>,
}

impl std::fmt::Debug for WorkerStudy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("WorkerStudy").field("study", &self.study.name).finish_non_exhaustive()
    }
}

impl WorkerStudy {
    /// The models of `study`, which must be the same as that of the run in the other process.
    pub fn new(mut study: Study) -> Self {
        if study.lows.is_empty() {
            study.lows = study.subject.cheaper();
        }
        let models = (0..=study.lows.len()).map(|_| OnceLock::new()).collect();
        Self { study, models }
    }

    /// Answers the requests to one worker until there are no more. Its programs live as long.
    pub fn serve(&self, context: &RunContext<'_>, requests: &mut dyn Requests) {
        let mut workers: BTreeMap<usize, Box<dyn Worker + '_>> = BTreeMap::new();
        let mut next = requests.next();
        while let Some(bytes) = next {
            let subject = Request::read(&bytes).and_then(|request| usize::try_from(request.subject).ok());
            let Some((number, model)) = subject.and_then(|number| Some((number, self.model(number)?))) else {
                next = refuse(requests, "a model that the study has not");
                continue;
            };
            let worker = workers.entry(number).or_insert_with(|| model.worker(context));
            let job = Job { design: &self.study.design, space: &self.study.space, model };
            next = serve(job, bytes, &mut **worker, context, requests);
        }
        context.messages().finish();
    }

    fn model(&self, number: usize) -> Option<&dyn Model> {
        let made = self.models.get(number)?;
        let make = || match number.checked_sub(1).and_then(|low| self.study.lows.get(low)) {
            None => self.study.model(),
            Some(low) => low.subject.model(&self.study.space),
        };
        Some(made.get_or_init(make).as_ref())
    }
}
