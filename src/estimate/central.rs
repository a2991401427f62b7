//! Mean, variance, skewness and kurtosis of an output.

use multiversion::multiversion;

use apportion_base::sum::{mean, range, sums_by};

/// Count, mean, range, and sums of the second to fourth powers of the deviations from the mean, of single outputs.
///
/// Merged by the updates of Pebay (2008), "Formulas for robust, one-pass parallel computation of covariances and
/// arbitrary-order statistical moments", Sandia report SAND2008-6212.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CentralMoments {
    n: u64,
    mean: f64,
    m2: f64,
    m3: f64,
    m4: f64,
    range: Option<(f64, f64)>,
}

impl CentralMoments {
    /// Computes the moments of `values`, ignoring those that are not finite.
    pub fn from_values(values: &[f64]) -> Self {
        // A mean is finite only if every value is.
        if mean(values).is_finite() {
            return Self::of_finite(values);
        }
        Self::of_finite(&values.iter().copied().filter(|y| y.is_finite()).collect::<Vec<_>>())
    }

    fn of_finite(values: &[f64]) -> Self {
        let mean = mean(values);
        let [m2, m3, m4] = powers(values, mean);
        Self { n: values.len() as u64, mean, m2, m3, m4, range: (!values.is_empty()).then(|| range(values)) }
    }

    /// Adds other values.
    pub fn merge(&mut self, other: &Self) {
        let (Some((low, high)), Some((other_low, other_high))) = (self.range, other.range) else {
            if self.range.is_none() {
                *self = *other;
            }
            return;
        };
        self.range = Some((low.min(other_low), high.max(other_high)));
        let (n, m) = (self.n as f64, other.n as f64);
        // Weights of the two sides; the powers of delta are spread so that none overflows before the sum does.
        let (p, q, delta) = (n / (n + m), m / (n + m), other.mean - self.mean);
        let pair = n * q * delta * delta;
        self.m4 += other.m4
            + pair * delta * delta * (p * p - p * q + q * q)
            + 6.0 * delta * delta * (p * p * other.m2 + q * q * self.m2)
            + 4.0 * delta * (p * other.m3 - q * self.m3);
        self.m3 += other.m3 + pair * delta * (p - q) + 3.0 * delta * (p * other.m2 - q * self.m2);
        self.m2 += other.m2 + pair;
        self.mean += delta * q;
        self.n += other.n;
    }

    /// Returns the number of values.
    pub fn count(&self) -> u64 {
        self.n
    }

    /// Returns the smallest and largest value; `None` if there are none.
    pub fn range(&self) -> Option<(f64, f64)> {
        self.range
    }

    /// Returns the mean; `None` without values.
    pub fn mean(&self) -> Option<f64> {
        (self.n > 0).then_some(self.mean)
    }

    /// Returns the variance with the divisor n, as for the indices; `None` without values.
    pub fn variance(&self) -> Option<f64> {
        (self.n > 0).then(|| self.m2 / self.n as f64)
    }

    /// Returns the skewness g1 = (m3/n)/(m2/n)^(3/2); `None` without variance.
    pub fn skewness(&self) -> Option<f64> {
        let sd = self.variance()?.sqrt();
        Some(self.m3 / self.n as f64 / sd / sd / sd).filter(|g| g.is_finite())
    }

    /// Returns the excess kurtosis g2 = (m4/n)/(m2/n)^2 - 3, 0 for a normal distribution; `None` without variance.
    pub fn excess_kurtosis(&self) -> Option<f64> {
        let variance = self.variance()?;
        Some(self.m4 / self.n as f64 / variance / variance - 3.0).filter(|g| g.is_finite())
    }
}

/// Returns the sums of the second, third and fourth powers of x - mean.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn powers(x: &[f64], mean: f64) -> [f64; 3] {
    sums_by(x.len(), |i| {
        let d = x[i] - mean;
        let square = d * d;
        [square, square * d, square * square]
    })
}
