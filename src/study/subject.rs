//! What a study is about: a model with its choices made.
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use serde_json::{Value, json};

use crate::afm::{Options, Parameter, Scene};
use crate::model::{
    AfmModel, AfmOutput, CommandModel, CommandSettings, Expression, ExpressionModel, ExternalModel, Form,
    KnownFunction, KnownModel, Model, ModelKind, Output, ParameterValue, edge_unit, known_inputs,
};
use crate::quantity::{Quantity, Unit};
use crate::space::Space;

/// A model with its choices made.
#[derive(Debug, Clone, PartialEq)]
pub enum Subject {
    /// The nanoparticle model.
    Afm(Box<AfmSubject>),
    /// Formulas.
    Expression(ExpressionSubject),
    /// A model outside of this program.
    External(ExternalSubject),
    /// A program of the user's own.
    Command(Box<CommandSubject>),
    /// A function with known indices.
    Known(KnownSubject),
    /// A model that is part of a program.
    Custom(CustomSubject),
}

/// The nanoparticle model with its choices made.
#[derive(Debug, Clone, PartialEq)]
pub struct AfmSubject {
    /// The constants; those of the factors are overwritten in every run.
    pub scene: Scene,
    /// Friction law, contact theory, fidelity and the like.
    pub options: Options,
    /// The outputs asked for.
    pub outputs: Vec<AfmOutput>,
}

/// A function with known indices and its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownSubject {
    /// The function.
    pub function: KnownFunction,
}

/// Formulas of the factors.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpressionSubject {
    /// The outputs asked for.
    pub formulas: Vec<Formula>,
    /// What formulas can name beside the factors.
    pub constants: Vec<ExpressionConstant>,
}

/// An output by its formula.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    /// The output's name.
    pub name: String,
    /// The unit in which it is reported; the formula gives it in SI.
    pub unit: Unit,
    /// The formula of the factors' SI values, in the order of the space.
    pub expression: Expression,
}

/// A program of the user's own.
#[derive(Debug, Clone, PartialEq)]
pub struct CommandSubject {
    /// The program and how it is asked.
    pub settings: CommandSettings,
    /// What decides its answers, in the terms of the study file.
    pub(super) stated: Vec<(&'static str, Value)>,
}

impl CommandSubject {
    /// The existing files that it is made of: those among the program and its arguments, the template, and what each run
    /// gets.
    fn files(&self) -> Vec<PathBuf> {
        let mut files = self.settings.program.files();
        if let Form::PerRun(form) = &self.settings.form {
            files.push(form.template_file.clone());
            files.extend(form.files.iter().cloned());
        }
        files
    }
}

/// A constant of formulas.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpressionConstant {
    /// Its name.
    pub name: String,
    /// Its value as typed; formulas have it in SI.
    pub quantity: Quantity,
}

/// A model outside of this program.
#[derive(Debug, Clone, PartialEq)]
pub struct ExternalSubject {
    /// What it computes.
    pub outputs: Vec<Output>,
}

/// A model that is part of a program.
#[derive(Clone)]
pub struct CustomSubject {
    /// The model.
    pub model: Arc<dyn Model>,
}

impl fmt::Debug for CustomSubject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CustomSubject").field("outputs", &self.model.outputs()).finish_non_exhaustive()
    }
}

/// The same model, not only one like it.
impl PartialEq for CustomSubject {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.model, &other.model)
    }
}

impl Subject {
    /// The model's entry in the catalogue; `None` for one that is part of a program.
    pub fn kind(&self) -> Option<ModelKind> {
        match self {
            Self::Afm(_) => Some(ModelKind::Afm),
            Self::Expression(_) => Some(ModelKind::Expression),
            Self::External(_) => Some(ModelKind::External),
            Self::Command(_) => Some(ModelKind::Command),
            Self::Known(known) => Some(ModelKind::Known(known.function.answer())),
            Self::Custom(_) => None,
        }
    }

    /// Files of the user, beside the study itself, that the outputs depend on, as far as the study names them.
    pub fn files(&self) -> Vec<PathBuf> {
        match self {
            Self::Afm(_) | Self::Expression(_) | Self::External(_) | Self::Known(_) | Self::Custom(_) => Vec::new(),
            Self::Command(command) => command.files(),
        }
    }

