//! Mixtures of distributions.

use super::prelude::*;
use super::solve;

/// A value of one distribution or another, by chance.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture {
    components: Vec<Distribution>,
    weights: Vec<f64>,
    /// The weights of sum 1.
    shares: Vec<f64>,
}

impl Distribution {
    /// Each of `components` with a probability proportional to its weight; equal probabilities without `weights`.
    ///
    /// # Formula
    ///
    /// ```text
    /// F(x) = sum of w_i F_i(x),   mean = sum of w_i mean_i,   variance = sum of w_i (sd_i^2 + (mean_i - mean)^2)
    /// ```
    ///
    /// Quantiles are roots of F, to the last few digits; values that have a probability of their own (those of a constant,
    /// for instance) are met exactly.
    ///
    /// # Errors
    ///
    /// If there are no components, as many weights as components are not given, a weight is not finite or negative, all
    /// are 0, a component has labels, or moments overflow.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// // No rain on 60 % of the days.
    /// let rain = [Distribution::constant(0.0)?, Distribution::exponential(8.0, 0.0)?];
    /// let rain = Distribution::mixture(&rain, Some(&[0.6, 0.4]))?;
    /// assert_eq!((rain.median(), rain.mean()), (0.0, 3.2));
    /// assert!((rain.quantile(0.8) - 8.0 * 2f64.ln()).abs() < 1e-13);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn mixture(components: &[Self], weights: Option<&[f64]>) -> Result<Self, DistributionError> {
        if components.is_empty() {
            return Err(refused("components", "`components` is empty, but must hold at least one distribution"));
        }
        let weights = weights.map_or_else(|| vec![1.0; components.len()], <[f64]>::to_vec);
        let total = sum_of_weights(&weights, components.len(), "components")?;
        if let Some(labelled) = components.iter().find(|component| component.has_no_order()) {
            return Err(no_order(labelled.name(), "components", "a part of a mixture"));
        }
        let shares = weights.iter().map(|weight| weight / total).collect();
        Self::Mixture(Mixture { components: components.to_vec(), weights, shares }).finite()
    }
}

impl Mixture {
    /// The components that occur, with their probabilities.
    pub fn components(&self) -> impl Iterator<Item = (&Distribution, f64)> {
        self.components.iter().zip(self.shares.iter().copied()).filter(|(_, share)| *share > 0.0)
    }

    /// The mixture of what is left of each component between two bounds; `None` if nothing is.
    pub(super) fn between(&self, min: f64, max: f64) -> Result<Option<Distribution>, DistributionError> {
        let (mut components, mut weights) = (Vec::new(), Vec::new());
        for (component, share) in self.components() {
            let mass = component.share_between(min, max);
            match component.truncated(min, max) {
                Ok(left) if mass > 0.0 => {
                    components.push(left);
                    weights.push(share * mass);
                }
                Ok(_) | Err(DistributionError::NothingLeft { .. }) => (),
                Err(error) => return Err(error),
            }
        }
        match components.is_empty() {
            true => Ok(None),
            false => Distribution::mixture(&components, Some(&weights)).map(Some),
        }
    }

    fn expectation(&self, statistic: impl Fn(&Distribution) -> f64) -> f64 {
        self.components().map(|(component, share)| share * statistic(component)).sum()
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "mixture",
    summary: "A value of one distribution or another, by chance.",
    ways: &[keys(&["components"]).perhaps(&["weights"])],
    build: |given| match given.get("components") {
        Some(Parameter::Laws(components)) => Distribution::mixture(components, given.list_if("weights")),
        _ => Err(given.missing("`components`".to_owned())),
    },
    ..PLAIN
}];

impl Family for Mixture {
    fn at(&self, u: f64, v: f64) -> f64 {
        let (least, largest) = self.support();
        if u <= 0.0 || v <= 0.0 {
            return if u <= 0.0 { least } else { largest };
        }
        // Between the least and the largest of the components' own quantiles.
        let own = |component: &Distribution| if u <= v { component.quantile(u) } else { component.upper_quantile(v) };
        let ends = self.components().map(|(component, _)| own(component));
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        solve::quantile(u, v, (low, high), |x| self.tails(x))
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        self.components().fold((0.0, 0.0), |(below, above), (component, share)| {
            let (b, a) = component.tails(x);
            (below + share * b, above + share * a)
        })
    }

    fn mean(&self) -> f64 {
        self.expectation(Distribution::mean)
    }

    fn sd(&self) -> f64 {
        let mean = self.mean();
        self.expectation(|component| component.sd().powi(2) + (component.mean() - mean).powi(2)).sqrt()
    }

    fn support(&self) -> (f64, f64) {
        let ends = self.components().map(|(component, _)| component.support());
        ends.fold((f64::INFINITY, f64::NEG_INFINITY), |all, own| (all.0.min(own.0), all.1.max(own.1)))
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("weights", self.weights.as_slice().into()), ("components", Parameter::Laws(self.components.clone()))]
    }
}
