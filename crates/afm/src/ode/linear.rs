//! Small dense linear systems.

/// An LU factorisation with its row exchanges.
pub(super) struct Factors<const N: usize> {
    matrix: [[f64; N]; N],
    rows: [usize; N],
}

impl<const N: usize> Factors<N> {
    /// Eliminates by Gauss with partial pivoting, rows weighted by their largest entry, since rows carry different
    /// units. A singular matrix gives non-finite solutions.
    pub fn new(mut matrix: [[f64; N]; N]) -> Self {
        let mut weights: [f64; N] =
            std::array::from_fn(|i| matrix[i].iter().fold(0.0_f64, |largest, value| largest.max(value.abs())));
        let mut rows: [usize; N] = std::array::from_fn(|i| i);
        for column in 0..N {
            let mut pivot = column;
            for row in column + 1..N {
                if matrix[row][column].abs() / weights[row] > matrix[pivot][column].abs() / weights[pivot] {
                    pivot = row;
                }
            }
            matrix.swap(column, pivot);
            rows.swap(column, pivot);
            weights.swap(column, pivot);
            let upper = matrix[column];
            for lower in &mut matrix[column + 1..] {
                let factor = lower[column] / upper[column];
                lower[column] = factor;
                for k in column + 1..N {
                    lower[k] -= factor * upper[k];
                }
            }
        }
        Self { matrix, rows }
    }

    /// Returns the solution for the right-hand side `b`.
    pub fn solve(&self, b: &[f64; N]) -> [f64; N] {
        let mut x = [0.0; N];
        for i in 0..N {
            x[i] = b[self.rows[i]];
            for k in 0..i {
                x[i] -= self.matrix[i][k] * x[k];
            }
        }
        for i in (0..N).rev() {
            for k in i + 1..N {
                x[i] -= self.matrix[i][k] * x[k];
            }
            x[i] /= self.matrix[i][i];
        }
        x
    }
}

#[cfg(test)]
#[path = "tests/linear.rs"]
mod tests;
