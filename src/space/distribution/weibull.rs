//! The Weibull distribution.

use super::prelude::*;

/// The distribution of strengths and lifetimes.
#[derive(Clone, Debug, PartialEq)]
pub struct Weibull {
    shape: f64,
    scale: f64,
    location: f64,
}

impl Distribution {
    /// Returns the Weibull distribution with shape `shape` and scale `scale`, beginning at `location` (usually 0).
    ///
    /// # Formula
    ///
    /// ```text
    /// F(x) = 1 - exp(-((x - location) / scale)^shape)
    /// quantile(u) = location + scale (-ln(1 - u))^(1 / shape)
    /// mean = location + scale Gamma(1 + 1 / shape)
    /// ```
    ///
    /// # Errors
    ///
    /// If `location` is not finite, `shape` or `scale` is not finite and positive, or values or moments overflow (for
    /// the standard deviation, at shapes below about 0.012).
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let exponential = Distribution::weibull(1.0, 2.0, 0.0)?;
    /// assert!((exponential.median() - 2.0 * 2f64.ln()).abs() < 1e-15);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn weibull(shape: f64, scale: f64, location: f64) -> Result<Self, DistributionError> {
        positive("shape", shape)?;
        positive("scale", scale)?;
        finite("location", location)?;
        Self::Weibull(Weibull { shape, scale, location }).finite()
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "weibull",
    summary: "Strengths and lifetimes.",
    key_sets: &[
        keys(&["shape", "scale"]).perhaps(&["location"]),
        MOMENTS.perhaps(&["location"]),
        TWO_QUANTILES.perhaps(&["location"]),
    ],
    shape: Shape::Between(1e4, 0.015, 500),
    make: |_, [location, scale, shape]| Distribution::weibull(shape, scale, location),
    defaults: &[("location", 0.0)],
    build: |given| Distribution::weibull(given.number("shape")?, given.number("scale")?, given.number("location")?),
    ..PLAIN
}];

impl Family for Weibull {
    fn quantile(&self, u: f64) -> f64 {
        self.location + self.scale * libm::pow(-libm::log1p(-u), 1.0 / self.shape)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let hazard = libm::pow((x - self.location).max(0.0) / self.scale, self.shape);
        (-libm::expm1(-hazard), libm::exp(-hazard))
    }

    fn upper_quantile(&self, v: f64) -> f64 {
        self.location + self.scale * libm::pow(-libm::log(v), 1.0 / self.shape)
    }

    fn moments(&self) -> (f64, f64) {
        (self.location + self.scale * libm::tgamma(1.0 + 1.0 / self.shape), self.scale * unit_sd(1.0 / self.shape))
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("shape", self.shape.into()), ("scale", self.scale.into()), ("location", self.location.into())]
    }
}

/// Returns the standard deviation at scale 1, `power` being 1 / shape.
fn unit_sd(power: f64) -> f64 {
    if power > 0.5 {
        let mean = libm::tgamma(1.0 + power);
        return mean * (libm::tgamma(1.0 + 2.0 * power) / mean / mean - 1.0).sqrt();
    }
    // The difference cancels as the shape grows. With x = exp(power t) and the density exp(t - exp(t)) of t, the
    // trapezoidal rule with step 1/4 is exact to 1e-16 (the integrand is analytic for |Im t| < pi / 2), and
    // expm1 keeps the small deviations from 1.
    let nodes = (-200..=16).map(|step| 0.25 * f64::from(step));
    let nodes: Vec<(f64, f64)> = nodes.map(|t| (0.25 * libm::exp(t - libm::exp(t)), libm::expm1(power * t))).collect();
    let mean: f64 = nodes.iter().map(|(weight, deviation)| weight * deviation).sum();
    nodes.iter().map(|(weight, deviation)| weight * ((deviation - mean) * (deviation - mean))).sum::<f64>().sqrt()
}
