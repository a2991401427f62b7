//! The gamma distribution.
//!
//! The quantile is solved here instead of by statrs 0.19, whose gamma quantiles are wrong in the lower tail.

use super::prelude::*;
use super::solve::{halley, parabola};
use apportion_base::special::away_from_zero;

/// Shapes outside are refused: the series would need thousands of terms, or all values are next to 0.
const SHAPES: (f64, f64) = (1e-3, 1e5);

/// The distribution of sums of waiting times, and of positive quantities of moderate scatter.
#[derive(Clone, Debug, PartialEq)]
pub struct Gamma {
    shape: f64,
    scale: f64,
    location: f64,
    split: Split,
}

impl Distribution {
    /// Returns the gamma distribution with shape `shape` and scale `scale`, beginning at `location` (usually 0).
    ///
    /// # Formula
    ///
    /// ```text
    /// F(x) = P(shape, (x - location) / scale)
    /// mean = location + shape scale,   sd = scale sqrt(shape)
    /// ```
    ///
    /// with `P` the regularised incomplete gamma function.
    ///
    /// # Errors
    ///
    /// If `shape` lies outside [1e-3, 1e5], `scale` is not finite and positive, `location` is not finite, or values
    /// overflow.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let gamma = Distribution::gamma(2.0, 3.0, 0.0)?;
    /// // By P(2, x) = 1 - (1 + x) exp(-x).
    /// let x = gamma.quantile(0.3) / 3.0;
    /// assert!((1.0 - (1.0 + x) * (-x).exp() - 0.3).abs() < 1e-15);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn gamma(shape: f64, scale: f64, location: f64) -> Result<Self, DistributionError> {
        within("shape", shape, SHAPES)?;
        positive("scale", scale)?;
        finite("location", location)?;
        Self::Gamma(Gamma { shape, scale, location, split: Split::new(shape) }).finite()
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "gamma",
    summary: "Sums of waiting times, and positive quantities of moderate scatter.",
    key_sets: &[
        keys(&["shape", "scale"]).perhaps(&["location"]),
        MOMENTS.perhaps(&["location"]),
        TWO_QUANTILES.perhaps(&["location"]),
    ],
    shape: Shape::Between(1e5, 1e-3, 300),
    make: |_, [location, scale, shape]| Distribution::gamma(shape, scale, location),
    defaults: &[("location", 0.0)],
    build: |given| Distribution::gamma(given.number("shape")?, given.number("scale")?, given.number("location")?),
    ..PLAIN
}];

impl Family for Gamma {
    fn at(&self, u: f64, v: f64) -> f64 {
        self.location + self.scale * self.split.solve(u, v)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        self.split.tails((x - self.location) / self.scale)
    }

    fn moments(&self) -> (f64, f64) {
        (self.location + self.shape * self.scale, self.scale * self.shape.sqrt())
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("shape", self.shape.into()), ("scale", self.scale.into()), ("location", self.location.into())]
    }
}

/// The incomplete gamma functions on either side of x_s = a + 1, below which the series of P converges fast, and above
/// which the continued fraction of Q.
///
/// ```text
/// P(a, x) = x^a e^-x S(x) / Gamma(a + 1),   Q(a, x) = x^a e^-x a C(x) / Gamma(a + 1)
/// ```
///
/// Their sum is 1 at x_s, which gives them without gamma functions, and a continuous distribution function there. In
/// terms of d = ln(x / x_s) both logarithms are concave, with the slopes a / S and -1 / C, and Halley's iteration never
/// leaves the root for long.
#[derive(Clone, Debug, PartialEq)]
struct Split {
    a: f64,
    x: f64,
    /// P and Q there.
    below: f64,
    above: f64,
    series: f64,
    fraction: f64,
}

impl Split {
    fn new(a: f64) -> Self {
        let x = a + 1.0;
        let (series, fraction) = (series(a, x), continued_fraction(a, x));
        let sum = series + a * fraction;
        Self { a, x, below: series / sum, above: a * fraction / sum, series, fraction }
    }

