//! What can be studied: every model with its inputs and outputs, for study files and for people.

use super::afm::{AfmOutput, edge_unit};
use super::known::KnownAnswer;
use crate::afm::{ContactTheory, Domain, Fidelity, FrictionLaw, LuGreParameters, Parameter, Scene, Torsion};
use crate::quantity::Unit;

/// A model that a study can name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelKind {
    /// The critical pushing force of a nanoparticle: the default.
    Afm,
    /// A function with exact indices.
    Known(KnownAnswer),
}

/// An input of a model, which a study can make a factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// The name in study files.
    pub name: &'static str,
    /// The symbol in the papers.
    pub symbol: &'static str,
    /// The unit in which people give it.
    pub unit: Unit,
    /// The value it has where nothing else is said, in `unit`.
    pub nominal: f64,
    /// Where it is physical (of its SI value); `None` for any finite number.
    pub domain: Option<Domain>,
    /// A few words for people.
    pub description: String,
}

/// An output of a model, which a study can ask for.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputInfo {
    /// The name in study files.
    pub name: &'static str,
    /// The unit in which it is reported.
    pub unit: Unit,
    /// A few words for people.
    pub description: &'static str,
}

impl ModelKind {
    /// Every model, the default first.
    pub fn all() -> Vec<Self> {
        std::iter::once(Self::Afm).chain(KnownAnswer::ALL.map(Self::Known)).collect()
    }

    /// The name in study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Afm => "afm",
            Self::Known(function) => function.name(),
        }
    }

    /// The model of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().into_iter().find(|kind| kind.name() == name)
    }

    /// One line for people.
    pub fn description(self) -> &'static str {
        match self {
            Self::Afm => "critical force with which an AFM tip pushes a nanoparticle over a substrate",
            Self::Known(function) => function.description(),
        }
    }

    /// The inputs, the main ones first.
    pub fn inputs(self) -> Vec<Input> {
        match self {
            Self::Afm => Parameter::ALL.iter().map(afm_input).collect(),
            Self::Known(function) => function
                .inputs()
                .into_iter()
                .map(|input| Input {
                    name: input.name,
                    symbol: input.name,
                    unit: Unit::dimensionless(),
                    // Off the middle, where Sobol' G is 0 whatever the other inputs are.
                    nominal: input.min + 0.75 * (input.max - input.min),
                    domain: None,
                    description: format!("exact indices hold for the range {} to {}", input.min, input.max),
                })
                .collect(),
        }
    }

    /// The choices of `[afm]`: the key, where it acts if not everywhere, and the names or the kind of value.
    pub fn choices(self) -> Vec<(&'static str, Vec<&'static str>)> {
        fn names<T: Copy>(all: &[T], name: fn(T) -> &'static str) -> Vec<&'static str> {
            all.iter().map(|&choice| name(choice)).collect()
        }
        match self {
            Self::Afm => vec![
                ("friction", names(FrictionLaw::ALL, FrictionLaw::name)),
                ("contact", names(ContactTheory::ALL, ContactTheory::name)),
                ("fidelity", names(Fidelity::ALL, Fidelity::name)),
                ("torsion", names(Torsion::ALL, Torsion::name)),
                ("adhesion_in_load", vec!["false", "true"]),
                (
                    "lugre_parameters (lugre at quasi-static and above)",
                    names(LuGreParameters::ALL, LuGreParameters::name),
                ),
                ("tolerance (quasi-static and above)", vec!["a number, 1e-6"]),
                ("step (fixed-step)", vec!["a time, \"10 ms\""]),
                ("step_budget (marched rungs)", vec!["a whole number, 1000000"]),
            ],
            Self::Known(_) => Vec::new(),
        }
    }

    /// The outputs, the default one first.
    pub fn outputs(self) -> Vec<OutputInfo> {
        match self {
            Self::Afm => AfmOutput::ALL
                .iter()
                .map(|o| OutputInfo { name: o.name(), unit: o.unit(), description: o.description() })
                .collect(),
            Self::Known(_) => {
                vec![OutputInfo { name: "y", unit: Unit::dimensionless(), description: "value of the function" }]
            }
        }
    }
}

fn afm_input(parameter: &Parameter) -> Input {
    let unit = edge_unit(parameter);
    Input {
        name: parameter.name,
        symbol: parameter.symbol,
        nominal: unit.from_si((parameter.get)(&Scene::default())),
        unit,
        domain: Some(parameter.domain),
        description: parameter.description.to_owned(),
    }
}
