//! Studies: the question and its settings, checked once.
//!
//! A [`Study`] is built in code ([`Study::builder`]) or read from a file (`apportion_files::load_study`), checked once.

mod build_error;
mod builder;
mod effects;
pub(crate) use effects::StudyEffect;
mod identity;
mod options;
mod rules;
mod subject;

use std::path::PathBuf;
use std::sync::Arc;

pub use crate::surrogate::SurrogateChoice;
pub use build_error::BuildError;
pub use builder::StudyBuilder;
pub(crate) use options::MAX_GROWN_ROWS;
pub use options::{AnalysisOptions, Target};
use options::{MAX_AUTOMATIC_VALUES, rows};
use serde_json::Value;
use subject::CustomSubject;
pub use subject::{ExternalSubject, LowFidelity, RepeatedSubject, Rung, Subject};

use crate::design::{Design, DesignError, DesignSettings};
use crate::effect::{Layout, NoiseLayout};
use crate::model::Model;
use crate::run::{BLOCK, ModelFiles};
use crate::space::Space;
use crate::surrogate::MIN_POINTS;

/// A checked study: a subject, the space of its factors, and the design that explores it. Its methods describe its fields.
#[derive(Debug, Clone)]
pub struct Study {
    pub(crate) name: String,
    pub(crate) title: Option<String>,
    pub(crate) subject: Arc<dyn Subject>,
    pub(crate) space: Space,
    pub(crate) design: Design,
    pub(crate) analysis: AnalysisOptions,
    pub(crate) target: Target,
    pub(crate) low_fidelities: Vec<LowFidelity>,
    pub(crate) source: StudySource,
}

/// The file that a study was read from, or a description of a study built in code.
#[derive(Debug, Clone, Default)]
pub struct StudySource {
    /// The path of the file; empty for a study built in code.
    pub path: PathBuf,
    /// The tables of measured values that it names.
    pub measured: Vec<PathBuf>,
    /// The text of the file.
    pub text: String,
    /// Its SHA-256 in hexadecimal.
    pub sha256: String,
    /// Changes made to it on the command line, as given.
    pub overrides: Vec<String>,
    /// Notes on values that were read differently from how they were written, in sentences.
    pub notes: Vec<String>,
}

