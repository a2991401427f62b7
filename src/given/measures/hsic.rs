//! The criterion of independence of Hilbert and Schmidt.

use statrs::distribution::{ContinuousCDF, Gamma};

/// Rows that are looked at, the first of the table: the time grows with their square.
pub const MOST_ROWS: usize = 4096;

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
    fn new(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let scaled = crate::sum::rescaled(values).0;
        let mean = crate::sum::mean(&scaled);
        let sd = (scaled.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
        let x: Vec<f64> = scaled.iter().map(|x| (x - mean) / sd).collect();
        let row = |a: &f64| x.iter().map(|b| kernel(*a, *b)).sum::<f64>() / count;
        let means: Vec<f64> = x.iter().map(row).collect();
        let mean = means.iter().sum::<f64>() / count;
        Self { x, means, mean }
    }

    /// The kernel of rows `i` and `j`, centred.
    fn centred(&self, i: usize, j: usize) -> f64 {
        kernel(self.x[i], self.x[j]) - self.means[i] - self.means[j] + self.mean
    }

    /// The mean of the matrix without its diagonal.
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
    kernel: Kernel,
    /// The sum of the squares of its centred kernels.
    squares: f64,
}

impl Outputs {
    pub fn new(z: &[f64]) -> Self {
        let kernel = Kernel::new(&z[..z.len().min(MOST_ROWS)]);
        let count = kernel.x.len();
        let squares = |i: usize| (0..count).map(|j| kernel.centred(i, j).powi(2)).sum::<f64>();
        let squares = (0..count).map(squares).sum();
        Self { kernel, squares }
    }

    /// HSIC(X, Y)/sqrt(HSIC(X, X) HSIC(Y, Y)) by V-statistics, and the probability that independent columns reach it, by the gamma
    /// distribution of the same mean and variance (Gretton et al. 2008, eq. 9 with its appendix).
    pub fn with(&self, x: &[f64]) -> (f64, Option<f64>) {
        let x = Kernel::new(&x[..x.len().min(MOST_ROWS)]);
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
        let own: Vec<(f64, f64)> = of_x.zip(of_y).collect();
        products = 2.0 * products + own.iter().map(|(x, y)| x * y).sum::<f64>();
        squares = 2.0 * squares + own.iter().map(|(x, _)| x * x).sum::<f64>();
        let r2 = products / (squares * self.squares).sqrt();
        let n = count as f64;
        let (mean_x, mean_y) = (x.mean_of_pairs(), y.mean_of_pairs());
        let mean = (1.0 + mean_x * mean_y - mean_x - mean_y) / n;
        let variance =
            2.0 * (2.0 * pairs / (n * (n - 1.0))) * (n - 4.0) * (n - 5.0) / (n * (n - 1.0) * (n - 2.0) * (n - 3.0));
        let gamma = Gamma::new(mean * mean / variance, mean / variance).ok();
        (if r2.is_nan() { 0.0 } else { r2 }, gamma.map(|gamma| gamma.sf(products / (n * n))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_depends_on_itself_alone() {
        let x: Vec<f64> = (0..200).map(|k| f64::from(k * 37 % 200)).collect();
        let y: Vec<f64> = (0..200).map(|k| f64::from(k * k % 193)).collect();
        let outputs = Outputs::new(&x);
        let (itself, p_value) = outputs.with(&x);
        assert!((itself - 1.0).abs() < 1e-12 && p_value.unwrap() < 1e-10);
        // Neither scale nor offset count.
        let moved: Vec<f64> = x.iter().map(|x| 3e200 * (x - 7.0)).collect();
        assert!((outputs.with(&moved).0 - 1.0).abs() < 1e-12);
        let (other, p_value) = outputs.with(&y);
        assert!(other < 0.1 && p_value.unwrap() > 0.01, "{other} {p_value:?}");
    }
}
