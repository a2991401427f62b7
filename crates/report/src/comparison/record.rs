//! The comparison as a record, with the differences between the studies.

use std::collections::BTreeSet;

use apportion::result::{FactorDistribution, FactorRecord, Named, OutputResult, StudyResult};
use apportion::uncertainty::{EffectEstimates, Estimate, Interval};
use apportion_base::quantity::Unit;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use thiserror::Error;

use crate::output_view::{effects, reason_in_words};
use crate::with_unit;

/// Two results compared, as described in `docs/reference/other-formats.md`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComparisonFile {
    /// `"apportion-comparison"`.
    pub format: String,
    /// 1.
    pub version: u32,
    /// The first result.
    pub a: ComparedSide,
    /// The second result.
    pub b: ComparedSide,
    /// The settings in which the studies differ.
    pub settings: Vec<SettingDifference>,
    /// Whether both use the same points: errors are then correlated, and the intervals of differences are too wide.
    pub shared_points: bool,
    /// Outputs that only one of them has.
    pub outputs_left_out: OneSided,
    /// Factors that only one of them has.
    pub factors_left_out: OneSided,
    /// The outputs that both have, in the order of A.
    pub outputs: Vec<ComparedOutput>,
}

/// One of the two results.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ComparedSide {
    /// Its label in tables and charts.
    pub label: String,
    /// Its study.
    pub study: String,
    /// Title of the study, if it has one.
    pub title: Option<String>,
    /// Its file.
    pub file: String,
    /// SHA-256 of the study file in hexadecimal.
    pub study_sha256: String,
}

/// What only one of the results has.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct OneSided {
    /// Names that only A has.
    pub a: Vec<String>,
    /// Names that only B has.
    pub b: Vec<String>,
}

/// An output in both results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComparedOutput {
    /// The output.
    pub name: String,
    /// Unit of the moments: that of A.
    pub unit: String,
    /// Mean in A and in B, in `unit`; `null` where there is none.
    pub mean: [Option<f64>; 2],
    /// Its interval in A and in B; `null` where there is none.
    pub mean_interval: [Option<Interval>; 2],
    /// Standard deviation in A and in B, in `unit`.
    pub sd: [Option<f64>; 2],
    /// Every factor, in the order of A and then of B, then the groups that both have.
    pub factors: Vec<ComparedFactor>,
    /// Why there are no indices in A, in B.
    pub reasons: [Option<String>; 2],
}

/// The indices of a factor or group in both results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComparedFactor {
    /// Its name.
    pub name: String,
    /// Whether it is a group of factors.
    pub group: bool,
    /// First-order index.
    pub first_order: ComparedIndex,
    /// Total index.
    pub total: ComparedIndex,
}

/// Differences of indices up to this are of the size of the rounding errors of the sums of the variance, which the
/// intervals do not include.
const ROUNDING: f64 = 1e-12;

/// One index in both results.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ComparedIndex {
    /// In A; `null` if it does not exist there.
    pub a: Option<Estimate>,
    /// In B; `null` if it does not exist there.
    pub b: Option<Estimate>,
    /// B minus A; `null` if one of them does not exist.
    pub difference: Option<Estimate>,
    /// Whether the interval of the difference excludes 0, and the difference is more than rounding (1e-12); `null`
    /// without an interval.
    pub differs: Option<bool>,
}

impl ComparedIndex {
    /// Compares the index `a` in A with the index `b` in B.
    pub fn new(a: Option<Estimate>, b: Option<Estimate>) -> Self {
        let difference = a.zip(b).map(|(a, b)| Estimate::difference(a, b));
        let differs = difference.and_then(|Estimate { estimate, interval }| {
            interval.map(|Interval { low, high }| (low > 0.0 || high < 0.0) && estimate.abs() > ROUNDING)
        });
        Self { a, b, difference, differs }
    }
}

/// Why two results cannot be compared.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum CompareError {
    /// They have no common output or no common factor.
    #[error("nothing to compare: the results have no {what} in common; A has {a}, B has {b}")]
    NothingInCommon {
        /// `output` or `factor`.
        what: &'static str,
        /// Those of A.
        a: String,
        /// Those of B.
        b: String,
    },
    /// Outputs of the same name are different quantities.
    #[error("the output `{output}` is not the same quantity: in {a} in A, in {b} in B")]
    OtherQuantity {
        /// The output.
        output: String,
        /// Its unit in A.
        a: String,
        /// Its unit in B.
        b: String,
    },
}

/// A result to compare, with its label.
#[derive(Debug, Clone, Copy)]
pub struct NamedResult<'a> {
    /// The result.
    pub result: &'a StudyResult,
    /// Its label in tables and charts.
    pub label: &'a str,
    /// The name of its file for the record of the comparison.
    pub file: &'a str,
}

