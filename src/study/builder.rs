//! Studies built in code, of models that no file can name.

use std::sync::Arc;

use super::options::DEFAULT_RESAMPLES;
use super::rules::{self, Length, wrong};
use super::subject::{CustomSubject, LowFidelity, Subject};
use super::{AnalysisOptions, BuildError, Study, StudySource, SurrogateChoice, Target};
use crate::design::{DesignSettings, Sampler};
use crate::model::Model;
use crate::space::{Dependence, Distribution, Factor, Space};
use crate::surrogate::MIN_NETS;
use crate::uncertainty::IntervalMethod;
use apportion_base::digest::sha256;
use apportion_base::quantity::Unit;

/// A builder of studies, created by [`Study::builder`].
///
/// Its methods are for programs, and say what each field means. The fields are public for readers of study files, where
/// most keys are optional.
#[must_use]
pub struct StudyBuilder {
    name: String,
    pub title: Option<String>,
    subject: Arc<dyn Subject>,
    /// In the order of the Sobol' dimensions.
    pub factors: Vec<Result<Factor, BuildError>>,
    pub sampler: Sampler,
    pub length: Length,
    pub replicates: Option<u64>,
    pub seed: u64,
    pub analysis: Option<AnalysisOptions>,
    pub low_fidelities: Vec<LowFidelity>,
    pub dependences: Vec<Dependence>,
}

impl StudyBuilder {
    /// Creates a study of `subject` with neither factors nor settings; result files are named after `name`.
    pub fn new(name: &str, subject: Arc<dyn Subject>) -> Self {
        let DesignSettings { sampler, seed, .. } = DesignSettings::default();
        Self {
            name: name.to_owned(),
            title: None,
            subject,
            factors: Vec::new(),
            sampler,
            length: Length { base_samples: None, runs: None, target: Target::default() },
            replicates: None,
            seed,
            analysis: None,
            low_fidelities: Vec::new(),
            dependences: Vec::new(),
        }
    }

    /// Sets a title for people.
    pub fn title(mut self, title: &str) -> Self {
        self.title = Some(title.to_owned());
        self
    }

    /// Sets the version, which distinguishes the model from others of the same outputs and factors: without it, a
    /// [journal](crate::Runner::journal) cannot detect a changed function, and reuses the old runs.
    pub fn version(mut self, version: &str) -> Self {
        if let Some(custom) = self.subject.downcast_ref::<CustomSubject>() {
            let (model, version) = (Arc::clone(&custom.model), Some(version.to_owned()));
            self.subject = Arc::new(CustomSubject { model, version });
        }
        self
    }

    /// Adds a dimensionless factor. The model gets the values in the order of the factors.
    pub fn factor(self, name: &str, distribution: Distribution) -> Self {
        self.factor_in(name, Unit::dimensionless(), distribution)
    }

    /// Adds a factor, whose distribution is in `unit`. The model gets its values in SI units.
    pub fn factor_in(mut self, name: &str, unit: Unit, distribution: Distribution) -> Self {
        let factor = Factor::new(name, unit, distribution);
        self.factors.push(factor.map_err(|source| BuildError::Factor { factor: name.to_owned(), source }));
        self
    }

    /// Adds an existing factor, for example with a group, or a nominal value other than its median.
    pub fn with_factor(mut self, factor: Factor) -> Self {
        self.factors.push(Ok(factor));
        self
    }

