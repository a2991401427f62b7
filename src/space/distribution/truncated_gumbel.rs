//! The Gumbel distribution of maxima, truncated.

use super::error::{bounds, bounds_to_si, finite, positive};
use super::family::{Family, Parameter};
use super::quadrature::integral;
use super::{Distribution, DistributionError};
use crate::quantity::Unit;

/// Below this probability between the bounds, probabilities of single values would leave the range of `f64`.
const LEAST_MASS: f64 = 1e-280;

/// A Gumbel distribution on the condition that it lies between two bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct TruncatedGumbel {
    /// Before truncation.
    location: f64,
    /// Before truncation.
    scale: f64,
    min: f64,
    max: f64,
    /// -ln F(min); infinite where F(min) is 0.
    log_min: f64,
    /// -ln F(max); 0 where F(max) is 1.
    log_max: f64,
    /// ln (F(max) / F(min)), from the width of the interval.
    ratio: f64,
}

impl Distribution {
    /// Gumbel of maximum type with mode `location` and scale `scale` *before* it is truncated to [`min`, `max`].
    ///
    /// [`mean`](Self::mean) and [`sd`](Self::sd) of the result are those after truncation.
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = location - scale ln(-ln(F(min) + u (F(max) - F(min)))),   F(x) = exp(-exp(-(x - location) / scale))
    /// ```
    ///
    /// computed from the nearer bound where that keeps more digits.
    ///
    /// # Errors
    ///
    /// If a parameter is not finite, `scale <= 0`, `min >= max`, or the probability between the bounds is below 1e-280:
    /// both bounds some 6 scales below or 640 scales above the location.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let flow = Distribution::truncated_gumbel(1013.0, 558.0, 500.0, 3000.0)?;
    /// assert!((flow.median() - 1261.1).abs() < 0.1);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn truncated_gumbel(location: f64, scale: f64, min: f64, max: f64) -> Result<Self, DistributionError> {
        finite("location", location)?;
        positive("scale", scale)?;
        bounds(min, max, "truncated-gumbel")?;
        Self::gumbel_between(location, scale, (min, max))
    }

    /// The same with bounds of which one or both may be infinite.
    pub(super) fn gumbel_between(location: f64, scale: f64, (min, max): (f64, f64)) -> Result<Self, DistributionError> {
        let width = (max - min) / scale;
        let [log_min, log_max] = [min, max].map(|bound| libm::exp(-(bound - location) / scale));
        // exp(-a) - exp(-b), which cancels nothing; where exp(-a) overflows, F(min) is 0.
        let ratio = if log_min.is_finite() { log_min * -libm::expm1(-width) } else { f64::INFINITY };
        let mass = libm::exp(-log_max) * -libm::expm1(-ratio);
        // Also refused when the bounds are one number as seen from the location.
        if mass.is_nan() || mass < LEAST_MASS {
            return Err(DistributionError::GumbelTruncation { location, scale, min, max });
        }
        Self::TruncatedGumbel(TruncatedGumbel { location, scale, min, max, log_min, log_max, ratio }).finite()
    }
}

impl TruncatedGumbel {
    pub(super) fn between(&self, min: f64, max: f64) -> Result<Distribution, DistributionError> {
        Distribution::gumbel_between(self.location, self.scale, (min, max))
    }

    /// The value of highest density, and mean and standard deviation relative to it, by quadrature.
    fn moments(&self) -> (f64, f64, f64) {
        let mode = self.location.clamp(self.min, self.max);
        let z = (mode - self.location) / self.scale;
        let log = libm::exp(-z);
        // Where the density has fallen below exp(-45) of its maximum, nothing is left.
        let from = ((self.min - mode) / self.scale).max(-libm::log1p(45.0 / log));
        let to = ((self.max - mode) / self.scale).min(46.0);
        let density = |t: f64| libm::exp(-t - log * libm::expm1(-t));
        let mass = integral(from, to, density);
        let mean = integral(from, to, |t| t * density(t)) / mass;
        let variance = integral(from, to, |t| (t - mean) * (t - mean) * density(t)) / mass;
        (mode, self.scale * mean, self.scale * variance.sqrt())
    }
}

impl Family for TruncatedGumbel {
    fn name(&self) -> &'static str {
        "truncated-gumbel"
    }

    fn quantile(&self, u: f64) -> f64 {
        // -ln F as a share of that of `min`, lost on the way up; overflows only where F(min) is far below u.
        let fall = libm::log1p(u * libm::expm1(self.ratio)) / self.log_min;
        let value = if fall < 0.5 {
            self.min - self.scale * libm::log1p(-fall)
        } else {
            // -ln (F / F(max)), a positive number like -ln F(max), so that their sum keeps its digits.
            let rest = libm::exp(-self.ratio);
            let above = if u < 0.5 {
                -libm::log(u + (1.0 - u) * rest)
            } else {
                -libm::log1p((1.0 - u) * libm::expm1(-self.ratio))
            };
            if above < self.log_max {
                self.max - self.scale * libm::log1p(above / self.log_max)
            } else {
                self.location - self.scale * libm::log(self.log_max + above)
            }
        };
        // Rounding may lead an ulp past a bound.
        value.clamp(self.min, self.max)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        // P(from < X < to) before truncation, as the mass is found.
        let between = |from: f64, to: f64| {
            let [log_from, log_to] = [from, to].map(|bound| libm::exp(-(bound - self.location) / self.scale));
            let width = (to - from) / self.scale;
            let ratio = if log_from.is_finite() { log_from * -libm::expm1(-width) } else { f64::INFINITY };
            libm::exp(-log_to) * -libm::expm1(-ratio)
        };
        let (x, mass) = (x.clamp(self.min, self.max), between(self.min, self.max));
        ((between(self.min, x) / mass).min(1.0), (between(x, self.max) / mass).min(1.0))
    }

    fn mean(&self) -> f64 {
        let (mode, mean, _) = self.moments();
        mode + mean
    }

    fn sd(&self) -> f64 {
        let (_, _, sd) = self.moments();
        sd
    }

    fn support(&self) -> (f64, f64) {
        (self.min, self.max)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        let Self { location, scale, min, max, .. } = *self;
        let all = [("location", location), ("scale", scale), ("min", min), ("max", max)];
        all.into_iter().filter(|(_, value)| value.is_finite()).map(|(name, value)| (name, value.into())).collect()
    }

    fn to_si(&self, unit: &Unit) -> Result<Distribution, DistributionError> {
        let location = finite("location", unit.to_si(self.location))?;
        let scale = positive("scale", unit.span_to_si(self.scale))?;
        Distribution::gumbel_between(location, scale, bounds_to_si((self.min, self.max), unit)?)
    }
}
