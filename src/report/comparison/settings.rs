//! In what two studies differ.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::report::with_unit;
use crate::result::{FactorRecord, StudyResult};

/// Something that the two studies say differently.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SettingDifference {
    /// What, as in `friction` or `factor length`.
    pub what: String,
    /// In A; `null` if A does not have it.
    pub a: Option<String>,
    /// In B; `null` if B does not have it.
    pub b: Option<String>,
}

/// What the studies of two results say differently: model, its choices and constants, factors, design. Of two different
/// models, choices and constants are not compared.
pub(super) fn differences(a: &StudyResult, b: &StudyResult) -> Vec<SettingDifference> {
    let mut found = Vec::new();
    let mut note = |what: &str, a: Option<String>, b: Option<String>| {
        if a != b {
            found.push(SettingDifference { what: what.to_owned(), a, b });
        }
    };
    note("model", Some(a.study.model.clone()), Some(b.study.model.clone()));
    if a.study.model == b.study.model {
        for key in union(a.study.settings.keys(), b.study.settings.keys()) {
            let value = |result: &StudyResult| result.study.settings.get(key).map(in_words);
            note(key, value(a), value(b));
        }
        let names = |result: &'_ StudyResult| result.study.constants.iter().map(|c| c.name.clone()).collect::<Vec<_>>();
        let (of_a, of_b) = (names(a), names(b));
        for name in union(of_a.iter(), of_b.iter()) {
            // What is a factor in one of them is told once, there.
            let is_factor = |result: &StudyResult| result.factors.iter().any(|factor| factor.name == *name);
            let value = |result: &StudyResult| {
                let constant = result.study.constants.iter().find(|constant| constant.name == *name)?;
                Some(with_unit(constant.value, &constant.unit))
            };
            if !is_factor(a) && !is_factor(b) {
                note(name, value(a), value(b));
            }
        }
    }
    for name in union(a.factors.iter().map(|f| &f.name), b.factors.iter().map(|f| &f.name)) {
        let factor = |result: &StudyResult| result.factors.iter().find(|factor| factor.name == *name).map(of_factor);
        note(&format!("factor {name}"), factor(a), factor(b));
    }
    let (p, q) = (&a.provenance, &b.provenance);
    note("sampler", Some(p.sampler.clone()), Some(q.sampler.clone()));
    for (what, a, b) in [
        ("base samples", p.base_samples, q.base_samples),
        ("replicates", p.replicates, q.replicates),
        ("plain rows", p.plain_rows.into(), q.plain_rows.into()),
        ("seed", p.seed, q.seed),
    ] {
        note(what, Some(a.to_string()), Some(b.to_string()));
    }
    note("version", Some(p.apportion_version.clone()), Some(q.apportion_version.clone()));
    found
}

/// The names of both, each once, in the order of A and then of B.
fn union<'a>(a: impl Iterator<Item = &'a String>, b: impl Iterator<Item = &'a String>) -> Vec<&'a String> {
    let mut seen = BTreeSet::new();
    a.chain(b).filter(|name| seen.insert(*name)).collect()
}

fn in_words(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// A factor's distribution with its parameters and its unit.
fn of_factor(factor: &FactorRecord) -> String {
    let Value::Object(map) = &factor.distribution else { return factor.distribution.to_string() };
    let said = map.iter().map(|(key, value)| match key.as_str() {
        "name" => in_words(value),
        _ => format!("{key} {}", in_words(value)),
    });
    let words = said.collect::<Vec<_>>().join(", ");
    if matches!(factor.unit.as_str(), "" | "1") { words } else { format!("{words} ({})", factor.unit) }
}
