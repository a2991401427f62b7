//! The beta distribution.
//!
//! The quantile is solved here instead of by statrs 0.19, whose `inv_beta_reg` stops at an absolute 1e-17 (at alpha =
//! 0.01, beta = 50 a quantile in the middle is off by 8 %) and takes up to 13 us.

use super::prelude::*;
use super::solve::{halley, parabola};
use apportion_base::special::beta_fraction;

/// Shapes outside are refused: the continued fraction would need thousands of terms, or all values are at a bound.
const SHAPES: (f64, f64) = (1e-3, 1e5);

/// The beta distribution between two bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Beta {
    alpha: f64,
    beta: f64,
    min: f64,
    max: f64,
    width: f64,
    lower: Side,
    upper: Side,
}

impl Distribution {
    /// Returns the beta distribution with shapes `alpha` and `beta`, scaled from [0, 1] to [`min`, `max`].
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = min + (max - min) x   where   I_x(alpha, beta) = u
    /// mean = min + (max - min) alpha / (alpha + beta)
    /// ```
    ///
    /// with `I` the regularised incomplete beta function.
    ///
    /// # Errors
    ///
    /// If a shape lies outside [1e-3, 1e5], a bound is not finite, `min >= max`, or their difference overflows.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let beta = Distribution::beta(2.0, 2.0, 10.0, 20.0)?;
    /// assert!((beta.median() - 15.0).abs() < 1e-14);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn beta(alpha: f64, beta: f64, min: f64, max: f64) -> Result<Self, DistributionError> {
        within("alpha", alpha, SHAPES)?;
        within("beta", beta, SHAPES)?;
        let width = bounds(min, max, "beta")?;
        let (lower, upper) = (Side::new(alpha, beta), Side::new(beta, alpha));
        Self::Beta(Beta { alpha, beta, min, max, width, lower, upper }).finite()
    }

    /// Returns the beta distribution on [`min`, `max`] with this mean and standard deviation.
    ///
    /// # Formula
    ///
    /// With the mean m and the variance v on [0, 1]: alpha = c m and beta = c (1 - m), where c = m (1 - m)/v - 1.
    ///
    /// # Errors
    ///
    /// As for [`beta`](Self::beta), and if no beta distribution has that mean and standard deviation.
    pub fn beta_of_mean(mean: f64, sd: f64, min: f64, max: f64) -> Result<Self, DistributionError> {
        let width = bounds(min, max, "beta")?;
        let (m, spread) = ((finite("mean", mean)? - min) / width, positive("sd", sd)? / width);
        let c = m * (1.0 - m) / (spread * spread) - 1.0;
        if c.is_nan() || c <= 0.0 {
            return Err(no_such_distribution("beta", &format!("mean = {mean} and sd = {sd}"), "mean"));
        }
        Self::beta(c * m, c * (1.0 - m), min, max)
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "beta",
    summary: "The beta distribution between two bounds.",
    key_sets: &[keys(&["alpha", "beta", "min", "max"]), keys(&["mean", "sd", "min", "max"])],
    defaults: &[("min", 0.0), ("max", 1.0)],
    build: |given| {
        let (min, max) = (given.number("min")?, given.number("max")?);
        match given.number_if("alpha") {
            Some(alpha) => Distribution::beta(alpha, given.number("beta")?, min, max),
            None => Distribution::beta_of_mean(given.number("mean")?, given.number("sd")?, min, max),
        }
    },
    ..PLAIN
}];

impl Family for Beta {
    fn at(&self, u: f64, v: f64) -> f64 {
        if u <= 0.0 || u > self.lower.mass && v <= 0.0 {
            return if u <= 0.0 { self.min } else { self.max };
        }
        let (x, y) = if u <= self.lower.mass {
            self.lower.solve(u)
        } else {
            let (y, x) = self.upper.solve(v);
            (x, y)
        };
        let value = if x < y { self.min + self.width * x } else { self.max - self.width * y };
        // Rounding may exceed a bound by an ulp.
        value.clamp(self.min, self.max)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let (x, y) = ((x - self.min) / self.width, (self.max - x) / self.width);
        if x <= 0.0 {
            (0.0, 1.0)
        } else if y <= 0.0 {
            (1.0, 0.0)
        } else {
            tails_of_sides(&self.lower, &self.upper, (x, y))
        }
    }

