//! Studies made in code, of models that no file can name.

use std::fmt::Write;
use std::sync::Arc;

use sha2::{Digest, Sha256};

use super::build_checks::{check_factor, checked, checked_target, refuse_overlap, refuse_repeated};
use super::options::{MOST_OUTPUTS_OF_MEASURES, rows, split_design};
use super::subject::{CustomSubject, LowFidelity};
use super::{AnalysisOptions, BuildError, Study, SurrogateChoice, Target};

use crate::design::{Design, DesignSettings, Sampler};
use crate::model::Model;
use crate::names::{names_files, refused_output_name, refused_title, shown};
use crate::quantity::Unit;
use crate::space::{Dependence, Distribution, Factor, Space};

/// A study in the making; [`Study::builder`] begins one.
pub struct StudyBuilder {
    name: String,
    title: Option<String>,
    model: Arc<dyn Model>,
    version: Option<String>,
    factors: Vec<Result<Factor, BuildError>>,
    sampler: Sampler,
    base_samples: Option<u64>,
    replicates: Option<u64>,
    plain_rows: u32,
    budget_runs: Option<u64>,
    seed: u64,
    analysis: Option<AnalysisOptions>,
    target: Target,
    lows: Vec<LowFidelity>,
    dependences: Vec<Dependence>,
}

impl StudyBuilder {
    pub(super) fn new(name: &str, model: Arc<dyn Model>) -> Self {
        let DesignSettings { sampler, seed, .. } = DesignSettings::default();
        Self {
            name: name.to_owned(),
            title: None,
            model,
            version: None,
            factors: Vec::new(),
            sampler,
            base_samples: None,
            replicates: None,
            plain_rows: 0,
            budget_runs: None,
            seed,
            analysis: None,
            target: Target::default(),
            lows: Vec::new(),
            dependences: Vec::new(),
        }
    }

    /// A title for people.
    #[must_use]
    pub fn title(mut self, title: &str) -> Self {
        self.title = Some(title.to_owned());
        self
    }

    /// What tells the model from others of the same outputs and factors: without it a [journal](crate::Runner::journal) cannot
    /// tell that the function has changed, and answers with the runs of the one before.
    #[must_use]
    pub fn version(mut self, version: &str) -> Self {
        self.version = Some(version.to_owned());
        self
    }

    /// One more factor: a pure number. The order of factors is that of the values that the model gets.
    #[must_use]
    pub fn factor(self, name: &str, distribution: Distribution) -> Self {
        self.factor_in(name, Unit::dimensionless(), distribution)
    }

    /// One more factor, whose distribution is in `unit`. The model gets its values in SI units.
    #[must_use]
    pub fn factor_in(mut self, name: &str, unit: Unit, distribution: Distribution) -> Self {
        let factor = Factor::new(name, unit, distribution);
        self.factors.push(factor.map_err(|source| BuildError::Factor { factor: name.to_owned(), source }));
        self
    }

    /// One more factor, made before: with a group, or a nominal value other than its median.
    #[must_use]
    pub fn with_factor(mut self, factor: Factor) -> Self {
        self.factors.push(Ok(factor));
        self
    }

    /// Factors that depend on each other.
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
    #[must_use]
    pub fn dependence(mut self, dependence: Dependence) -> Self {
        self.dependences.push(dependence);
        self
    }

    /// Where the points come from; scrambled Sobol' points by default.
    #[must_use]
    pub fn sampler(mut self, sampler: Sampler) -> Self {
        self.sampler = sampler;
        self
    }

    /// Base samples in all, best a power of two for each replicate; 2^14 by default, less at the start of a run that goes on
    /// [until](Self::until) a target. The cost is base samples x (2 + factors) runs.
    #[must_use]
    pub fn base_samples(mut self, base_samples: u64) -> Self {
        self.base_samples = Some(base_samples);
        self
    }

    /// Independent randomisations that share the base samples; by default as many as the kind of interval works best with.
    #[must_use]
    pub fn replicates(mut self, replicates: u64) -> Self {
        self.replicates = Some(replicates);
        self
    }

