//! Functions with known indices, for trials and tests of the engine.
//!
//! One file per function or family; each states its formula, its source, its inputs and its exact mean, variance and
//! indices. To add one: a file with a struct, its [`Function`] and its `Entry`; one line in [`KnownAnswer::all`].

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

pub use exact::{Basis, Exact, ExactIndices};
use function::Made;
pub use function::{Function, KnownInput};
pub use model::{known_inputs, known_model, known_output};
use parameters::Given;
pub use parameters::{MAX_INPUTS, ParameterError, ParameterInfo, ParameterValue};

/// An entry of the list of functions.
#[derive(Debug)]
struct Entry {
    name: &'static str,
    summary: &'static str,
    formula: &'static str,
    source: &'static str,
    parameters: &'static [ParameterInfo],
    build: fn(&mut Given<'_>) -> Result<Made, ParameterError>,
}

const ENTRIES: [&Entry; 17] = [
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
#[derive(Clone, Copy, Debug)]
pub struct KnownAnswer(&'static Entry);

impl KnownAnswer {
    /// Iterates over all of them.
    pub fn all() -> impl Iterator<Item = Self> {
        ENTRIES.into_iter().map(Self)
    }

    /// Returns the function of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().find(|function| function.name() == name)
    }

    /// Returns the name in study files.
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Returns one line for people.
    pub fn description(self) -> &'static str {
        self.0.summary
    }

    /// Returns the formula of the value, in plain characters.
    pub fn formula(self) -> &'static str {
        self.0.formula
    }

    /// Returns the source of the function.
    pub fn source(self) -> &'static str {
        self.0.source
    }

    /// Returns the parameters, in the order in which they are shown.
    pub fn parameters(self) -> &'static [ParameterInfo] {
        self.0.parameters
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
    pub fn with(self, parameters: &[(String, ParameterValue)]) -> Result<KnownFunction, ParameterError> {
        let is_known = |name: &String| self.0.parameters.iter().any(|parameter| parameter.name == name);
        if let Some((name, _)) = parameters.iter().find(|(name, _)| !is_known(name)) {
            return Err(ParameterError::unknown(name));
        }
        let mut given = Given::new(parameters);
        let Made { inputs, function } = (self.0.build)(&mut given)?;
        let (inputs, parameters) = (inputs.into(), given.in_force.into());
        Ok(KnownFunction { answer: self, inputs, parameters, function: function.into() })
    }

    /// Returns the function with its default parameters.
    ///
    /// # Panics
    /// Never: a test covers all of them.
    pub fn default_function(self) -> KnownFunction {
        self.with(&[]).expect("the defaults make sense")
    }
}

/// A function with its parameters chosen. Cheap to clone.
#[derive(Clone)]
pub struct KnownFunction {
    answer: KnownAnswer,
    inputs: Arc<[KnownInput]>,
    parameters: Arc<[(&'static str, ParameterValue)]>,
    function: Arc<dyn Function>,
}

impl KnownFunction {
    /// Returns its entry in the list.
    pub fn answer(&self) -> KnownAnswer {
        self.answer
    }

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
        self.function.value(x)
    }

    /// Returns why there is no value at `x`, if the function can tell.
    pub fn reason(&self, x: &[f64]) -> Option<&'static str> {
        self.function.reason(x)
    }

    /// Returns mean, variance and indices for independent inputs with their own distributions.
    pub fn exact(&self) -> Exact {
        self.function.exact()
    }
}

impl PartialEq for KnownFunction {
    fn eq(&self, other: &Self) -> bool {
        self.answer.name() == other.answer.name() && self.parameters() == other.parameters()
    }
}

impl fmt::Debug for KnownFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct(self.answer.name()).field("parameters", &self.parameters()).finish()
    }
}

#[cfg(test)]
mod tests;
