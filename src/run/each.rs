//! A caller's work, distributed over the workers of a model.

use rayon::prelude::*;

use super::growing::thread_pool;
use super::tracker::Tracker;
use super::{Progress, RunError};
use crate::model::{GiveUp, Model, RunContext, Worker};
use apportion_base::clock::Instant;

/// Calls `evaluate` for every number below `count` with a worker of `model`, on `threads` threads (0: one per core) in
/// the run of `context`; returns the results in order.
///
/// # Errors
/// [`RunError::Interrupted`] if the run is to stop, [`RunError::GaveUp`] if a worker cannot continue.
pub fn run_each<T: Send>(
    model: &dyn Model,
    threads: usize,
    context: &RunContext<'_>,
    count: u64,
    evaluate: impl Fn(&mut dyn Worker, u64) -> Result<T, GiveUp> + Sync,
    on_progress: &(dyn Fn(Progress) + Sync),
) -> Result<Vec<T>, RunError> {
    let before = Progress { total: count, ..Progress::default() };
    let tracker = Tracker::new(context, before, Instant::now(), on_progress);
    let evaluate = |worker: &mut Box<dyn Worker + '_>, number| {
        if !tracker.goes_on() {
            return None;
        }
        let output = evaluate(&mut **worker, number);
        match &output {
            Ok(_) => tracker.add(1, 0),
            Err(give_up) => tracker.end(RunError::GaveUp(give_up.clone())),
        }
        output.ok()
    };
    let all = || (0..count).into_par_iter().map_init(|| model.worker(context), evaluate).collect::<Option<Vec<T>>>();
    let outputs = match thread_pool(threads) {
        Some(pool) => pool.install(all),
        None => all(),
    };
    tracker.finish()?;
    Ok(outputs.unwrap_or_default())
}