    fn moments(&self) -> (f64, f64) {
        let sum = self.alpha + self.beta;
        (
            self.min + self.width * (self.alpha / (self.alpha + self.beta)),
            self.width * (self.alpha * self.beta / (sum + 1.0)).sqrt() / sum,
        )
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![
            ("alpha", self.alpha.into()),
            ("beta", self.beta.into()),
            ("min", self.min.into()),
            ("max", self.max.into()),
        ]
    }
}

/// The distribution function on one side of the split x_s = (a + 1) / (a + b + 2), where its continued fraction
/// converges fast. The other side is the same with a and b exchanged.
///
/// ```text
/// I_x(a, b) = x^a y^b c(x) / (a B(a, b)),   y = 1 - x,   c(x) the continued fraction
/// ```
///
/// The sum of both sides is 1 at the split, which gives B(a, b) without gamma functions, and a continuous distribution
/// function there. In terms of d, the distance from the split in the logit ln(x / y), the derivative of ln I is r = a /
/// c, its logarithm has the derivative a y - b x - r, and ln I is concave: Halley's iteration for ln I = ln p converges
/// from the left of the root, and never leaves it for long.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Side {
    a: f64,
    b: f64,
    /// x at the split.
    x: f64,
    /// 1 - x at the split.
    y: f64,
    /// Probability on this side.
    pub mass: f64,
    ln_mass: f64,
    /// Continued fraction at the split.
    fraction: f64,
}

impl Side {
    pub fn new(a: f64, b: f64) -> Self {
        let sum = a + b + 2.0;
        let (x, y) = ((a + 1.0) / sum, (b + 1.0) / sum);
        let fraction = beta_fraction(x, a, b, f64::EPSILON);
        let (here, there) = (fraction / a, beta_fraction(y, b, a, f64::EPSILON) / b);
        let mass = here / (here + there);
        Self { a, b, x, y, mass, ln_mass: libm::log(mass), fraction }
    }

    /// Returns x and 1 - x at which the probability below x is `p`, at most that of this side.
    pub fn solve(&self, p: f64) -> (f64, f64) {
        let (d, _) = self.distance(p);
        self.point(d)
    }

    /// Returns the probability below `x`, on this side of the split; `y` is 1 - x.
    fn below(&self, (x, y): (f64, f64)) -> f64 {
        let d = libm::log(x / y) - libm::log(self.x / self.y);
        let growth = libm::log1p(self.x * libm::expm1(d));
        let fraction = beta_fraction(x, self.a, self.b, f64::EPSILON);
        libm::exp(self.ln_mass + self.a * d - (self.a + self.b) * growth + libm::log(fraction / self.fraction))
    }

    /// Returns the distance d of the solution, and the number of steps.
    fn distance(&self, p: f64) -> (f64, u32) {
        let target = libm::log(p) - self.ln_mass;
        halley(self.start(target), (f64::NEG_INFINITY, 0.0), |d| {
            let (x, y) = self.point(d);
            let fraction = beta_fraction(x, self.a, self.b, f64::EPSILON);
            // ln(y_s / y)
            let growth = libm::log1p(self.x * libm::expm1(d));
            let residual = self.a * d - (self.a + self.b) * growth + libm::log(fraction / self.fraction) - target;
            let slope = self.a / fraction;
            (residual, slope, self.a * y - self.b * x - slope)
        })
    }

    /// Returns a first guess of d: the greater root of the tangent at minus infinity (which is left of the solution)
    /// and of the parabola at the split.
    fn start(&self, target: f64) -> f64 {
        let slope = self.a / self.fraction;
        let curvature = slope * (slope + self.b * self.x - self.a * self.y);
        let tangent = (target + libm::log(self.fraction) + (self.a + self.b) * libm::log(self.y)) / self.a;
        tangent.max(parabola(slope, curvature, target)).min(0.0)
    }

    /// Returns x and 1 - x at the distance d from the split.
    fn point(&self, d: f64) -> (f64, f64) {
        let ratio = libm::exp(d);
        let sum = self.y + self.x * ratio;
        (self.x * ratio / sum, self.y / sum)
    }
}

/// Returns the probabilities below and above `x`, `y` being 1 - x, from the two sides of one distribution.
pub(super) fn tails_of_sides(lower: &Side, upper: &Side, (x, y): (f64, f64)) -> (f64, f64) {
    if x / y <= lower.x / lower.y {
        let below = lower.below((x, y)).min(1.0);
        (below, 1.0 - below)
    } else {
        let above = upper.below((y, x)).min(1.0);
        (1.0 - above, above)
    }
}

#[cfg(test)]
#[path = "tests/beta.rs"]
mod tests;
