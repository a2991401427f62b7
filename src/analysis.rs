//! The whole way of the data in one function.

use std::sync::atomic::AtomicBool;

mod estimate;
mod result;
mod warnings;

#[cfg(feature = "report")]
pub(crate) use estimate::{names_of_swaps, row_inputs};
pub use result::{Aggregate, Analysis, FailureCount, LookupError, NoIndices, OutputAnalysis, StopReason, Stopped};

use crate::design::{Design, MAX_POINTS};
use crate::estimate::{MomentParts, PointOutputs};
use crate::run::{GrowingRun, Job, Keep, Progress, RunError, Shard, Store, threads_in_force};
use crate::study::{Stopping, Study};
use crate::uncertainty::{IntervalOptions, KeptPoints, output_indices};
use estimate::{FinishedRun, interval_options};

/// Runs `study` on `threads` threads (0: one per core) and estimates its indices. `on_progress` is called from time to
/// time, from any thread. The result is the same for any number of threads, apart from the fields that tell about them
/// (and but for a study with a budget of time, which ends when it is spent).
///
/// ```
/// use std::path::Path;
/// use apportion::{analyse, study::Study};
///
/// let text = include_str!("../studies/ishigami.toml");
/// let study = Study::parse(text, Path::new("ishigami.toml"), &[])?;
/// let analysis = analyse(&study, 0, &|_| ())?;
/// let first_order = analysis.output("y")?.factor("x1")?.first_order;
/// assert!((first_order.estimate - 0.3139).abs() < 0.003);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RunError`] if the threads cannot be started, a row fails in a study that says to stop then, or intervals need more
/// outputs at once than fit. Otherwise rows that fail are part of the result.
pub fn analyse(study: &Study, threads: usize, on_progress: &(dyn Fn(Progress) + Sync)) -> Result<Analysis, RunError> {
    analyse_with(study, Running { on_progress, ..Running::on(threads) })
}

/// How a study is run.
#[derive(Clone, Copy)]
pub struct Running<'a> {
    /// Threads (0: one per core).
    pub threads: usize,
    /// Called from time to time, from any thread.
    pub on_progress: &'a (dyn Fn(Progress) + Sync),
    /// Outputs that are there already, which are not evaluated again; those that are evaluated join them. A model that asks
    /// for a [concurrency](crate::model::Model::concurrency) of its own is run with a store in any case.
    pub store: Option<&'a Store>,
    /// Told of every piece that joins the store.
    pub keep: Option<Keep<'a>>,
    /// Ends the run when it is set.
    pub stop: Option<&'a AtomicBool>,
}

impl Running<'_> {
    /// On `threads` threads (0: one per core), silently and without a store.
    pub fn on(threads: usize) -> Self {
        Self { threads, on_progress: &|_| (), store: None, keep: None, stop: None }
    }
}

/// Evaluates the rows `shard` of `study` that the store of `running` lacks, and no others; nothing is estimated.
///
/// # Errors
/// As for [`analyse_with`].
pub fn evaluate_shard(study: &Study, shard: Shard, running: Running<'_>) -> Result<(), RunError> {
    let model = study.model();
    let job = Job { design: &study.design, space: &study.space, model: model.as_ref() };
    let own = Store::new(&study.design, model.as_ref());
    let run = growing(study, job, running)?.with_store(running.store.unwrap_or(&own));
    run.fill(&shard.rows(&study.design), running.on_progress)
}

fn growing<'a>(study: &Study, job: Job<'a>, running: Running<'a>) -> Result<GrowingRun<'a>, RunError> {
    let run = GrowingRun::new(job, running.threads)?.with_failures(study.analysis.failures);
    let run = run.with_outputs_kept(study.analysis.intervals.keeps_outputs());
    Ok(run.with_keep(running.keep).with_stop(running.stop))
}

