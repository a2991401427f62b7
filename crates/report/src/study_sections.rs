//! The sections and sentences that the documents of runs, screenings and sweeps share: validity of the model, and the
//! study.

use apportion::CorrelationMeasure;
use apportion::result::{FactorDistribution, FactorRecord, StudyRecord, ValidityRecord};
use apportion_base::text::listed;
use serde_json::{Map, Value};

use super::document::{Cell, Mark, Part, Section, Table};
use super::format::{count, grouped, name, share_of_runs, significant, unit, value};

/// Maximum number of factors in the table of the study.
const MAX_FACTORS: usize = 50;
/// Maximum number of values of a list in a table.
const MAX_VALUES: usize = 8;

/// Builds the section on where the model's assumptions do not hold; shown on a terminal only if a flag was raised.
pub(super) fn validity_section(validity: &[ValidityRecord]) -> Option<Section> {
    let text = "Runs that violate an assumption of the model are included; their share shows how much of the \
                result depends on them.";
    let table = Table::from_rows("Flags that the model raises, with the share of the runs that have them.", validity)
        .text("flag", |flag| flag.flag.replace('-', " "))
        .text("raised on", |flag| match (flag.runs, share_of_runs(flag.share)) {
            (0, _) => Cell::marked("no run", Mark::Good),
            (_, share) if flag.share < 0.5 => Cell::marked(share, Mark::Mixed),
            (_, share) => Cell::marked(share, Mark::Bad),
        })
        .text("meaning", |flag| &flag.description);
    let parts = vec![Part::Text(text.to_owned()), table.into()];
    let is_raised = validity.iter().any(|flag| flag.runs > 0);
    let parts = if is_raised { parts } else { vec![Part::OnPage(parts)] };
    (!validity.is_empty()).then(|| Section::new("validity", "Model validity", parts))
}

/// Explains why runs failed: for each reason the inputs of the first run and the number of runs.
pub(super) fn failures<'a>(failures: impl IntoIterator<Item = (&'a str, String, u64)>) -> Option<Part> {
    const MAX_REASONS: usize = 50;
    let failures: Vec<_> = failures.into_iter().take(MAX_REASONS).collect();
    let table = Table::from_rows("Runs without a value, by reason, with the inputs of the first of each.", &failures)
        .text("reason", |(reason, ..)| *reason)
        .text("first", |(_, first, _)| first)
        .number("runs", |(.., runs)| grouped(*runs));
    (!failures.is_empty()).then(|| table.into())
}

/// Formats the inputs of a run, the first dozen of many.
pub fn inputs(inputs: &Map<String, Value>) -> String {
    const MAX_INPUTS: usize = 12;
    let more = if inputs.len() > MAX_INPUTS { ", …" } else { "" };
    inputs.iter().take(MAX_INPUTS).map(|(name, value)| format!("{name} = {value}")).collect::<Vec<_>>().join(", ")
        + more
}

/// Builds the section on the study: the factors, the choices, the file.
pub(crate) fn study_section(study: &StudyRecord, factors: &[FactorRecord]) -> Section {
    let mut parts = Vec::new();
    let shown = &factors[..factors.len().min(MAX_FACTORS)];
    let mut caption = "The factors with their distributions.".to_owned();
    if shown.len() < factors.len() {
        caption.push_str(&format!(" The first {} of {}, all in the JSON file.", shown.len(), factors.len()));
    }
    let mut rows = Table::from_rows(caption, shown)
        .text("factor", |factor| name(&factor.name))
        .text("distribution", |factor| distribution(&factor.distribution, &factor.unit));
    if shown.iter().any(|factor| factor.group.is_some()) {
        rows = rows.text("group", |factor| factor.group.as_deref().unwrap_or("–"));
    }
    rows = rows.number("nominal value", |factor| value(factor.nominal, &factor.unit));
    if shown.iter().any(|factor| factor.description.is_some()) {
        rows = rows.text("meaning", |factor| factor.description.as_deref().unwrap_or("–"));
    }
    parts.push(rows.into());
    if !study.dependences.is_empty() {
        let pairs = study.dependences.iter().flat_map(|record| {
            let places = (0..record.factors.len()).flat_map(|i| (0..i).map(move |j| (j, i)));
            places.map(move |(j, i)| (record, j, i))
        });
        let table = Table::from_rows("Factors that depend on each other, by a Gaussian copula.", pairs)
            .text("factors", |(record, j, i)| [j, i].map(|k| name(&record.factors[k])).join(", "))
            .text("correlation", |(record, j, i)| {
                let measure = match record.measure {
                    CorrelationMeasure::Pearson => "of the values (Pearson)",
                    CorrelationMeasure::Spearman => "of the ranks (Spearman)",
                    CorrelationMeasure::Kendall => "of the ranks (Kendall)",
                    CorrelationMeasure::Normal => "of the normal scores",
                };
                format!("{} {measure}", significant(record.correlation[j][i]))
            });
        parts.push(table.into());
    }
    let mut choices = vec![("model".to_owned(), format!("`{}`", study.model))];
    choices.extend(study.settings.iter().map(|(key, json)| (name(key), plain(json))));
    choices.extend(study.overrides.iter().map(|text| ("changed on the command line".to_owned(), format!("`{text}`"))));
    parts.push(Table::pairs("Model settings.", choices).into());
    if !study.constants.is_empty() {
        let constants = study.constants.iter();
        let constants = constants.map(|constant| (name(&constant.name), value(constant.value, &constant.unit)));
        let table = Table::pairs("Inputs that are fixed in the study.", constants);
        parts.push(Part::Details { summary: "Fixed inputs".to_owned(), parts: vec![table.into()] });
    }
    let source = vec![Part::Code(study.source.clone())];
    parts.push(Part::Details { summary: "The study file".to_owned(), parts: source });
    Section::new("study", "The study", vec![Part::OnPage(parts)])
}

