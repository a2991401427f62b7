//! The models that a study file can name, with their choices made.

use std::path::PathBuf;
use std::sync::Arc;

use serde_json::{Value, json};

use crate::afm::{Fidelity, Options, Parameter, Scene};
use crate::model::{
    AfmHistory, AfmModel, AfmMoments, AfmOutput, CommandModel, CommandSettings, Expression, ExpressionModel,
    ExternalModel, Form, Input, KnownFunction, Model, ModelKind, Output, OutputSeries, ParameterValue, edge_unit,
    known_inputs, known_model, program_files,
};
#[cfg(feature = "extremes")]
use crate::model::{AfmSecond, PreciseFormulas, SecondCalculation};
use crate::quantity::{Quantity, Unit};
use crate::space::{Distribution, Factor, Space};
use crate::study::{LowFidelity, Rung, Subject};

/// The nanoparticle model with its choices made.
#[derive(Debug, Clone, PartialEq)]
pub struct AfmSubject {
    /// The constants; those of the factors are overwritten in every run.
    pub scene: Scene,
    /// Friction law, contact theory, fidelity and the like.
    pub options: Options,
    /// The outputs asked for.
    pub outputs: Vec<AfmOutput>,
    /// The histories asked for, and the moments at which they are given.
    pub histories: Vec<AfmHistory>,
    pub moments: AfmMoments,
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
    /// Other files that decide its answers.
    pub(super) depends_on: Vec<PathBuf>,
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
    /// Those of the outputs that are series.
    pub series: Vec<OutputSeries>,
}

fn is_factor(space: &Space, name: &str) -> bool {
    space.factors().iter().any(|factor| factor.name == name)
}

/// The shorter step of the march (s): what its force is off by, speed times step, is then below a hundredth of a nanometre.
const SHORT_STEP: f64 = 1e-5;

/// The tolerance of the finest rung.
const FINEST_TOLERANCE: f64 = 1e-9;

