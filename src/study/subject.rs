//! What a study is about: a model with its choices made.

use std::any::Any;
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use serde_json::Value;

use crate::model::Model;
use crate::space::Space;

/// A model with its choices made, ready to be run on the factors of any space.
pub trait Subject: fmt::Debug + Send + Sync + Any {
    /// The model's name in study files; `custom` for one that is part of a program.
    fn name(&self) -> &'static str;

    /// The model on the factors of `space`.
    fn model(&self, space: &Space) -> Box<dyn Model>;

    /// The choices in force, in the terms of the study file.
    fn settings(&self) -> Vec<(&'static str, Value)> {
        Vec::new()
    }

    /// The inputs that are not factors, as (name, value, unit).
    fn constants(&self, _space: &Space) -> Vec<(String, f64, String)> {
        Vec::new()
    }

    /// Files of the user, beside the study itself, that the outputs depend on, as far as the study names them.
    fn files(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    /// Whether rows are evaluated by somebody else, and only their outputs are analysed here.
    fn is_external(&self) -> bool {
        false
    }
}

impl dyn Subject {
    /// The subject as a `T`, if it is one.
    pub fn downcast_ref<T: Subject>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }
}

/// A model that is part of a program.
pub(super) struct CustomSubject(pub Arc<dyn Model>);

impl fmt::Debug for CustomSubject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CustomSubject").field("outputs", &self.0.outputs()).finish_non_exhaustive()
    }
}

impl Subject for CustomSubject {
    fn name(&self) -> &'static str {
        "custom"
    }

    fn model(&self, _space: &Space) -> Box<dyn Model> {
        Box::new(self.0.clone())
    }
}