/// Describes a distribution: its name, then its parameters with the unit.
fn distribution(FactorDistribution { name, parameters }: &FactorDistribution, symbol: &str) -> String {
    let parameters = parameters.iter().map(|(key, json)| format!("{} {}", key.replace('_', " "), plain(json)));
    let parameters: Vec<String> = parameters.collect();
    let unit = match symbol {
        "" | "1" => String::new(),
        symbol => format!(" ({})", unit(symbol)),
    };
    if parameters.is_empty() { name.clone() } else { format!("{name}, {}{unit}", parameters.join(", ")) }
}

/// Formats a value of JSON for a reader.
fn plain(json: &Value) -> String {
    match json {
        Value::Null => "none".to_owned(),
        Value::Bool(true) => "yes".to_owned(),
        Value::Bool(false) => "no".to_owned(),
        Value::Number(number) => number.as_f64().map_or_else(|| number.to_string(), |number| value(number, "")),
        Value::String(text) => text.clone(),
        Value::Array(values) => first_values(values.iter().map(plain)),
        Value::Object(keys) => first_values(keys.iter().map(|(key, json)| format!("{key} {}", plain(json)))),
    }
}

/// Lists values, the first ones of many.
fn first_values(values: impl ExactSizeIterator<Item = String>) -> String {
    let count = values.len();
    let more = if count > MAX_VALUES { format!("; … ({count} in all)") } else { String::new() };
    values.take(MAX_VALUES).collect::<Vec<_>>().join("; ") + &more
}

/// Says on how many runs which validity flags are raised; `None` if none is.
pub(super) fn sentence(validity: &[ValidityRecord]) -> Option<String> {
    let mut raised: Vec<&ValidityRecord> = validity.iter().filter(|flag| flag.runs > 0).collect();
    raised.sort_by(|a, b| b.share.total_cmp(&a.share));
    let flags = raised.iter().map(|flag| format!("{} on {}", flag.flag.replace('-', " "), share_of_runs(flag.share)));
    let flags: Vec<String> = flags.collect();
    (!flags.is_empty()).then(|| format!("The model leaves its range of validity: {} of the runs.", listed(&flags)))
}

/// Sets off what is said of a run: flags with the meaning of the most frequent one, and failures.
pub(super) fn callout(validity: &[ValidityRecord], failed_runs: (u64, u64)) -> Option<Part> {
    let flags = sentence(validity).map(|sentence| {
        let most = validity.iter().max_by(|a, b| a.share.total_cmp(&b.share));
        format!("{sentence} {}", most.map_or("", |flag| &flag.description))
    });
    let texts: Vec<String> = flags.into_iter().chain(of_failures(failed_runs)).collect();
    (!texts.is_empty()).then(|| Part::Notice { mark: Mark::Mixed, kind: "Model validity".to_owned(), texts })
}

/// Says how many runs failed and what that means; `None` if none or all failed.
pub(super) fn of_failures((failed, all): (u64, u64)) -> Option<String> {
    (failed > 0 && failed < all).then(|| {
        let (failed, share) = (grouped(failed), share_of_runs(failed as f64 / all as f64));
        let all = count(all, "run", "runs");
        format!(
            "{failed} of {all} ({share}) failed: the numbers describe the part of the factor space where runs succeed."
        )
    })
}