    /// Runs of every base sample at points of their own, which only surrogates learn from: for models so dear that a few
    /// hundred runs are all. Three quarters of the runs are a good share.
    #[must_use]
    pub fn plain_rows(mut self, rows: u32) -> Self {
        self.plain_rows = rows;
        self
    }

    /// The best split design of at most so many runs, in the place of [`base_samples`](Self::base_samples) and
    /// [`plain_rows`](Self::plain_rows): an eighth to a third of the runs at base samples, the others at plain rows.
    ///
    /// ```
    /// use apportion::{Distribution, Study, function_model};
    ///
    /// let model = function_model("y", |x| x[0] + x[1] * x[1]);
    /// let study = Study::builder("dear", model)
    ///     .factor("a", Distribution::uniform(0.0, 1.0)?)
    ///     .factor("b", Distribution::uniform(0.0, 1.0)?)
    ///     .budget_runs(100)
    ///     .build()?;
    /// assert!(study.design().rows() <= 100);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn budget_runs(mut self, runs: u64) -> Self {
        self.budget_runs = Some(runs);
        self
    }

    /// Seed of the design, 0 by default.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// What is asked of the runs; [`AnalysisOptions::for_sampler`] by default.
    #[must_use]
    pub fn analysis(mut self, analysis: AnalysisOptions) -> Self {
        self.analysis = Some(analysis);
        self
    }

    /// How well the indices must be known: the run goes on by doubling until they are.
    #[must_use]
    pub fn until(mut self, target: Target) -> Self {
        self.target = target;
        self
    }

    /// A cheaper model of the same outputs, by name: it stands in for the model where that helps, and the runs of the model
    /// show the rest. `base_samples` is the size of its own design; `None` to let the run choose.
    #[must_use]
    pub fn low_fidelity(mut self, name: &str, model: impl Model + 'static, base_samples: Option<u64>) -> Self {
        let subject = Arc::new(CustomSubject { model: Arc::new(model), version: None });
        self.lows.push(LowFidelity { name: name.to_owned(), subject, base_samples });
        self
    }

    /// The study.
    ///
    /// # Errors
    /// [`BuildError`] with what is wrong and what would be right.
    pub fn build(self) -> Result<Study, BuildError> {
        if !names_files(&self.name) {
            return Err(BuildError::Name(self.name));
        }
        if self.model.outputs().is_empty() {
            return Err(BuildError::NoOutputs);
        }
        let words = |what, name: &str, expected| Err(BuildError::Words { what, name: shown(name), expected });
        if let Some((title, expected)) = self.title.as_ref().and_then(|title| Some((title, refused_title(title)?))) {
            return words("title", title, expected);
        }
        for output in self.model.outputs() {
            if let Some(expected) = refused_output_name(&output.name) {
                return words("output", &output.name, expected);
            }
        }
        for factor in self.factors.iter().flatten() {
            check_factor(factor)?;
        }
        refuse_repeated("output", self.model.outputs().iter().map(|output| &*output.name))?;
        refuse_overlap(&*self.model)?;
        let space = Space::new(self.factors.into_iter().collect::<Result<_, _>>()?);
        refuse_repeated("factor", space.factors().iter().map(|factor| factor.name.as_str()))?;
        let analysis = self.analysis.unwrap_or_else(|| AnalysisOptions::for_sampler(self.sampler));
        let analysis = checked(analysis, self.sampler, &space)?;
        let space = space.with_dependences(self.dependences)?;
        if space.noise().is_some() && analysis.asks_for_shapley() {
            return Err(BuildError::Dependent { what: "Shapley effects beside the noise of a stochastic model" });
        }
        if space.copula().is_some() {
            let refused = [
                ("the noise of a stochastic model", space.noise().is_some()),
                ("surrogate = \"on\"", analysis.surrogate == SurrogateChoice::On),
                ("a target of accuracy, which chooses by surrogates (a half width does not)", self.target.is_free),
                ("cheaper models", !self.lows.is_empty()),
            ];
            if let Some((what, _)) = refused.into_iter().find(|(_, asked)| *asked) {
                return Err(BuildError::Dependent { what });
            }
        }
        let outputs = self.model.outputs().len();
        if !analysis.measures.is_empty() && outputs > MOST_OUTPUTS_OF_MEASURES {
            return Err(BuildError::Measures { outputs });
        }
        let target = checked_target(self.target, self.sampler)?;
        let is_split = self.plain_rows > 0 || self.budget_runs.is_some();
        let replicates = self.replicates.unwrap_or(analysis.intervals.default_replicates());
        if let Some(why) = analysis.refuses_plain_rows(self.sampler, replicates).filter(|_| is_split) {
            return Err(BuildError::PlainRows { why });
        }
        let mut sizes = (self.base_samples.unwrap_or_else(|| target.base_samples(replicates)), self.plain_rows);
        if let Some(runs) = self.budget_runs {
            let others = [
                ("base_samples", self.base_samples.is_some()),
                ("plain_rows", self.plain_rows > 0),
                ("a target", self.target != Target::default()),
            ];
            if let Some((other, _)) = others.into_iter().find(|(_, is_there)| *is_there) {
                return Err(BuildError::BudgetRunsBeside { other });
            }
            let split = split_design(runs, &analysis, &space, self.sampler, replicates).transpose();
            sizes = split.map_err(|least| BuildError::BudgetRuns { least })?.unwrap_or(sizes);
        }
        let (base_samples, plain_rows) = sizes;
        let settings =
            target.first_stage(DesignSettings { sampler: self.sampler, base_samples, replicates, seed: self.seed });
        let design = Design::new(settings, space.factors().len(), rows(&analysis, &space, plain_rows))?;
        let design = target.within_max_runs(design).map_err(|least| BuildError::MaxRuns { least })?;
        for low in &self.lows {
            if let Some(problem) = low.refused(&*self.model, &space) {
                return Err(BuildError::LowFidelity { name: low.name.clone(), problem });
            }
        }
        let source = in_words(&self.name, &design, &space);
        Ok(Study {
            sha256: Sha256::digest(source.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect(),
            name: self.name,
            title: self.title,
            subject: Arc::new(CustomSubject { model: self.model, version: self.version }),
            space,
            design,
            analysis,
            target,
            lows: self.lows,
            overrides: Vec::new(),
            source,
            notes: Vec::new(),
        })
    }
}

