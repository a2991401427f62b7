//! The study file as TOML sees it, every value with its place in the text, after [`parse`](super::parse) has converted what
//! can be written in several ways. Editors show the comments on its fields, by the schema.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::sync::LazyLock;

use apportion::design::Sampler;
use apportion::estimate::Estimator;
use apportion::given::Measure;
use apportion::run::FailurePolicy;
use apportion::space::distribution::{KEYS, Key, KeyKind, Kind, Parameter};
use apportion::space::{CorrelationMeasure, IndicesOf};
use apportion::study::SurrogateChoice;
use apportion::uncertainty::IntervalMethod;
use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::{Deserializer, Error, MapAccess, Visitor};
use serde_json::json;

use super::at::{At, Choices};
use super::context::names_of;
use super::key_schemas;
use super::output_table::Outputs;
use crate::{ModelKind, Protocol};

/// A study of apportion: a model, the factors to compare, and the number of model runs.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(title = "apportion study")]
pub(super) struct StudyFile {
    /// Name of the result files; by default the name of the study file without its ending.
    pub name: Option<At<String>>,
    /// Title of the report.
    pub title: Option<At<String>>,
    /// The model; `apportion models` lists all of them.
    #[schemars(extend("enum" = ModelKind::all().iter().map(|kind| kind.name).collect::<Vec<_>>(), "default" = "afm"))]
    pub model: Option<At<String>>,
    /// Outputs: a list of names, by default the model's first. For formulas, a table: outputs.y = "x1 + x2". For programs
    /// and external models, also a table of units: outputs.y = "nN".
    #[schemars(schema_with = "key_schemas::outputs")]
    pub outputs: Option<At<Outputs>>,
    /// The physics of the nanoparticle model: choices by name, and inputs that are fixed, with their units.
    #[schemars(schema_with = "key_schemas::afm")]
    pub afm: Option<At<Choices>>,
    /// Parameters of a function with known indices.
    #[schemars(schema_with = "key_schemas::function")]
    pub function: Option<At<Choices>>,
    /// Constants of formulas.
    pub expression: Option<At<ExpressionSection>>,
    /// The program that is the model: a list of the program and its arguments, or a table.
    #[schemars(schema_with = "key_schemas::list_or_table::<CommandSection>")]
    pub command: Option<At<CommandSection>>,
    /// The noise of a stochastic model: the name of the seed that it gets with every row, or a table.
    #[schemars(schema_with = "key_schemas::name_or_table::<NoiseSection>")]
    pub noise: Option<At<NoiseSection>>,
    /// Required accuracy: the half width that the 95 % interval of every first-order and total index must
    /// reach. The run then chooses its design, surrogates and cheaper models.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub accuracy: Option<At<f64>>,
    /// With `accuracy`: the smallest part of a factor's range in which the output may behave differently that the run
    /// must not miss, such as 0.01; 0.05 where the model is a program or integrates motion, otherwise 0.001.
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub smallest_region: Option<At<f64>>,
    /// Factors that depend on each other, by a Gaussian copula: tables [[dependence]].
    pub dependence: Vec<At<DependenceSection>>,
    /// Cheaper models of the same outputs, used in place of the model where they help.
    pub fidelity: Option<At<FidelitySection>>,
    /// The points at which the model runs.
    pub design: DesignSection,
    /// Results in addition to first-order and total indices, and how they are estimated.
    pub analysis: AnalysisSection,
    /// The inputs to compare: tables [[factor]]. Their order in the file assigns the dimensions of the sequence.
    pub factor: Vec<At<FactorSection>>,
    /// The same, one line for each factor.
    #[schemars(skip)]
    pub factors: BTreeMap<At<String>, At<FactorSection>>,
}