impl Subject for AfmSubject {
    fn name(&self) -> &'static str {
        ModelKind::AFM.name
    }

    fn model(&self, space: &Space) -> Box<dyn Model> {
        let factors = space.factors().iter().filter_map(|factor| Parameter::from_name(&factor.name)).collect();
        let model = AfmModel::new(self.scene, self.options, factors, self.outputs.clone());
        Box::new(model.with_histories(&self.histories, &self.moments))
    }

    fn settings(&self) -> Vec<(&'static str, Value)> {
        let options = &self.options;
        let mut settings = vec![
            ("friction", json!(options.friction.name())),
            ("contact", json!(options.contact.name())),
            ("fidelity", json!(options.fidelity.name())),
            ("torsion", json!(options.torsion.name())),
            ("adhesion_in_load", json!(options.adhesion_in_load)),
            ("lugre_parameters", json!(options.lugre.name())),
            ("tolerance", json!(options.tolerance)),
            ("step", json!(format!("{} s", options.step))),
            ("step_budget", json!(options.step_budget)),
        ];
        if !self.histories.is_empty() {
            let (duration, points) = (self.moments.duration(), self.moments.times().len());
            settings.push(("history", json!({ "duration": format!("{duration} s"), "points": points })));
        }
        settings
    }

    fn rung_name(&self) -> String {
        let (Options { fidelity, tolerance, step, .. }, usual) = (self.options, Options::default());
        match fidelity {
            Fidelity::Dynamic if tolerance != usual.tolerance => {
                format!("{}, tolerance {tolerance:e}", fidelity.name())
            }
            Fidelity::FixedStep if step != usual.step => format!("{}, step {step:e} s", fidelity.name()),
            _ => fidelity.name().to_owned(),
        }
    }

    /// The closed form, the quasi-static rung, the equations of motion in fixed steps of two lengths, and adaptively at three
    /// tolerances.
    fn rungs(&self) -> Vec<Rung> {
        let Options { tolerance, step, .. } = Options::default();
        let of = |fidelity| Options { fidelity, tolerance, step, ..self.options };
        let (marched, dynamic) = (of(Fidelity::FixedStep), of(Fidelity::Dynamic));
        let ladder = [
            of(Fidelity::ClosedForm),
            of(Fidelity::QuasiStatic),
            marched,
            Options { step: SHORT_STEP, ..marched },
            Options { tolerance: 1e-3, ..dynamic },
            dynamic,
            Options { tolerance: FINEST_TOLERANCE, ..dynamic },
        ];
        let rung = |options: Options| {
            let subject = Self { options, ..self.clone() };
            let mut lines = format!("[afm]\nfidelity = \"{}\"\n", options.fidelity.name());
            match options.fidelity {
                Fidelity::Dynamic => lines.push_str(&format!("tolerance = {:e}\n", options.tolerance)),
                Fidelity::FixedStep => lines.push_str(&format!("step = \"{:e} s\"\n", options.step)),
                _ => (),
            }
            Rung {
                name: subject.rung_name(),
                subject: Arc::new(subject),
                lines,
                is_finest: options.tolerance == FINEST_TOLERANCE,
            }
        };
        ladder.into_iter().map(rung).collect()
    }

    fn cheaper(&self) -> Vec<LowFidelity> {
        let at = |fidelity: Fidelity| LowFidelity {
            name: fidelity.name().to_owned(),
            subject: Arc::new(Self { options: Options { fidelity, ..self.options }, ..self.clone() }),
            base_samples: None,
        };
        match self.options.fidelity {
            Fidelity::ClosedForm => Vec::new(),
            Fidelity::QuasiStatic | Fidelity::Auto => vec![at(Fidelity::ClosedForm)],
            Fidelity::Dynamic | Fidelity::FixedStep => vec![at(Fidelity::QuasiStatic), at(Fidelity::ClosedForm)],
        }
    }

    fn constants(&self, space: &Space) -> Vec<(String, f64, String)> {
        // A shear modulus that is not set follows E and nu: it is no constant.
        let is_set = |p: &Parameter| p.name != "shear_modulus" || self.scene.shear_modulus.is_some();
        let constants = Parameter::ALL.iter().filter(|p| !is_factor(space, p.name) && is_set(p));
        let constant = |p: &Parameter| {
            let unit = edge_unit(p);
            (p.name.to_owned(), unit.from_si((p.get)(&self.scene)), unit.to_string())
        };
        constants.map(constant).collect()
    }

    #[cfg(feature = "extremes")]
    fn second_calculation(&self, space: &Space) -> Result<Box<dyn SecondCalculation>, &'static str> {
        if !self.histories.is_empty() {
            return Err("there is no second calculation of a history");
        }
        let factors = space.factors().iter().filter_map(|factor| Parameter::from_name(&factor.name)).collect();
        Ok(Box::new(AfmSecond::new(self.scene, self.options, factors, self.outputs.clone())))
    }

    /// Velocity and adhesion, which may be zero.
    fn further_inputs(&self, space: &Space) -> Vec<Factor> {
        let further = ["velocity", "adhesion"].into_iter().filter(|name| !is_factor(space, name));
        let constant = |name: &'static str| {
            let parameter = Parameter::from_name(name)?;
            let unit = edge_unit(parameter);
            let value = Distribution::constant(unit.from_si((parameter.get)(&self.scene))).ok()?;
            Factor::new(name, unit, value).ok()
        };
        further.filter_map(constant).collect()
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

    #[cfg(feature = "extremes")]
    fn second_calculation(&self, _: &Space) -> Result<Box<dyn SecondCalculation>, &'static str> {
        let formulas = self.formulas.iter().map(|formula| formula.expression.clone());
        Ok(Box::new(PreciseFormulas(formulas.collect())))
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
        Box::new(ExternalModel::new(self.outputs.clone()).with_series(self.series.clone()))
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

    /// The existing files that it is made of: those of the program and of the study's `depends_on`, the template, and what each
    /// run gets.
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
        self.function.answer().name()
    }

    fn model(&self, space: &Space) -> Box<dyn Model> {
        let inputs = known_inputs(&self.function);
        let place = |factor: &Factor| inputs.iter().position(|input| input.name == factor.name);
        let base = inputs.iter().map(|input| input.nominal).collect();
        let factors = space.factors().iter().filter_map(place).collect();
        Box::new(known_model(self.function.clone(), base, factors))
    }

    fn exact_indices(&self, space: &Space) -> Option<(Vec<f64>, Vec<f64>)> {
        let inputs = known_inputs(&self.function);
        let is_own = |(factor, input): (&Factor, &Input)| {
            factor.name == input.name && input.distribution.as_ref() == Some(factor.distribution())
        };
        let factors = space.factors();
        let all = factors.len() == inputs.len() && factors.iter().zip(&inputs).all(is_own);
        let indices = self.function.exact().indices.filter(|_| all)?;
        Some((indices.first_order, indices.total))
    }

    fn settings(&self) -> Vec<(&'static str, Value)> {
        self.function.parameters().iter().map(|(name, value)| (*name, in_json(value))).collect()
    }

    fn constants(&self, space: &Space) -> Vec<(String, f64, String)> {
        let inputs = known_inputs(&self.function).into_iter().filter(|input| !is_factor(space, &input.name));
        inputs.map(|input| (input.name, input.nominal, input.unit.to_string())).collect()
    }
}

fn in_json(value: &ParameterValue) -> Value {
    match *value {
        // Whole numbers, such as dimensions, as people write them.
        ParameterValue::Number(number) if number.fract() == 0.0 && number.abs() < 1e15 => json!(number as i64),
        ParameterValue::Number(number) => json!(number),
        ParameterValue::List(ref list) => json!(list),
    }
}
