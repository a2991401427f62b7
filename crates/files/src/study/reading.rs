//! A study file that has been read, and the configured model that its table becomes.

use std::sync::Arc;

use apportion::study::Subject;

use super::context::{Context, Fault};
use super::sections::StudyFile;
use crate::ModelKind;

/// A study file and the kind of its model.
pub(super) struct Reading {
    pub context: Context,
    pub file: StudyFile,
    pub kind: ModelKind,
}

/// A configured model, and notes on what has no effect.
pub(super) type Configured = Result<(Arc<dyn Subject>, Vec<String>), Fault>;
