//! The differences between two studies.

use std::collections::BTreeSet;

use apportion::result::{FactorRecord, StudyResult};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::with_unit;

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
pub(super) fn differences<'a>(a: &'a StudyResult, b: &'a StudyResult) -> Vec<SettingDifference> {
    let mut found = Vec::new();
    let mut note = |what: &str, said: &dyn Fn(&StudyResult) -> Option<String>| {
        let (a, b) = (said(a), said(b));
        found.extend((a != b).then(|| SettingDifference { what: what.to_owned(), a, b }));
    };
    note("model", &|result| Some(result.study.model.clone()));
    if a.study.model == b.study.model {
        for key in union(a.study.settings.keys(), b.study.settings.keys()) {
            note(key, &|result| result.study.settings.get(key).map(in_words));
        }
        // A name that is a factor in either study is compared among the factors.
        let is_factor = |name: &String| [a, b].iter().any(|result| result.factors.iter().any(|f| f.name == *name));
        let names = |result: &'a StudyResult| result.study.constants.iter().map(|constant| &constant.name);
        for name in union(names(a), names(b)).into_iter().filter(|name| !is_factor(name)) {
            note(name, &|result| {
                let constant = result.study.constants.iter().find(|constant| constant.name == *name)?;
                Some(with_unit(constant.value, &constant.unit))
            });
        }
    }
    for name in union(a.factors.iter().map(|f| &f.name), b.factors.iter().map(|f| &f.name)) {
        let factor = |result: &StudyResult| result.factors.iter().find(|factor| factor.name == *name).map(of_factor);
        note(&format!("factor {name}"), &factor);
    }
    note("sampler", &|result| Some(result.provenance.sampler.clone()));
    note("base samples", &|result| Some(result.provenance.base_samples.to_string()));
    note("replicates", &|result| Some(result.provenance.replicates.to_string()));
    note("plain rows", &|result| Some(result.provenance.plain_rows.to_string()));
    note("seed", &|result| Some(result.provenance.seed.to_string()));
    note("version", &|result| Some(result.provenance.apportion_version.clone()));
    found
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
    let Value::Object(map) = &factor.distribution else { return factor.distribution.to_string() };
    let said = map.iter().map(|(key, value)| match key.as_str() {
        "name" => in_words(value),
        _ => format!("{key} {}", in_words(value)),
    });
    let words = said.collect::<Vec<_>>().join(", ");
    if matches!(factor.unit.as_str(), "" | "1") { words } else { format!("{words} ({})", factor.unit) }
}
