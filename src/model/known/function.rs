//! The parts that functions with known indices are made of.

use super::Exact;
use crate::space::{Distribution, DistributionError};
use apportion_base::quantity::Domain;

/// An input of a function.
///
/// Inputs are dimensionless. Those of the engineering functions are quantities in the units of their papers, given in
/// the description: the constants of the formulas hold only for these, and some of the units (ohms, kelvins, feet) are
/// not among those of [`apportion_base::quantity`].
#[derive(Debug, Clone, PartialEq)]
pub struct KnownInput {
    /// Its name in study files: the symbol of the paper.
    pub name: String,
    /// Its meaning, with its unit if it has one.
    pub description: String,
    /// The domain of the function; `None` for any finite number.
    pub domain: Option<Domain>,
    /// The distribution for which the exact indices hold.
    pub distribution: Distribution,
}

/// The value at a point with one entry per input, all in their domains; or a sentence without a full stop that says why
/// there is none. Does not allocate.
pub(super) type Value = dyn Fn(&[f64]) -> Result<f64, &'static str> + Send + Sync;

/// A function of independent inputs with its mean, variance and indices, built from its parameters.
pub(super) struct Made {
    pub inputs: Vec<KnownInput>,
    pub exact: Exact,
    pub value: Box<Value>,
}

impl Made {
    /// Of a function that has a value wherever its inputs are in their domains.
    pub fn new(inputs: Vec<KnownInput>, exact: Exact, value: impl Fn(&[f64]) -> f64 + Send + Sync + 'static) -> Self {
        Self { inputs, exact, value: Box::new(move |x| Ok(value(x))) }
    }
}

/// Returns inputs x1 to xd of one distribution.
pub(super) fn alike(count: usize, description: &str, distribution: &Distribution) -> Vec<KnownInput> {
    let (description, domain, distribution) = (description.to_owned(), None, distribution.clone());
    let first = KnownInput { name: String::new(), description, domain, distribution };
    (1..=count).map(|number| KnownInput { name: format!("x{number}"), ..first.clone() }).collect()
}

/// Returns inputs x1 to xd, uniform on (0, 1).
pub(super) fn unit_cube(count: usize) -> Vec<KnownInput> {
    alike(count, "uniform on (0, 1)", &uniform(0.0, 1.0))
}

/// Returns an input that must be greater than 0.
pub(super) fn positive(name: &str, description: &str, distribution: Distribution) -> KnownInput {
    let (name, description) = (name.to_owned(), description.to_owned());
    KnownInput { name, description, domain: Some(Domain::Positive), distribution }
}

/// Returns a distribution whose parameters are constants of the program.
///
/// # Panics
/// If they are invalid.
pub(super) fn constant(distribution: Result<Distribution, DistributionError>) -> Distribution {
    distribution.expect("valid constants")
}

pub(super) fn uniform(min: f64, max: f64) -> Distribution {
    constant(Distribution::uniform(min, max))
}

pub(super) fn triangular(min: f64, mode: f64, max: f64) -> Distribution {
    constant(Distribution::triangular(min, mode, max))
}
