//! The growth of a run of plain rows.

use std::sync::Arc;

use super::growth::{Grown, Growth, fails_too_often};
use crate::analysis::{PlainOutputs, enough_base_samples, is_doubted, rare_levels};
use crate::design::Design;
use crate::estimate::{CentralMoments, Undefined};
use crate::result::StopReason;
use crate::run::RunError;
use crate::study::{MAX_GROWN_ROWS, Target};

/// Rows of a stage as multiples of those of the one before it: fewest and most.
const MIN_GROWTH: f64 = 1.125;
const MAX_GROWTH: f64 = 1.5;

/// Powers of the number of rows with which half widths fall: fewest, of a first stage, and most.
const POWERS: [f64; 3] = [0.5, 1.0, 4.0];

/// Parts of the runs of a study at which its plain rows are looked at, and fewest rows for that.
const LOOKS: [u64; 2] = [4, 2];
const MIN_ROWS_OF_LOOK: u64 = 128;

/// Stages after which it is known how half widths fall.
const ENOUGH_STAGES: usize = 5;

/// Ratio of predicted half widths from which swaps are clearly better.
const CLEARLY: f64 = 0.7;

/// Half width of the indices that swaps measure, in units of the root of what a surrogate leaves over the number of points.
const SWAPPED: f64 = 2.0;

/// What a stage shows of its accuracy.
struct Stage {
    rows: f64,
    /// Largest half width of the outputs that vary; `None` if some are missing, or none varies.
    widest: Option<f64>,
    /// Largest share of the variance that a surrogate leaves.
    rest: f64,
    is_doubted: bool,
}

impl Growth<'_> {
    /// Adds plain rows until there is a reason to stop, or swaps are expected to be cheaper: then there is none.
    pub(super) fn grow_plain(&mut self) -> Result<Grown, RunError> {
        let most = self.study.design.rows();
        let each = 2 * self.study.design.settings().replicates;
        let mut stages: Vec<Stage> = Vec::new();
        let has_accuracy = self.study.target.accuracy.is_some();
        let mut sizes: Vec<u64> = LOOKS.iter().map(|part| most / part / each * each).collect();
        sizes.retain(|rows| !has_accuracy && *rows >= MIN_ROWS_OF_LOOK);
        sizes.push(most);
        let mut next = sizes[0];
        loop {
            self.run.grow_to(next / each, self.on_progress)?;
            let Ok(design) = self.run.design().with_points(next / each) else { return Ok(Grown::default()) };
            let plain = self.run.install(|| PlainOutputs::new(self.study, &design, self.run.totals()));
            let Some(fits) = plain else { return Ok(Grown::default()) };
            stages.push(self.run.install(|| self.plain_stage(&fits, &design)));
            let reason =
                if has_accuracy { self.after_stage(&design, &stages) } else { self.look(next, &sizes, &stages) };
            match reason {
                Next::Rows(rows) => next = rows.next_multiple_of(each),
                Next::Swaps => return Ok(Grown { plain: Some(fits), ..Grown::default() }),
                Next::Stop(reason) => return Ok(Grown { reason, plain: Some(fits), ..Grown::default() }),
            }
        }
    }

    fn plain_stage(&self, fits: &Arc<PlainOutputs>, design: &Design) -> Stage {
        let (study, model) = (self.study, self.study.model());
        let mut stage = Stage { rows: design.rows() as f64, widest: None, rest: 0.0, is_doubted: false };
        let mut has_all = true;
        for number in 0..model.outputs().len() {
            match fits.indices(study, model.as_ref(), number, false) {
                Ok(indices) => {
                    let mut values = CentralMoments::default();
                    self.run.totals().iter().for_each(|totals| values.merge(&totals.outputs[number].values));
                    stage.is_doubted |= is_doubted(study, &indices, &values);
                    stage.rest = fits.rest(number).unwrap_or(0.0).max(stage.rest);
                    let widest = indices.largest_half_width();
                    has_all &= widest.is_some();
                    stage.widest = stage.widest.into_iter().chain(widest).reduce(f64::max);
                }
                Err(Undefined::ZeroVariance) => (),
                Err(_) => has_all = false,
            }
        }
        stage.widest = stage.widest.filter(|_| has_all);
        stage
    }

    /// Returns what a run with an accuracy does after the last of some stages.
    fn after_stage(&self, design: &Design, stages: &[Stage]) -> Next {
        let study = self.study;
        let Target { accuracy, max_time, max_runs, .. } = study.target;
        let (rows, target) = (design.rows(), accuracy.unwrap_or(f64::INFINITY));
        let (base_samples, rare) = (design.settings().base_samples, rare_levels(&study.space, design));
        let last = &stages[stages.len() - 1];
        let widest = last.widest.unwrap_or(f64::INFINITY);
        if fails_too_often(self) {
            return Next::Stop(Some(StopReason::NoIntervals { base_samples }));
        }
        let is_reached = widest <= target && !last.is_doubted && rows >= study.needed_values();
        if is_reached && rare.is_empty() {
            return Next::Stop(Some(StopReason::TargetMet { widest, target }));
        }
        let needed = match widest <= target {
            true => (2.0 * enough_base_samples(&rare)).max(MAX_GROWTH * last.rows),
            false => last.rows * libm::pow(widest / target, 1.0 / power(stages)),
        };
        let is_known = stages.len() >= ENOUGH_STAGES;
        if is_known && needed > MAX_GROWN_ROWS as f64 || rows >= MAX_GROWN_ROWS {
            return Next::Swaps;
        }
        let next = needed.clamp(MIN_GROWTH * last.rows, MAX_GROWTH * last.rows).min(MAX_GROWN_ROWS as f64) as u64;
        let seconds = self.run.elapsed().as_secs_f64() * next as f64 / last.rows;
        match (max_runs, max_time) {
            (Some(most), _) if next > most => Next::Stop(Some(StopReason::MaxRuns { runs: next, most })),
            (_, Some(budget)) if seconds > budget => Next::Stop(Some(StopReason::Budget { seconds, budget })),
            _ => Next::Rows(next),
        }
    }

    /// Returns what a run of a number of rows does after the last of some stages.
    fn look(&self, rows: u64, sizes: &[u64], stages: &[Stage]) -> Next {
        let most = self.study.design.rows();
        let Some(next) = sizes.iter().find(|size| **size > rows) else { return Next::Stop(None) };
        let last = &stages[stages.len() - 1];
        let points = (most - rows) as f64 / self.study.swapped_rows() as f64;
        let by_swaps = SWAPPED * (last.rest / points).sqrt();
        let by_rows = last.widest.map_or(0.0, |widest| widest * libm::pow(rows as f64 / most as f64, power(stages)));
        // Swaps do not narrow what is due to few rows.
        let is_rest = !last.is_doubted && last.widest.is_some_and(|widest| 2.0 * last.rest > widest);
        if is_rest && by_swaps < CLEARLY * by_rows { Next::Swaps } else { Next::Rows(*next) }
    }
}

/// What a run of plain rows does next.
enum Next {
    Rows(u64),
    Swaps,
    Stop(Option<StopReason>),
}

/// Returns the power of the number of rows with which the half width falls.
fn power(stages: &[Stage]) -> f64 {
    let [least, first, most] = POWERS;
    let [.., last] = stages else { return first };
    let before = &stages[stages.len().saturating_sub(3)];
    let (Some(old), Some(new)) = (before.widest, last.widest) else { return first };
    if last.rows <= before.rows || new <= 0.0 {
        return first;
    }
    (libm::log(old / new) / libm::log(last.rows / before.rows)).clamp(least, most)
}