    /// Returns x with P(a, x) = `u`, `v` being 1 - u.
    fn solve(&self, u: f64, v: f64) -> f64 {
        if u <= 0.0 {
            0.0
        } else if v <= 0.0 {
            f64::INFINITY
        } else if u <= self.below {
            self.x * libm::exp(self.lower(libm::log(u / self.below)))
        } else {
            self.x * libm::exp(self.upper(libm::log(v / self.above)))
        }
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        if x <= 0.0 {
            return (0.0, 1.0);
        }
        let common = self.a * libm::log(x / self.x) - (x - self.x);
        if x <= self.x {
            let below = self.below * libm::exp(common + libm::log(series(self.a, x) / self.series));
            (below, 1.0 - below)
        } else {
            let above = self.above * libm::exp(common + libm::log(continued_fraction(self.a, x) / self.fraction));
            (1.0 - above, above)
        }
    }

    /// Returns the d at which ln P has risen by `target` from the split, which is not positive.
    fn lower(&self, target: f64) -> f64 {
        // The greater root of the tangent at minus infinity (which is left of the solution) and of the parabola at the
        // split.
        let slope = self.a / self.series;
        let parabola = parabola(slope, slope * (slope + self.x - self.a), target);
        let tangent = (target + libm::log(self.series) - self.x) / self.a;
        self.distance(tangent.max(parabola).min(0.0), target, (f64::NEG_INFINITY, 0.0), |x| {
            let series = series(self.a, x);
            (libm::log(series / self.series), self.a / series)
        })
    }

    /// Returns the d at which ln Q has risen by `target` from the split, which is not positive.
    fn upper(&self, target: f64) -> f64 {
        // The smaller root of the parabola at the split and of an exponential of the slowest fall.
        let slope = 1.0 / self.fraction;
        let parabola = -parabola(slope, slope * (slope + self.a - self.x), target);
        let exponential = libm::log1p(-target / (self.x * (slope / self.x).min(1.0)));
        self.distance(exponential.min(parabola).max(0.0), target, (0.0, f64::INFINITY), |x| {
            let fraction = continued_fraction(self.a, x);
            (libm::log(fraction / self.fraction), -1.0 / fraction)
        })
    }

    /// Returns the d between two bounds at which the logarithm of P or Q has risen by `target`, from a first guess;
    /// `side` returns the series or fraction over its value at the split, and the slope.
    fn distance(&self, start: f64, target: f64, bounds: (f64, f64), side: impl Fn(f64) -> (f64, f64)) -> f64 {
        let (d, _) = halley(start, bounds, |d| {
            let x = self.x * libm::exp(d);
            let (log, slope) = side(x);
            (self.a * d - self.x * libm::expm1(d) + log - target, slope, self.a - x - slope)
        });
        d
    }
}

/// Returns S(x) = 1 + x / (a + 1) + x^2 / ((a + 1) (a + 2)) + ... (Abramowitz and Stegun 1964, 6.5.29).
fn series(a: f64, x: f64) -> f64 {
    const TERMS: u32 = 5000;
    let (mut term, mut sum) = (1.0, 1.0);
    for n in (1..=TERMS).map(f64::from) {
        term *= x / (a + n);
        sum += term;
        if term < 0.25 * f64::EPSILON * sum {
            break;
        }
    }
    sum
}

/// Returns C(x) = 1 / (x + 1 - a - 1 (1 - a) / (x + 3 - a - 2 (2 - a) / (x + 5 - a - ...))), the continued fraction
/// 6.5.31 of Abramowitz and Stegun 1964 in its even form, by the modified Lentz algorithm (Press et al. 2007, Numerical
/// Recipes, section 6.2).
fn continued_fraction(a: f64, x: f64) -> f64 {
    const TERMS: u32 = 5000;
    let mut b = x + 1.0 - a;
    let mut c = 1.0 / 1e-300;
    let mut d = away_from_zero(b).recip();
    let mut fraction = d;
    for n in (1..=TERMS).map(f64::from) {
        let numerator = -n * (n - a);
        b += 2.0;
        d = away_from_zero(numerator * d + b).recip();
        c = away_from_zero(b + numerator / c);
        let change = c * d;
        fraction *= change;
        if (change - 1.0).abs() < f64::EPSILON {
            break;
        }
    }
    fraction
}
