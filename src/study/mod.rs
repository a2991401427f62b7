//! Studies: what is asked, as typed (`StudyFile`) and as meant ([`Study`]).
//!
//! A study is read once and checked once; after that nothing re-validates. Everything wrong with a file is reported
//! with its line and column.

mod at;
mod builder;
mod command;
mod constants;
mod distribution;
mod error;
mod expression;
mod external;
mod file;
mod forms;
mod function;
mod identity;
mod measured;
mod names;
mod nominal;
mod options;
mod overrides;
mod plan;
mod read;
mod resolve;
mod schema;
mod subject;
mod template;
mod units;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sha2::{Digest, Sha256};

pub use builder::{BuildError, StudyBuilder};
pub use error::{Diagnostic, OverrideProblem, Problem, StudyError, nearest};
pub use options::{AnalysisOptions, Stopping};
pub use schema::study_schema;
pub use subject::{
    AfmSubject, CommandSubject, CustomSubject, ExpressionConstant, ExpressionSubject, ExternalSubject, Formula,
    KnownSubject, Subject,
};
pub use template::{NEW_PROGRAM, TemplateRequest, new_program, template};

use crate::design::Design;
use crate::files::read_text;
use crate::model::Model;
use crate::space::Space;
use crate::uncertainty::Layout;

/// A checked study: a subject, the space of its factors, and the design that explores it.
#[derive(Debug, Clone)]
pub struct Study {
    /// Name, by default the file's name without its ending. Result files are named after it.
    pub name: String,
    /// Title for people.
    pub title: Option<String>,
    /// What is studied.
    pub subject: Subject,
    /// The factors.
    pub space: Space,
    /// The points at which the model runs, or starts to; its swaps are the factors, the groups, the subsets of
    /// [`Study::analysis`], and the dummy factor if there is one.
    pub design: Design,
    /// What is asked of the runs.
    pub analysis: AnalysisOptions,
    /// When a run that grows ends.
    pub stopping: Stopping,
    /// Changes made to the file on the command line, as given.
    pub overrides: Vec<String>,
    /// The file, word for word.
    pub source: String,
    /// SHA-256 of the file in hexadecimal.
    pub sha256: String,
    /// What was read otherwise than it was written, in sentences.
    pub notes: Vec<String>,
}

impl Study {
    /// Reads a study file, after applying `overrides` of the form `KEY=VALUE`.
    ///
    /// # Errors
    /// [`StudyError`] with the place in the file and what would be right.
    pub fn load(path: &Path, overrides: &[String]) -> Result<Self, StudyError> {
        let unreadable = |source| StudyError::Unreadable { path: path.to_owned(), source };
        let text = read_text(path).map_err(unreadable)?;
        Self::parse(&text, path, overrides)
    }

    /// Reads a study from its text; `path` is for messages, and names the study unless the text does.
    ///
    /// ```
    /// use std::path::Path;
    /// use apportion::study::Study;
    ///
    /// let text = r#"
    ///     model = "ishigami"
    ///     [[factor]]
    ///     name = "x1"
    ///     min = -3.14
    ///     max = 3.14
    /// "#;
    /// let study = Study::parse(text, Path::new("small.toml"), &["design.base_samples=256".to_owned()])?;
    /// assert_eq!(study.name, "small");
    /// // A and B: with one factor, A with its column from B is B, and is not run again.
    /// assert_eq!(study.design.rows(), 2 * 256);
    /// # Ok::<(), apportion::study::StudyError>(())
    /// ```
    ///
    /// # Errors
    /// [`StudyError`] with the place in the text and what would be right.
    pub fn parse(text: &str, path: &Path, overrides: &[String]) -> Result<Self, StudyError> {
        let effective = if overrides.is_empty() { Some(text.to_owned()) } else { overridden(text, overrides)? };
        let context = resolve::Context { path: PathBuf::from(path), text: effective.as_deref().unwrap_or(text) };
        let mut study = resolve::study(&context).map_err(|mut diagnostic| {
            diagnostic.overrides = overrides.to_vec();
            diagnostic
        })?;
        if effective.is_none() {
            // The reader takes whole numbers up to 2^64, the editor up to 2^63, as TOML has it.
            let (text, problem) = (overrides.join(" "), OverrideProblem::NotEditable);
            return Err(StudyError::Override { text, problem });
        }
        study.overrides = overrides.to_vec();
        text.clone_into(&mut study.source);
        study.sha256 = Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(study)
    }

    /// Begins a study of a model that is part of a program: a function (see
    /// [`function_model`](crate::model::function_model) and [`FunctionModel`](crate::model::FunctionModel)), or any other
    /// [`Model`]. Result files are named after `name`.
    ///
    /// ```
    /// use apportion::model::function_model;
    /// use apportion::space::Distribution;
    /// use apportion::study::Study;
    ///
    /// let study = Study::builder("product", function_model("y", |x| x[0] * x[1]))
    ///     .factor("a", Distribution::uniform(1.0, 2.0)?)
    ///     .factor("b", Distribution::uniform(1.0, 5.0)?)
    ///     .base_samples(1024)
    ///     .build()?;
    /// let result = study.run()?;
    /// let indices = result.outputs[0].indices.as_ref().ok_or("no indices")?;
    /// // With c^2 = variance / mean^2 (1/27 and 4/27): S_a = c_a^2 / ((1 + c_a^2) (1 + c_b^2) - 1).
    /// assert!((indices[0].effect.first_order.estimate - 27.0 / 139.0).abs() < 0.002);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn builder(name: &str, model: impl Model + 'static) -> StudyBuilder {
        StudyBuilder::new(name, Arc::new(model))
    }

    /// The model, ready to run on this study's factors.
    pub fn model(&self) -> Box<dyn Model> {
        self.subject.model(&self.space)
    }

    /// What is estimated from the swaps of the design.
    pub fn layout(&self) -> Layout {
        Layout {
            factors: self.space.factors().len(),
            groups: self.space.groups().len(),
            subsets: self.analysis.subsets.len(),
            dummy: self.analysis.dummy,
            estimators: self.analysis.estimators.clone(),
            second_order: self.analysis.second_order,
        }
    }

    /// The choices in force, such as the friction law, in the terms of the study file.
    pub fn settings(&self) -> Vec<(&'static str, serde_json::Value)> {
        self.subject.settings()
    }

    /// The inputs that are not factors, as (name, value, unit).
    pub fn constants(&self) -> Vec<(String, f64, String)> {
        self.subject.constants(&self.space)
    }
}

fn overridden(text: &str, overrides: &[String]) -> Result<Option<String>, StudyError> {
    overrides::apply(text, overrides).map_err(|(text, problem)| StudyError::Override { text, problem })
}
