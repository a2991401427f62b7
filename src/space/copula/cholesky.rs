//! The triangular factor of correlations, in any order of the factors.

/// L of S = L L^T, where S are the correlations of some factors in an order (Cholesky): scores z with these
/// correlations are L e, where the e are independent of each other, and the first depend only on the first factors.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CholeskyFactor {
    rows: Vec<Vec<f64>>,
}

impl CholeskyFactor {
    /// Computes the factor for `factors` factors; `correlation` is called with two places of the order, the greater one
    /// first. The matrix must be positive definite.
    pub fn new(factors: usize, correlation: impl Fn(usize, usize) -> f64) -> Self {
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(factors);
        for row in 0..factors {
            let mut own: Vec<f64> = Vec::with_capacity(row + 1);
            for (column, other) in rows.iter().enumerate() {
                let known: f64 = own.iter().zip(other).map(|(a, b)| a * b).sum();
                own.push((correlation(row, column) - known) / other[column]);
            }
            // Above 0, because the smallest eigenvalue of the matrix is.
            own.push((1.0 - own.iter().map(|l| l * l).sum::<f64>()).max(f64::MIN_POSITIVE).sqrt());
            rows.push(own);
        }
        Self { rows }
    }

    /// Returns the e of the scores of the first factors.
    pub fn whiten(&self, scores: &[f64]) -> Vec<f64> {
        let mut e: Vec<f64> = Vec::with_capacity(scores.len());
        for (score, row) in scores.iter().zip(&self.rows) {
            let known: f64 = e.iter().zip(row).map(|(e, l)| e * l).sum();
            e.push((score - known) / row[e.len()]);
        }
        e
    }

    /// Returns the score of the factor at `place` of a point with this e, which may end there.
    pub fn score(&self, place: usize, e: &[f64]) -> f64 {
        self.rows[place].iter().zip(e).map(|(l, e)| l * e).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factor_gives_the_correlations_and_the_scores_back() {
        let correlations = [[1.0, 0.5, -0.3], [0.5, 1.0, 0.2], [-0.3, 0.2, 1.0]];
        for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0]] {
            let lower = CholeskyFactor::new(3, |row, column| correlations[order[row]][order[column]]);
            for (i, j) in (0..3).flat_map(|i| (0..=i).map(move |j| (i, j))) {
                let product: f64 = lower.rows[i].iter().zip(&lower.rows[j]).map(|(a, b)| a * b).sum();
                assert!((product - correlations[order[i]][order[j]]).abs() < 1e-15);
            }
            let e = lower.whiten(&[0.3, -1.0, 2.0]);
            assert_eq!(e[..2], lower.whiten(&[0.3, -1.0]));
            for (place, score) in [0.3, -1.0, 2.0].into_iter().enumerate() {
                assert!((lower.score(place, &e) - score).abs() < 1e-15);
            }
        }
    }
}
