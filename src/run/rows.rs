//! Single rows of a design, in any number, through a worker.

use std::ops::Range;

use super::Job;
use crate::design::{BasePoints, Matrix};
use crate::model::{Batch, Standing, Worker};

/// What a thread needs to evaluate any rows.
pub(super) struct RowRunner<'a> {
    worker: Box<dyn Worker + 'a>,
    batch: Batch,
    rows: RowValues,
}

impl<'a> RowRunner<'a> {
    pub fn new(job: Job<'a>) -> Self {
        Self { worker: job.model.worker(), batch: Batch::of(job.model), rows: RowValues::default() }
    }

    /// The settled outputs of rows `rows` of `replicate`, counted within the replicate, and whether they stand.
    pub fn run(&mut self, job: Job<'_>, replicate: u64, rows: Range<u64>) -> (&Batch, Standing) {
        let inputs = self.rows.values(job, replicate, rows.clone());
        let inputs: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
        self.batch.reset((rows.end - rows.start) as usize);
        let standing = self.worker.run_ahead(&inputs, &mut self.batch);
        self.batch.settle();
        (&self.batch, standing)
    }

    /// Decides on the rows that are pending.
    pub fn confirm(&mut self) -> Standing {
        self.worker.confirm()
    }
}

/// Makes the values of any rows of a design.
#[derive(Debug, Default)]
pub struct RowValues {
    /// The replicate whose points these are.
    points: Option<(u64, BasePoints)>,
    /// Columns of A, B and C over the base points.
    unit: Vec<Vec<f64>>,
    values: Vec<Vec<f64>>,
    /// One column of each factor over the rows.
    inputs: Vec<Vec<f64>>,
}

impl RowValues {
    /// The values of rows `rows` of `replicate`, counted within the replicate as in [`Piece`](super::Piece): a column of
    /// SI values for each factor.
    pub fn values(&mut self, job: Job<'_>, replicate: u64, rows: Range<u64>) -> &[Vec<f64>] {
        let (design, factors) = (job.design, job.design.factors());
        let per_point = design.rows_per_point();
        let points = rows.start / per_point..rows.end.div_ceil(per_point);
        self.unit.resize(design.columns(), Vec::new());
        self.values.resize(design.columns(), Vec::new());
        self.inputs.resize(factors, Vec::new());
        let length = (points.end - points.start) as usize;
        self.unit.iter_mut().for_each(|column| column.resize(length, 0.0));
        if self.points.as_ref().is_none_or(|(of, _)| *of != replicate) {
            self.points = Some((replicate, design.replicate(replicate)));
        }
        if let Some((_, base)) = &self.points {
            base.fill(points.start, &mut self.unit);
        }
        for (k, (unit, values)) in self.unit.iter().zip(&mut self.values).enumerate() {
            values.resize(length, 0.0);
            job.space.factors()[k % factors].fill_si(unit, values);
        }
        let column_of = |matrix: Matrix, factor: usize| &self.values[matrix as usize * factors + factor];
        for (factor, input) in self.inputs.iter_mut().enumerate() {
            input.clear();
            // Which matrix a run takes this factor from.
            let of_run = |run: &crate::design::Run| match run.columns.binary_search(&factor) {
                Ok(_) => run.from,
                Err(_) => run.base,
            };
            let columns: Vec<&Vec<f64>> = design.runs().iter().map(|run| column_of(of_run(run), factor)).collect();
            input.extend(rows.clone().map(|row| {
                let (point, run) = (row / per_point - points.start, row % per_point);
                columns[run as usize][point as usize]
            }));
        }
        &self.inputs
    }
}
