//! Truncation of any distribution.

use std::f64::consts::FRAC_1_SQRT_2;

use libm::erf;

use super::gumbel::Gumbel;
use super::normal::Normal;
use super::prelude::*;
use super::quadrature::{integral, moments};
use apportion_base::quantity::Unit;
use apportion_base::special::{normal_below, normal_quantile, normal_quantile_near_median};

/// Below this probability between the bounds, probabilities of single values would exceed the range of `f64`.
const MIN_MASS: f64 = 1e-280;

/// A distribution conditional on being between two bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Truncated {
    law: Box<Distribution>,
    min: f64,
    max: f64,
    /// Probability below `min` before truncation.
    below: f64,
    /// Probability above `max` before truncation.
    above: f64,
    /// Probability between the bounds.
    mass: f64,
    quantiles: Quantiles,
    mean: f64,
    sd: f64,
}

/// How quantiles are computed.
#[derive(Clone, Debug, PartialEq)]
enum Quantiles {
    /// From the nearer tail.
    Tails,
    /// For a normal distribution, also from the centre: 2 P(0 < z < (min - mean) / sd), negative for `min` < mean.
    Normal { centre: f64 },
    /// For a Gumbel distribution, from -ln F(min), infinite if F(min) is 0, from -ln F(max), 0 if F(max) is 1, and from
    /// ln(F(max) / F(min)), computed from the width of the interval.
    Gumbel { log_min: f64, log_max: f64, ratio: f64 },
}

impl Distribution {
    /// Returns this distribution conditional on being between `min` and `max`, both included; an infinite bound has no
    /// effect. Parameters keep their meaning: they are those before truncation. Mean, standard deviation and quantiles
    /// of the result are those after it.
    ///
    /// If a family is closed under truncation (uniform, log-uniform, discrete, integer, empirical, histogram, mixture,
    /// Poisson; Pareto from below) the result is of that family.
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = F^-1(F(min) + u (F(max) - F(min)))
    /// ```
    ///
    /// computed from the nearer tail, so that bounds far out on one side keep all digits.
    ///
    /// # Errors
    ///
    /// If the bounds are not in order, almost no probability is between them, the distribution has labels, or it still
    /// has no finite variance.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let tail = Distribution::exponential(1.0, 0.0)?.truncated(100.0, f64::INFINITY)?;
    /// assert!((tail.median() - (100.0 + 2f64.ln())).abs() < 1e-13 && (tail.mean() - 101.0).abs() < 1e-12);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn truncated(&self, min: f64, max: f64) -> Result<Self, DistributionError> {
        let distribution = self.name();
        if min.is_nan() || max.is_nan() || min > max {
            let must = "must be two numbers, the lower one first; inf and -inf cut nothing off";
            return Err(refused("truncate", format!("`truncate` is [{min}, {max}], but {must}")));
        }
        if self.has_no_order() {
            return Err(no_order(distribution, "truncate", "truncated"));
        }
        let (low, high) = self.support();
        if min <= low && high <= max {
            return self.clone().finite();
        }
        if matches!(self, Self::Discrete(_) | Self::Empirical(_) | Self::Integer(_) | Self::Histogram(_))
            || self.counts().is_some()
        {
            let message =
                format!("`truncate` does not apply to the {distribution} distribution: leave out values outside");
            return Err(refused("truncate", message));
        }
        let (min, max) = (min.max(low), max.min(high));
        if min >= max {
            return Err(nothing_left(distribution, (min, max)));
        }
        match self {
            Self::Uniform(_) => Self::uniform(min, max),
            Self::LogUniform(_) => Self::log_uniform(min, max),
            Self::Truncated(truncated) => truncated.law.truncated(min, max),
            Self::Pareto(pareto) if max == f64::INFINITY => Self::pareto(pareto.shape, min),
            law => {
                if let Self::StudentT(student) = law {
                    student.refuse_one_long_tail((min, max))?;
                }
                let truncated = Truncated::new(law, (min, max));
                Self::Truncated(truncated.ok_or_else(|| nothing_left(distribution, (min, max)))?).finite()
            }
        }
    }

    /// Returns the normal distribution with mean `mean` and standard deviation `sd` *before* it is
    /// [`truncated`](Self::truncated).
    ///
    /// # Errors
    ///
    /// If a parameter is not finite, `sd <= 0`, `min >= max`, or the probability between the bounds is below 1e-280:
    /// both bounds more than about 35 sd from the mean on one side.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let tail = Distribution::truncated_normal(0.0, 1.0, 8.0, 9.0)?;
    /// assert!((tail.median() - 8.084888899018166).abs() < 1e-13);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn truncated_normal(mean: f64, sd: f64, min: f64, max: f64) -> Result<Self, DistributionError> {
        let normal = Normal::new(mean, sd)?;
        bounds(min, max, "truncated-normal")?;
        Self::Normal(normal).truncated(min, max)
    }

    /// Returns the Gumbel distribution of mode `location` and scale `scale` *before* it is
    /// [`truncated`](Self::truncated).
    ///
    /// # Errors
    ///
    /// If a parameter is not finite, `scale <= 0`, `min >= max`, or the probability between the bounds is below 1e-280:
    /// both bounds about 6 scales below or 640 scales above the location.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let flow = Distribution::truncated_gumbel(1013.0, 558.0, 500.0, 3000.0)?;
    /// assert!((flow.median() - 1261.1).abs() < 0.1);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn truncated_gumbel(location: f64, scale: f64, min: f64, max: f64) -> Result<Self, DistributionError> {
        let gumbel = Gumbel::new(location, scale)?;
        bounds(min, max, "truncated-gumbel")?;
        Self::Gumbel(gumbel).truncated(min, max)
    }

    /// Returns P(min <= X <= max), without the loss of digits by a difference from 1.
    pub(super) fn share_between(&self, min: f64, max: f64) -> f64 {
        let (below, above) = (self.tails(min.next_down()), self.tails(max));
        // By the tails that are small.
        if below.0 > 0.5 {
            below.1 - above.1
        } else if above.1 > 0.5 {
            above.0 - below.0
        } else {
            1.0 - below.0 - above.1
        }
    }
}

