//! The normal distribution between two bounds.

use std::f64::consts::FRAC_1_SQRT_2;

use libm::erf;

use super::error::{bounds, bounds_to_si, finite, positive};
use super::family::{Family, Parameter};
use super::quadrature::integral;
use super::{Distribution, DistributionError};
use crate::quantity::Unit;
use crate::special::{normal_below, normal_quantile, normal_quantile_beside_median};

/// Below this probability between the bounds, probabilities of single values would leave the range of `f64`.
const LEAST_MASS: f64 = 1e-280;

/// A normal distribution on the condition that it lies between two bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct TruncatedNormal {
    /// Before truncation.
    mean: f64,
    /// Before truncation.
    sd: f64,
    min: f64,
    max: f64,
    /// Probability of the untruncated distribution below `min`.
    below: f64,
    /// Probability of the untruncated distribution above `max`.
    above: f64,
    /// 2 P(0 < z < (min - mean) / sd), negative if `min` is below the mean.
    centre: f64,
    /// Probability between the bounds.
    mass: f64,
}

/// P(a < Z < b) of the standard normal distribution: the difference of two tails on one side, or of two central parts,
/// whichever loses no digits.
fn between(a: f64, b: f64) -> f64 {
    if a > 0.5 {
        normal_below(-a) - normal_below(-b)
    } else if b < -0.5 {
        normal_below(b) - normal_below(a)
    } else {
        0.5 * (erf(b * FRAC_1_SQRT_2) - erf(a * FRAC_1_SQRT_2))
    }
}

impl Distribution {
    /// Normal with mean `mean` and standard deviation `sd` *before* it is truncated to [`min`, `max`].
    ///
    /// [`mean`](Self::mean) and [`sd`](Self::sd) of the result are those after truncation.
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = mean + sd Phi^-1(Phi(a) + u (Phi(b) - Phi(a))),   a = (min - mean) / sd, b = (max - mean) / sd
    /// ```
    ///
    /// computed from the nearer tail, so that bounds far out on one side keep all digits.
    ///
    /// # Errors
    ///
    /// If a parameter is not finite, `sd <= 0`, `min >= max`, or the probability between the bounds is below
    /// 1e-280: both bounds beyond some 35 sd from the mean on one side.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let tail = Distribution::truncated_normal(0.0, 1.0, 8.0, 9.0)?;
    /// assert!((tail.median() - 8.084888899018166).abs() < 1e-13);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn truncated_normal(mean: f64, sd: f64, min: f64, max: f64) -> Result<Self, DistributionError> {
        finite("mean", mean)?;
        positive("sd", sd)?;
        bounds(min, max, "truncated-normal")?;
        Self::normal_between(mean, sd, (min, max))
    }

    /// The same with bounds of which one or both may be infinite.
    pub(super) fn normal_between(mean: f64, sd: f64, (min, max): (f64, f64)) -> Result<Self, DistributionError> {
        let (a, b) = ((min - mean) / sd, (max - mean) / sd);
        let mass = between(a, b);
        // Also refused when the bounds are one number as seen from the mean, or overflow.
        if mass.is_nan() || mass < LEAST_MASS {
            return Err(DistributionError::Truncation { mean, sd, min, max });
        }
        let (below, above, centre) = (normal_below(a), normal_below(-b), erf(a * FRAC_1_SQRT_2));
        Self::TruncatedNormal(TruncatedNormal { mean, sd, min, max, below, above, centre, mass }).finite()
    }
}

impl TruncatedNormal {
    pub(super) fn between(&self, min: f64, max: f64) -> Result<Distribution, DistributionError> {
        Distribution::normal_between(self.mean, self.sd, (min, max))
    }

    /// The standardised value at `u`, from the tail or the centre where the probability has the most digits.
    fn standardised(&self, u: f64) -> f64 {
        let lower = self.below + u * self.mass;
        if lower < 0.25 {
            return normal_quantile(lower);
        }
        let upper = self.above + (1.0 - u) * self.mass;
        if upper < 0.25 {
            return -normal_quantile(upper);
        }
        normal_quantile_beside_median(0.5 * self.centre + u * self.mass)
    }

    /// The value of highest density, and mean and standard deviation relative to it.
    ///
    /// By quadrature: the formulas with the densities at the bounds cancel where those are far out or close together.
    fn moments(&self) -> (f64, f64, f64) {
        let mode = self.mean.clamp(self.min, self.max);
        let z = (mode - self.mean) / self.sd;
        // Where the density has fallen below exp(-45) of its maximum, nothing is left.
        let reach = 90.0 / (z.abs() + (z * z + 90.0).sqrt());
        let from = ((self.min - mode) / self.sd).max(-reach);
        let to = ((self.max - mode) / self.sd).min(reach);
        let density = |t: f64| libm::exp(-t * (0.5 * t + z));
        let mass = integral(from, to, density);
        let mean = integral(from, to, |t| t * density(t)) / mass;
        let variance = integral(from, to, |t| (t - mean) * (t - mean) * density(t)) / mass;
        (mode, self.sd * mean, self.sd * variance.sqrt())
    }
}

impl Family for TruncatedNormal {
    fn name(&self) -> &'static str {
        "truncated-normal"
    }

    fn quantile(&self, u: f64) -> f64 {
        // Rounding may lead an ulp past a bound.
        (self.mean + self.sd * self.standardised(u)).clamp(self.min, self.max)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let part = |from: f64, to: f64| {
            let [from, to] = [from, to].map(|x| (x.clamp(self.min, self.max) - self.mean) / self.sd);
            (between(from, to) / self.mass).clamp(0.0, 1.0)
        };
        (part(self.min, x), part(x, self.max))
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
        let all = [("mean", self.mean), ("sd", self.sd), ("min", self.min), ("max", self.max)];
        all.into_iter().filter(|(_, value)| value.is_finite()).map(|(name, value)| (name, value.into())).collect()
    }

    fn to_si(&self, unit: &Unit) -> Result<Distribution, DistributionError> {
        let mean = finite("mean", unit.to_si(self.mean))?;
        let sd = positive("sd", unit.span_to_si(self.sd))?;
        Distribution::normal_between(mean, sd, bounds_to_si((self.min, self.max), unit)?)
    }
}