/// Compares two results, output by output and factor by factor.
///
/// ```
/// use std::path::Path;
/// use apportion_report::comparison::{NamedResult, compare_results};
/// use apportion::result::StudyResult;
/// use apportion::Study;
///
/// let result = |choice: &str| -> Result<_, Box<dyn std::error::Error>> {
///     let text = format!("model = \"ishigami\"\n[function]\n{choice}\n[design]\nbase_samples = 4096");
///     let study = apportion_files::parse_study(&text, Path::new("a.toml"), &[])?;
///     Ok(study.run()?)
/// };
/// let (a, b) = (result("b = 0.1")?, result("b = 0.2")?);
/// let named = |result, label, file| NamedResult { result, label, file };
/// let file = compare_results(&named(&a, "A", "a.json"), &named(&b, "B", "b.json"))?;
/// // x3 acts only together with x1, the more so the larger b is.
/// let x3 = &file.outputs[0].factors[2];
/// assert_eq!((x3.first_order.differs, x3.total.differs), (Some(false), Some(true)));
/// assert_eq!(file.settings[0].what, "b");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`CompareError`] if they have no common output or factor, or outputs of the same name are different quantities.
pub fn compare_results(a: &NamedResult<'_>, b: &NamedResult<'_>) -> Result<ComparisonFile, CompareError> {
    let (first, second) = (a.result, b.result);
    let outputs_left_out = one_sided("output", &output_names(first), &output_names(second))?;
    let factors_left_out = one_sided("factor", &factor_names(first), &factor_names(second))?;
    let names: Vec<String> = factor_names(first).into_iter().chain(factors_left_out.b.iter().cloned()).collect();
    let mut outputs = Vec::new();
    for output in &first.outputs {
        if let Some(other) = second.outputs.iter().find(|other| other.name == output.name) {
            outputs.push(compared(&names, output, other)?);
        }
    }
    Ok(ComparisonFile {
        format: "apportion-comparison".to_owned(),
        version: 1,
        a: side(a),
        b: side(b),
        settings: differences(first, second),
        shared_points: shared_points(first, second),
        outputs_left_out,
        factors_left_out,
        outputs,
    })
}

/// Returns whether two results use the same points: the same sampler, seed, size and number of factors.
pub fn shared_points(a: &StudyResult, b: &StudyResult) -> bool {
    let [a, b] = [a, b].map(|result| {
        let p = &result.provenance;
        (p.sampler, p.seed, p.base_samples, p.replicates, result.factors.len())
    });
    a == b
}

fn side(&NamedResult { result, label, file }: &NamedResult<'_>) -> ComparedSide {
    ComparedSide {
        label: label.to_owned(),
        study: result.study.name.clone(),
        title: result.study.title.clone(),
        file: file.to_owned(),
        study_sha256: result.provenance.study_sha256.clone(),
    }
}

fn output_names(result: &StudyResult) -> Vec<String> {
    result.outputs.iter().map(|output| output.name.clone()).collect()
}

fn factor_names(result: &StudyResult) -> Vec<String> {
    result.factors.iter().map(|factor| factor.name.clone()).collect()
}

/// Returns the names that only one of them has; there must be common ones.
fn one_sided(what: &'static str, a: &[String], b: &[String]) -> Result<OneSided, CompareError> {
    let only_a: Vec<String> = a.iter().filter(|name| !b.contains(name)).cloned().collect();
    let only_b = b.iter().filter(|name| !a.contains(name)).cloned().collect();
    match only_a.len() == a.len() {
        true => {
            let [a, b] = [a, b].map(|names| if names.is_empty() { "none".to_owned() } else { names.join(", ") });
            Err(CompareError::NothingInCommon { what, a, b })
        }
        false => Ok(OneSided { a: only_a, b: only_b }),
    }
}

fn compared(names: &[String], a: &OutputResult, b: &OutputResult) -> Result<ComparedOutput, CompareError> {
    // If a unit is not understood, its text must be the same.
    let (of_a, of_b) = (Unit::label(&a.unit), Unit::label(&b.unit));
    if !of_a.compatible(&of_b) {
        return Err(CompareError::OtherQuantity { output: a.name.clone(), a: a.unit.clone(), b: b.unit.clone() });
    }
    let (mut mean, mut mean_interval) = (b.mean, b.mean_interval);
    let [sd, mut other_sd] = [a, b].map(|output| output.variance.filter(|variance| *variance >= 0.0).map(f64::sqrt));
    if a.unit != b.unit {
        mean = mean.map(|mean| of_a.from_si(of_b.to_si(mean)));
        mean_interval = mean_interval.map(|Interval { low, high }| {
            let [low, high] = [low, high].map(|bound| of_a.from_si(of_b.to_si(bound)));
            Interval { low, high }
        });
        other_sd = other_sd.map(|sd| of_a.span_from_si(of_b.span_to_si(sd)));
    }
    let mut factors = Vec::new();
    for name in names {
        let [a, b] = [a, b].map(|output| effects(output).find(|(factor, _)| factor == name).map(|(_, effect)| *effect));
        factors.push(compared_factor(name, false, a, b));
    }
    for Named { name, effect, .. } in a.groups.iter().flatten() {
        let other = b.groups.iter().flatten().find(|other| other.name == *name);
        factors.extend(other.map(|other| compared_factor(name, true, Some(*effect), Some(other.effect))));
    }
    Ok(ComparedOutput {
        name: a.name.clone(),
        unit: a.unit.clone(),
        mean: [a.mean, mean],
        mean_interval: [a.mean_interval, mean_interval],
        sd: [sd, other_sd],
        factors,
        reasons: [a, b].map(|output| output.indices.is_none().then(|| reason_in_words(output.reason))),
    })
}

