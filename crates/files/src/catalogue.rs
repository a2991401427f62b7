//! The catalogue of models with their inputs and outputs, for study files and for readers. One entry for each kind; the
//! registry of the study files says how their tables become a model.

use apportion::model::{Choice, Input, KnownAnswer, KnownFunction, Output};
use apportion_afm::model::{afm_choices, afm_inputs, afm_outputs};

/// A model that a study can name, and its description without a study.
#[derive(Clone, Copy, Debug)]
pub struct ModelKind {
    /// The name in study files.
    pub name: &'static str,
    /// A description in one line.
    pub description: &'static str,
    /// The table of a study file that belongs to it.
    pub table: &'static str,
    /// The inputs that become factors in a new study; empty for all of them.
    pub main_inputs: &'static [&'static str],
    /// The function, if it is one with known indices.
    pub known: Option<&'static KnownAnswer>,
}

impl ModelKind {
    /// The critical pushing force of a nanoparticle.
    pub const AFM: Self = Self {
        name: "afm",
        description: "critical force with which an AFM tip pushes a nanoparticle over a substrate",
        table: "afm",
        main_inputs: &["length", "width", "thickness"],
        known: None,
    };
    /// Formulas of the study's own factors.
    pub const EXPRESSION: Self = Self::users_own("expression", "formulas in the study file, with your own factors");
    /// A program of the user's own.
    pub const COMMAND: Self = Self::users_own("command", "a program of your own, in any language");
    /// A model that is run outside this program.
    pub const EXTERNAL: Self = Self::users_own(
        "external",
        "any model outside this program: `sample` writes the points, `analyze` reads its outputs",
    );
    /// The model of a study that names none.
    pub const DEFAULT: Self = Self::AFM;

    const fn users_own(name: &'static str, description: &'static str) -> Self {
        Self { name, description, table: name, main_inputs: &[], known: None }
    }

    /// Returns a function with known indices.
    pub fn from_known(answer: &'static KnownAnswer) -> Self {
        Self {
            name: answer.name,
            description: answer.description,
            table: "function",
            main_inputs: &[],
            known: Some(answer),
        }
    }

    /// Returns every model, the default first.
    pub fn all() -> Vec<Self> {
        [Self::AFM, Self::EXPRESSION, Self::COMMAND, Self::EXTERNAL]
            .into_iter()
            .chain(KnownAnswer::all().map(Self::from_known))
            .collect()
    }

    /// Returns the model of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().into_iter().find(|kind| kind.name == name)
    }

    /// Returns whether the study names the inputs and outputs.
    pub fn is_users_own(self) -> bool {
        self.outputs().is_empty()
    }

    /// Returns the inputs, the main ones first; of a function, those it has with its default parameters; none of a
    /// model whose inputs are the factors of a study.
    pub fn inputs(self) -> Vec<Input> {
        match self.known {
            Some(answer) => answer.default_function().model_inputs(),
            None if self == Self::AFM => afm_inputs(),
            None => Vec::new(),
        }
    }

    /// Returns the outputs, the default one first; none of a model whose outputs a study names.
    pub fn outputs(self) -> Vec<Output> {
        match self.known {
            Some(_) => vec![KnownFunction::output()],
            None if self == Self::AFM => afm_outputs(),
            None => Vec::new(),
        }
    }

    /// Returns the choices of its table.
    pub fn choices(self) -> Vec<Choice> {
        if self == Self::AFM { afm_choices() } else { Vec::new() }
    }
}

/// Models are equal if their names are.
impl PartialEq for ModelKind {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for ModelKind {}
