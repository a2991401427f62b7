//! The Pareto distribution.

use super::prelude::*;

/// A power law above a minimum: sizes, incomes, losses.
#[derive(Clone, Debug, PartialEq)]
pub struct Pareto {
    pub(super) shape: f64,
    min: f64,
}

impl Distribution {
    /// Returns the Pareto distribution (of type I) with exponent `shape`, from `min` on.
    ///
    /// # Formula
    ///
    /// ```text
    /// F(x) = 1 - (min / x)^shape,   quantile(u) = min (1 - u)^(-1 / shape)
    /// mean = min shape / (shape - 1),   sd = min / (shape - 1) sqrt(shape / (shape - 2))
    /// ```
    ///
    /// # Errors
    ///
    /// If a parameter is not finite and positive, values overflow, or `shape <= 2`, where there is no variance.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let loss = Distribution::pareto(3.0, 2.0)?;
    /// assert!((loss.mean() - 3.0).abs() < 1e-15 && (loss.quantile(0.875) - 4.0).abs() < 1e-15);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn pareto(shape: f64, min: f64) -> Result<Self, DistributionError> {
        Self::Pareto(Pareto::new(shape, min)?).finite()
    }
}

impl Pareto {
    /// Allows any shape above 0; one of at most 2 needs an upper bound.
    pub(crate) fn new(shape: f64, min: f64) -> Result<Self, DistributionError> {
        Ok(Self { shape: positive("shape", shape)?, min: positive("min", min)? })
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "pareto",
    summary: "A power law above a smallest value.",
    key_sets: &[keys(&["shape", "min"]), MOMENTS, TWO_QUANTILES],
    of_ratios: true,
    shape: Shape::Between(1e6, 2.0001, 500),
    make: |_, [_, min, shape]| Distribution::pareto(shape, min),
    build: |given| Pareto::new(given.number("shape")?, given.number("min")?).map(Distribution::Pareto),
    ..PLAIN
}];

impl Family for Pareto {
    fn refuse_infinite_variance(&self) -> Result<(), DistributionError> {
        of_finite_variance("shape", self.shape, 2.0)
    }

    fn quantile(&self, u: f64) -> f64 {
        (self.min * libm::exp(-libm::log1p(-u) / self.shape)).max(self.min)
    }

    fn upper_quantile(&self, v: f64) -> f64 {
        (self.min * libm::exp(-libm::log(v) / self.shape)).max(self.min)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let log = -self.shape * libm::log1p((x - self.min).max(0.0) / self.min);
        (-libm::expm1(log), libm::exp(log))
    }

    fn moments(&self) -> (f64, f64) {
        (
            self.min * (self.shape / (self.shape - 1.0)),
            self.min / (self.shape - 1.0) * (self.shape / (self.shape - 2.0)).sqrt(),
        )
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("shape", self.shape.into()), ("min", self.min.into())]
    }
}
