//! The whole way of the data in one function.

use std::time::Instant;

use crate::report::{ResultFile, RunFacts, build_result};
use crate::run::{Job, Progress, RunError, run, threads_in_force};
use crate::study::Study;

/// Runs `study` on `threads` threads (0: one per core) and estimates its indices. `on_progress` is called from time to
/// time, from any thread. The result is the same for any number of threads, apart from the fields that tell about them.
///
/// ```
/// use std::path::Path;
/// use apportion::{analyse, study::Study};
///
/// let text = include_str!("../studies/ishigami.toml");
/// let study = Study::parse(text, Path::new("ishigami.toml"), &[])?;
/// let result = analyse(&study, 0, &|_| ())?;
/// let indices = result.outputs[0].indices.as_ref().ok_or("no indices")?;
/// assert!((indices[0].effect.first_order.estimate - 0.3139).abs() < 0.003);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RunError`] if the threads cannot be started. Rows that fail are part of the result.
pub fn analyse(study: &Study, threads: usize, on_progress: &(dyn Fn(Progress) + Sync)) -> Result<ResultFile, RunError> {
    let model = study.model();
    let start = Instant::now();
    let job = Job { design: &study.design, space: &study.space, model: model.as_ref() };
    let replicates = run(job, threads, on_progress)?;
    let facts = RunFacts { threads: threads_in_force(threads), wall_seconds: start.elapsed().as_secs_f64() };
    Ok(build_result(study, model.as_ref(), &replicates, facts))
}
