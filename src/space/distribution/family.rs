//! The interface of a family of distributions.

use super::entry::{Entry, in_si};
use super::{Distribution, DistributionError, Parameter};
use apportion_base::quantity::Unit;

/// One family; [`Distribution`] describes each of these. A family has [`quantile`](Self::quantile) or [`at`](Self::at).
pub(super) trait Family {
    /// Returns P(X <= x) and P(X > x), each to full precision if the distribution is continuous.
    fn tails(&self, x: f64) -> (f64, f64);
    /// Returns mean and standard deviation.
    fn moments(&self) -> (f64, f64);
    fn parameters(&self) -> Vec<(&'static str, Parameter)>;

    /// Returns the smallest closed interval that contains every value: by default the range of the quantiles.
    fn support(&self) -> (f64, f64) {
        (self.quantile(0.0), self.quantile(1.0))
    }

    /// Returns its name in study files; `default` is that of its first entry.
    fn name(&self, default: &'static str) -> &'static str {
        default
    }

    /// Returns the quantile at `u`, `v` being 1 - `u`, to full precision if either is small.
    fn at(&self, u: f64, _v: f64) -> f64 {
        self.quantile(u)
    }

    fn quantile(&self, u: f64) -> f64 {
        self.at(u, 1.0 - u)
    }

    /// Returns the quantile at 1 - `v`, to full precision if `v` is small.
    fn upper_quantile(&self, v: f64) -> f64 {
        self.at(1.0 - v, v)
    }

    fn fill(&self, u: &[f64], out: &mut [f64]) {
        for (value, &u) in out.iter_mut().zip(u) {
            *value = self.quantile(u);
        }
    }

    /// Returns the same quantity in SI, without a check of its variance: a truncated part may have one.
    fn in_si(&self, entry: &'static Entry, unit: &Unit) -> Result<Distribution, DistributionError> {
        in_si(entry, self.parameters(), unit)
    }

    /// Refuses parameters for which there is no variance.
    fn refuse_infinite_variance(&self) -> Result<(), DistributionError> {
        Ok(())
    }
}
