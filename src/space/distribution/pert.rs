//! The PERT distribution, for ranges that experts state.

use super::prelude::*;

/// A beta distribution stated by its bounds and its mode.
#[derive(Clone, Debug, PartialEq)]
pub struct Pert {
    mode: f64,
    law: Box<Distribution>,
}

impl Distribution {
    /// Returns the PERT distribution on [`min`, `max`] with its peak at `mode`: smooth, and less spread towards the bounds
    /// than the [`triangular`](Self::triangular) one (Malcolm, Roseboom, Clark and Fazar 1959, Oper. Res. 7, 646-669).
    ///
    /// # Formula
    ///
    /// The [`beta`](Self::beta) distribution on these bounds with
    ///
    /// ```text
    /// alpha = 1 + 4 (mode - min) / (max - min),   beta = 1 + 4 (max - mode) / (max - min)
    /// mean = (min + 4 mode + max) / 6
    /// ```
    ///
    /// # Errors
    ///
    /// If a parameter is not finite, `min >= max`, their difference overflows, or `mode` is outside the bounds.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// assert_eq!(Distribution::pert(0.0, 1.0, 8.0)?.mean(), 2.0);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn pert(min: f64, mode: f64, max: f64) -> Result<Self, DistributionError> {
        let width = bounds(min, max, "pert")?;
        let must = format!("lie between `min` ({min}) and `max` ({max})");
        number("mode", mode, (min..=max).contains(&mode), &must)?;
        let [alpha, beta] = [mode - min, max - mode].map(|part| 1.0 + 4.0 * part / width);
        let law = Box::new(Self::beta(alpha, beta, min, max)?);
        Self::Pert(Pert { mode, law }).finite()
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "pert",
    summary: "Like a triangular distribution, but smooth: experts' lowest, most likely and highest value.",
    key_sets: &[keys(&["min", "mode", "max"])],
    build: |given| Distribution::pert(given.number("min")?, given.number("mode")?, given.number("max")?),
    ..PLAIN
}];

impl Family for Pert {
    fn at(&self, u: f64, v: f64) -> f64 {
        self.law.family().at(u, v)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        self.law.tails(x)
    }

    fn moments(&self) -> (f64, f64) {
        (self.law.mean(), self.law.sd())
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        let (min, max) = self.support();
        vec![("min", min.into()), ("mode", self.mode.into()), ("max", max.into())]
    }
}