impl Study {
    /// Creates a builder for a study of a model that is part of a program: a function (see
    /// [`function_model`](crate::model::function_model) and [`FunctionModel`](crate::model::FunctionModel)), or any other
    /// [`Model`]. Result files are named after `name`.
    ///
    /// ```
    /// use apportion::function_model;
    /// use apportion::Distribution;
    /// use apportion::Study;
    ///
    /// let study = Study::builder("product", function_model("y", |x| x[0] * x[1]))
    ///     .factor("a", Distribution::uniform(1.0, 2.0)?)
    ///     .factor("b", Distribution::uniform(1.0, 5.0)?)
    ///     .base_samples(1024)
    ///     .build()?;
    /// let analysis = study.run()?;
    /// let a = analysis.output("y")?.factor("a")?;
    /// // With c^2 = variance / mean^2 (1/27 and 4/27): S_a = c_a^2 / ((1 + c_a^2) (1 + c_b^2) - 1).
    /// assert!((a.first_order.estimate - 27.0 / 139.0).abs() < 0.002);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn builder(name: &str, model: impl Model + 'static) -> StudyBuilder {
        StudyBuilder::new(name, Arc::new(CustomSubject { model: Arc::new(model), version: None }))
    }

    /// Replaces the model of the study: the new one is part of a program, and a study file has the rest. `version`
    /// distinguishes it from other models of the same outputs, so that their recorded runs are not confused.
    ///
    /// # Errors
    /// [`BuildError`] if its outputs, by name and unit, differ from those of the study.
    pub fn with_model(self, model: Arc<dyn Model>, version: &str) -> Result<Self, BuildError> {
        let [outputs, expected] = [&model, &self.model()].map(|model| {
            let outputs = model.outputs().iter().map(|output| format!("{} ({})", output.name, output.unit));
            outputs.collect::<Vec<_>>().join(", ")
        });
        if outputs != expected {
            return rules::wrong("outputs", format!("those of the study, {expected}"), outputs);
        }
        // The design is that of a model outside, which may be slow.
        let smallest_region = self.target.accuracy.map(|_| self.target.region(true));
        let subject = CustomSubject { model, version: Some(version.to_owned()) };
        Ok(Self { subject: Arc::new(subject), target: Target { smallest_region, ..self.target }, ..self })
    }

    /// Returns its name, by default that of the file without its ending. Result files are named after it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns its title for people.
    pub fn title(&self) -> Option<&str> {
        self.title.as_deref()
    }

    /// Returns the model with its choices.
    pub fn subject(&self) -> &Arc<dyn Subject> {
        &self.subject
    }

    /// Returns the factors.
    pub fn space(&self) -> &Space {
        &self.space
    }

    /// Returns the points at which the model runs, or starts to; its swaps are the factors, the groups, the subsets of
    /// [`analysis`](Self::analysis), and the dummy factor if there is one.
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// Returns what to estimate from the runs.
    pub fn analysis(&self) -> &AnalysisOptions {
        &self.analysis
    }

    /// Returns when a growing run ends.
    pub fn target(&self) -> Target {
        self.target
    }

    /// Returns the low-fidelity models of the same outputs, used where they help.
    pub fn low_fidelities(&self) -> &[LowFidelity] {
        &self.low_fidelities
    }

    /// Returns the study of another subject, with the same outputs or others.
    #[must_use]
    pub fn with_subject(self, subject: Arc<dyn Subject>) -> Self {
        Self { subject, ..self }
    }

    /// Adds a note on how the study was read, in a sentence.
    pub fn note(&mut self, note: String) {
        self.source.notes.push(note);
    }

    /// Returns the study with another target; one that does not grow has the default target.
    #[must_use]
    pub fn with_target(self, target: Target) -> Self {
        Self { target, ..self }
    }

    /// Returns the study with the points of `settings` and the estimates of `analysis`.
    ///
    /// # Errors
    /// [`DesignError`] if the design is invalid.
    pub fn with_design(self, settings: DesignSettings, analysis: AnalysisOptions) -> Result<Self, DesignError> {
        let design = Design::new(settings, self.design.factors(), rows(&analysis, &self.space))?;
        Ok(Self { design, analysis, ..self })
    }

    /// Returns the design with the swaps of all effects at as many base points.
    pub(crate) fn with_swaps(&self, base_samples: u64) -> Result<Design, DesignError> {
        let settings = DesignSettings { base_samples, ..self.design.settings().clone() };
        Design::new(settings, self.design.factors(), rows(&self.analysis, &self.space))
    }

    /// Returns the number of rows with swaps of a base point.
    pub(crate) fn swapped_rows(&self) -> u64 {
        self.with_swaps(2 * self.design.settings().replicates).map_or(1, |design| design.rows_per_point() - 2)
    }

    /// Returns the study without low-fidelity models.
    #[must_use]
    pub fn without_low_fidelities(self) -> Self {
        Self { low_fidelities: Vec::new(), ..self }
    }

    /// Returns the study as one that was read from a file.
    #[must_use]
    pub fn with_source(self, source: StudySource) -> Self {
        let notes = [self.source.notes, source.notes].concat();
        Self { source: StudySource { notes, ..source }, ..self }
    }

    /// Returns the changes made to the file on the command line, as given.
    pub fn overrides(&self) -> &[String] {
        &self.source.overrides
    }

    /// Returns all files that the study reads: its own first, those of its models, and measured values.
    pub fn files(&self) -> Vec<PathBuf> {
        let models = std::iter::once(&self.subject).chain(self.low_fidelities.iter().map(|low| &low.subject));
        let own = std::iter::once(&self.source.path).chain(&self.source.measured).cloned();
        own.chain(models.flat_map(|subject| subject.files())).collect()
    }

    /// Returns the SHA-256 of all these files but its own, by path.
    pub fn data_digests(&self) -> Value {
        ModelFiles::new(self.files().split_off(1)).digests
    }

    /// Returns the text of the file.
    pub fn source(&self) -> &str {
        &self.source.text
    }

    /// Returns the SHA-256 of the file in hexadecimal.
    pub fn sha256(&self) -> &str {
        &self.source.sha256
    }

    /// Returns notes on values that were read differently from how they were written, in sentences.
    pub fn notes(&self) -> &[String] {
        &self.source.notes
    }

    /// Creates the model, ready to run on this study's factors.
    pub fn model(&self) -> Arc<dyn Model> {
        self.subject.model(&self.space)
    }

    /// Returns what is estimated from the swaps of the design.
    pub fn layout(&self) -> Layout {
        Layout {
            effects: self.effects().into_iter().map(|effect| effect.effect).collect(),
            estimators: self.analysis.estimators.clone(),
            second_order: self.analysis.second_order,
            dependent: self.space.copula().is_some(),
            shapley: self.analysis.has_shapley(&self.space),
            noise: self.space.noise().map(|noise| NoiseLayout::new(noise, self.design.swaps())),
        }
    }

    /// Returns the number of distinct values of every factor that a run with an accuracy needs, so that a region of the
    /// smallest size contains one with 95 % probability.
    pub(crate) fn needed_values(&self) -> u64 {
        self.target.needed_values(self.model().is_slow() || self.subject.is_external())
    }

    /// Returns whether surrogates correct the indices of a run of `design`, which may be longer than that of the study.
    pub fn uses_surrogate(&self, design: &Design) -> bool {
        let has_points = self.target.grows() || design.points_per_replicate() >= MIN_POINTS as u64;
        let DesignSettings { sampler, replicates, .. } = *design.settings();
        let fits = has_points && self.analysis.takes_surrogates(sampler, replicates, &self.space);
        let is_automatic = self.analysis.surrogate == SurrogateChoice::Auto && self.low_fidelities.is_empty();
        let model = self.model();
        let has_size = self.target.accuracy.is_some() || !self.target.grows() || model.concurrency().is_some();
        let values = design.rows().saturating_mul(model.outputs().len() as u64);
        fits && (!is_automatic || has_size && values <= MAX_AUTOMATIC_VALUES)
    }

    /// Returns the bytes that each thread of a run takes: the columns of the factors in a block (unit cube and SI, A and
    /// B), and of every output of every kind of row.
    pub fn bytes_per_thread(&self) -> u64 {
        let outputs = self.model().outputs().len() as u64;
        (2 * self.design.columns() as u64 + self.design.rows_per_point() * (outputs + 1)) * BLOCK * 8
    }

    /// Returns whether the estimates need the outputs of every run, not only their sums.
    pub fn needs_outputs(&self) -> bool {
        self.analysis.intervals.keeps_outputs() || self.design.is_plain() || self.uses_surrogate(&self.design)
    }

    /// Returns the current choices, such as the protocol of a program, with the keys of the study file.
    pub fn settings(&self) -> Vec<(&'static str, serde_json::Value)> {
        self.subject.settings()
    }

    /// Returns the inputs that are not factors, as (name, value, unit).
    pub fn constants(&self) -> Vec<(String, f64, String)> {
        self.subject.constants(&self.space)
    }
}
