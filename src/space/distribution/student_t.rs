//! Student's t distribution.

use super::beta::{Side, tails_of_sides};
use super::prelude::*;

/// Degrees of freedom outside are refused: fewer have no practical meaning, with more it is a normal distribution.
const DEGREES: (f64, f64) = (0.01, 2e5);

/// With fewer degrees of freedom, the part of a single tail beyond the smallest probabilities affects the moments.
const MIN_DF_OF_ONE_TAIL: f64 = 2.1;

/// A symmetric distribution with tails that fall by a power: means of few measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct StudentT {
    df: f64,
    location: f64,
    scale: f64,
    /// I_x(df / 2, 1 / 2) at x = df / (df + t^2), the probability of both tails beyond t, on either side of its split.
    tails: Side,
    middle: Side,
}

impl Distribution {
    /// Returns Student's t distribution with `df` degrees of freedom, shifted to `location` and scaled by `scale`.
    ///
    /// # Formula
    ///
    /// ```text
    /// P(|t| > z) = I_x(df / 2, 1 / 2),   x = df / (df + z^2),   value = location + scale t
    /// mean = location,   sd = scale sqrt(df / (df - 2))
    /// ```
    ///
    /// with `I` the regularised incomplete beta function (Abramowitz and Stegun 1964, 26.7.1), inverted as for
    /// [`beta`](Self::beta).
    ///
    /// # Errors
    ///
    /// If `df` is outside [0.01, 2e5] or at most 2 (where there is no variance), `location` is not finite, `scale` is
    /// not finite and positive, or values overflow.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let mean = Distribution::student_t(4.0, 10.0, 0.5)?;
    /// assert!((mean.quantile(0.975) - (10.0 + 0.5 * 2.7764451051977987)).abs() < 1e-14);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn student_t(df: f64, location: f64, scale: f64) -> Result<Self, DistributionError> {
        Self::StudentT(StudentT::new(df, location, scale)?).finite()
    }
}

impl StudentT {
    /// Allows any degrees of freedom; at most 2 of them need two bounds.
    pub(crate) fn new(df: f64, location: f64, scale: f64) -> Result<Self, DistributionError> {
        within("df", df, DEGREES)?;
        finite("location", location)?;
        positive("scale", scale)?;
        let (tails, middle) = (Side::new(df / 2.0, 0.5), Side::new(0.5, df / 2.0));
        Ok(Self { df, location, scale, tails, middle })
    }

    /// Does the same for the part between the bounds of a truncation.
    pub(super) fn refuse_one_long_tail(&self, (min, max): (f64, f64)) -> Result<(), DistributionError> {
        let least = if min.is_finite() && max.is_finite() { 0.0 } else { MIN_DF_OF_ONE_TAIL };
        of_finite_variance("df", self.df, least)
    }

    /// Returns the t beyond which the probability is `tail`, at most 1/2, on one side; `rest` is 1/2 - `tail`.
    fn beyond(&self, tail: f64, rest: f64) -> f64 {
        if tail <= 0.0 {
            return f64::INFINITY;
        }
        if rest <= 0.0 {
            return 0.0;
        }
        let (x, y) = if 2.0 * tail <= self.tails.mass {
            self.tails.solve(2.0 * tail)
        } else {
            let (y, x) = self.middle.solve(2.0 * rest);
            (x, y)
        };
        (self.df * (y / x)).sqrt()
    }

    /// Returns the distance from the location of the value with the share `tail`, or the rest, on one side.
    fn deviation(&self, tail: f64) -> f64 {
        self.scale * self.beyond(tail.min(1.0 - tail), (tail - 0.5).abs()).copysign(0.5 - tail)
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "student-t",
    summary: "Symmetric, with tails that fall by a power.",
    key_sets: &[keys(&["df", "location", "scale"]), solved_keys(&["df", "mean", "sd"]), two_quantiles_and(&["df"])],
    shape: Shape::Given("df"),
    make: |_, [location, scale, df]| Distribution::student_t(df, location, scale),
    defaults: &[("location", 0.0), ("scale", 1.0)],
    build: |given| {
        let (df, location) = (given.number("df")?, given.number("location")?);
        StudentT::new(df, location, given.number("scale")?).map(Distribution::StudentT)
    },
    ..PLAIN
}];

impl Family for StudentT {
    fn refuse_infinite_variance(&self) -> Result<(), DistributionError> {
        of_finite_variance("df", self.df, 2.0)
    }

    fn quantile(&self, u: f64) -> f64 {
        self.location - self.deviation(u)
    }

    fn upper_quantile(&self, v: f64) -> f64 {
        self.location + self.deviation(v)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let z = (x - self.location) / self.scale;
        let square = z * z / self.df;
        let (both, _) = tails_of_sides(&self.tails, &self.middle, (1.0 / (1.0 + square), 1.0 / (1.0 + 1.0 / square)));
        let tail = 0.5 * both;
        if z < 0.0 { (tail, 1.0 - tail) } else { (1.0 - tail, tail) }
    }

    fn moments(&self) -> (f64, f64) {
        (self.location, self.scale * (self.df / (self.df - 2.0)).sqrt())
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("df", self.df.into()), ("location", self.location.into()), ("scale", self.scale.into())]
    }
}