/// A program of your own as the model.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, expecting = "a list in square brackets, or a table")]
pub(super) struct CommandSection {
    /// The program and its arguments; no shell reads them.
    #[schemars(length(min = 1))]
    pub program: Option<At<Vec<At<String>>>>,
    /// The format of rows and answers of a program that is kept alive.
    #[schemars(extend("enum" = names_of::<Protocol>(), "default" = "csv"))]
    pub protocol: Option<At<String>>,
    /// Number of processes at the same time; by default the number of cores.
    #[schemars(range(min = 1, max = 1024))]
    pub workers: Option<At<u64>>,
    /// Time limit for a row, as in "60 s"; by default none.
    pub timeout: Option<At<String>>,
    /// How often a row is retried after the program crashed, hung or printed an invalid answer; once by default.
    #[schemars(range(max = 100))]
    pub retries: Option<At<u64>>,
    /// Working directory of the program, relative to the study; by default the folder of the study.
    pub directory: Option<At<String>>,
    /// Environment variables that are set for the program.
    pub env: BTreeMap<String, String>,
    /// Other files that its answers depend on, such as data, relative to the study: recorded answers from before a change of these
    /// files are not reused. The program and files among its arguments are included; list what they import.
    pub depends_on: Vec<At<String>>,
    /// Template of an input file, in which {{name}} stands for the value of a factor: the program then runs once for each
    /// row, in its own directory.
    pub template: Option<At<String>>,
    /// Name of the input file in the directory of a run; by default that of the template.
    pub input: Option<At<String>>,
    /// Files that are copied to the directory of each run, relative to the study.
    pub files: Vec<At<String>>,
    /// Whether paths in this table may lead outside the study's folder.
    pub files_outside: Option<At<bool>>,
    /// Folder that keeps the directories of runs, relative to the study; by default each is removed after its run.
    pub keep: Option<At<String>>,
}

/// Constants of formulas.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, expecting = "a table [expression]")]
pub(super) struct ExpressionSection {
    /// Numbers, or quantities with units, that formulas may use.
    #[schemars(schema_with = "key_schemas::expression_constants")]
    pub constants: Choices,
}

/// Cheaper models of the same outputs.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table [fidelity]")]
pub(super) struct FidelitySection {
    /// The cheaper models: names of those that come with the model, as in "closed-form"; or tables of the keys that replace
    /// those of the model, as in { name = "coarse", command = ["./coarse"] }.
    #[schemars(schema_with = "key_schemas::lows")]
    pub low: At<Vec<At<toml::Value>>>,
    /// Base samples of their additional points; 16384 by default; with `accuracy` the run chooses.
    #[schemars(range(min = 1))]
    pub base_samples: Option<At<u64>>,
}

/// Factors that depend on each other, by a Gaussian copula.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table [[dependence]]")]
pub(super) struct DependenceSection {
    /// The factors: two or more.
    pub factors: NameList,
    /// Their correlation: one number for all pairs, or the symmetric matrix with ones on its diagonal.
    pub correlation: Option<At<Correlation>>,
    /// Measure of correlation: of the values ("pearson"), of the ranks ("spearman", "kendall"), or of the normal scores
    /// ("normal"), which are the parameters of the copula.
    #[schemars(extend("enum" = names_of::<CorrelationMeasure>(), "default" = "pearson"))]
    pub measure: Option<At<String>>,
    /// Instead of `correlation`: a CSV file of joint measurements, relative to the study, with a column named after each
    /// factor. The correlations are those of the normal scores of their ranks.
    pub file: Option<At<String>>,
    /// Instead of `file`: the joint measurements, each a list of one number for every factor.
    pub measurements: Option<At<Vec<Vec<f64>>>>,
}

/// Correlations of factors.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected a number, or a matrix as in [[1, 0.5], [0.5, 1]]")]
pub(super) enum Correlation {
    /// Of every pair.
    Pairs(f64),
    Matrix(Vec<Vec<f64>>),
}

/// The noise of a stochastic model.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "the name under which the model gets its seed, or a table [noise]")]
pub(super) struct NoiseSection {
    /// The name of the seed that the model gets, a whole number from 0 to 2^31 - 1; "seed" by default.
    pub name: Option<At<String>>,
    /// Runs of each row, each with its own seed: the outputs are then the mean and the variance over them.
    #[schemars(range(min = 1, max = 1000), extend("default" = 1))]
    pub repetitions: Option<At<u64>>,
    /// Whether to estimate total indices of the mean over the noise: one more run for each factor.
    #[schemars(extend("default" = false))]
    pub mean_totals: Option<At<bool>>,
}