fn nothing_left(distribution: &str, (min, max): (f64, f64)) -> DistributionError {
    let message = format!(
        "truncation leaves nothing of this {distribution} distribution: almost none of its values lie between {min} \
         and {max}"
    );
    refused("truncate", message)
}

impl Normal {
    /// Returns P(min < X < max): the difference of two tails or of two central parts, whichever loses no digits.
    fn share_between(&self, min: f64, max: f64) -> f64 {
        let [a, b] = [min, max].map(|x| (x - self.mean) / self.sd);
        if a > 0.5 {
            normal_below(-a) - normal_below(-b)
        } else if b < -0.5 {
            normal_below(b) - normal_below(a)
        } else {
            0.5 * (erf(b * FRAC_1_SQRT_2) - erf(a * FRAC_1_SQRT_2))
        }
    }
}

impl Gumbel {
    /// Returns -ln F(min), -ln F(max) and ln(F(max) / F(min)).
    fn logs(&self, min: f64, max: f64) -> (f64, f64, f64) {
        let [log_min, log_max] = [min, max].map(|bound| libm::exp(-(bound - self.location) / self.scale));
        let width = (max - min) / self.scale;
        // exp(-a) - exp(-b) without cancellation; if exp(-a) overflows, F(min) is 0.
        let ratio = if log_min.is_finite() { log_min * -libm::expm1(-width) } else { f64::INFINITY };
        (log_min, log_max, ratio)
    }
}

