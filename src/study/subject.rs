//! The subject of a study: a model with its choices made.

use std::any::Any;
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use serde_json::Value;

use crate::model::{FunctionModel, Model, Output, OutputSeries, RepeatedModel};
use crate::space::Space;

/// A model with its choices made, ready to be run on the factors of any space.
pub trait Subject: fmt::Debug + Send + Sync + Any {
    /// Returns the model's name in study files; `custom` for one that is part of a program.
    fn name(&self) -> &'static str;

    /// Creates the model on the factors of `space`.
    fn model(&self, space: &Space) -> Arc<dyn Model>;

    /// Returns the current choices, with the keys of the study file.
    fn settings(&self) -> Vec<(&'static str, Value)> {
        Vec::new()
    }

    /// Returns the inputs that are not factors, as (name, value, unit).
    fn constants(&self, _space: &Space) -> Vec<(String, f64, String)> {
        Vec::new()
    }

    /// Returns what an input is, with its unit if the study has none, such as "width of the river, m"; `None` if its
    /// name is all there is.
    fn meaning(&self, _input: &str) -> Option<String> {
        None
    }

    /// Returns files of the user other than the study on which the outputs depend, if the study names them.
    fn files(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    /// Returns the name of the model among its [rungs](Self::rungs).
    fn rung_name(&self) -> String {
        "the model".to_owned()
    }

    /// Returns the models of the same outputs that differ in fidelity, the cheapest first; none if there is only one.
    fn rungs(&self) -> Vec<Rung> {
        Vec::new()
    }

    /// Returns the exact first-order and total indices of the factors of `space`, if there is a formula or a table of them.
    fn exact_indices(&self, _space: &Space) -> Option<(Vec<f64>, Vec<f64>)> {
        None
    }

    /// Returns the built-in low-fidelity models of the same outputs, by name, the nearest first.
    fn cheaper(&self) -> Vec<LowFidelity> {
        Vec::new()
    }

    /// Returns whether rows are evaluated elsewhere, and only their outputs are analysed here.
    fn is_external(&self) -> bool {
        false
    }
}

/// One of several models of the same outputs.
#[derive(Debug, Clone)]
pub struct Rung {
    /// Its name.
    pub name: String,
    /// The model.
    pub subject: Arc<dyn Subject>,
    /// The lines of a study that select it.
    pub lines: String,
    /// Whether it is the reference for the others.
    pub is_finest: bool,
}

/// A low-fidelity model of the same outputs.
#[derive(Debug, Clone)]
pub struct LowFidelity {
    /// Its name.
    pub name: String,
    /// The model.
    pub subject: Arc<dyn Subject>,
    /// Base samples of its separate design; `None` to let the run choose.
    pub base_samples: Option<u64>,
}

impl dyn Subject {
    /// Returns the subject as a `T`, if it is one.
    pub fn downcast_ref<T: Subject>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }
}

/// A stochastic model, whose rows consist of several runs: see [`RepeatedModel`].
#[derive(Debug)]
pub struct RepeatedSubject {
    pub subject: Arc<dyn Subject>,
    /// The index of the factor that is its seed.
    pub seed: usize,
    pub repetitions: usize,
}

impl Subject for RepeatedSubject {
    fn name(&self) -> &'static str {
        self.subject.name()
    }

    fn model(&self, space: &Space) -> Arc<dyn Model> {
        Arc::new(RepeatedModel::new(self.subject.model(space), self.seed, self.repetitions))
    }

    fn settings(&self) -> Vec<(&'static str, Value)> {
        let mut settings = self.subject.settings();
        settings.push(("repetitions", Value::from(self.repetitions)));
        settings
    }

    fn constants(&self, space: &Space) -> Vec<(String, f64, String)> {
        self.subject.constants(space)
    }

    fn meaning(&self, input: &str) -> Option<String> {
        self.subject.meaning(input)
    }

    fn files(&self) -> Vec<PathBuf> {
        self.subject.files()
    }
}

/// A model that is part of a program.
pub(super) struct CustomSubject {
    pub(super) model: Arc<dyn Model>,
    /// What distinguishes it from others in journals, if anything does.
    pub(super) version: Option<String>,
}

impl fmt::Debug for CustomSubject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CustomSubject").field("outputs", &self.model.outputs()).finish_non_exhaustive()
    }
}

impl Subject for CustomSubject {
    fn name(&self) -> &'static str {
        "custom"
    }

    fn model(&self, _space: &Space) -> Arc<dyn Model> {
        Arc::clone(&self.model)
    }

    fn settings(&self) -> Vec<(&'static str, Value)> {
        self.version.iter().map(|version| ("version", Value::from(version.as_str()))).collect()
    }
}

/// A model outside this program.
#[derive(Debug, Clone, PartialEq)]
pub struct ExternalSubject {
    /// Its outputs.
    pub outputs: Vec<Output>,
    /// Those of the outputs that are series.
    pub series: Vec<OutputSeries>,
}

impl Subject for ExternalSubject {
    fn name(&self) -> &'static str {
        "external"
    }

    fn model(&self, _space: &Space) -> Arc<dyn Model> {
        Arc::new(FunctionModel::elsewhere(self.outputs.clone(), self.series.clone()))
    }

    fn is_external(&self) -> bool {
        true
    }
}
