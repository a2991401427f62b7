//! What a function with known indices has to tell.

use super::Exact;
use crate::quantity::Domain;
use crate::space::Distribution;

/// An input of a function.
///
/// Inputs are pure numbers. Those of the engineering functions stand for quantities in the units that their papers use,
/// which the description names: the constants of the formulas hold for these alone, and some of the units (ohms,
/// kelvins, feet) are not among those of [`crate::quantity`].
#[derive(Debug, Clone, PartialEq)]
pub struct KnownInput {
    /// Its name in study files: the symbol of the paper.
    pub name: String,
    /// What it is, with its unit if it has one.
    pub description: String,
    /// Where the function is defined; `None` for any finite number.
    pub domain: Option<Domain>,
    /// The distribution for which the exact indices hold.
    pub distribution: Distribution,
}

/// A function of independent inputs whose mean, variance and indices are known.
pub trait Function: Send + Sync {
    /// The value at `x`, which has one entry per input; NaN where there is none. Allocates nothing.
    fn value(&self, x: &[f64]) -> f64;

    /// Why there is no value at `x`, where the function can say so: a sentence without a full stop.
    fn reason(&self, _x: &[f64]) -> Option<&'static str> {
        None
    }

    /// Mean, variance and indices.
    fn exact(&self) -> Exact;
}

/// A function with its inputs, as its entry makes it of its parameters.
pub(super) struct Made {
    pub inputs: Vec<KnownInput>,
    pub function: Box<dyn Function>,
}

impl Made {
    pub fn new(inputs: Vec<KnownInput>, function: impl Function + 'static) -> Self {
        Self { inputs, function: Box::new(function) }
    }
}

/// Inputs x1 to xd of one distribution.
pub(super) fn alike(count: usize, description: &str, distribution: &Distribution) -> Vec<KnownInput> {
    let input = |number| KnownInput {
        name: format!("x{number}"),
        description: description.to_owned(),
        domain: None,
        distribution: distribution.clone(),
    };
    (1..=count).map(input).collect()
}

/// Inputs x1 to xd, uniform on (0, 1).
pub(super) fn unit_cube(count: usize) -> Vec<KnownInput> {
    alike(count, "uniform on (0, 1)", &uniform(0.0, 1.0))
}

/// An input that has to be greater than 0.
pub(super) fn positive(name: &str, description: &str, distribution: Distribution) -> KnownInput {
    let (name, description) = (name.to_owned(), description.to_owned());
    KnownInput { name, description, domain: Some(Domain::Positive), distribution }
}

/// A uniform distribution between two constants of the program.
///
/// # Panics
/// If they are not in order.
pub(super) fn uniform(min: f64, max: f64) -> Distribution {
    Distribution::uniform(min, max).expect("bounds in order")
}

/// Whether every entry is finite and greater than 0.
pub(super) fn all_positive(x: &[f64]) -> bool {
    x.iter().all(|&x| x > 0.0 && x < f64::INFINITY)
}