    /// The model's name in study files; `custom` for one that is part of a program.
    pub fn name(&self) -> &'static str {
        self.kind().map_or("custom", ModelKind::name)
    }

    pub(super) fn model(&self, space: &Space) -> Box<dyn Model> {
        let names = || space.factors().iter().map(|factor| factor.name.as_str());
        match self {
            Self::Afm(afm) => {
                let factors = names().filter_map(Parameter::from_name).collect();
                Box::new(AfmModel::new(afm.scene, afm.options, factors, afm.outputs.clone()))
            }
            Self::Expression(ExpressionSubject { formulas, .. }) => {
                let output = |formula: &Formula| {
                    (Output::new(formula.name.clone(), formula.unit.clone(), "a formula"), formula.expression.clone())
                };
                Box::new(ExpressionModel::new(formulas.iter().map(output).collect()))
            }
            Self::External(ExternalSubject { outputs }) => Box::new(ExternalModel::new(outputs.clone())),
            Self::Command(command) => Box::new(CommandModel::new(command.settings.clone(), space.factors().to_vec())),
            Self::Known(KnownSubject { function }) => {
                let inputs = known_inputs(function);
                let factors = names().filter_map(|name| inputs.iter().position(|i| i.name == name)).collect();
                Box::new(KnownModel::new(function.clone(), inputs.iter().map(|i| i.nominal).collect(), factors))
            }
            Self::Custom(custom) => Box::new(custom.model.clone()),
        }
    }

    pub(super) fn settings(&self) -> Vec<(&'static str, Value)> {
        match self {
            Self::Afm(afm) => vec![
                ("friction", json!(afm.options.friction.name())),
                ("contact", json!(afm.options.contact.name())),
                ("fidelity", json!(afm.options.fidelity.name())),
                ("torsion", json!(afm.options.torsion.name())),
                ("adhesion_in_load", json!(afm.options.adhesion_in_load)),
                ("lugre_parameters", json!(afm.options.lugre.name())),
                ("tolerance", json!(afm.options.tolerance)),
                ("step", json!(format!("{} s", afm.options.step))),
                ("step_budget", json!(afm.options.step_budget)),
            ],
            Self::Expression(ExpressionSubject { formulas, .. }) => {
                let texts = formulas.iter().map(|formula| (formula.name.clone(), json!(formula.expression.text())));
                vec![("formulas", Value::Object(texts.collect()))]
            }
            Self::Command(command) => command.stated.clone(),
            Self::Known(known) => {
                known.function.parameters().into_iter().map(|(name, value)| (name, in_json(value))).collect()
            }
            Self::External(_) | Self::Custom(_) => Vec::new(),
        }
    }

    pub(super) fn constants(&self, space: &Space) -> Vec<(String, f64, String)> {
        let is_factor = |name: &str| space.factors().iter().any(|factor| factor.name == name);
        let constant = |name: &str, value: f64, unit: String| (name.to_owned(), value, unit);
        match self {
            Self::Afm(afm) => Parameter::ALL
                .iter()
                // A shear modulus that nobody set follows E and nu: it is no constant.
                .filter(|p| !is_factor(p.name) && (p.name != "shear_modulus" || afm.scene.shear_modulus.is_some()))
                .map(|p| (p, edge_unit(p)))
                .map(|(p, unit)| constant(p.name, unit.from_si((p.get)(&afm.scene)), unit.to_string()))
                .collect(),
            Self::Expression(ExpressionSubject { constants, .. }) => {
                constants.iter().map(|c| constant(&c.name, c.quantity.value, c.quantity.unit.to_string())).collect()
            }
            Self::Known(KnownSubject { function }) => known_inputs(function)
                .iter()
                .filter(|input| !is_factor(&input.name))
                .map(|input| constant(&input.name, input.nominal, input.unit.to_string()))
                .collect(),
            Self::Command(_) | Self::External(_) | Self::Custom(_) => Vec::new(),
        }
    }
}

fn in_json(value: ParameterValue) -> Value {
    match value {
        // Whole numbers, such as dimensions, as people write them.
        ParameterValue::Number(number) if number.fract() == 0.0 && number.abs() < 1e15 => json!(number as i64),
        ParameterValue::Number(number) => json!(number),
        ParameterValue::List(list) => json!(list),
    }
}
