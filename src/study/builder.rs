//! Studies made in code, of models that no file can name.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::sync::Arc;

use sha2::{Digest, Sha256};
use thiserror::Error;

use super::options::rows;
use super::subject::CustomSubject;
use super::{AnalysisOptions, Study, Target};
use crate::design::{Design, DesignError, DesignSettings, Sampler};
use crate::estimate::Estimator;
use crate::model::Model;
use crate::names::{names_files, refused_name, refused_output_name, refused_title, shown};
use crate::quantity::Unit;
use crate::space::{Distribution, DistributionError, Factor, Space};

/// Why a study cannot be built.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum BuildError {
    /// The name cannot name files.
    #[error("the name {0:?} of the study: expected {NAME}", NAME = crate::names::NAME_RULE)]
    Name(String),
    /// A name or title that no table or file has room for, or with marks in it that are not seen.
    #[error("{what} {name}: expected {expected}")]
    Words {
        /// What it is of.
        what: &'static str,
        /// The name or title, or its beginning.
        name: String,
        /// What would be right.
        expected: String,
    },
    /// The model has no outputs.
    #[error("the model has no outputs")]
    NoOutputs,
    /// A name twice.
    #[error("{what} `{name}` is there twice")]
    Repeated {
        /// What the name is of.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A factor cannot be converted to SI units.
    #[error("factor `{factor}`: {source}")]
    Factor {
        /// Its name.
        factor: String,
        /// Why.
        source: DistributionError,
    },
    /// There is no such design.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// Intervals of a kind that does not hold for these points.
    #[error("intervals \"{method}\" do not hold for points of the sampler \"{sampler}\"")]
    UnfitInterval {
        /// The kind of interval.
        method: &'static str,
        /// The sampler.
        sampler: &'static str,
    },
    /// A subset names no factors, or one that is not there.
    #[error("subset {subset:?}: expected numbers of factors, counted from 0, of which there are {factors}")]
    Subset {
        /// The subset.
        subset: Vec<usize>,
        /// The number of factors.
        factors: usize,
    },
    /// A target that no run can reach.
    #[error("{what} = {value}: expected a finite number above 0")]
    NotPositive {
        /// What of the target.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A target for points that cannot be added to.
    #[error(
        "a run goes on until a target by adding points, and a Latin hypercube has none to add: take another sampler"
    )]
    CannotGrow,
    /// Fewer runs than the smallest design takes.
    #[error("max_runs of the target: expected {least} or more, which 2 base points in each replicate take")]
    MaxRuns {
        /// Runs of the smallest design.
        least: u64,
    },
    /// A share or threshold that is none.
    #[error("{what} = {value}: expected a number from 0 to 1")]
    NotAShare {
        /// Which.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// Plain rows where no surrogate would learn from them.
    #[error("plain rows serve surrogates alone, and there are none with {why}")]
    PlainRows {
        /// The option that stands against them.
        why: String,
    },
}

/// A study in the making; [`Study::builder`] begins one.
pub struct StudyBuilder {
    name: String,
    title: Option<String>,
    model: Arc<dyn Model>,
    factors: Vec<Result<Factor, BuildError>>,
    sampler: Sampler,
    base_samples: Option<u64>,
    replicates: Option<u64>,
    plain_rows: u32,
    seed: u64,
    analysis: Option<AnalysisOptions>,
    target: Target,
}

impl StudyBuilder {
    pub(super) fn new(name: &str, model: Arc<dyn Model>) -> Self {
        let DesignSettings { sampler, seed, .. } = DesignSettings::default();
        Self {
            name: name.to_owned(),
            title: None,
            model,
            factors: Vec::new(),
            sampler,
            base_samples: None,
            replicates: None,
            plain_rows: 0,
            seed,
            analysis: None,
            target: Target::default(),
        }
    }

    /// A title for people.
    #[must_use]
    pub fn title(mut self, title: &str) -> Self {
        self.title = Some(title.to_owned());
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
            if let Some(expected) = refused_name(&factor.name) {
                return words("factor", &factor.name, expected);
            }
        }
        refuse_repeated("output", self.model.outputs().iter().map(|output| &*output.name))?;
        let space = Space::new(self.factors.into_iter().collect::<Result<_, _>>()?);
        refuse_repeated("factor", space.factors().iter().map(|factor| factor.name.as_str()))?;
        let analysis = self.analysis.unwrap_or_else(|| AnalysisOptions::for_sampler(self.sampler));
        let analysis = checked(analysis, self.sampler, space.factors().len())?;
        let target = checked_target(self.target, self.sampler)?;
        let replicates = self.replicates.unwrap_or(analysis.default_replicates(self.sampler, self.plain_rows > 0));
        let settings = target.first_stage(DesignSettings {
            sampler: self.sampler,
            base_samples: self.base_samples.unwrap_or_else(|| target.base_samples(replicates)),
            replicates,
            seed: self.seed,
        });
        if let Some(why) = analysis.refuses_plain_rows(self.sampler, replicates).filter(|_| self.plain_rows > 0) {
            return Err(BuildError::PlainRows { why });
        }
        let design = Design::new(settings, space.factors().len(), rows(&analysis, &space, self.plain_rows))?;
        let design = target.within_max_runs(design).map_err(|least| BuildError::MaxRuns { least })?;
        let source = in_words(&self.name, &design, &space);
        Ok(Study {
            sha256: Sha256::digest(source.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect(),
            name: self.name,
            title: self.title,
            subject: Arc::new(CustomSubject(self.model)),
            space,
            design,
            analysis,
            target,
            overrides: Vec::new(),
            source,
            notes: Vec::new(),
        })
    }
}

fn refuse_repeated<'a>(what: &'static str, mut names: impl Iterator<Item = &'a str>) -> Result<(), BuildError> {
    let mut seen = BTreeSet::new();
    let repeated = names.find(|name| !seen.insert(*name));
    repeated.map_or(Ok(()), |name| Err(BuildError::Repeated { what, name: name.to_owned() }))
}

/// The options as a study file could have said them.
fn checked(mut options: AnalysisOptions, sampler: Sampler, factors: usize) -> Result<AnalysisOptions, BuildError> {
    if !options.intervals.serves(sampler) {
        let (method, sampler) = (options.intervals.name(), sampler.name());
        return Err(BuildError::UnfitInterval { method, sampler });
    }
    for (what, value) in [("threshold", options.threshold), ("max_failed", options.max_failed)] {
        if !(0.0..=1.0).contains(&value) {
            return Err(BuildError::NotAShare { what, value });
        }
    }
    for subset in &mut options.subsets {
        subset.sort_unstable();
        subset.dedup();
        if subset.is_empty() || subset.iter().any(|factor| *factor >= factors) {
            return Err(BuildError::Subset { subset: subset.clone(), factors });
        }
    }
    // The default ones are in every result.
    options.estimators.retain(|estimator| *estimator != Estimator::Default);
    Ok(options)
}

/// The target as a study file could have said it.
fn checked_target(target: Target, sampler: Sampler) -> Result<Target, BuildError> {
    if target.grows() && sampler == Sampler::LatinHypercube {
        return Err(BuildError::CannotGrow);
    }
    for (what, value) in [("half width of the target", target.half_width), ("budget", target.budget)] {
        if let Some(value) = value.filter(|value| !(*value > 0.0 && value.is_finite())) {
            return Err(BuildError::NotPositive { what, value });
        }
    }
    Ok(target)
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
    text
}
