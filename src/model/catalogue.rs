//! What can be studied: every model with its inputs and outputs, for study files and for people.

use super::Output;
use super::afm::{AfmOutput, edge_unit};
use super::known::{KnownAnswer, KnownFunction, KnownModel};
use crate::afm::{ContactTheory, Fidelity, FrictionLaw, LuGreParameters, Parameter, Scene, Torsion};
use crate::quantity::Domain;
use crate::quantity::Unit;
use crate::space::Distribution;

/// A model that a study can name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelKind {
    /// The critical pushing force of a nanoparticle: the default.
    Afm,
    /// Formulas of the study's own factors.
    Expression,
    /// A model that runs outside of this program.
    External,
    /// A program of the user's own.
    Command,
    /// A function with known indices.
    Known(KnownAnswer),
}

/// An input of a model, which a study can make a factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// The name in study files.
    pub name: String,
    /// The symbol in the papers.
    pub symbol: String,
    /// The unit in which people give it.
    pub unit: Unit,
    /// The value it has where nothing else is said, in `unit`.
    pub nominal: f64,
    /// Where it is physical (of its SI value); `None` for any finite number.
    pub domain: Option<Domain>,
    /// How it varies where a study says nothing else, in `unit`; `None` if a study has to say.
    pub distribution: Option<Distribution>,
    /// A few words for people.
    pub description: String,
}

impl ModelKind {
    /// Every model, the default first.
    pub fn all() -> Vec<Self> {
        [Self::Afm, Self::Expression, Self::Command, Self::External]
            .into_iter()
            .chain(KnownAnswer::all().map(Self::Known))
            .collect()
    }

    /// The name in study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Afm => "afm",
            Self::Expression => "expression",
            Self::External => "external",
            Self::Command => "command",
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
            Self::Expression => "formulas in the study file, of factors of its own",
            Self::External => {
                "any model outside of this program: `sample` writes the points, `analyze` reads its outputs"
            }
            Self::Command => "a program of your own, in any language",
            Self::Known(function) => function.description(),
        }
    }

    /// The inputs, the main ones first; of a function, those it has with its default parameters; none of formulas, of
    /// programs and of models outside, whose inputs are the factors of a study.
    pub fn inputs(self) -> Vec<Input> {
        match self {
            Self::Afm => Parameter::ALL.iter().map(afm_input).collect(),
            Self::Expression | Self::Command | Self::External => Vec::new(),
            Self::Known(answer) => known_inputs(&answer.default_function()),
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
            Self::Expression | Self::Command | Self::External | Self::Known(_) => Vec::new(),
        }
    }

    /// The outputs, the default one first; none of formulas, of programs and of models outside, which a study names.
    pub fn outputs(self) -> Vec<Output> {
        match self {
            Self::Afm => AfmOutput::ALL.iter().map(|output| output.info()).collect(),
            Self::Expression | Self::Command | Self::External => Vec::new(),
            Self::Known(_) => vec![KnownModel::output()],
        }
    }
}

/// The inputs of a function with its parameters chosen. An input that is no factor stands at its upper quartile: at
/// their middle, many of these functions hide what the other inputs do (Sobol' G of a_1 = 0 is 0 there).
pub fn known_inputs(function: &KnownFunction) -> Vec<Input> {
    let input = |input: super::KnownInput| Input {
        symbol: input.name.clone(),
        name: input.name,
        unit: Unit::dimensionless(),
        nominal: input.distribution.quantile(0.75),
        domain: input.domain,
        description: input.description,
        distribution: Some(input.distribution),
    };
    function.inputs().into_iter().map(input).collect()
}

fn afm_input(parameter: &Parameter) -> Input {
    let unit = edge_unit(parameter);
    Input {
        name: parameter.name.to_owned(),
        symbol: parameter.symbol.to_owned(),
        nominal: unit.from_si((parameter.get)(&Scene::default())),
        unit,
        domain: Some(parameter.domain),
        distribution: None,
        description: parameter.description.to_owned(),
    }
}