/// The points at which the model runs.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table [design]")]
pub(super) struct DesignSection {
    /// Kind of points: Sobol', random, or a Latin hypercube.
    #[schemars(extend("enum" = names_of::<Sampler>(), "default" = "sobol"))]
    pub sampler: Option<At<String>>,
    /// Total number of base samples, preferably a power of two for each replicate; the study costs base_samples x (2 + factors) runs.
    pub base_samples: Option<At<u64>>,
    /// Instead of `base_samples`: the largest number of model runs; the design is the best one within it.
    #[schemars(range(min = 1))]
    pub runs: Option<At<u64>>,
    /// Number of independent randomisations that share the base samples.
    pub replicates: Option<At<u64>>,
    /// Seed of the design; 0 is a valid seed.
    pub seed: Option<At<u64>>,
    /// Limit of model runs for a run with `accuracy`; alone, the number of runs is doubled up to this limit.
    pub max_runs: Option<At<u64>>,
    /// Time limit for a run with `accuracy`, as in "30 s"; alone, the number of runs is doubled up to this limit.
    pub max_time: Option<At<String>>,
}

/// Names, each with its place.
pub(super) type NameList = At<Vec<At<String>>>;

/// Results in addition to first-order and total indices, and how they are estimated.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table [analysis]")]
pub(super) struct AnalysisSection {
    /// Further estimators, in addition to the default ones.
    #[schemars(extend("items" = json!({ "enum": names_of::<Estimator>() })))]
    pub estimators: Option<At<Vec<At<String>>>>,
    /// What has indices: every factor, and the groups in addition; or the groups in place of their factors, which takes the runs
    /// of so many factors.
    #[schemars(extend("enum" = names_of::<IndicesOf>(), "default" = "factors"))]
    pub indices_of: Option<At<String>>,
    /// Second-order indices of all pairs; nearly twice the runs.
    pub second_order: Option<At<bool>>,
    /// Sets of factors whose joint indices are estimated.
    pub subsets: Option<At<Vec<NameList>>>,
    /// Shapley effects: shares of the variance that sum to 1 even where factors depend on each other. 2^d runs for each base sample
    /// for up to 8 factors. By default for up to 4 factors that depend on each other.
    pub shapley: Option<At<bool>>,
    /// Other measures of the influence of every factor, from the first 4096 rows A and B; for at most 100 outputs.
    #[schemars(extend("items" = json!({ "enum": names_of::<Measure>() })))]
    pub measures: Option<At<Vec<At<String>>>>,
    /// Indices over all outputs together.
    pub aggregate: Option<At<bool>>,
    /// Adds a factor without effect: its indices show the numerical error.
    pub dummy: Option<At<bool>>,
    /// Also estimates the indices from half of the runs, a quarter, and so on. With surrogates each stage needs its own fits: without
    /// these stages an analysis takes a third of the time.
    #[schemars(extend("default" = true))]
    pub convergence: Option<At<bool>>,
    /// How intervals are estimated; the default depends on the sampler.
    #[schemars(extend("enum" = names_of::<IntervalMethod>()))]
    pub intervals: Option<At<String>>,
    /// Whether surrogates (polynomials fitted to the runs) correct the indices. More accurate, by orders of magnitude for
    /// smooth models; needs time, and memory for all outputs.
    #[schemars(extend("enum" = names_of::<SurrogateChoice>(), "default" = "off"))]
    pub surrogate: Option<At<String>>,
    /// Number of resamples of a bootstrap.
    #[schemars(range(min = 100, max = 1_000_000))]
    pub resamples: Option<At<u64>>,
    /// Total index above which a factor counts as influential.
    #[schemars(extend("minimum" = 0, "maximum" = 1))]
    pub threshold: Option<At<f64>>,
    /// What to do when a run fails.
    #[schemars(extend("enum" = names_of::<FailurePolicy>()))]
    pub failures: Option<At<String>>,
    /// Largest share of runs that may fail; beyond it no indices are estimated.
    #[schemars(extend("minimum" = 0, "maximum" = 1))]
    pub max_failed: Option<At<f64>>,
}

/// An input of the model, and its distribution.
#[derive(Debug, Default, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub(super) struct FactorSection {
    /// The input of the model.
    pub name: At<String>,
    /// Its distribution.
    #[schemars(extend("enum" = Kind::all().map(Kind::name).collect::<Vec<_>>(), "default" = "uniform"))]
    #[schemars(extend("enumDescriptions" = Kind::all().map(Kind::summary).collect::<Vec<_>>()))]
    pub distribution: Option<At<String>>,
    /// Unit of all numbers of this factor, as in "um".
    pub unit: Option<At<String>>,
    /// Factors of one group also get joint indices.
    pub group: Option<At<String>>,
    /// Its value in scenes and in sweeps of other factors; for a category, its label.
    pub nominal: Option<At<Nominal>>,
    /// The keys of its distribution.
    #[schemars(skip)]
    pub keys: Vec<TypedKey>,
}

