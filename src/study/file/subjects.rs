//! The models that a study file can name, with their choices made.

use std::path::PathBuf;

use serde_json::{Value, json};

use crate::afm::{Options, Parameter, Scene};
use crate::model::{
    AfmModel, AfmOutput, CommandModel, CommandSettings, Expression, ExpressionModel, ExternalModel, Form,
    KnownFunction, KnownModel, Model, ModelKind, Output, ParameterValue, edge_unit, known_inputs,
};
use crate::quantity::{Quantity, Unit};
use crate::space::{Factor, Space};
use crate::study::Subject;

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

fn is_factor(space: &Space, name: &str) -> bool {
    space.factors().iter().any(|factor| factor.name == name)
}

impl Subject for AfmSubject {
    fn name(&self) -> &'static str {
        ModelKind::AFM.name
    }

    fn model(&self, space: &Space) -> Box<dyn Model> {
        let factors = space.factors().iter().filter_map(|factor| Parameter::from_name(&factor.name)).collect();
        Box::new(AfmModel::new(self.scene, self.options, factors, self.outputs.clone()))
    }

    fn settings(&self) -> Vec<(&'static str, Value)> {
        let options = &self.options;
        vec![
            ("friction", json!(options.friction.name())),
            ("contact", json!(options.contact.name())),
            ("fidelity", json!(options.fidelity.name())),
            ("torsion", json!(options.torsion.name())),
            ("adhesion_in_load", json!(options.adhesion_in_load)),
            ("lugre_parameters", json!(options.lugre.name())),
            ("tolerance", json!(options.tolerance)),
            ("step", json!(format!("{} s", options.step))),
            ("step_budget", json!(options.step_budget)),
        ]
    }

    fn constants(&self, space: &Space) -> Vec<(String, f64, String)> {
        // A shear modulus that nobody set follows E and nu: it is no constant.
        let is_set = |p: &Parameter| p.name != "shear_modulus" || self.scene.shear_modulus.is_some();
        let constants = Parameter::ALL.iter().filter(|p| !is_factor(space, p.name) && is_set(p));
        let constant = |p: &Parameter| {
            let unit = edge_unit(p);
            (p.name.to_owned(), unit.from_si((p.get)(&self.scene)), unit.to_string())
        };
        constants.map(constant).collect()
    }
}

impl Subject for ExpressionSubject {
    fn name(&self) -> &'static str {
        ModelKind::EXPRESSION.name
    }

    fn model(&self, _space: &Space) -> Box<dyn Model> {
        let output = |formula: &Formula| {
            (Output::new(formula.name.clone(), formula.unit.clone(), "a formula"), formula.expression.clone())
        };
        Box::new(ExpressionModel::new(self.formulas.iter().map(output).collect()))
    }

    fn settings(&self) -> Vec<(&'static str, Value)> {
        let texts = self.formulas.iter().map(|formula| (formula.name.clone(), json!(formula.expression.text())));
        vec![("formulas", Value::Object(texts.collect()))]
    }

    fn constants(&self, _space: &Space) -> Vec<(String, f64, String)> {
        let constant = |c: &ExpressionConstant| (c.name.clone(), c.quantity.value, c.quantity.unit.to_string());
        self.constants.iter().map(constant).collect()
    }
}

impl Subject for ExternalSubject {
    fn name(&self) -> &'static str {
        ModelKind::EXTERNAL.name
    }

    fn model(&self, _space: &Space) -> Box<dyn Model> {
        Box::new(ExternalModel::new(self.outputs.clone()))
    }

    fn is_external(&self) -> bool {
        true
    }
}

impl Subject for CommandSubject {
    fn name(&self) -> &'static str {
        ModelKind::COMMAND.name
    }

    fn model(&self, space: &Space) -> Box<dyn Model> {
        Box::new(CommandModel::new(self.settings.clone(), space.factors().to_vec()))
    }

    fn settings(&self) -> Vec<(&'static str, Value)> {
        self.stated.clone()
    }

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

impl Subject for KnownSubject {
    fn name(&self) -> &'static str {
        self.function.answer().name()
    }

    fn model(&self, space: &Space) -> Box<dyn Model> {
        let inputs = known_inputs(&self.function);
        let place = |factor: &Factor| inputs.iter().position(|input| input.name == factor.name);
        let factors = space.factors().iter().filter_map(place).collect();
        Box::new(KnownModel::new(self.function.clone(), inputs.iter().map(|i| i.nominal).collect(), factors))
    }

    fn settings(&self) -> Vec<(&'static str, Value)> {
        self.function.parameters().into_iter().map(|(name, value)| (name, in_json(value))).collect()
    }

    fn constants(&self, space: &Space) -> Vec<(String, f64, String)> {
        let inputs = known_inputs(&self.function).into_iter().filter(|input| !is_factor(space, &input.name));
        inputs.map(|input| (input.name, input.nominal, input.unit.to_string())).collect()
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
