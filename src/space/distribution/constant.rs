//! The constant.

use super::prelude::*;

/// One value with certainty.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    value: f64,
}

impl Distribution {
    /// Returns the distribution that is always `value`.
    ///
    /// # Errors
    ///
    /// If `value` is not finite.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// assert_eq!(Distribution::constant(3.0)?.sd(), 0.0);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn constant(value: f64) -> Result<Self, DistributionError> {
        Ok(Self::Constant(Constant { value: finite("value", value)? }))
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "constant",
    summary: "One value with certainty.",
    key_sets: &[keys(&["value"])],
    build: |given| Distribution::constant(given.number("value")?),
    ..PLAIN
}];

impl Family for Constant {
    fn quantile(&self, _u: f64) -> f64 {
        self.value
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        if x < self.value { (0.0, 1.0) } else { (1.0, 0.0) }
    }

    fn moments(&self) -> (f64, f64) {
        (self.value, 0.0)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("value", self.value.into())]
    }
}
