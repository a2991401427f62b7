//! Columns of rows of dependent factors that do not come from a single matrix.
//!
//! For independent factors, a row AB_s is A with the columns s from B. For dependent factors there are two choices:
//! either the factors s come from B and the others follow them, each keeping the part of A that is independent of the
//! factors s; or the others come from A, and the factors s are drawn again given them. For a Gaussian copula both are
//! linear in normal scores (Kucherenko, Tarantola and Annoni 2012, Comput. Phys. Commun. 183, 937-946; Mara, Tarantola
//! and Annoni 2015, Environ. Model. Softw. 72, 173-183): with a difference b - a of the scores of B and A, the first is
//! z_r = a_r + R (b_s - a_s), the second z_s = b_s + R' (a_r - b_r), R and R' being the regressions.

use std::sync::Arc;

use crate::space::{GaussianCopula, from_score};

/// A column computed from others.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MixedColumn {
    /// The factor of the column.
    pub factor: usize,
    /// The column of a matrix whose scores are the starting value.
    start: usize,
    /// Terms added to it: (coefficient, of the scores of this column, minus those of that one).
    terms: Vec<(f64, usize, usize)>,
}

/// The mixed columns of a design, and the copula that its matrices follow.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MixedColumns {
    copula: Arc<GaussianCopula>,
    /// The index of the first mixed column among the columns of the base points.
    pub first: usize,
    pub columns: Vec<MixedColumn>,
}

impl MixedColumns {
    /// Creates an empty set of columns.
    pub fn new(copula: Arc<GaussianCopula>, first: usize) -> Self {
        Self { copula, first, columns: Vec::new() }
    }

    /// Returns the columns in which a row differs from `base` with the columns `swap` of `from`, as (factor, column),
    /// in rising order. If `redrawn`, the factors of the swap are drawn given the others; otherwise the others follow
    /// them. `base` and `from` are the indices of the first columns of the two matrices.
    pub fn of_row(&mut self, swap: &[usize], redrawn: bool, base: usize, from: usize) -> Vec<(usize, usize)> {
        let copula = Arc::clone(&self.copula);
        let (swapped, others): (Vec<usize>, Vec<usize>) = copula.dependent().iter().partition(|j| swap.contains(j));
        let (following, given, start, sign) =
            if redrawn { (&swapped, &others, from, -1.0) } else { (&others, &swapped, base, 1.0) };
        let mut row = Vec::new();
        for &factor in following {
            let coefficients = copula.regression(factor, given);
            let terms = given.iter().zip(coefficients).filter(|(_, coefficient)| *coefficient != 0.0);
            let terms: Vec<(f64, usize, usize)> =
                terms.map(|(j, coefficient)| (sign * coefficient, from + j, base + j)).collect();
            if !terms.is_empty() {
                row.push((factor, self.number(MixedColumn { factor, start: start + factor, terms })));
            }
        }
        row.sort_unstable();
        row
    }

    fn number(&mut self, column: MixedColumn) -> usize {
        let place = self.columns.iter().position(|other| *other == column);
        self.first
            + place.unwrap_or_else(|| {
                self.columns.push(column);
                self.columns.len() - 1
            })
    }

    /// Makes the columns of A and B dependent, `factors` each, and fills the mixed ones after all others.
    pub fn fill(&self, columns: &mut [Vec<f64>], factors: usize) {
        let (independent, mixed) = columns.split_at_mut(self.first.min(columns.len()));
        for matrix in independent.chunks_mut(factors).take(2) {
            self.copula.correlate(matrix);
        }
        if mixed.is_empty() {
            return;
        }
        let scores: Vec<Vec<f64>> =
            independent.chunks(factors).take(2).flat_map(|matrix| self.copula.scores(matrix)).collect();
        for (MixedColumn { start, terms, .. }, column) in self.columns.iter().zip(mixed) {
            column.copy_from_slice(&scores[*start]);
            for (coefficient, plus, less) in terms {
                for (score, (plus, less)) in column.iter_mut().zip(scores[*plus].iter().zip(&scores[*less])) {
                    *score += coefficient * (plus - less);
                }
            }
            for score in column {
                *score = from_score(*score);
            }
        }
    }
}
