//! The Gaussian copula: factors whose normal scores are correlated, each with any distribution.

use crate::space::Distribution;
use nalgebra::{DMatrix, DVector};

use apportion_base::special::{normal_below, normal_quantile};

/// A Gaussian copula of all factors of a space: the normal scores Phi^-1(u) of the factors have a joint normal distribution.
///
/// Conditional distributions are linear in the scores, so any factors can be drawn given any others (Kucherenko,
/// Tarantola and Annoni 2012, Comput. Phys. Commun. 183, 937-946, section 4).
#[derive(Debug, Clone, PartialEq)]
pub struct GaussianCopula {
    correlation: DMatrix<f64>,
    /// The factors that are correlated with another one, in rising order.
    dependent: Vec<usize>,
    /// The Cholesky factor of the correlations among these.
    lower: DMatrix<f64>,
}

// Correlations are never NaN, so equality is reflexive.
impl Eq for GaussianCopula {}

/// The minimum eigenvalue of a correlation matrix: with less, a factor is almost a function of others.
const MIN_EIGENVALUE: f64 = 1e-9;

/// The minimum eigenvalue of a proposed matrix: rounding to four digits then keeps it positive definite.
const PROPOSED_EIGENVALUE: f64 = 1e-3;

impl GaussianCopula {
    /// Creates the copula whose normal scores have this correlation matrix, symmetric with a diagonal of ones; returns
    /// the nearest valid matrix, rounded to four digits, as an error if it is not positive definite.
    pub(crate) fn new(correlation: DMatrix<f64>) -> Result<Self, DMatrix<f64>> {
        let factors = correlation.nrows();
        let dependent: Vec<usize> =
            (0..factors).filter(|&i| (0..factors).any(|j| j != i && correlation[(i, j)] != 0.0)).collect();
        let among = part(&correlation, &dependent, &dependent);
        if dependent.is_empty() {
            return Ok(Self { correlation, dependent, lower: among });
        }
        let least = among.symmetric_eigenvalues().iter().copied().fold(1.0, f64::min);
        let lower = among.cholesky().filter(|_| least >= MIN_EIGENVALUE).map(|cholesky| cholesky.l());
        match lower {
            Some(lower) => Ok(Self { correlation, dependent, lower }),
            None => Err(nearest_correlation(&correlation)),
        }
    }

    /// Returns the number of factors.
    pub(crate) fn factors(&self) -> usize {
        self.correlation.nrows()
    }

    /// Returns the correlation matrix of the normal scores, row by row.
    pub(crate) fn rows(&self) -> Vec<Vec<f64>> {
        self.correlation.row_iter().map(|row| row.iter().copied().collect()).collect()
    }

    /// Returns the factors that are correlated with another one, in rising order.
    pub(crate) fn dependent(&self) -> &[usize] {
        &self.dependent
    }

    /// Makes points of the unit cube, a column for each factor, whose coordinates are independent, dependent: the first
    /// of the dependent factors keeps its coordinates.
    pub(crate) fn correlate(&self, columns: &mut [Vec<f64>]) {
        let mut scores: Vec<Vec<f64>> = self.dependent.iter().map(|&factor| normal_scores(&columns[factor])).collect();
        for (row, &factor) in self.dependent.iter().enumerate().skip(1).rev() {
            let (before, scores) = scores.split_at_mut(row);
            let scores = &mut scores[0];
            for score in scores.iter_mut() {
                *score *= self.lower[(row, row)];
            }
            for (column, other) in before.iter().enumerate().filter(|(column, _)| self.lower[(row, *column)] != 0.0) {
                let weight = self.lower[(row, column)];
                for (score, other) in scores.iter_mut().zip(other) {
                    *score += weight * other;
                }
            }
            for (u, score) in columns[factor].iter_mut().zip(scores) {
                *u = from_score(*score);
            }
        }
    }

    /// Returns the scores of points of the unit cube, a column for each factor: empty for one that depends on no other.
    pub(crate) fn scores(&self, columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut scores = vec![Vec::new(); columns.len()];
        for &factor in &self.dependent {
            scores[factor] = normal_scores(&columns[factor]);
        }
        scores
    }

    /// Returns the coefficients in E(score of `of` | scores of `given`) = sum coefficient x score, in `given`'s order.
    pub(crate) fn regression(&self, of: usize, given: &[usize]) -> Vec<f64> {
        // Only factors connected with it, directly or through others, have a coefficient.
        let mut tied = vec![of];
        let mut next = 0;
        while next < tied.len() {
            let from = tied[next];
            let more = given.iter().filter(|j| self.correlation[(from, **j)] != 0.0 && !tied.contains(j));
            let more: Vec<usize> = more.copied().collect();
            tied.extend(more);
            next += 1;
        }
        let tied: Vec<usize> = given.iter().copied().filter(|j| tied[1..].contains(j)).collect();
        let covariances = DVector::from_iterator(tied.len(), tied.iter().map(|&j| self.correlation[(of, j)]));
        // A principal part of a positive definite matrix is positive definite.
        let solved = part(&self.correlation, &tied, &tied).cholesky().map(|cholesky| cholesky.solve(&covariances));
        let mut coefficients = vec![0.0; given.len()];
        if let Some(solved) = solved {
            for (&factor, coefficient) in tied.iter().zip(&solved) {
                let place = given.iter().position(|&other| other == factor);
                place.into_iter().for_each(|place| coefficients[place] = *coefficient);
            }
        }
        coefficients
    }
}

/// Returns the normal scores of coordinates of the unit cube.
pub(crate) fn normal_scores(u: &[f64]) -> Vec<f64> {
    u.iter().map(|&u| normal_quantile(u)).collect()
}

/// Returns the coordinate of the unit cube with this normal score, inside the range of all coordinates.
pub(crate) fn from_score(score: f64) -> f64 {
    normal_below(score).clamp(Distribution::SMALLEST_U, Distribution::LARGEST_U)
}

fn part(matrix: &DMatrix<f64>, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), columns.len(), |i, j| matrix[(rows[i], columns[j])])
}

/// Returns the correlation matrix nearest to `matrix` in the Frobenius norm, made safely positive definite and rounded
/// to four digits, by alternating projections (Higham 2002, IMA J. Numer. Anal. 22, 329-343, algorithm 3.3).
fn nearest_correlation(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    const STEPS: usize = 500;
    let n = matrix.nrows();
    let mut nearest = matrix.clone();
    let mut correction = DMatrix::zeros(n, n);
    for _ in 0..STEPS {
        let shifted = &nearest - &correction;
        let positive = with_min_eigenvalue(shifted.clone(), 0.0);
        correction = &positive - shifted;
        let mut next = positive;
        next.fill_diagonal(1.0);
        let change = (&next - &nearest).norm();
        nearest = next;
        if change < 1e-8 {
            break;
        }
    }
    let mut safe = with_min_eigenvalue(nearest, PROPOSED_EIGENVALUE * n as f64);
    let scale: Vec<f64> = (0..n).map(|i| safe[(i, i)].sqrt()).collect();
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        safe[(i, j)] = (safe[(i, j)] / (scale[i] * scale[j]) * 1e4).round() / 1e4;
    }
    safe
}

fn with_min_eigenvalue(matrix: DMatrix<f64>, min: f64) -> DMatrix<f64> {
    let mut eigen = matrix.symmetric_eigen();
    for value in eigen.eigenvalues.iter_mut() {
        *value = value.max(min);
    }
    eigen.recompose()
}

#[cfg(test)]
#[path = "tests/copula.rs"]
mod tests;