/// Runs `study` as [`analyse`] does, with what is there already, and kept for the next time. The result is the same in
/// every bit, wherever the outputs come from.
///
/// ```
/// use std::path::Path;
/// use apportion::run::Store;
/// use apportion::study::Study;
/// use apportion::{Running, analyse_with};
///
/// let text = include_str!("../studies/ishigami.toml");
/// let study = Study::parse(text, Path::new("ishigami.toml"), &["design.base_samples=1024".to_owned()])?;
/// let store = Store::new(&study.design, study.model().as_ref());
/// let running = Running { store: Some(&store), ..Running::on(0) };
/// let first = analyse_with(&study, running)?;
/// // The second time nothing is evaluated; twice the points would evaluate the second half of them alone.
/// let second = analyse_with(&study, running)?;
/// assert_eq!(first.output("y")?.indices, second.output("y")?.indices);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// `examples/interrupted.rs` puts runs on record in a [`journal`](crate::run::journal), stops, and goes on.
///
/// # Errors
/// [`RunError`] if the threads cannot be started, a row fails in a study that says to stop then, intervals need more
/// outputs at once than fit, the model gives up, an output cannot be kept, or the run is asked to end.
pub fn analyse_with(study: &Study, running: Running<'_>) -> Result<Analysis, RunError> {
    let model = study.model();
    let longest = if study.stopping.grows() { longest(&study.design) } else { study.design.clone() };
    let job = Job { design: &longest, space: &study.space, model: model.as_ref() };
    let own = Store::new(&longest, model.as_ref());
    let store = running.store.or_else(|| model.concurrency().map(|_| &own));
    let Running { threads, on_progress, .. } = running;
    let mut run = growing(study, job, running)?;
    if let Some(store) = store {
        run = run.with_store(store);
    }
    run.grow_to(study.design.points_per_replicate(), on_progress)?;
    let mut stopped = None;
    if study.stopping.grows() {
        stopped = Some(loop {
            if let Some(reason) = run.install(|| reason_to_stop(study, &run, &longest)) {
                break reason;
            }
            run.grow_to(run.points_per_replicate() * 2, on_progress)?;
        });
    }
    let design = longest.with_points(run.points_per_replicate()).unwrap_or(longest.clone());
    let finished = FinishedRun {
        study,
        model: model.as_ref(),
        design: &design,
        replicates: run.totals(),
        threads: threads_in_force(threads),
        wall_seconds: run.elapsed().as_secs_f64(),
    };
    Ok(run.install(|| estimate::analysis(&finished, stopped)))
}

/// The longest design that a run of `design` can grow into.
fn longest(design: &Design) -> Design {
    let mut points = MAX_POINTS;
    loop {
        match design.with_points(points) {
            Ok(longest) => return longest,
            Err(_) if points > design.points_per_replicate() => points /= 2,
            Err(_) => return design.clone(),
        }
    }
}

/// Why the run should not be doubled once more; `None` if it should.
fn reason_to_stop(study: &Study, run: &GrowingRun<'_>, longest: &Design) -> Option<Stopped> {
    let Stopping { half_width, budget, max_runs } = study.stopping;
    let widest = widest(study, run);
    let met = half_width.map(|target| widest.is_some_and(|widest| widest <= target));
    let next = run.points_per_replicate() * 2;
    let runs = u128::from(next) * u128::from(longest.settings().replicates) * u128::from(longest.rows_per_point());
    let seconds = 2.0 * run.elapsed().as_secs_f64();
    let reason = match (half_width, widest) {
        (Some(target), Some(widest)) if widest <= target => StopReason::TargetMet { widest, target },
        (Some(_), None) => StopReason::NoIntervals,
        _ if next > longest.points_per_replicate() => StopReason::EndOfSequence,
        _ if run.room_for(next).is_err() => StopReason::Memory,
        _ => match (max_runs, budget) {
            (Some(most), _) if runs > u128::from(most) => StopReason::MaxRuns { runs, most },
            (_, Some(budget)) if seconds > budget => StopReason::Budget { seconds, budget },
            _ => return None,
        },
    };
    Some(Stopped { reason, target_met: met })
}

/// Largest half width of the indices of all outputs; `None` if some are missing. An output that does not vary has no
/// indices and waits for none.
fn widest(study: &Study, run: &GrowingRun<'_>) -> Option<f64> {
    let outputs = run.totals().first().map_or(0, |totals| totals.outputs.len());
    let (layout, options) = (study.layout(), interval_options(study));
    let design = run.design();
    let mut widest = None;
    for number in 0..outputs {
        let parts: Vec<MomentParts> = run.totals().iter().map(|t| t.outputs[number].moments.clone()).collect();
        let kept: Vec<&PointOutputs> = run.totals().iter().map(|t| &t.outputs[number].kept).collect();
        let options = IntervalOptions { points: KeptPoints::all(design, &kept), ..options };
        match output_indices(&parts, &layout, &options) {
            Ok(indices) => widest = Some(indices.largest_half_width()?.max(widest.unwrap_or(0.0))),
            Err(crate::estimate::Undefined::ZeroVariance) => (),
            Err(_) => return None,
        }
    }
    widest
}
