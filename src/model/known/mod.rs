//! Functions with known indices, for trials and tests of the engine.
//!
//! One file per function or family; each states its formula, its source, its inputs and its exact mean, variance and
//! indices. To add one: a file with its value, its exact answer and its `ENTRY`; one line in [`KnownAnswer::all`].

mod borehole;
mod bratley;
mod exact;
mod flood;
mod function;
mod g_star;
mod ishigami;
mod linear;
mod minimum;
mod model;
mod morris;
mod oakley_ohagan;
mod otl_circuit;
mod parameters;
mod piston;
mod product;
mod simplex;
mod sobol_g;
mod sobol_levitan;
mod steps;
mod wing_weight;

use std::fmt;
use std::sync::Arc;

pub use exact::{Basis, Exact};
pub use function::KnownInput;
use function::{Made, Value};
use parameters::ParameterReader;
pub use parameters::{ParameterError, ParameterInfo, ParameterValue};

use apportion_base::quantity::Domain;

const ENTRIES: [&KnownAnswer; 17] = [
    &ishigami::ENTRY,
    &sobol_g::ENTRY,
    &g_star::ENTRY,
    &morris::ENTRY,
    &bratley::ENTRY,
    &oakley_ohagan::ENTRY,
    &sobol_levitan::ENTRY,
    &linear::ENTRY,
    &product::ENTRY,
    &minimum::ENTRY,
    &steps::ENTRY,
    &simplex::ENTRY,
    &flood::ENTRY,
    &borehole::ENTRY,
    &wing_weight::ENTRY,
    &otl_circuit::ENTRY,
    &piston::ENTRY,
];

/// A function of the list, before its parameters are chosen.
#[derive(Debug)]
pub struct KnownAnswer {
    /// The name in study files.
    pub name: &'static str,
    /// One line for people.
    pub description: &'static str,
    /// The formula of the value, in plain characters.
    pub formula: &'static str,
    /// The source of the function.
    pub source: &'static str,
    /// The parameters, in the order in which they are shown.
    pub parameters: &'static [ParameterInfo],
    build: fn(&mut ParameterReader<'_>) -> Result<Made, ParameterError>,
}

impl KnownAnswer {
    /// Iterates over all of them.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        ENTRIES.into_iter()
    }

    /// Returns the function of that name.
    pub fn from_name(name: &str) -> Option<&'static Self> {
        Self::all().find(|function| function.name == name)
    }

    /// Returns the function with these parameters, and its defaults for the others.
    ///
    /// ```
    /// use apportion::model::ParameterValue;
    /// use apportion::KnownAnswer;
    ///
    /// let g = KnownAnswer::from_name("sobol-g").ok_or("no such function")?;
    /// let g = g.with(&[("a".to_owned(), ParameterValue::List(vec![0.0, 1.0]))])?;
    /// assert_eq!(g.value(&[0.75, 1.0]), 1.5);
    /// let exact = g.exact();
    /// let indices = exact.indices.ok_or("a constant")?;
    /// assert!((indices.first_order[0] / indices.first_order[1] - 4.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ParameterError`] if the function has no such parameter, or the value is invalid.
    pub fn with(&'static self, parameters: &[(String, ParameterValue)]) -> Result<KnownFunction, ParameterError> {
        for (name, _) in parameters {
            if self.parameters.iter().all(|parameter| parameter.name != name) {
                return Err(ParameterError::unknown(name));
            }
        }
        let mut reader = ParameterReader::new(parameters);
        let Made { inputs, exact, value } = (self.build)(&mut reader)?;
        let domains = inputs.iter().enumerate().filter_map(|(number, input)| Some((number, input.domain?))).collect();
        let (inputs, parameters) = (inputs.into(), reader.in_force.into());
        Ok(KnownFunction { answer: self, inputs, domains, parameters, exact: exact.into(), value: value.into() })
    }

    /// Returns the function with its default parameters.
    ///
    /// # Panics
    /// Never: a test covers all of them.
    pub fn default_function(&'static self) -> KnownFunction {
        self.with(&[]).expect("the defaults make sense")
    }
}

/// A function with its parameters chosen. Cheap to clone.
#[derive(Clone)]
pub struct KnownFunction {
    /// Its entry in the list.
    pub answer: &'static KnownAnswer,
    inputs: Arc<[KnownInput]>,
    /// Those of the inputs that have one.
    domains: Arc<[(usize, Domain)]>,
    parameters: Arc<[(&'static str, ParameterValue)]>,
    exact: Arc<Exact>,
    value: Arc<Value>,
}

impl KnownFunction {
    /// Returns the inputs in order, each with the distribution for which the exact indices hold.
    pub fn inputs(&self) -> &[KnownInput] {
        &self.inputs
    }

    /// Returns the current parameters.
    pub fn parameters(&self) -> &[(&'static str, ParameterValue)] {
        &self.parameters
    }

    /// Returns the value at `x`, which has one entry per input; NaN if there is none.
    pub fn value(&self, x: &[f64]) -> f64 {
        self.checked_value(x).unwrap_or(f64::NAN)
    }

    /// Returns the value at `x`.
    ///
    /// # Errors
    /// Why there is none, if the function can tell.
    pub fn checked_value(&self, x: &[f64]) -> Result<f64, &'static str> {
        let are_inside = self.domains.iter().all(|(input, domain)| domain.contains(x[*input]));
        if are_inside { (self.value)(x) } else { Err("an input is not positive") }
    }

    /// Returns mean, variance and indices for independent inputs with their distributions.
    pub fn exact(&self) -> Exact {
        Exact::clone(&self.exact)
    }
}

impl PartialEq for KnownFunction {
    fn eq(&self, other: &Self) -> bool {
        self.answer.name == other.answer.name && self.parameters() == other.parameters()
    }
}

impl fmt::Debug for KnownFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct(self.answer.name).field("parameters", &self.parameters()).finish()
    }
}

#[cfg(test)]
mod tests;
