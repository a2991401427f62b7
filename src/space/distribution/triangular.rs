//! The triangular distribution.

use super::prelude::*;

/// A distribution whose density rises linearly from `min` to `mode` and falls linearly to `max`.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangular {
    min: f64,
    mode: f64,
    max: f64,
    width: f64,
    /// (mode - min) / width, the probability below the mode
    below: f64,
    /// (max - mode) / width
    above: f64,
}

impl Distribution {
    /// Returns the triangular distribution on [`min`, `max`] with its peak at `mode`.
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = min + sqrt(u (max - min) (mode - min))         where u <= (mode - min) / (max - min)
    ///             = max - sqrt((1 - u) (max - min) (max - mode))   above
    /// ```
    ///
    /// # Errors
    ///
    /// If a parameter is not finite, `min >= max`, their difference overflows, or `mode` is outside the bounds.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// assert_eq!(Distribution::triangular(0.0, 1.0, 4.0)?.quantile(0.25), 1.0);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn triangular(min: f64, mode: f64, max: f64) -> Result<Self, DistributionError> {
        let width = bounds(min, max, "triangular")?;
        let must = format!("lie between `min` ({min}) and `max` ({max})");
        number("mode", mode, (min..=max).contains(&mode), &must)?;
        let (below, above) = ((mode - min) / width, (max - mode) / width);
        Self::Triangular(Triangular { min, mode, max, width, below, above }).finite()
    }
}

impl Triangular {
    pub(super) fn mode(&self) -> f64 {
        self.mode
    }

    /// Returns the density at a value between the bounds.
    pub(super) fn density(&self, x: f64) -> f64 {
        let part = if x < self.mode { (x - self.min) / self.below } else { (self.max - x) / self.above };
        2.0 * part / self.width / self.width
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "triangular",
    summary: "The density rises from `min` to `mode`, and falls to `max`.",
    key_sets: &[keys(&["min", "mode", "max"]), two_quantiles_and(&["mode"])],
    shape: Shape::Mode,
    make: |given, [min, width, share]| {
        let max = min + width;
        let mode = given.number_or("mode", min + width * share);
        Distribution::triangular(min, mode.clamp(min, max), max)
    },
    build: |given| Distribution::triangular(given.number("min")?, given.number("mode")?, given.number("max")?),
    ..PLAIN
}];

impl Family for Triangular {
    fn quantile(&self, u: f64) -> f64 {
        // The two branches meet at the mode, which rounding must not exceed either.
        if u <= self.below {
            (self.min + self.width * (u * self.below).sqrt()).min(self.mode)
        } else {
            (self.max - self.width * ((1.0 - u) * self.above).sqrt()).max(self.mode)
        }
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let (low, high) = (((x - self.min) / self.width).max(0.0), ((self.max - x) / self.width).max(0.0));
        if x <= self.mode && self.below > 0.0 {
            let below = low * low / self.below;
            (below, 1.0 - below)
        } else {
            let above = if self.above > 0.0 { high * high / self.above } else { 0.0 };
            (1.0 - above, above)
        }
    }

    fn upper_quantile(&self, v: f64) -> f64 {
        if v >= self.above {
            return self.quantile(1.0 - v);
        }
        (self.max - self.width * (v * self.above).sqrt()).max(self.mode)
    }

    fn moments(&self) -> (f64, f64) {
        let (p, q) = (self.below, self.above);
        (self.min + self.width * ((1.0 + self.below) / 3.0), self.width * ((p * p + p * q + q * q) / 18.0).sqrt())
    }

    fn support(&self) -> (f64, f64) {
        (self.min, self.max)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("min", self.min.into()), ("mode", self.mode.into()), ("max", self.max.into())]
    }
}
