//! What was typed: the study file as TOML sees it, every value with its place in the text.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

/// A number, string or list with its byte range in the file.
pub(super) type At<T> = Spanned<T>;

/// A table of choices by name.
pub(super) type Choices = BTreeMap<At<String>, At<toml::Value>>;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyFile {
    pub name: Option<At<String>>,
    pub title: Option<String>,
    pub model: Option<At<String>>,
    pub outputs: Option<At<Vec<At<String>>>>,
    pub afm: Option<At<Choices>>,
    pub function: Option<At<Choices>>,
    pub expression: Option<At<ExpressionSection>>,
    #[serde(default)]
    pub design: DesignSection,
    #[serde(default)]
    pub analysis: AnalysisSection,
    #[serde(default)]
    pub factor: Vec<At<FactorSection>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ExpressionSection {
    #[serde(default)]
    pub outputs: Choices,
    #[serde(default)]
    pub constants: Choices,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DesignSection {
    pub sampler: Option<At<String>>,
    pub base_samples: Option<At<u64>>,
    pub replicates: Option<At<u64>>,
    pub seed: Option<At<u64>>,
    pub target: Option<At<TargetSection>>,
    pub budget: Option<At<String>>,
    pub max_runs: Option<At<u64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TargetSection {
    pub half_width: At<f64>,
}

/// Names, each with its place.
pub(super) type NameList = At<Vec<At<String>>>;

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AnalysisSection {
    pub estimators: Option<At<Vec<At<String>>>>,
    pub second_order: Option<At<bool>>,
    pub subsets: Option<At<Vec<NameList>>>,
    pub aggregate: Option<At<bool>>,
    pub dummy: Option<At<bool>>,
    pub intervals: Option<At<String>>,
    pub resamples: Option<At<u64>>,
    pub threshold: Option<At<f64>>,
    pub failures: Option<At<String>>,
    pub max_failed: Option<At<f64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FactorSection {
    pub name: At<String>,
    pub distribution: Option<At<String>>,
    pub unit: Option<At<String>>,
    pub group: Option<At<String>>,
    pub nominal: Option<At<Nominal>>,
    pub min: Option<At<f64>>,
    pub max: Option<At<f64>>,
    pub mean: Option<At<f64>>,
    pub sd: Option<At<f64>>,
    pub log_mean: Option<At<f64>>,
    pub log_sd: Option<At<f64>>,
    pub mode: Option<At<f64>>,
    pub alpha: Option<At<f64>>,
    pub beta: Option<At<f64>>,
    pub shape: Option<At<f64>>,
    pub scale: Option<At<f64>>,
    pub location: Option<At<f64>>,
    pub p01: Option<At<f64>>,
    pub p05: Option<At<f64>>,
    pub p10: Option<At<f64>>,
    pub p25: Option<At<f64>>,
    pub p50: Option<At<f64>>,
    pub p75: Option<At<f64>>,
    pub p90: Option<At<f64>>,
    pub p95: Option<At<f64>>,
    pub p99: Option<At<f64>>,
    pub probability: Option<At<f64>>,
    pub value: Option<At<f64>>,
    pub values: Option<At<Vec<f64>>>,
    pub weights: Option<At<Vec<f64>>>,
    pub labels: Option<At<Vec<String>>>,
    pub file: Option<At<String>>,
    pub column: Option<At<String>>,
}

/// Where a factor stands when it does not vary: a number, a category, or true or false.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
pub(super) enum Nominal {
    Truth(bool),
    Number(f64),
    Label(String),
}

impl StudyFile {
    /// The keys it can have.
    pub(super) const KEYS: [&str; 10] =
        ["name", "title", "model", "outputs", "afm", "function", "expression", "design", "analysis", "factor"];
}