impl Truncated {
    fn new(law: &Distribution, (min, max): (f64, f64)) -> Option<Self> {
        let mass = share(law, min, max);
        // NaN if the bounds are one number at the scale of the distribution.
        if mass.is_nan() || mass < MIN_MASS {
            return None;
        }
        let quantiles = match law {
            Distribution::Normal(Normal { mean, sd }) => {
                Quantiles::Normal { centre: erf((min - mean) / sd * FRAC_1_SQRT_2) }
            }
            Distribution::Gumbel(gumbel) => {
                let (log_min, log_max, ratio) = gumbel.logs(min, max);
                Quantiles::Gumbel { log_min, log_max, ratio }
            }
            _ => Quantiles::Tails,
        };
        let (below, above) = (law.tails(min).0, law.tails(max).1);
        let law = Box::new(law.clone());
        let mut truncated = Self { law, min, max, below, above, mass, quantiles, mean: 0.0, sd: 0.0 };
        (truncated.mean, truncated.sd) = truncated.integrated();
        Some(truncated)
    }

    /// Returns the distribution before truncation.
    pub fn law(&self) -> &Distribution {
        &self.law
    }

    /// Computes mean and standard deviation by quadrature: formulas cancel if the bounds are far out or close together.
    fn integrated(&self) -> (f64, f64) {
        let Self { min, max, mass, .. } = *self;
        match &*self.law {
            Distribution::Triangular(triangular) => {
                // The density is linear on either side of the mode.
                let mode = triangular.mode().clamp(min, max);
                let sides = [(min, mode), (mode, max)];
                let [below, above] =
                    sides.map(|(from, to)| integral(from, to, |x| triangular.density(x) * (x - mode)) / mass);
                let mean = mode + (below + above);
                let [below, above] = sides
                    .map(|(from, to)| integral(from, to, |x| triangular.density(x) * ((x - mean) * (x - mean))) / mass);
                (mean, (below + above).sqrt())
            }
            // Where a density has fallen below exp(-45) of its maximum, it is negligible.
            Distribution::Normal(Normal { mean, sd }) => {
                let mode = mean.clamp(min, max);
                let z = (mode - mean) / sd;
                let reach = 90.0 / (z.abs() + (z * z + 90.0).sqrt());
                self.moments_around(mode, *sd, (-reach, reach), |t| libm::exp(-t * (0.5 * t + z)))
            }
            Distribution::Gumbel(Gumbel { location, scale }) => {
                let mode = location.clamp(min, max);
                let log = libm::exp(-((mode - location) / scale));
                let reach = (-libm::log1p(45.0 / log), 46.0);
                self.moments_around(mode, *scale, reach, |t| libm::exp(-t - log * libm::expm1(-t)))
            }
            _ => moments(|u, v| self.at(u, v)),
        }
    }

    /// Computes mean and standard deviation by the density of (x - mode) / scale, within `reach` of it.
    fn moments_around(&self, mode: f64, scale: f64, reach: (f64, f64), density: impl Fn(f64) -> f64) -> (f64, f64) {
        let (from, to) = (((self.min - mode) / scale).max(reach.0), ((self.max - mode) / scale).min(reach.1));
        let mass = integral(from, to, &density);
        let mean = integral(from, to, |t| t * density(t)) / mass;
        let variance = integral(from, to, |t| (t - mean) * (t - mean) * density(t)) / mass;
        (mode + scale * mean, scale * variance.sqrt())
    }
}

/// Returns the probability of `law` between two bounds.
fn share(law: &Distribution, min: f64, max: f64) -> f64 {
    match law {
        Distribution::Normal(normal) => normal.share_between(min, max),
        Distribution::Gumbel(gumbel) => {
            let (_, log_max, ratio) = gumbel.logs(min, max);
            libm::exp(-log_max) * -libm::expm1(-ratio)
        }
        law => law.share_between(min, max),
    }
}

