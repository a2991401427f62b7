//! The interface of a function with known indices.

use super::Exact;
use crate::quantity::Domain;
use crate::space::Distribution;

/// An input of a function.
///
/// Inputs are dimensionless. Those of the engineering functions are quantities in the units of their papers, given in
/// the description: the constants of the formulas hold only for these, and some of the units (ohms, kelvins, feet) are
/// not among those of [`crate::quantity`].
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

/// A function of independent inputs whose mean, variance and indices are known.
pub trait Function: Send + Sync {
    /// Returns the value at `x`, which has one entry per input; NaN if there is none. Does not allocate.
    fn value(&self, x: &[f64]) -> f64;

    /// Returns why there is no value at `x`, if the function can tell: a sentence without a full stop.
    fn reason(&self, _x: &[f64]) -> Option<&'static str> {
        None
    }

    /// Returns mean, variance and indices.
    fn exact(&self) -> Exact;
}

/// A function with its inputs, built from its parameters.
pub(super) struct Made {
    pub inputs: Vec<KnownInput>,
    pub function: Box<dyn Function>,
}

impl Made {
    pub fn new(inputs: Vec<KnownInput>, function: impl Function + 'static) -> Self {
        Self { inputs, function: Box::new(function) }
    }
}

/// Returns inputs x1 to xd of one distribution.
pub(super) fn alike(count: usize, description: &str, distribution: &Distribution) -> Vec<KnownInput> {
    let input = |number| KnownInput {
        name: format!("x{number}"),
        description: description.to_owned(),
        domain: None,
        distribution: distribution.clone(),
    };
    (1..=count).map(input).collect()
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

/// Returns a uniform distribution between two constants of the program.
///
/// # Panics
/// If they are not in order.
pub(super) fn uniform(min: f64, max: f64) -> Distribution {
    Distribution::uniform(min, max).expect("bounds in order")
}

/// Returns whether every entry is finite and greater than 0.
pub(super) fn all_positive(x: &[f64]) -> bool {
    x.iter().all(|&x| x > 0.0 && x < f64::INFINITY)
}
