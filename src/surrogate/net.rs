//! The runs of one replicate as used in the fit: polynomials of the base points, and the outputs of every run.

use std::ops::Range;
use std::sync::Arc;

use super::basis::{Family, Term, polynomials};
use crate::design::{Design, Run};

/// One scrambled net: its base points by their polynomials, and an output at each of their runs. Base points at which a
/// run failed are left out.
pub struct Net {
    rows: Arc<NetRows>,
    /// For each run its standardised outputs.
    pub outputs: Vec<Vec<f64>>,
}

/// The base points of a net, and the matrices of its runs.
struct NetRows {
    /// For each matrix and factor a column for each degree from 1.
    columns: Vec<Vec<Vec<f64>>>,
    /// For each matrix and factor the quantiles.
    quantiles: Vec<Vec<f64>>,
    factors: usize,
    /// For each run and factor the matrix of its column.
    matrices: Vec<Vec<usize>>,
    points: usize,
}

impl Net {
    /// Creates a net of those base points of `replicate` among `points` whose `outputs`, a column for each run, are all
    /// finite.
    pub fn new(
        design: &Design,
        replicate: u64,
        points: Range<usize>,
        families: &[Family],
        degree: usize,
        outputs: &[Vec<f64>],
    ) -> Self {
        let outputs: Vec<&[f64]> = outputs.iter().map(|run| &run[points.clone()]).collect();
        let good: Vec<usize> = (0..points.len()).filter(|&p| outputs.iter().all(|run| run[p].is_finite())).collect();
        let mut base = vec![vec![0.0; points.len()]; design.columns()];
        design.replicate(replicate).fill(points.start as u64, &mut base);
        let factors = design.factors();
        let quantiles: Vec<Vec<f64>> = base.iter().map(|u| good.iter().map(|&p| u[p]).collect()).collect();
        let of_column = |(number, u): (usize, &Vec<f64>)| polynomials(&families[number % factors], u, degree);
        let matrix = |run: &Run, factor: usize| {
            design.first_column(if run.columns.binary_search(&factor).is_ok() { run.from } else { run.base }) / factors
        };
        let columns = quantiles.iter().enumerate().map(of_column).collect();
        let matrices = design.runs().iter().map(|run| (0..factors).map(|f| matrix(run, f)).collect()).collect();
        Self {
            rows: Arc::new(NetRows { columns, quantiles, factors, matrices, points: good.len() }),
            outputs: outputs.iter().map(|run| good.iter().map(|&p| run[p]).collect()).collect(),
        }
    }

    /// Creates a net of plain rows, one run of one matrix: `columns` has a column for each factor and degree from 1.
    pub fn of_rows(columns: Vec<Vec<Vec<f64>>>, outputs: Vec<f64>) -> Self {
        let (factors, points) = (columns.len(), outputs.len());
        let matrices = vec![vec![0; factors]];
        let rows = NetRows { columns, quantiles: Vec::new(), factors, matrices, points };
        Self { rows: Arc::new(rows), outputs: vec![outputs] }
    }

    /// Returns the net with other `outputs` at the same rows.
    pub fn with_outputs(&self, outputs: Vec<Vec<f64>>) -> Self {
        Self { rows: Arc::clone(&self.rows), outputs }
    }

    /// Returns the number of base points.
    pub fn points(&self) -> usize {
        self.rows.points
    }

    /// Returns the number of runs of each of them.
    pub fn runs(&self) -> usize {
        self.outputs.len()
    }

    /// Returns the polynomial of `degree` of `factor` at the base points of `run`.
    fn column(&self, run: usize, factor: usize, degree: usize) -> &[f64] {
        &self.rows.columns[self.rows.matrices[run][factor] * self.rows.factors + factor][degree - 1]
    }

    /// Returns the quantiles of `factor` at the base points of `run`.
    pub fn quantiles(&self, run: usize, factor: usize) -> &[f64] {
        &self.rows.quantiles[self.rows.matrices[run][factor] * self.rows.factors + factor]
    }

    /// Returns mean and mean square of the polynomials of each degree of `factor` over the columns of all matrices.
    pub fn spreads(&self, factor: usize) -> Vec<(f64, f64)> {
        let matrices = self.rows.columns.len() / self.rows.factors;
        let columns =
            |degree: usize| (0..matrices).map(move |m| &self.rows.columns[m * self.rows.factors + factor][degree]);
        let count = (matrices * self.rows.points).max(1) as f64;
        let mean = |degree: usize, of: fn(&f64) -> f64| columns(degree).flatten().map(of).sum::<f64>() / count;
        (0..self.rows.columns[factor].len()).map(|k| (mean(k, |x| *x), mean(k, |x| x * x))).collect()
    }

    /// Writes the values of `term` at every base point of `run` to `values`.
    pub fn fill(&self, term: &Term, run: usize, values: &mut Vec<f64>) {
        values.clear();
        let Some(((factor, degree), others)) = term.split_first() else {
            values.resize(self.rows.points, 1.0);
            return;
        };
        values.extend_from_slice(self.column(run, *factor, *degree));
        for (factor, degree) in others {
            let column = self.column(run, *factor, *degree);
            values.iter_mut().zip(column).for_each(|(value, p)| *value *= p);
        }
    }

    /// Returns at most `most` rows (run, base point) in the order of the runs: one at a pseudo-random place in each of
    /// as many equal stretches. Points at equal distances near a power of two are not a net, and miss rare levels.
    pub fn spaced_rows(&self, most: usize) -> Vec<(usize, usize)> {
        let all = self.rows.points * self.runs();
        let count = all.min(most);
        let row = |k: usize| {
            let (first, next) = (k * all / count, (k + 1) * all / count);
            // The fractional part of a multiple of the golden ratio, in 32 bits.
            let within = (k as u32).wrapping_mul(0x9e37_79b9);
            first + (((next - first) * (within >> 16) as usize) >> 16)
        };
        (0..count).map(row).map(|row| (row / self.rows.points, row % self.rows.points)).collect()
    }

    /// Returns the values of `term` at some rows, in the order of the runs.
    pub fn at(&self, term: &Term, rows: &[(usize, usize)]) -> Vec<f64> {
        let mut values = vec![1.0; rows.len()];
        let mut rest = &mut values[..];
        for rows in rows.chunk_by(|a, b| a.0 == b.0) {
            let (of_run, after) = rest.split_at_mut(rows.len());
            for (factor, degree) in term {
                let column = self.column(rows[0].0, *factor, *degree);
                of_run.iter_mut().zip(rows).for_each(|(value, (_, point))| *value *= column[*point]);
            }
            rest = after;
        }
        values
    }
}
