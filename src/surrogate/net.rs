//! The runs of one replicate as used in the fit: polynomials of the base points, and the outputs of every run.

use std::ops::Range;
use std::sync::Arc;

use super::basis::Term;
use super::family::{Family, polynomials};
use crate::design::Design;

/// One scrambled net: its base points by their polynomials, and an output at each of their runs. Base points at which a
/// run failed are left out.
pub struct Net {
    rows: Arc<NetRows>,
    /// For each run its standardised outputs.
    pub outputs: Vec<Vec<f64>>,
}

/// The base points of a net, and the columns of its runs.
struct NetRows {
    /// For each factor of each matrix a column for each degree from 1.
    columns: Vec<Vec<Vec<f64>>>,
    /// For each factor of each matrix the quantiles.
    quantiles: Vec<Vec<f64>>,
    factors: usize,
    /// For each run and factor the index of its column.
    places: Vec<Vec<usize>>,
    points: usize,
}

/// The mean and the mean square of a polynomial over some rows.
#[derive(Debug, Clone, Copy, Default)]
pub struct Spread {
    pub mean: f64,
    pub square: f64,
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
        let complete: Vec<usize> =
            (0..points.len()).filter(|&p| outputs.iter().all(|run| run[p].is_finite())).collect();
        let mut base = vec![vec![0.0; points.len()]; design.columns()];
        design.replicate(replicate).fill(points.start as u64, &mut base);
        let factors = design.factors();
        let quantiles: Vec<Vec<f64>> = base.iter().map(|u| complete.iter().map(|&p| u[p]).collect()).collect();
        let columns =
            quantiles.iter().enumerate().map(|(k, u)| polynomials(&families[k % factors], u, degree)).collect();
        let places = design.runs().iter().map(|run| (0..factors).map(|f| design.column(run, f)).collect()).collect();
        Self {
            rows: Arc::new(NetRows { columns, quantiles, factors, places, points: complete.len() }),
            outputs: outputs.iter().map(|run| complete.iter().map(|&p| run[p]).collect()).collect(),
        }
    }

    /// Creates a net of plain rows for tests, one run of one matrix: `columns` has a column for each factor and degree from 1.
    #[cfg(test)]
    pub fn of_rows(columns: Vec<Vec<Vec<f64>>>, outputs: Vec<f64>) -> Self {
        let (factors, points) = (columns.len(), outputs.len());
        let places = vec![(0..factors).collect()];
        let rows = NetRows { columns, quantiles: Vec::new(), factors, places, points };
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
        &self.rows.columns[self.rows.places[run][factor]][degree - 1]
    }

    /// Returns the quantiles of `factor` at the base points of `run`.
    pub fn quantiles(&self, run: usize, factor: usize) -> &[f64] {
        &self.rows.quantiles[self.rows.places[run][factor]]
    }

    /// Returns the spread of the polynomial of each degree of `factor` over the columns of all matrices.
    pub fn spreads(&self, factor: usize) -> Vec<Spread> {
        let count = (self.rows.columns.len() / self.rows.factors * self.rows.points).max(1) as f64;
        let degrees = 0..self.rows.columns[factor].len();
        let of_degree = degrees.map(|degree| {
            let columns = self.rows.columns.iter().skip(factor).step_by(self.rows.factors);
            let values = columns.flat_map(|of_matrix| &of_matrix[degree]);
            Spread { mean: values.clone().sum::<f64>() / count, square: values.map(|x| x * x).sum::<f64>() / count }
        });
        of_degree.collect()
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
            for (value, p) in values.iter_mut().zip(column) {
                *value *= p;
            }
        }
    }

    /// Returns at most `most` rows (run, base point) in the order of the runs: one at a pseudo-random place in each of
    /// as many equal stretches. Points at equal distances near a power of two are not a net, and miss rare levels.
    pub fn spaced_rows(&self, most: usize) -> Vec<(usize, usize)> {
        let all = self.rows.points * self.runs();
        let count = all.min(most);
        let rows = (0..count).map(|k| {
            let (first, next) = (k * all / count, (k + 1) * all / count);
            // The fractional part of a multiple of the golden ratio, in 32 bits.
            let within = (k as u32).wrapping_mul(0x9e37_79b9);
            let row = first + (((next - first) * (within >> 16) as usize) >> 16);
            (row / self.rows.points, row % self.rows.points)
        });
        rows.collect()
    }

    /// Returns the values of `term` at some rows, in the order of the runs.
    pub fn at(&self, term: &Term, rows: &[(usize, usize)]) -> Vec<f64> {
        let mut values = vec![1.0; rows.len()];
        let mut rest = &mut values[..];
        for rows in rows.chunk_by(|a, b| a.0 == b.0) {
            let (of_run, after) = rest.split_at_mut(rows.len());
            for (factor, degree) in term {
                let column = self.column(rows[0].0, *factor, *degree);
                for (value, (_, point)) in of_run.iter_mut().zip(rows) {
                    *value *= column[*point];
                }
            }
            rest = after;
        }
        values
    }
}