    /// Adds a dependence between factors.
    ///
    /// ```
    /// use apportion::{Dependence, Distribution, Study, function_model};
    ///
    /// let study = Study::builder("sum", function_model("y", |x| x[0] + x[1]))
    ///     .factor("a", Distribution::normal(0.0, 1.0)?)
    ///     .factor("b", Distribution::normal(0.0, 1.0)?)
    ///     .dependence(Dependence::pair("a", "b", 0.5))
    ///     .base_samples(1024)
    ///     .build()?;
    /// let analysis = study.run()?;
    /// // E(Y | a) = 1.5 a, and the variance is 3.
    /// assert!((analysis.output("y")?.factor("a")?.first_order.estimate - 0.75).abs() < 0.02);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn dependence(mut self, dependence: Dependence) -> Self {
        self.dependences.push(dependence);
        self
    }

    /// Sets the sampler; scrambled Sobol' points by default.
    pub fn sampler(mut self, sampler: Sampler) -> Self {
        self.sampler = sampler;
        self
    }

    /// Sets the number of base samples in all, best a power of two for each replicate; 2^14 by default. The cost is
    /// base samples x (2 + factors) runs.
    pub fn base_samples(mut self, base_samples: u64) -> Self {
        self.length.base_samples = Some(base_samples);
        self
    }

    /// Sets the number of model runs in all, instead of [`base_samples`](Self::base_samples): the best design with at
    /// most this many. Up to 4096 are plain rows, to which surrogates are fitted, unless these explain too little.
    ///
    /// ```
    /// use apportion::{Distribution, Study, function_model};
    ///
    /// let model = function_model("y", |x| x[0] + x[1] * x[1]);
    /// let study = Study::builder("expensive", model)
    ///     .factor("a", Distribution::uniform(0.0, 1.0)?)
    ///     .factor("b", Distribution::uniform(0.0, 1.0)?)
    ///     .runs(100)
    ///     .build()?;
    /// assert!(study.design().rows() <= 100);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn runs(mut self, runs: u64) -> Self {
        self.length.runs = Some(runs);
        self
    }

    /// Sets the number of randomisations that share the base samples; by default the best for the interval method.
    pub fn replicates(mut self, replicates: u64) -> Self {
        self.replicates = Some(replicates);
        self
    }

    /// Sets the seed of the design, 0 by default.
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Sets what to estimate; [`AnalysisOptions::for_sampler`] by default.
    pub fn analysis(mut self, analysis: AnalysisOptions) -> Self {
        self.analysis = Some(analysis);
        self
    }

    /// Sets the required accuracy of the indices, and the limits of a run that continues until it is reached.
    pub fn until(mut self, target: Target) -> Self {
        self.length.target = target;
        self
    }

    /// Adds a named low-fidelity model of the same outputs, used where it helps; the runs of the model correct it.
    /// `base_samples` is the size of its separate design; `None` to let the run choose.
    pub fn low_fidelity(mut self, name: &str, model: impl Model + 'static, base_samples: Option<u64>) -> Self {
        let subject = Arc::new(CustomSubject { model: Arc::new(model), version: None });
        self.low_fidelities.push(LowFidelity { name: name.to_owned(), subject, base_samples });
        self
    }

    /// Builds the study.
    ///
    /// # Errors
    /// [`BuildError`] with what is wrong and what is allowed.
    pub fn build(self) -> Result<Study, BuildError> {
        let mut study = self.checked()?;
        study.source.text = in_words(&study);
        study.source.sha256 = sha256(study.source.text.as_bytes());
        Ok(study)
    }

    /// Builds the study, checked against every rule, without its source text.
    ///
    /// # Errors
    /// [`BuildError`] with what is wrong and what is allowed.
    pub fn checked(self) -> Result<Study, BuildError> {
        rules::check_title(&self.name, self.title.as_deref())?;
        let factors = self.factors.into_iter().collect::<Result<Vec<Factor>, _>>()?;
        let space = Space::new(factors);
        let model = self.subject.model(&space);
        rules::check_outputs(&*model)?;
        rules::check_factors(space.factors(), &*model)?;
        let outputs = model.outputs().len();
        let (sampler, length) = (self.sampler, self.length);
        let analysis = self.analysis.unwrap_or_else(|| AnalysisOptions::for_sampler(sampler));
        let analysis = rules::checked_options(analysis, sampler, &space, outputs)?;
        let space = space.with_dependences(self.dependences)?;
        rules::check_dependent(&analysis, &space, &self.low_fidelities)?;
        length.check(sampler)?;
        let replicates = self.replicates.unwrap_or(analysis.intervals.default_replicates());
        let settings = DesignSettings { sampler, base_samples: 0, replicates, seed: self.seed };
        let has_cheaper =
            !self.low_fidelities.is_empty() || length.target.accuracy.is_some() && !self.subject.cheaper().is_empty();
        let is_slow = model.is_slow() || self.subject.is_external();
        let first_rows = (!has_cheaper).then(|| length.target.needed_values(is_slow));
        let design = length.design(&analysis, &space, outputs, settings, first_rows)?;
        let design = length.target.within_max_runs(design).or_else(|min_runs| {
            let expected = format!("{min_runs} or more, for 2 base samples in each of {replicates} replicates");
            wrong("max_runs", expected, length.target.max_runs.unwrap_or_default())
        })?;
        rules::check_low_fidelities(&self.low_fidelities, &*model, &space, length.target)?;
        let mut notes = Vec::new();
        let used = design.settings().base_samples;
        if let Some(requested) = length.base_samples.filter(|requested| *requested != used) {
            notes.push(format!(
                "{requested} base samples are not a multiple of {replicates} replicates: {used} are used"
            ));
        }
        if analysis.surrogate == SurrogateChoice::On && replicates < MIN_NETS as u64 {
            notes.push(format!("surrogates have no effect with fewer than {MIN_NETS} replicates"));
        }
        if analysis.resamples != DEFAULT_RESAMPLES && analysis.intervals != IntervalMethod::Percentile {
            notes.push("the number of resamples has an effect only on percentile intervals".to_owned());
        }
        if analysis.aggregate && outputs < 2 {
            notes.push("indices over all outputs have no effect with a single output".to_owned());
        }
        Ok(Study {
            name: self.name,
            title: self.title,
            subject: self.subject,
            space,
            design,
            analysis,
            target: length.target,
            low_fidelities: self.low_fidelities,
            source: StudySource { notes, ..StudySource::default() },
        })
    }
}

/// Describes the study in comments, in place of a study file in the result: no file can name its model.
fn in_words(study: &Study) -> String {
    let (base_samples, identity) = (study.design.settings().base_samples, study.identity());
    let lines =
        format!("A study built in code: its model is part of a program.\nbase_samples = {base_samples}\n{identity:#}");
    lines.lines().map(|line| format!("# {line}\n")).collect()
}