/// A key of a distribution.
#[derive(Debug)]
pub(super) struct TypedKey {
    pub key: &'static Key,
    /// The position of its value.
    pub span: Range<usize>,
    pub value: TypedValue,
}

/// The value of a distribution's key.
#[derive(Debug)]
pub(super) enum TypedValue {
    Parameter(Parameter),
    Text(At<String>),
    Bounds(Vec<f64>),
    Quantiles(BTreeMap<At<String>, At<f64>>),
}

impl FactorSection {
    /// The place of a key of its distribution.
    pub fn place(&self, key: &str) -> Option<Range<usize>> {
        self.keys.iter().find(|typed| typed.key.name == key).map(|typed| typed.span.clone())
    }
}

impl<'de> Deserialize<'de> for FactorSection {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(FactorVisitor)
    }
}

/// A visitor, because the keys of distributions are those of a table.
struct FactorVisitor;

impl<'de> Visitor<'de> for FactorVisitor {
    type Value = FactorSection;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table, as in { min = 0, max = 1 }")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<FactorSection, A::Error> {
        let mut fields = FactorSection::default();
        while let Some(FactorKey(name)) = map.next_key()? {
            match name {
                "name" => fields.name = map.next_value()?,
                "distribution" => fields.distribution = Some(map.next_value()?),
                "unit" => fields.unit = Some(map.next_value()?),
                "group" => fields.group = Some(map.next_value()?),
                "nominal" => fields.nominal = Some(map.next_value()?),
                name => {
                    let key = KEYS.iter().find(|key| key.name == name);
                    let key = key.ok_or_else(|| A::Error::unknown_field(name, &FACTOR_KEYS))?;
                    let (span, value) = typed_value(key.kind, &mut map)?;
                    fields.keys.push(TypedKey { key, span, value });
                }
            }
        }
        fields.keys.sort_by_key(|typed| typed.span.start);
        Ok(fields)
    }
}

fn typed_value<'de, A: MapAccess<'de>>(kind: KeyKind, map: &mut A) -> Result<(Range<usize>, TypedValue), A::Error> {
    Ok(match kind {
        KeyKind::Number => spanned(map.next_value()?, |number| TypedValue::Parameter(Parameter::Number(number))),
        KeyKind::Numbers => spanned(map.next_value()?, |list| TypedValue::Parameter(Parameter::List(list))),
        KeyKind::Text => map.next_value().map(|text: At<String>| (text.span(), TypedValue::Text(text)))?,
        KeyKind::Texts => spanned(map.next_value()?, |texts| TypedValue::Parameter(Parameter::Texts(texts))),
        KeyKind::Bounds => spanned(map.next_value()?, TypedValue::Bounds),
        KeyKind::Quantiles => spanned(map.next_value()?, TypedValue::Quantiles),
    })
}

fn spanned<T>(value: At<T>, convert: impl FnOnce(T) -> TypedValue) -> (Range<usize>, TypedValue) {
    (value.span(), convert(value.into_inner()))
}

/// Keys of a factor that are not about its distribution.
const OF_FACTORS: [&str; 4] = ["name", "unit", "group", "nominal"];

/// All keys of a factor.
static FACTOR_KEYS: LazyLock<Vec<&str>> =
    LazyLock::new(|| OF_FACTORS.into_iter().chain(["distribution"]).chain(KEYS.iter().map(|key| key.name)).collect());

/// A key that a factor has.
struct FactorKey(&'static str);

impl<'de> Deserialize<'de> for FactorKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let typed = String::deserialize(deserializer)?;
        let key = FACTOR_KEYS.iter().find(|key| **key == typed);
        key.map(|key| Self(key)).ok_or_else(|| D::Error::unknown_field(&typed, &FACTOR_KEYS))
    }
}

/// The value of a factor that does not vary: a number, a category, or true or false.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(super) enum Nominal {
    Truth(bool),
    Number(f64),
    Label(String),
}
