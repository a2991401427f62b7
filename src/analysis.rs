//! The whole way of the data in one function.

use crate::design::{Design, MAX_POINTS};
use crate::estimate::{MomentParts, PointOutputs};
use crate::report::{FinishedRun, ResultFile, RunFacts, StoppingRecord, build_result, judgement};
use crate::run::{GrowingRun, Job, Progress, RunError, threads_in_force};
use crate::study::{Stopping, Study};
use crate::uncertainty::{Judgement, KeptPoints, output_indices};

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
/// let result = analyse(&study, 0, &|_| ())?;
/// let indices = result.outputs[0].indices.as_ref().ok_or("no indices")?;
/// assert!((indices[0].effect.first_order.estimate - 0.3139).abs() < 0.003);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RunError`] if the threads cannot be started, a row fails in a study that says to stop then, or intervals need more
/// outputs at once than fit. Otherwise rows that fail are part of the result.
pub fn analyse(study: &Study, threads: usize, on_progress: &(dyn Fn(Progress) + Sync)) -> Result<ResultFile, RunError> {
    let model = study.model();
    let longest = if study.stopping.grows() { longest(&study.design) } else { study.design.clone() };
    let job = Job { design: &longest, space: &study.space, model: model.as_ref() };
    let run = GrowingRun::new(job, threads)?.with_failures(study.analysis.failures);
    let mut run = run.with_outputs_kept(study.analysis.intervals.keeps_outputs());
    run.grow_to(study.design.points_per_replicate(), on_progress)?;
    let mut stopping = None;
    if study.stopping.grows() {
        stopping = Some(loop {
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
        facts: RunFacts { threads: threads_in_force(threads), wall_seconds: run.elapsed().as_secs_f64() },
    };
    Ok(run.install(|| build_result(&finished, stopping)))
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
fn reason_to_stop(study: &Study, run: &GrowingRun<'_>, longest: &Design) -> Option<StoppingRecord> {
    let Stopping { half_width, budget, max_runs } = study.stopping;
    let widest = widest(study, run);
    let met = half_width.map(|target| widest.is_some_and(|widest| widest <= target));
    let end = |reason: String| StoppingRecord {
        reason,
        target_met: met,
        target_half_width: half_width,
        budget_seconds: budget,
        max_runs,
    };
    if let (Some(true), Some(target), Some(widest)) = (met, half_width, widest) {
        return Some(end(format!("every half width is {widest:.2e} or less: the target of {target} is met")));
    }
    if half_width.is_some() && widest.is_none() {
        return Some(end("there are indices or intervals missing: no number of runs would meet the target".to_owned()));
    }
    let next = run.points_per_replicate() * 2;
    let runs = u128::from(next) * u128::from(longest.settings().replicates) * u128::from(longest.rows_per_point());
    if next > longest.points_per_replicate() {
        return Some(end("the sequence of points has come to its end".to_owned()));
    }
    if run.room_for(next).is_err() {
        return Some(end(
            "the outputs of twice the runs would not fit: these intervals need all of them at once".to_owned()
        ));
    }
    if let Some(most) = max_runs.filter(|most| runs > u128::from(*most)) {
        return Some(end(format!("twice the runs would be {runs}, more than max_runs = {most}")));
    }
    let elapsed = run.elapsed().as_secs_f64();
    if let Some(budget) = budget.filter(|budget| 2.0 * elapsed > *budget) {
        return Some(end(format!(
            "twice the runs would take some {:.1} s, more than the budget of {budget} s",
            2.0 * elapsed
        )));
    }
    None
}

/// Largest half width of the indices of all outputs; `None` if some are missing. An output that does not vary has no
/// indices and waits for none.
fn widest(study: &Study, run: &GrowingRun<'_>) -> Option<f64> {
    let outputs = run.totals().first().map_or(0, |totals| totals.outputs.len());
    let (layout, judgement) = (study.layout(), judgement(study));
    let design = run.design();
    let mut widest = None;
    for number in 0..outputs {
        let parts: Vec<MomentParts> = run.totals().iter().map(|t| t.outputs[number].moments.clone()).collect();
        let kept: Vec<&PointOutputs> = run.totals().iter().map(|t| &t.outputs[number].kept).collect();
        let judgement = Judgement { points: KeptPoints::all(design, &kept), ..judgement };
        match output_indices(&parts, &layout, &judgement) {
            Ok(indices) => widest = Some(indices.largest_half_width()?.max(widest.unwrap_or(0.0))),
            Err(crate::estimate::Undefined::ZeroVariance) => (),
            Err(_) => return None,
        }
    }
    widest
}
