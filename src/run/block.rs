//! One block of base points: unit cube to SI values, rows to outputs, outputs to totals.

use std::collections::BTreeMap;

use super::Job;
use super::totals::{OutputTotals, Tally, Totals};
use crate::estimate::{BlockOutputs, Moments};
use crate::model::{Batch, Effort, Worker};

/// What a thread needs to evaluate blocks, kept from block to block.
pub(super) struct Scratch<'a> {
    worker: Box<dyn Worker + 'a>,
    /// Columns of A, then of B, in the unit cube.
    unit: Vec<Vec<f64>>,
    /// The same in SI units.
    values: Vec<Vec<f64>>,
    /// Outputs of A, B and every AB_j.
    batches: Vec<Batch>,
    /// Outputs of a block with the incomplete base points left out.
    kept: Vec<Vec<f64>>,
    /// Which base points of the block are complete in the output at hand.
    complete: Vec<bool>,
    differences: Vec<f64>,
}

impl<'a> Scratch<'a> {
    pub(super) fn new(job: Job<'a>) -> Self {
        let (factors, kinds) = (job.design.factors(), job.design.rows_per_point() as usize);
        Self {
            worker: job.model.worker(),
            unit: vec![Vec::new(); factors * 2],
            values: vec![Vec::new(); factors * 2],
            batches: vec![Batch::of(job.model); kinds],
            kept: vec![Vec::new(); kinds],
            complete: Vec::new(),
            differences: Vec::new(),
        }
    }

    /// The unit-cube columns for `rows` base points, to be filled.
    pub(super) fn unit_columns(&mut self, rows: usize) -> &mut [Vec<f64>] {
        for column in &mut self.unit {
            column.resize(rows, 0.0);
        }
        &mut self.unit
    }

    /// Evaluates the base points in the unit columns; `first_row` is the row number of the first one's A. `report` is
    /// told of every batch: its runs, and how many of them failed.
    pub(super) fn evaluate(&mut self, job: Job<'_>, first_row: u64, report: &dyn Fn(u64, u64)) -> Totals {
        self.run_rows(job, report);
        let rows = self.unit.first().map_or(0, Vec::len);
        let mut totals = Totals {
            runs: (rows * self.batches.len()) as u64,
            failed_runs: self.batches.iter().map(failed_rows).sum(),
            outputs: Vec::with_capacity(job.model.outputs().len()),
            flags: vec![0; job.model.flags().len()],
            effort: Effort::none(job.model.rungs().len()),
        };
        for batch in &self.batches {
            totals.effort.merge(batch.effort());
            for (total, raised) in totals.flags.iter_mut().zip(batch.flags()) {
                *total += raised;
            }
        }
        for output in 0..job.model.outputs().len() {
            totals.outputs.push(self.totals_of(output, rows, first_row));
        }
        totals
    }

    fn run_rows(&mut self, job: Job<'_>, report: &dyn Fn(u64, u64)) {
        let factors = job.design.factors();
        for (k, (unit, values)) in self.unit.iter().zip(&mut self.values).enumerate() {
            values.resize(unit.len(), 0.0);
            job.space.factors()[k % factors].fill_si(unit, values);
        }
        let (a, b) = self.values.split_at(factors);
        let mut inputs: Vec<&[f64]> = Vec::with_capacity(factors);
        for (kind, batch) in self.batches.iter_mut().enumerate() {
            inputs.clear();
            inputs.extend(if kind == 1 { b } else { a }.iter().map(Vec::as_slice));
            if let Some(swap) = kind.checked_sub(2) {
                for &column in &job.design.swaps()[swap] {
                    inputs[column] = &b[column];
                }
            }
            batch.reset(inputs[0].len());
            self.worker.run(&inputs, batch);
            batch.settle();
            report(batch.rows() as u64, failed_rows(batch));
        }
    }

    fn totals_of(&mut self, output: usize, rows: usize, first_row: u64) -> OutputTotals {
        let kinds = self.batches.len() as u64;
        let mut totals = OutputTotals { moments: Moments::empty(0), runs_failed: 0, failures: BTreeMap::new() };
        self.complete.clear();
        self.complete.resize(rows, true);
        for (kind, batch) in self.batches.iter().enumerate() {
            for (_, row, failure) in batch.failures().iter().filter(|(o, _, _)| *o == output) {
                self.complete[*row] = false;
                totals.runs_failed += 1;
                totals.count(
                    failure.clone(),
                    Tally { count: 1, first_row: first_row + *row as u64 * kinds + kind as u64 },
                );
            }
        }
        let columns: Vec<&[f64]> = if totals.runs_failed == 0 {
            self.batches.iter().map(|batch| batch.column(output)).collect()
        } else {
            for (batch, kept) in self.batches.iter().zip(&mut self.kept) {
                kept.clear();
                let complete = batch.column(output).iter().zip(&self.complete).filter(|(_, complete)| **complete);
                kept.extend(complete.map(|(value, _)| value));
            }
            self.kept.iter().map(Vec::as_slice).collect()
        };
        let outputs = BlockOutputs { a: columns[0], b: columns[1], swapped: &columns[2..] };
        totals.moments = Moments::of_block(outputs, &mut self.differences);
        totals
    }
}

/// Rows of a settled batch with at least one failure.
fn failed_rows(batch: &Batch) -> u64 {
    let mut rows: Vec<usize> = batch.failures().iter().map(|&(_, row, _)| row).collect();
    rows.sort_unstable();
    rows.dedup();
    rows.len() as u64
}
