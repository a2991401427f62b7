//! The outputs of a block of base points in one thread, and their totals.

use super::failures::{Place, Tally};
use super::rows::BaseColumns;
use super::totals::{OutputTotals, Totals};
use super::{Job, Store};
use crate::design::{BasePoints, Design};
use crate::estimate::{BlockOutputs, CentralMoments, MomentParts, Moments, PointOutputs, Workspace};
use crate::model::{Batch, GiveUp, RowFailure, RunContext, Worker};

/// Buffers for the evaluation of blocks, reused from block to block.
pub(super) struct Scratch {
    columns: BaseColumns,
    /// Outputs of every run of the design.
    batches: Vec<Batch>,
    workspace: Workspace,
}

impl Scratch {
    /// Creates empty buffers.
    pub fn new(job: Job<'_>) -> Self {
        let batches = vec![Batch::new(job.model); job.design.runs().len()];
        Self { columns: BaseColumns::default(), batches, workspace: Workspace::default() }
    }

    /// Sets the outputs of `points` base points at `place` to those in `store`; returns false if a row is missing.
    pub fn recall(&mut self, store: &Store, place: BlockPlace, points: usize) -> bool {
        self.batches.iter_mut().for_each(|batch| batch.reset(points));
        store.recall(place.first.replicate, place.first.point, &mut self.batches)
    }

    /// Computes the totals of the outputs that were evaluated or recalled last.
    pub fn totals(&mut self, job: Job<'_>, place: BlockPlace) -> Totals {
        let rows = self.batches.first().map_or(0, Batch::rows);
        let mut totals = Totals {
            runs: (rows * self.batches.len()) as u64,
            failed_runs: self.batches.iter().map(failed_rows).sum(),
            ..Totals::none(job.model)
        };
        for batch in &self.batches {
            totals.counts.merge(batch.counts());
            for (total, raised) in totals.flags.iter_mut().zip(batch.flags()) {
                *total += raised;
            }
        }
        for (output, of_output) in totals.outputs.iter_mut().enumerate() {
            *of_output = self.totals_of(job, output, place);
        }
        totals
    }

    /// Returns the outputs that were evaluated or recalled last, a batch for each run of the design.
    pub fn batches(&self) -> &[Batch] {
        &self.batches
    }

    /// Evaluates `count` base points from `first` on of `base`, a replicate of the design.
    ///
    /// # Errors
    /// [`GiveUp`] if the model gives up.
    pub fn run_rows(
        &mut self,
        Job { design, space, .. }: Job<'_>,
        (base, first, count): (&BasePoints, u64, usize),
        worker: &mut dyn Worker,
        context: &RunContext<'_>,
    ) -> Result<(), GiveUp> {
        self.columns.fill(space, design, base, first, count);
        let values = &self.columns.values;
        let mut inputs: Vec<&[f64]> = Vec::with_capacity(design.factors());
        for (run, batch) in design.runs().iter().zip(&mut self.batches) {
            if context.is_stopped() {
                return Err(RowFailure::interrupted().into());
            }
            inputs.clear();
            inputs.extend((0..design.factors()).map(|factor| values[design.column(run, factor)].as_slice()));
            batch.reset(count);
            worker.run(&inputs, batch);
            batch.settle();
            if let Some(reason) = batch.given_up() {
                return Err(reason.clone());
            }
        }
        Ok(())
    }

    fn totals_of(&mut self, job: Job<'_>, output: usize, place: BlockPlace) -> OutputTotals {
        let mut totals = OutputTotals::default();
        for (run, batch) in self.batches.iter_mut().enumerate() {
            let failures = batch.failures().iter().filter(|(o, _, _)| *o == output).map(|(_, row, why)| (*row, why));
            let failed: Vec<usize> = failures.clone().map(|(row, _)| row).collect();
            for (row, failure) in failures {
                let first = Place { point: place.first.point + row as u64, run: run as u64, ..place.first };
                totals.runs_failed += 1;
                totals.failures.count(failure, Tally { count: 1, first });
            }
            // Values that the model left in failed rows are ignored.
            for row in failed {
                batch.set(row, output, f64::NAN);
            }
        }
        let runs: Vec<&[f64]> = self.batches.iter().map(|batch| batch.column(output)).collect();
        totals.set_sums(job.design, &runs, place, &mut self.workspace);
        totals
    }
}

impl OutputTotals {
    /// Sets the sums to those of a block with an output for each of `runs` and base point, not finite if missing.
    pub(crate) fn set_sums(&mut self, design: &Design, runs: &[&[f64]], place: BlockPlace, work: &mut Workspace) {
        let columns = |of: &[usize]| of.iter().map(|run| runs[*run]).collect::<Vec<&[f64]>>();
        let (a, b) = (runs[0], runs[1]);
        let (ab, ba) = (columns(design.ab_runs()), columns(design.ba_runs()));
        let length = place.part_length as usize;
        let mut parts = Vec::with_capacity(a.len().div_ceil(length));
        let mut cut: [Vec<&[f64]>; 2] = Default::default();
        for first in (0..a.len()).step_by(length) {
            let part = first..(first + length).min(a.len());
            for (cut, whole) in cut.iter_mut().zip([&ab, &ba]) {
                cut.clear();
                cut.extend(whole.iter().map(|column| &column[part.clone()]));
            }
            let [ab, ba] = cut.each_ref().map(Vec::as_slice);
            let (a, b, paired) = (&a[part.clone()], &b[part.clone()], design.paired());
            let outputs = BlockOutputs { a, b, ab, ba, paired };
            parts.push(Moments::of_block(outputs, work));
        }
        if place.keeps_outputs {
            self.point_outputs = PointOutputs::of_block(runs);
        }
        self.moments = MomentParts::new(place.part_length, a.len() as u64, parts);
        self.values = CentralMoments::from_values(a);
        self.values.merge(&CentralMoments::from_values(b));
        self.sample = a.iter().zip(b).take(place.sampled).flat_map(|(a, b)| [*a, *b]).collect();
    }
}

/// The place of a block in its design, and what is kept of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BlockPlace {
    /// Row A of the first base point.
    pub first: Place,
    /// Base points in each part with separate moments, a power of two.
    pub part_length: u64,
    /// How many of its base points, from the first on, belong to the sample.
    pub sampled: usize,
    /// Whether all outputs are kept.
    pub keeps_outputs: bool,
}

/// Returns the number of rows of a settled batch with at least one failure.
fn failed_rows(batch: &Batch) -> u64 {
    let mut rows: Vec<usize> = batch.failures().iter().map(|&(_, row, _)| row).collect();
    rows.sort_unstable();
    rows.dedup();
    rows.len() as u64
}
