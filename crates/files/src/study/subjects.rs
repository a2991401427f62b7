//! The configured models that a study file can name.

use std::path::PathBuf;
use std::sync::Arc;

use apportion::model::{Expression, ExpressionModel, KnownFunction, Model, Output, ParameterValue};
use apportion::space::Space;
use apportion::study::Subject;
use apportion_base::quantity::{Quantity, Unit};
use serde_json::{Value, json};

use crate::command::program_files;
use crate::{CommandModel, CommandSettings, Form, ModelKind};

/// A function with known indices and its parameters.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct KnownSubject {
    /// The function.
    pub function: KnownFunction,
}

/// Formulas of the factors.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpressionSubject {
    /// The requested outputs.
    pub formulas: Vec<Formula>,
    /// The names in formulas in addition to the factors.
    pub(super) constants: Vec<ExpressionConstant>,
}

/// An output by its formula.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    /// The output's name.
    pub name: String,
    /// The unit in which it is reported; the formula is in SI.
    pub unit: Unit,
    /// The formula of the factors' SI values, in the order of the space.
    pub expression: Expression,
}

/// A user's program.
#[derive(Debug, Clone)]
pub(super) struct CommandSubject {
    /// The program and how it receives rows.
    pub settings: CommandSettings,
    /// The settings that determine its replies, in the terms of the study file.
    pub stated: Vec<(&'static str, Value)>,
    /// Other files that determine its replies.
    pub depends_on: Vec<PathBuf>,
}

/// A constant of formulas.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ExpressionConstant {
    /// Its name.
    pub name: String,
    /// Its value as typed; formulas use it in SI.
    pub quantity: Quantity,
}

impl Subject for ExpressionSubject {
    fn name(&self) -> &'static str {
        ModelKind::EXPRESSION.name
    }

    fn model(&self, _space: &Space) -> Arc<dyn Model> {
        let formulas = self.formulas.iter().map(|formula| {
            (Output::new(formula.name.clone(), formula.unit.clone(), "a formula"), formula.expression.clone())
        });
        Arc::new(ExpressionModel::new(formulas.collect()))
    }

    fn settings(&self) -> Vec<(&'static str, Value)> {
        let texts = self.formulas.iter().map(|formula| (formula.name.clone(), json!(formula.expression.text())));
        vec![("formulas", Value::Object(texts.collect()))]
    }

    fn constants(&self, _space: &Space) -> Vec<(String, f64, String)> {
        let constants = self.constants.iter();
        constants.map(|c| (c.name.clone(), c.quantity.value, c.quantity.unit.to_string())).collect()
    }
}

impl Subject for CommandSubject {
    fn name(&self) -> &'static str {
        ModelKind::COMMAND.name
    }

    fn model(&self, space: &Space) -> Arc<dyn Model> {
        Arc::new(CommandModel::new(self.settings.clone(), space.factors().to_vec()))
    }

    fn settings(&self) -> Vec<(&'static str, Value)> {
        self.stated.clone()
    }

    /// Returns the existing files of the model: those of the program and of the study's `depends_on`, the template, and
    /// the files copied to each run.
    fn files(&self) -> Vec<PathBuf> {
        let mut files = program_files(&self.settings.program);
        files.extend(self.depends_on.iter().cloned());
        if let Form::PerRun(form) = &self.settings.form {
            files.push(form.template_file.clone());
            files.extend(form.files.iter().cloned());
        }
        files
    }
}

impl Subject for KnownSubject {
    fn name(&self) -> &'static str {
        self.function.answer.name
    }

    fn model(&self, space: &Space) -> Arc<dyn Model> {
        let inputs = self.function.model_inputs();
        let base = inputs.iter().map(|input| input.nominal).collect();
        let factors = space.factors().iter();
        let factors = factors.filter_map(|factor| inputs.iter().position(|input| input.name == factor.name));
        Arc::new(self.function.clone().model(base, factors.collect()))
    }

    fn exact_indices(&self, space: &Space) -> Option<(Vec<f64>, Vec<f64>)> {
        let inputs = self.function.model_inputs();
        let factors = space.factors().iter().map(|factor| (&factor.name, Some(factor.distribution())));
        let is_default = factors.eq(inputs.iter().map(|input| (&input.name, input.distribution.as_ref())));
        let indices = self.function.exact().indices.filter(|_| is_default)?;
        Some((indices.first_order, indices.total))
    }

    fn settings(&self) -> Vec<(&'static str, Value)> {
        self.function.parameters().iter().map(|(name, value)| (*name, in_json(value))).collect()
    }

    /// Inputs with a domain are quantities; the description of the others is their distribution.
    fn meaning(&self, input: &str) -> Option<String> {
        let inputs = self.function.inputs();
        let input = inputs.iter().find(|other| other.name == input && other.domain.is_some())?;
        Some(input.description.clone())
    }

    fn constants(&self, space: &Space) -> Vec<(String, f64, String)> {
        let inputs = self.function.model_inputs().into_iter();
        let fixed = inputs.filter(|input| space.factors().iter().all(|factor| factor.name != input.name));
        fixed.map(|input| (input.name, input.nominal, input.unit.to_string())).collect()
    }
}

fn in_json(value: &ParameterValue) -> Value {
    match *value {
        // Whole numbers, such as dimensions, without a decimal point.
        ParameterValue::Number(number) if number.fract() == 0.0 && number.abs() < 1e15 => json!(number as i64),
        ParameterValue::Number(number) => json!(number),
        ParameterValue::List(ref list) => json!(list),
    }
}
