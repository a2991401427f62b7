//! Truncation of any distribution.

use super::error::bounds_to_si;
use super::family::{Family, Parameter};
use super::quadrature::{integral, moments};
use super::{Distribution, DistributionError};
use crate::quantity::Unit;

/// Below this probability between the bounds, probabilities of single values would leave the range of `f64`.
const LEAST_MASS: f64 = 1e-280;

/// A distribution on the condition that it lies between two bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Truncated {
    law: Box<Distribution>,
    min: f64,
    max: f64,
    /// Probability of the whole distribution below `min`.
    below: f64,
    /// Probability of the whole distribution above `max`.
    above: f64,
    /// Probability between the bounds.
    mass: f64,
    mean: f64,
    sd: f64,
}

impl Distribution {
    /// This distribution on the condition that it lies between `min` and `max`, both included; an infinite bound cuts nothing
    /// off. Parameters keep their meaning: they are those before truncation. Mean, standard deviation and quantiles of
    /// the result are those after it.
    ///
    /// Where a family stays itself (uniform, log-uniform, discrete, integer, empirical, histogram, mixture, Poisson; Pareto
    /// from below) the result is of that family; of a normal and a Gumbel distribution it is that of
    /// [`truncated_normal`](Self::truncated_normal) and [`truncated_gumbel`](Self::truncated_gumbel).
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
    /// If the bounds are not in order, next to nothing lies between them, the distribution has labels, or it has no
    /// finite variance even so.
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
            return Err(DistributionError::TruncationBounds { min, max });
        }
        if self.has_no_order() {
            return Err(DistributionError::NoOrder { distribution, what: "truncated" });
        }
        let (low, high) = self.support();
        if min <= low && high <= max {
            return self.clone().finite();
        }
        let bounds = (min.max(low), max.min(high));
        let nothing = DistributionError::NothingLeft { distribution, min, max };
        let is_single = matches!(self, Self::Discrete(_) | Self::Integer(_) | Self::Poisson(_) | Self::Empirical(_));
        if bounds.0 > bounds.1 || bounds.0 == bounds.1 && !is_single && !matches!(self, Self::Mixture(_)) {
            return Err(nothing);
        }
        let (min, max) = bounds;
        let of_mass = |made: Result<Self, DistributionError>| match made {
            Err(DistributionError::Truncation { .. } | DistributionError::GumbelTruncation { .. }) => {
                Err(nothing.clone())
            }
            made => made,
        };
        match self {
            Self::Uniform(_) => Self::uniform(min, max),
            Self::LogUniform(_) => Self::log_uniform(min, max),
            Self::Normal(normal) => of_mass(normal.between(min, max)),
            Self::TruncatedNormal(normal) => of_mass(normal.between(min, max)),
            Self::Gumbel(gumbel) => of_mass(gumbel.between(min, max)),
            Self::TruncatedGumbel(gumbel) => of_mass(gumbel.between(min, max)),
            Self::Discrete(discrete) => discrete.between(min, max),
            Self::Empirical(empirical) => empirical.between(min, max),
            Self::Integer(integer) => integer.between(min, max),
            Self::Poisson(poisson) => poisson.between(min, max),
            Self::Histogram(histogram) => histogram.between(min, max),
            Self::Mixture(mixture) => mixture.between(min, max),
            Self::Pareto(pareto) if max == f64::INFINITY => pareto.beginning_at(min),
            Self::Truncated(truncated) => truncated.law.truncated(min, max),
            law => {
                if let Self::StudentT(student) = law {
                    student.refuse_one_long_tail((min, max))?;
                }
                Self::Truncated(Truncated::new(law, (min, max)).ok_or(nothing)?).finite()
            }
        }
    }

    /// P(min <= X <= max), without the loss of digits by a difference from 1.
    pub(super) fn share_between(&self, min: f64, max: f64) -> f64 {
        let (below, above) = (self.tails(min.next_down()), self.tails(max));
        // Whichever sides of the bounds are small.
        if below.0 > 0.5 {
            below.1 - above.1
        } else if above.1 > 0.5 {
            above.0 - below.0
        } else {
            1.0 - below.0 - above.1
        }
    }
}

impl Truncated {
    fn new(law: &Distribution, (min, max): (f64, f64)) -> Option<Self> {
        let mass = law.share_between(min, max);
        if mass.is_nan() || mass < LEAST_MASS {
            return None;
        }
        let (below, above) = (law.tails(min).0, law.tails(max).1);
        let law = Box::new(law.clone());
        let mut truncated = Self { law, min, max, below, above, mass, mean: 0.0, sd: 0.0 };
        (truncated.mean, truncated.sd) = match &*truncated.law {
            Distribution::Triangular(triangular) => {
                // The density is linear on either side of the mode.
                let mode = triangular.mode().clamp(min, max);
                let over = |of: &dyn Fn(f64) -> f64| {
                    let part = |from: f64, to: f64| integral(from, to, |x| triangular.density(x) * of(x)) / mass;
                    part(min, mode) + part(mode, max)
                };
                let mean = mode + over(&|x| x - mode);
                (mean, over(&|x| (x - mean) * (x - mean)).sqrt())
            }
            _ => moments(|u, v| truncated.at(u, v), &[]),
        };
        Some(truncated)
    }

    pub(super) fn law(&self) -> &Distribution {
        &self.law
    }

    fn at(&self, u: f64, v: f64) -> f64 {
        if u <= 0.0 || v <= 0.0 {
            return if u <= 0.0 { self.min } else { self.max };
        }
        // The quadrature of the moments asks for less than a double can hold.
        let part = |beyond: f64, part: f64| (beyond + part * self.mass).max(f64::MIN_POSITIVE);
        let (lower, upper) = (part(self.below, u), part(self.above, v));
        let value = if lower < upper { self.law.quantile(lower) } else { self.law.upper_quantile(upper) };
        // Rounding may lead past a bound.
        value.clamp(self.min, self.max)
    }
}

impl Family for Truncated {
    fn name(&self) -> &'static str {
        self.law.name()
    }

    fn quantile(&self, u: f64) -> f64 {
        self.at(u, 1.0 - u)
    }

    fn upper_quantile(&self, v: f64) -> f64 {
        self.at(1.0 - v, v)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        if x < self.min {
            return (0.0, 1.0);
        }
        if x >= self.max {
            return (1.0, 0.0);
        }
        let (below, above) = (self.law.share_between(self.min, x), self.law.share_between(x, self.max));
        ((below / self.mass).clamp(0.0, 1.0), (above / self.mass).clamp(0.0, 1.0))
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sd(&self) -> f64 {
        self.sd
    }

    fn support(&self) -> (f64, f64) {
        (self.min, self.max)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        let mut parameters = self.law.parameters();
        parameters.push(("truncate", Parameter::Bounds(self.min, self.max)));
        parameters
    }

    fn to_si(&self, unit: &Unit) -> Result<Distribution, DistributionError> {
        let (min, max) = bounds_to_si((self.min, self.max), unit)?;
        self.law.in_si(unit)?.truncated(min, max)
    }
}
