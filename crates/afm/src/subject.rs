//! The nanoparticle model as the subject of a study.

use std::sync::Arc;

use apportion::model::Model;
use apportion::space::Space;
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
        let (mut nominal, mut factors) = (self.scene, Vec::new());
        for factor in space.factors() {
            if let Some(parameter) = Parameter::from_name(&factor.name) {
                (parameter.set)(&mut nominal, factor.unit().to_si(factor.nominal));
                factors.push(parameter);
            }
        }
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
        let [closed, quasi_static, marched, dynamic] =
            [Fidelity::ClosedForm, Fidelity::QuasiStatic, Fidelity::FixedStep, Fidelity::Dynamic]
                .map(|fidelity| Options { fidelity, tolerance, step, ..self.options });
        let ladder = [
            closed,
            quasi_static,
            marched,
            Options { step: SHORT_STEP, ..marched },
            Options { tolerance: 1e-3, ..dynamic },
            dynamic,
            Options { tolerance: FINEST_TOLERANCE, ..dynamic },
        ];
        let rungs = ladder.into_iter().map(|options| {
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
        });
        rungs.collect()
    }

    fn cheaper(&self) -> Vec<LowFidelity> {
        let cheaper: &[Fidelity] = match self.options.fidelity {
            Fidelity::ClosedForm => &[],
            Fidelity::QuasiStatic | Fidelity::Auto => &[Fidelity::ClosedForm],
            Fidelity::Dynamic | Fidelity::FixedStep => &[Fidelity::QuasiStatic, Fidelity::ClosedForm],
        };
        let cheaper = cheaper.iter().map(|&fidelity| LowFidelity {
            name: fidelity.name().to_owned(),
            subject: Arc::new(Self { options: Options { fidelity, ..self.options }, ..self.clone() }),
            base_samples: None,
        });
        cheaper.collect()
    }

    fn constants(&self, space: &Space) -> Vec<(String, f64, String)> {
        let mut constants = Vec::new();
        for parameter in Parameter::ALL {
            // An unset shear modulus follows E and nu: it is not a constant.
            let is_set = parameter.name != "shear_modulus" || self.scene.shear_modulus.is_some();
            if is_set && !is_factor(space, parameter.name) {
                let unit = edge_unit(parameter);
                constants.push((
                    parameter.name.to_owned(),
                    unit.from_si((parameter.get)(&self.scene)),
                    unit.to_string(),
                ));
            }
        }
        constants
    }

    fn meaning(&self, input: &str) -> Option<String> {
        Parameter::from_name(input).map(|parameter| parameter.description.to_owned())
    }
}
