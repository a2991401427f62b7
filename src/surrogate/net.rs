//! The runs of one replicate as used in the fit: polynomials of the base points, and the outputs of every run.

use std::ops::Range;
use std::sync::Arc;

use super::family::{Family, polynomials};
use super::terms::Term;
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
    /// For each run and factor the index of its column.
    places: Vec<Vec<usize>>,
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
            rows: Arc::new(NetRows { columns, quantiles, places, points: complete.len() }),
            outputs: outputs.iter().map(|run| complete.iter().map(|&p| run[p]).collect()).collect(),
        }
    }

    /// Creates a net of plain rows for tests, one run of one matrix: `columns` has a column for each factor and degree from 1.
    #[cfg(test)]
    pub fn of_rows(columns: Vec<Vec<Vec<f64>>>, outputs: Vec<f64>) -> Self {
        let (factors, points) = (columns.len(), outputs.len());
        let places = vec![(0..factors).collect()];
        let rows = NetRows { columns, quantiles: Vec::new(), places, points };
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
}
