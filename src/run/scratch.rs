//! The outputs of a block of base points in one thread, and their totals.

use std::ops::Range;

use super::failures::{RowPosition, Tally};
use super::rows::BaseColumns;
use super::totals::{OutputTotals, Totals};
use super::{Job, RunError, Store};
use crate::design::{BasePoints, Design};
use crate::estimate::{BlockOutputs, CentralMoments, MomentParts, Moments, PartShape, PointOutputs, Workspace};
use crate::model::{Batch, RowFailure, RunContext, Worker};

/// A worker and buffers for the evaluation of blocks, reused from block to block.
pub(super) struct Scratch<'f> {
    worker: Option<Box<dyn Worker + 'f>>,
    columns: BaseColumns,
    /// The outputs that were evaluated or recalled last, a batch for each run of the design.
    pub batches: Vec<Batch>,
    /// The outputs of several runs, for models that prefer long calls, and their inputs.
    joined: (Batch, Vec<Vec<f64>>),
    workspace: Workspace,
}

impl<'f> Scratch<'f> {
    /// Creates empty buffers, and no worker.
    pub fn new(job: Job<'_>) -> Self {
        let batches = vec![Batch::new(job.model); job.design.runs().len()];
        let joined = (Batch::new(job.model), vec![Vec::new(); job.design.factors()]);
        Self { worker: None, columns: BaseColumns::default(), batches, joined, workspace: Workspace::default() }
    }

    /// Sets the outputs of `points` base points at `place` to those in `store`; returns false if a row is missing.
    pub fn recall(&mut self, store: &Store, place: BlockPlace, points: usize) -> bool {
        self.batches.iter_mut().for_each(|batch| batch.reset(points));
        store.recall(place.first.replicate, place.first.point, &mut self.batches)
    }

    /// Evaluates `count` base points from `first` on of `base`, a replicate of the design.
    ///
    /// # Errors
    /// [`RunError::GaveUp`] if the model gives up.
    pub fn run_rows(
        &mut self,
        Job { design, space, model }: Job<'f>,
        (base, first, count): (&BasePoints, u64, usize),
        context: &'f RunContext<'f>,
    ) -> Result<(), RunError> {
        self.columns.fill(space, design, base, first, count);
        let (values, worker) = (&self.columns.values, self.worker.get_or_insert_with(|| model.worker(context)));
        let mut inputs: Vec<&[f64]> = Vec::with_capacity(design.factors());
        let at_once = model.rows_per_call().div_ceil(count.max(1)).max(1);
        for (runs, batches) in design.runs().chunks(at_once).zip(self.batches.chunks_mut(at_once)) {
            if context.is_stopped() {
                return Err(RunError::GaveUp(RowFailure::interrupted().into()));
            }
            batches.iter_mut().for_each(|batch| batch.reset(count));
            inputs.clear();
            let evaluated = if let ([run], [batch]) = (runs, &mut *batches) {
                inputs.extend((0..design.factors()).map(|factor| values[design.column(run, factor)].as_slice()));
                worker.run(&inputs, batch);
                batch
            } else {
                let (batch, columns) = &mut self.joined;
                for (factor, column) in columns.iter_mut().enumerate() {
                    column.clear();
                    runs.iter().for_each(|run| column.extend_from_slice(&values[design.column(run, factor)]));
                }
                batch.reset(runs.len() * count);
                worker.run(&columns.iter().map(Vec::as_slice).collect::<Vec<_>>(), batch);
                batch
            };
            evaluated.settle();
            if let Some(reason) = evaluated.given_up() {
                return Err(RunError::GaveUp(reason.clone()));
            }
            if runs.len() > 1 {
                let (joined, _) = &self.joined;
                batches.iter_mut().enumerate().for_each(|(run, batch)| batch.copy_rows(joined, run * count));
                batches[0].add_counts(joined.flags(), joined.counts());
            }
        }
        Ok(())
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
            *of_output = self.totals_of(job.design, output, place);
        }
        totals
    }

    fn totals_of(&mut self, design: &Design, output: usize, place: BlockPlace) -> OutputTotals {
        let mut totals = OutputTotals::default();
        for (run, batch) in self.batches.iter_mut().enumerate() {
            let failures = batch.failures().iter().filter(|(failed, ..)| *failed == output);
            let failures: Vec<(usize, RowFailure)> = failures.map(|(_, row, why)| (*row, why.clone())).collect();
            for (row, failure) in failures {
                let first = RowPosition { point: place.first.point + row as u64, run: run as u64, ..place.first };
                totals.runs_failed += 1;
                totals.failures.count(&failure, Tally { count: 1, first });
                // A value that the model left in a failed row is ignored.
                batch.set(row, output, f64::NAN);
            }
        }
        let runs: Vec<&[f64]> = self.batches.iter().map(|batch| batch.column(output)).collect();
        let (a, b, length) = (runs[0], runs[1], place.parts.length as usize);
        let parts = (0..a.len()).step_by(length).map(|first| {
            let part = first..(first + length).min(a.len());
            let (ab, ba) = (parts_of(&runs, design.ab_runs(), &part), parts_of(&runs, design.ba_runs(), &part));
            let (a, b, paired) = (&a[part.clone()], &b[part.clone()], design.paired());
            Moments::of_block(BlockOutputs { a, b, ab: &ab, ba: &ba, paired }, &mut self.workspace)
        });
        totals.moments = MomentParts::new(place.parts, a.len() as u64, parts.collect());
        if place.keeps_outputs {
            totals.point_outputs = PointOutputs::of_block(&runs);
        }
        totals.values = CentralMoments::from_values(a);
        totals.values.merge(&CentralMoments::from_values(b));
        totals.sample = a.iter().zip(b).take(place.sampled).flat_map(|(a, b)| [*a, *b]).collect();
        totals
    }
}

/// Returns the base points `part` of those of `runs` that are `selected`.
fn parts_of<'r>(runs: &[&'r [f64]], selected: &[usize], part: &Range<usize>) -> Vec<&'r [f64]> {
    selected.iter().map(|run| &runs[*run][part.clone()]).collect()
}

/// The position of a block in its design, and what is kept of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct BlockPlace {
    /// Row A of the first base point.
    pub first: RowPosition,
    /// Its parts with separate moments.
    pub parts: PartShape,
    /// How many of its base points, from the first on, belong to the sample.
    pub sampled: usize,
    /// Whether all outputs are kept.
    pub keeps_outputs: bool,
}

/// Returns the number of rows of a settled batch with at least one failure.
pub(crate) fn failed_rows(batch: &Batch) -> u64 {
    let mut rows: Vec<usize> = batch.failures().iter().map(|&(_, row, _)| row).collect();
    rows.sort_unstable();
    rows.dedup();
    rows.len() as u64
}
