//! The Hilbert-Schmidt independence criterion.

use statrs::distribution::{ContinuousCDF, Gamma};

use super::Measured;
use crate::given::drawn_rows;
use crate::uncertainty::Estimate;

/// Maximum number of rows, a random part of those of a larger table: the time grows with their square.
pub const MAX_ROWS: usize = 4096;

/// A column in Gaussian kernels of the width of its standard deviation: k(a, b) = exp(-(a - b)^2/(2 s^2)).
struct Kernel {
    /// Values in units of the standard deviation.
    x: Vec<f64>,
    /// Means of the rows of the matrix of kernels.
    means: Vec<f64>,
    /// Mean of the whole matrix.
    mean: f64,
}

impl Kernel {
    /// Computes the kernels of a column; `None` if it has one value.
    fn new(values: &[f64]) -> Option<Self> {
        if values.iter().all(|value| *value == values[0]) {
            return None;
        }
        let count = values.len() as f64;
        let scaled = apportion_base::sum::rescaled(values).0;
        let mean = apportion_base::sum::mean(&scaled);
        let sd = (scaled.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
        let x: Vec<f64> = scaled.iter().map(|x| (x - mean) / sd).collect();
        let means: Vec<f64> = x.iter().map(|a| x.iter().map(|b| kernel(*a, *b)).sum::<f64>() / count).collect();
        let mean = means.iter().sum::<f64>() / count;
        Some(Self { x, means, mean })
    }

    /// Returns the kernel of rows `i` and `j`, centred.
    fn centred(&self, i: usize, j: usize) -> f64 {
        kernel(self.x[i], self.x[j]) - self.means[i] - self.means[j] + self.mean
    }

    /// Returns the mean of the matrix without its diagonal.
    fn mean_of_pairs(&self) -> f64 {
        let count = self.x.len() as f64;
        (self.mean * count - 1.0) / (count - 1.0)
    }
}

fn kernel(a: f64, b: f64) -> f64 {
    libm::exp(-(a - b).powi(2) / 2.0)
}

/// An output.
pub struct Outputs {
    /// The rows that are used.
    rows: Vec<usize>,
    kernel: Kernel,
    /// The sum of the squares of its centred kernels.
    squares: f64,
}

impl Outputs {
    /// Draws at most [`MAX_ROWS`] rows of a table by `seed`: the first ones of a sorted table would be a part of the
    /// input's range. `None` if they have one value.
    pub fn new(z: &[f64], seed: u64) -> Option<Self> {
        let mut rows = drawn_rows(z.len(), MAX_ROWS, seed);
        rows.sort_unstable();
        let kernel = Kernel::new(&taken(z, &rows))?;
        let count = kernel.x.len();
        let squares = (0..count).map(|i| (0..count).map(|j| kernel.centred(i, j).powi(2)).sum::<f64>()).sum();
        Some(Self { rows, kernel, squares })
    }

    /// Computes HSIC(X, Y)/sqrt(HSIC(X, X) HSIC(Y, Y)) by V-statistics, and the probability that independent columns
    /// reach it, by the gamma distribution of the same mean and variance (Gretton et al. 2008, eq. 9 with its
    /// appendix). `None` if the input has one value in the rows that are used.
    pub fn measure(&self, x: &[f64]) -> Option<Measured> {
        let x = Kernel::new(&taken(x, &self.rows))?;
        let (y, count) = (&self.kernel, self.kernel.x.len());
        let (mut products, mut squares, mut pairs) = (0.0, 0.0, 0.0);
        for i in 0..count {
            for j in 0..i {
                let (of_x, of_y) = (x.centred(i, j), y.centred(i, j));
                products += of_x * of_y;
                squares += of_x * of_x;
                pairs += (of_x * of_y).powi(2);
            }
        }
        let (of_x, of_y) = ((0..count).map(|i| x.centred(i, i)), (0..count).map(|i| y.centred(i, i)));
        products = 2.0 * products + of_x.clone().zip(of_y).map(|(x, y)| x * y).sum::<f64>();
        squares = 2.0 * squares + of_x.map(|x| x * x).sum::<f64>();
        let r2 = products / (squares * self.squares).sqrt();
        let n = count as f64;
        let (mean_x, mean_y) = (x.mean_of_pairs(), y.mean_of_pairs());
        let mean = (1.0 + mean_x * mean_y - mean_x - mean_y) / n;
        let variance =
            2.0 * (2.0 * pairs / (n * (n - 1.0))) * (n - 4.0) * (n - 5.0) / (n * (n - 1.0) * (n - 2.0) * (n - 3.0));
        let gamma = Gamma::new(mean * mean / variance, mean / variance).ok();
        let p_value = gamma.map(|gamma| gamma.sf(products / (n * n)));
        r2.is_finite().then(|| Measured { estimate: Estimate::alone(r2), p_value })
    }
}

fn taken(values: &[f64], rows: &[usize]) -> Vec<f64> {
    rows.iter().map(|row| values[*row]).collect()
}

#[cfg(test)]
#[path = "tests/hsic.rs"]
mod tests;