/// What stands in the result in the place of a study file.
fn in_words(name: &str, design: &Design, space: &Space) -> String {
    let settings = design.settings();
    let mut text = format!(
        "# A study built in code: its model is part of a program.\nname = \"{name}\"\n\n[design]\nsampler = \"{}\"\n\
         base_samples = {}\nreplicates = {}\nseed = {}\n",
        settings.sampler.name(),
        settings.base_samples,
        settings.replicates,
        settings.seed
    );
    if design.plain_rows() > 0 {
        let _ = writeln!(text, "plain_rows = {}", design.plain_rows());
    }
    for factor in space.factors() {
        let law = serde_json::to_string(factor.distribution()).unwrap_or_default();
        // Escapes of JSON are escapes of TOML.
        let name = serde_json::to_string(&factor.name).unwrap_or_default();
        let unit = factor.unit();
        // Into a string, which takes everything.
        let _ = write!(text, "\n[[factor]]\nname = {name}\n# {law} ({unit}), nominal {}\n", factor.nominal);
    }
    for dependence in space.dependences() {
        let (factors, correlation) = (dependence.factors(), dependence.correlation());
        let measure = dependence.measure_in_force().name();
        // Debug forms of lists of texts and numbers are TOML.
        let _ = write!(
            text,
            "\n[[dependence]]\nfactors = {factors:?}\ncorrelation = {correlation:?}\nmeasure = {measure:?}\n"
        );
    }
    text
}
