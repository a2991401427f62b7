//! The nanoparticle model as the subject of a study.

use std::sync::Arc;

use apportion::model::Model;
use apportion::space::{Distribution, Factor, Space};
use apportion::study::{LowFidelity, Rung, Subject};
use serde_json::{Value, json};

use crate::model::{AfmHistory, AfmModel, AfmMoments, AfmOutput, edge_unit};
use crate::{Fidelity, Options, Parameter, Scene};

/// The configured nanoparticle model.
#[derive(Debug, Clone, PartialEq)]
pub struct AfmSubject {
    /// The constants; those of the factors are overwritten in every run.
    pub scene: Scene,
    /// Friction law, contact theory, fidelity and the like.
    pub options: Options,
    /// The requested outputs.
    pub outputs: Vec<AfmOutput>,
    /// The requested histories, and their moments.
    pub histories: Vec<AfmHistory>,
    pub moments: AfmMoments,
}

/// The shorter fixed step (s): the error of its force, speed times step, is then below a hundredth of a nanometre.
const SHORT_STEP: f64 = 1e-5;

/// The tolerance of the finest rung.
const FINEST_TOLERANCE: f64 = 1e-9;

fn is_factor(space: &Space, name: &str) -> bool {
    space.factors().iter().any(|factor| factor.name == name)
}

impl Subject for AfmSubject {
    fn name(&self) -> &'static str {
        "afm"
    }

    fn model(&self, space: &Space) -> Arc<dyn Model> {
        let of_space = space.factors().iter().filter_map(|factor| Some((Parameter::from_name(&factor.name)?, factor)));
        let mut nominal = self.scene;
        of_space
            .clone()
            .for_each(|(parameter, factor)| (parameter.set)(&mut nominal, factor.unit().to_si(factor.nominal)));
        let factors = of_space.map(|(parameter, _)| parameter).collect();
        let model = AfmModel::new(self.scene, self.options, factors, self.outputs.clone()).with_nominal(&nominal);
        Arc::new(model.with_histories(&self.histories, &self.moments))
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

    /// Returns the closed form, the quasi-static rung, the equations of motion in fixed steps of two lengths, and
    /// adaptively at three tolerances.
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
        // An unset shear modulus follows E and nu: it is not a constant.
        let is_set = |p: &Parameter| p.name != "shear_modulus" || self.scene.shear_modulus.is_some();
        let constants = Parameter::ALL.iter().filter(|p| !is_factor(space, p.name) && is_set(p));
        let constant = |p: &Parameter| {
            let unit = edge_unit(p);
            (p.name.to_owned(), unit.from_si((p.get)(&self.scene)), unit.to_string())
        };
        constants.map(constant).collect()
    }

    fn meaning(&self, input: &str) -> Option<String> {
        Parameter::from_name(input).map(|parameter| parameter.description.to_owned())
    }

    /// Adds velocity and adhesion, which may be zero.
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
