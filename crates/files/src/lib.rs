//! Studies in TOML, programs as models, and tables of points and outputs, for [`apportion`].
//!
//! [`load_study`] reads a study file; every error in it is reported with its line and column. [`CommandModel`] runs the
//! user's own program, in any language. [`exchange`] writes the points of a study to a file, and reads outputs that
//! were computed anywhere.

#![deny(clippy::disallowed_methods)]

mod catalogue;
mod command;
pub mod exchange;
mod study;

pub use catalogue::ModelKind;
pub use command::{
    CommandModel, CommandOutput, CommandSettings, Form, InputTemplate, Match, PerRun, Pick, PickMethod, Program,
    Protocol, Source, TemplateError, end_all_programs, parse_answer,
};
pub use study::{
    Diagnostic, ExpressionSubject, Formula, NEW_PROGRAM, Problem, StudyError, TemplateRequest, edited, load_study,
    model_guide, new_program, parse_study, problem_factors, study_schema, template,
};