/// The short forms of a normal and a Gumbel distribution with `truncate`.
pub(super) const ENTRIES: &[Entry] = &[
    Entry {
        name: "truncated-normal",
        summary: "Normal between two bounds; mean and standard deviation are those before truncation.",
        key_sets: &[keys(&["mean", "sd", "min", "max"])],
        build: |given| {
            let (mean, sd) = (given.number("mean")?, given.number("sd")?);
            Distribution::truncated_normal(mean, sd, given.number("min")?, given.number("max")?)
        },
        ..PLAIN
    },
    Entry {
        name: "truncated-gumbel",
        summary: "Gumbel between two bounds; location and scale are those before truncation.",
        key_sets: &[keys(&["location", "scale", "min", "max"])],
        build: |given| {
            let (location, scale) = (given.number("location")?, given.number("scale")?);
            Distribution::truncated_gumbel(location, scale, given.number("min")?, given.number("max")?)
        },
        ..PLAIN
    },
];

impl Family for Truncated {
    fn name(&self, default: &'static str) -> &'static str {
        match &*self.law {
            Distribution::Normal(_) => default,
            Distribution::Gumbel(_) => ENTRIES[1].name,
            law => law.name(),
        }
    }

    fn at(&self, u: f64, v: f64) -> f64 {
        let Self { min, max, below, above, mass, .. } = *self;
        if u <= 0.0 || v <= 0.0 {
            return if u <= 0.0 { min } else { max };
        }
        let value = match (&self.quantiles, &*self.law) {
            (Quantiles::Normal { centre }, Distribution::Normal(Normal { mean, sd })) => {
                // From the tail or the centre, where the probability has the most digits.
                let (lower, upper) = (below + u * mass, above + v * mass);
                let z = if lower < 0.25 {
                    normal_quantile(lower)
                } else if upper < 0.25 {
                    -normal_quantile(upper)
                } else {
                    normal_quantile_near_median(0.5 * centre + u * mass)
                };
                mean + sd * z
            }
            (Quantiles::Gumbel { log_min, log_max, ratio }, Distribution::Gumbel(Gumbel { location, scale })) => {
                // -ln F as a share of that of `min`, lost on the way up; overflows only where F(min) is far below u.
                let fall = libm::log1p(u * libm::expm1(*ratio)) / log_min;
                if fall < 0.5 {
                    min - scale * libm::log1p(-fall)
                } else {
                    // -ln (F / F(max)), a positive number like -ln F(max), so that their sum keeps its digits.
                    let above = match u < 0.5 {
                        true => -libm::log(u + v * libm::exp(-ratio)),
                        false => -libm::log1p(v * libm::expm1(-ratio)),
                    };
                    match above < *log_max {
                        true => max - scale * libm::log1p(above / log_max),
                        false => location - scale * libm::log(log_max + above),
                    }
                }
            }
            (_, law) => {
                // The quadrature of the moments uses probabilities smaller than a double can represent.
                let lower = (below + u * mass).max(f64::MIN_POSITIVE);
                let upper = (above + v * mass).max(f64::MIN_POSITIVE);
                if lower < upper { law.quantile(lower) } else { law.upper_quantile(upper) }
            }
        };
        // Rounding may exceed a bound by an ulp.
        value.clamp(min, max)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        if x < self.min || x >= self.max {
            return if x < self.min { (0.0, 1.0) } else { (1.0, 0.0) };
        }
        let [below, above] = [(self.min, x), (x, self.max)].map(|(from, to)| share(&self.law, from, to) / self.mass);
        (below.clamp(0.0, 1.0), above.clamp(0.0, 1.0))
    }

    fn moments(&self) -> (f64, f64) {
        (self.mean, self.sd)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        let mut parameters = self.law.parameters();
        match self.quantiles {
            Quantiles::Tails => parameters.push(("truncate", Parameter::Bounds(self.min, self.max))),
            _ => {
                let bounds = [("min", self.min), ("max", self.max)].into_iter().filter(|(_, bound)| bound.is_finite());
                parameters.extend(bounds.map(|(key, bound)| (key, bound.into())));
            }
        }
        parameters
    }

    fn in_si(&self, _: &'static Entry, unit: &Unit) -> Result<Distribution, DistributionError> {
        let (min, max) = bounds_to_si((self.min, self.max), unit)?;
        self.law.in_si(unit)?.truncated(min, max)
    }
}
