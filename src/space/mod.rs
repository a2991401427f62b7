//! Factor spaces: ordered, named factors, each a distribution with a unit, a nominal value and optionally a group.
//!
//! The order is part of the meaning: factor j takes coordinate j of the unit cube.

mod copula;
mod dependence;
pub mod distribution;

use std::sync::Arc;

pub(crate) use copula::{GaussianCopula, from_score, normal_scores};
pub use dependence::{CorrelationMeasure, Dependence, DependenceError};
pub use distribution::{Distribution, DistributionError};

use serde::{Deserialize, Serialize};

use apportion_base::names::named;
use apportion_base::quantity::Unit;

named! {
/// What has indices.
#[derive(Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum IndicesOf {
    /// Every factor, and the groups in addition.
    #[default]
    Factors = "factors",
    /// The groups in place of their factors, and each factor without a group: a base point then has the runs of so many
    /// factors.
    Groups = "groups",
}
}

/// One factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    /// The name, unique in its space.
    pub name: String,
    /// Its value when it does not vary, in its unit.
    pub nominal: f64,
    /// The group whose joint effect is estimated, if any.
    pub group: Option<String>,
    /// Whether the parameters of its distribution were solved for from other statements.
    pub determined: bool,
    unit: Unit,
    distribution: Distribution,
    /// The distribution in SI units, so that no value has to be converted during a run; `None` if each one is.
    si: Option<Distribution>,
}

impl Factor {
    /// Creates a factor in no group that varies by `distribution`, in `unit`, around its
    /// [`central`](Distribution::central) value.
    ///
    /// # Errors
    /// [`DistributionError`] if the distribution exceeds the range of doubles when converted to SI units.
    pub fn new(name: &str, unit: Unit, distribution: Distribution) -> Result<Self, DistributionError> {
        let si = (!distribution.is_converted_by_value()).then(|| distribution.to_si(&unit)).transpose()?;
        let nominal = distribution.central();
        Ok(Self { name: name.to_owned(), nominal, group: None, determined: false, unit, distribution, si })
    }

    /// Returns the unit of the distribution's parameters and of the nominal value.
    pub fn unit(&self) -> &Unit {
        &self.unit
    }

    /// Returns its distribution, in its unit.
    pub fn distribution(&self) -> &Distribution {
        &self.distribution
    }

    /// Returns whether it has a single value.
    pub fn is_constant(&self) -> bool {
        matches!(self.distribution, Distribution::Constant(_))
    }

    /// Formats `value`, which is in the factor's unit: the label of a category, otherwise the number by `number`.
    pub fn in_words(&self, value: f64, number: impl Fn(f64) -> String) -> String {
        self.distribution.label(value).map_or_else(|| number(value), str::to_owned)
    }

    /// Converts points of the unit interval to SI values, by the inverse of the distribution function. Both slices have
    /// one length; `u` is strictly between 0 and 1.
    ///
    /// # Panics
    /// If the slices have different lengths.
    pub fn fill_si(&self, u: &[f64], si: &mut [f64]) {
        match &self.si {
            Some(distribution) => distribution.fill(u, si),
            None => {
                self.distribution.fill(u, si);
                si.iter_mut().for_each(|value| *value = self.unit.to_si(*value));
            }
        }
    }
}

/// A group of factors whose joint effect is estimated.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Group {
    /// The name.
    pub name: String,
    /// Indices of its factors, ascending.
    pub factors: Vec<usize>,
}

/// The factors of a study, in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Space {
    factors: Vec<Factor>,
    dependences: Vec<Dependence>,
    copula: Option<Arc<GaussianCopula>>,
}

impl Space {
    /// Creates a space of these factors. Names are expected to be distinct.
    pub fn new(factors: Vec<Factor>) -> Self {
        Self { factors, dependences: Vec::new(), copula: None }
    }

    /// Adds dependences between the factors.
    ///
    /// # Errors
    /// [`DependenceError`] if they cannot depend on each other like that, with what is allowed.
    ///
    /// ```
    /// use apportion::{Dependence, Distribution, Factor, Space, Unit};
    ///
    /// let factor = |name: &str| Factor::new(name, Unit::dimensionless(), Distribution::uniform(0.0, 1.0)?);
    /// let space = Space::new(vec![factor("a")?, factor("b")?]).with_dependences(vec![Dependence::pair("a", "b", 0.6)])?;
    /// # let _ = space;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_dependences(self, dependences: Vec<Dependence>) -> Result<Self, DependenceError> {
        let copula = dependence::copula(&self, &dependences)?.map(Arc::new);
        Ok(Self { dependences, copula, ..self })
    }

    /// Returns the dependences as stated.
    pub fn dependences(&self) -> &[Dependence] {
        &self.dependences
    }

    /// Returns the copula of the factors; `None` if they are independent.
    pub(crate) fn copula(&self) -> Option<&Arc<GaussianCopula>> {
        self.copula.as_ref()
    }

    /// Returns the factors in order.
    pub fn factors(&self) -> &[Factor] {
        &self.factors
    }

    /// Returns the index of the factor that is the noise of a stochastic model (with seeds as values), if there is one.
    pub fn noise(&self) -> Option<usize> {
        self.factors.iter().position(|factor| factor.distribution.is_noise())
    }

    /// Returns the indices of the constants, in rising order.
    pub(crate) fn constants(&self) -> Vec<usize> {
        (0..self.factors.len()).filter(|&factor| self.factors[factor].is_constant()).collect()
    }

    /// Returns the groups in order of first appearance.
    pub fn groups(&self) -> Vec<Group> {
        let mut groups: Vec<Group> = Vec::new();
        for (number, factor) in self.factors.iter().enumerate() {
            let Some(name) = &factor.group else { continue };
            match groups.iter_mut().find(|group| group.name == *name) {
                Some(group) => group.factors.push(number),
                None => groups.push(Group { name: name.clone(), factors: vec![number] }),
            }
        }
        groups
    }

    /// Returns what has indices, in order of first appearance: factors as groups of one, or groups in place of their
    /// factors.
    pub fn members(&self, of: IndicesOf) -> Vec<Group> {
        let mut members: Vec<Group> = Vec::new();
        let groups = if of == IndicesOf::Groups { self.groups() } else { Vec::new() };
        for (number, factor) in self.factors.iter().enumerate() {
            match groups.iter().find(|group| group.factors.contains(&number)) {
                Some(group) if group.factors[0] == number => members.push(group.clone()),
                Some(_) => (),
                None => members.push(Group { name: factor.name.clone(), factors: vec![number] }),
            }
        }
        members
    }

    /// Returns a point of the unit cube as values in the units of the factors.
    pub fn values_at(&self, u: &[f64]) -> Vec<f64> {
        self.factors.iter().zip(u).map(|(factor, &u)| factor.distribution.quantile(u)).collect()
    }
}
