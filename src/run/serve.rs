//! The other end of the talk with workers in other processes: requests are read there, and answered by a worker of theirs.

use super::blocks::{BlockOptions, Blocks};
use super::fold::{Fold, Sums};
use super::remote::{Answer, Errand, Request};
use super::rows::MissingRows;
use super::task::{Evaluated, Task};
use super::{FailurePolicy, Job, Store};
use crate::binary::Reader;
use crate::model::{RowFailure, RunContext, Worker};

/// Where requests come from, and where answers go.
pub trait Requests {
    /// The next request; `None` if there are no more.
    fn next(&mut self) -> Option<Vec<u8>>;

    /// Sends the answer to the last one.
    fn answer(&mut self, answer: Vec<u8>);
}

/// Answers `bytes`, a request of a piece for the model of `job`, and those that follow it of the same task, by `worker`;
/// returns the first one that is of another.
pub(crate) fn serve(
    job: Job<'_>,
    bytes: Vec<u8>,
    worker: &mut dyn Worker,
    context: &RunContext<'_>,
    requests: &mut dyn Requests,
) -> Option<Vec<u8>> {
    let Some(Request { errand, .. }) = Request::read(&bytes) else { return refuse(requests, "no task that it knows") };
    let Some(design) = errand.design.design(job.design) else { return refuse(requests, "no such design") };
    let job = Job { design: &design, ..job };
    let failures = if errand.fails { FailurePolicy::Fail } else { FailurePolicy::DropBlock };
    if errand.is_of_blocks {
        let keeps_outputs = errand.keeps_outputs;
        let options = BlockOptions { failures, keeps_outputs, in_strips: true, store: None, checkpoint: None };
        let sums = Sums { from: errand.from, began: errand.from, ..Sums::new(design.settings().replicates) };
        serve_task(&Blocks::new(job, context, Fold::new(sums), errand.end, options), errand, bytes, worker, requests)
    } else {
        let store = Store::new(&design, job.model);
        serve_task(&MissingRows::new(job, &[], &store, None, failures).0, errand, bytes, worker, requests)
    }
}

fn serve_task<T: Task>(
    task: &T,
    errand: Errand,
    mut bytes: Vec<u8>,
    worker: &mut dyn Worker,
    requests: &mut dyn Requests,
) -> Option<Vec<u8>> {
    let Some(abroad) = task.abroad() else { return refuse(requests, "no task for other processes") };
    let subject = Request::read(&bytes)?.subject;
    let mut scratch = task.scratch();
    loop {
        let request = Request::read(&bytes).filter(|request| request.subject == subject);
        let Some(request) = request.filter(|request| request.errand == errand) else { return Some(bytes) };
        let Some(piece) = abroad.read_piece(&mut Reader { bytes: request.piece }) else {
            return refuse(requests, "no piece of the task");
        };
        let began = crate::clock::Instant::now();
        let evaluated = task.evaluate(worker, &mut scratch, &piece, &|_| ());
        let seconds = began.elapsed().as_secs_f64();
        let Evaluated { output, given_up } = evaluated;
        let answer = Answer { seconds, given_up, output };
        requests.answer(answer.write(|output, out| abroad.write_output(output, out)));
        bytes = requests.next()?;
    }
}

/// Answers that the last request cannot be met; returns the next one.
pub(crate) fn refuse(requests: &mut dyn Requests, why: &str) -> Option<Vec<u8>> {
    let given_up = Some(RowFailure::new(&format!("a worker in another process was asked for {why}")).into());
    let answer = Answer { seconds: 0.0, given_up, output: None::<()> };
    requests.answer(answer.write(|(), _| ()));
    requests.next()
}
