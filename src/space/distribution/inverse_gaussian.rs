//! The inverse Gaussian distribution.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use libm::erfc;

use super::prelude::*;
use super::quadrature::short_integral;
use super::solve;
use crate::special::normal_below;

/// Ratios of `scale` to `mean` beyond are refused: scatter of 1e6 means, or of a millionth of one.
const RATIOS: (f64, f64) = (1e-12, 1e12);

/// First passage times of a drifting random walk; positive and skewed.
#[derive(Clone, Debug, PartialEq)]
pub struct InverseGaussian {
    mean: f64,
    scale: f64,
    /// scale / mean
    ratio: f64,
}

impl Distribution {
    /// Inverse Gaussian (Wald) with mean `mean` and scale `scale`, the lambda of textbooks, in the unit of the mean.
    ///
    /// # Formula
    ///
    /// ```text
    /// F(x) = Phi(s (x / mean - 1)) + exp(2 scale / mean) Phi(-s (x / mean + 1)),   s = sqrt(scale / x)
    /// sd = mean sqrt(mean / scale)
    /// ```
    ///
    /// (Johnson, Kotz and Balakrishnan 1994, Continuous Univariate Distributions 1, chapter 15), with scaled complementary
    /// error functions in the place of the exponential, which would overflow, and of the difference in the upper tail.
    ///
    /// # Errors
    ///
    /// If a parameter is not finite and positive, `scale` is not between 1e-12 and 1e12 means, or values overflow.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let passage = Distribution::inverse_gaussian(2.0, 8.0)?;
    /// assert_eq!((passage.mean(), passage.sd()), (2.0, 1.0));
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn inverse_gaussian(mean: f64, scale: f64) -> Result<Self, DistributionError> {
        positive("mean", mean)?;
        positive("scale", scale)?;
        let ratio = scale / mean;
        within("scale / mean", ratio, RATIOS)?;
        Self::InverseGaussian(InverseGaussian { mean, scale, ratio }).finite()
    }
}

impl InverseGaussian {
    /// P(X <= x mean) and P(X > x mean).
    fn tails_at(&self, x: f64) -> (f64, f64) {
        let root = (self.ratio / x).sqrt();
        let (t, w) = (root * (x - 1.0), root * (x + 1.0));
        // Phi(-w) exp(2 ratio), since w^2 = t^2 + 4 ratio.
        let density = 0.5 * libm::exp(-0.5 * t * t);
        if t <= 0.0 {
            let below = normal_below(t) + density * scaled(w);
            if below <= 0.5 {
                return (below, 1.0 - below);
            }
        }
        // From the derivative of `scaled`, where the difference would cancel.
        let difference = match root < 0.125 {
            true => short_integral((root * x, root), |s| (2.0 / PI).sqrt() - s * scaled(s)),
            false => scaled(t) - scaled(w),
        };
        let above = density * difference;
        (1.0 - above, above)
    }
}

/// exp(t^2 / 2) erfc(t / sqrt(2)), for t above -30.
fn scaled(t: f64) -> f64 {
    // Past it the square loses digits that the exponential would show; the continued fraction (Abramowitz and Stegun 1964,
    // 26.2.14) needs 26 terms there, and ever fewer.
    const FAR: f64 = 6.0;
    if t < FAR {
        return libm::exp(0.5 * t * t) * erfc(t * FRAC_1_SQRT_2);
    }
    let terms = (8.0 + 660.0 / (t * t)) as u32;
    let fraction = (1..=terms).rev().map(f64::from).fold(t, |rest, n| t + n / rest);
    (2.0 / PI).sqrt() / fraction
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "inverse-gaussian",
    summary: "First passage times of a drifting random walk.",
    ways: &[keys(&["mean", "scale"]), MOMENTS, TWO_QUANTILES],
    of_ratios: true,
    shape: Shape::Between(1e-5, 1e5, 300),
    make: |_, [_, mean, variation]| Distribution::inverse_gaussian(mean, mean / (variation * variation)),
    build: |given| Distribution::inverse_gaussian(given.number("mean")?, given.number("scale")?),
    ..PLAIN
}];

impl Family for InverseGaussian {
    fn at(&self, u: f64, v: f64) -> f64 {
        if u <= 0.0 {
            return 0.0;
        }
        if v <= 0.0 {
            return f64::INFINITY;
        }
        // exp(-ratio / (2 x)) below and exp(-ratio x / 2 + ratio) above bound the tails, down to the smallest double.
        let ends = (self.ratio.min(1.0) / 2000.0, 4.0 + 2000.0 / self.ratio);
        self.mean * solve::quantile(u, v, ends, |x| self.tails_at(x))
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        if x <= 0.0 { (0.0, 1.0) } else { self.tails_at(x / self.mean) }
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sd(&self) -> f64 {
        self.mean / self.ratio.sqrt()
    }

    fn support(&self) -> (f64, f64) {
        (0.0, f64::INFINITY)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("mean", self.mean.into()), ("scale", self.scale.into())]
    }
}