fn compared_factor(name: &str, group: bool, a: Option<EffectEstimates>, b: Option<EffectEstimates>) -> ComparedFactor {
    ComparedFactor {
        name: name.to_owned(),
        group,
        first_order: ComparedIndex::new(a.map(|e| e.first_order), b.map(|e| e.first_order)),
        total: ComparedIndex::new(a.map(|e| e.total), b.map(|e| e.total)),
    }
}

/// A setting in which the two studies differ.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SettingDifference {
    /// The setting, such as `friction` or `factor length`.
    pub what: String,
    /// In A; `null` if A does not have it.
    pub a: Option<String>,
    /// In B; `null` if B does not have it.
    pub b: Option<String>,
}

/// Returns the settings in which the studies differ: model, its choices and constants, factors, design. If the models
/// differ, choices and constants are not compared.
pub(super) fn differences(a: &StudyResult, b: &StudyResult) -> Vec<SettingDifference> {
    let mut all = vec![setting("model", [a, b].map(|result| Some(result.study.model.clone())))];
    if a.study.model == b.study.model {
        for key in union(a.study.settings.keys(), b.study.settings.keys()) {
            all.push(setting(key, [a, b].map(|result| result.study.settings.get(key).map(in_words))));
        }
        let [of_a, of_b] = [a, b].map(|result| result.study.constants.iter().map(|constant| &constant.name));
        for name in union(of_a, of_b) {
            // A name that is a factor in either study is compared among the factors.
            if a.factors.iter().chain(&b.factors).all(|factor| factor.name != *name) {
                all.push(setting(
                    name,
                    [a, b].map(|result| {
                        let constant = result.study.constants.iter().find(|constant| constant.name == *name)?;
                        Some(with_unit(constant.value, &constant.unit))
                    }),
                ));
            }
        }
    }
    for name in union(a.factors.iter().map(|f| &f.name), b.factors.iter().map(|f| &f.name)) {
        let factors = [a, b].map(|result| result.factors.iter().find(|factor| factor.name == *name).map(of_factor));
        all.push(setting(&format!("factor {name}"), factors));
    }
    let [of_a, of_b] = [a, b].map(|result| {
        let p = &result.provenance;
        let [base_samples, replicates, seed] = [p.base_samples, p.replicates, p.seed].map(|number| number.to_string());
        let rows = if p.plain { "plain" } else { "with swaps" };
        [p.sampler.name().to_owned(), base_samples, replicates, rows.to_owned(), seed, p.apportion_version.clone()]
    });
    let names = ["sampler", "base samples", "replicates", "rows", "seed", "version"];
    for (name, (a, b)) in names.into_iter().zip(of_a.into_iter().zip(of_b)) {
        all.push(setting(name, [Some(a), Some(b)]));
    }
    all.into_iter().flatten().collect()
}

/// Returns a setting if it differs.
fn setting(what: &str, [a, b]: [Option<String>; 2]) -> Option<SettingDifference> {
    (a != b).then(|| SettingDifference { what: what.to_owned(), a, b })
}

/// Returns the names of both, each once, in the order of A and then of B.
fn union<'a>(a: impl Iterator<Item = &'a String>, b: impl Iterator<Item = &'a String>) -> Vec<&'a String> {
    let mut seen = BTreeSet::new();
    a.chain(b).filter(|name| seen.insert(*name)).collect()
}

fn in_words(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Describes a factor's distribution with its parameters and its unit.
fn of_factor(factor: &FactorRecord) -> String {
    let FactorDistribution { name, parameters } = &factor.distribution;
    let parameters = parameters.iter().map(|(key, value)| format!("{key} {}", in_words(value)));
    let words = std::iter::once(name.clone()).chain(parameters).collect::<Vec<_>>().join(", ");
    if matches!(factor.unit.as_str(), "" | "1") { words } else { format!("{words} ({})", factor.unit) }
}
