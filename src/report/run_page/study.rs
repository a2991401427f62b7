//! What holds for the whole run: validity, cost, the study, its provenance.

use serde_json::Value;

use super::tables::table;
use super::words::{count, grouped, name, value};
use crate::report::page::{Cell, Mark, Part};
use crate::report::result::{FactorRecord, ResultFile, ValidityRecord};
use crate::report::{share_of_runs, significant};

/// Most factors in the table of the study.
const FACTORS: usize = 50;
/// Most values of a list in a table.
const VALUES: usize = 8;

/// A table of two columns, label and text.
fn pairs(caption: &str, rows: Vec<(String, String)>) -> Part {
    let rows = rows.into_iter().map(|(label, text)| vec![Cell::plain(label), Cell::plain(text)]).collect();
    let Part::Table(mut of_texts) = table(caption.to_owned(), &[], (0, rows)) else { unreachable!("a table") };
    of_texts.numeric.clear();
    Part::Table(of_texts)
}

/// Where the model's assumptions do not hold.
pub(super) fn validity(result: &ResultFile) -> Vec<Part> {
    if result.validity.is_empty() {
        return Vec::new();
    }
    let row = |flag: &ValidityRecord| {
        let share = if flag.runs == 0 { "no run".to_owned() } else { share_of_runs(flag.share) };
        let mark = match flag.runs {
            0 => Mark::Good,
            _ if flag.share < 0.5 => Mark::Mixed,
            _ => Mark::Bad,
        };
        vec![Cell::plain(flag.flag.replace('-', " ")), Cell::marked(share, mark), Cell::plain(&flag.description)]
    };
    let text = "Runs on which an assumption of the model does not hold count all the same; their share says how much of the \
                result rests on them.";
    let caption = "Flags that the model raises, with the share of the runs on which it does.".to_owned();
    let rows = result.validity.iter().map(row).collect();
    vec![Part::Text(text.to_owned()), table(caption, &["flag", "raised on", "what it means"], (3, rows))]
}

/// What the run took.
pub(super) fn cost(result: &ResultFile) -> Vec<Part> {
    let provenance = &result.provenance;
    let seconds = provenance.wall_seconds;
    let mut rows = vec![
        ("model runs".to_owned(), grouped(provenance.model_runs)),
        (
            "base points".to_owned(),
            format!("{} in {} replicates", grouped(provenance.base_samples), provenance.replicates),
        ),
        ("time".to_owned(), format!("{} s", significant(format!("{seconds:.2e}").parse().unwrap_or(seconds)))),
        ("threads".to_owned(), provenance.threads.to_string()),
    ];
    if seconds > 0.0 {
        let rate = (provenance.model_runs as f64 / seconds).round() as u64;
        rows.push(("runs per second".to_owned(), grouped(rate)));
    }
    if let Some(effort) = &result.effort {
        let rungs: Vec<String> = effort.rungs.iter().map(|r| format!("{} {}", r.rung, grouped(r.runs))).collect();
        rows.push(("runs by fidelity".to_owned(), rungs.join(", ")));
        rows.push(("evaluations".to_owned(), grouped(effort.evaluations)));
        rows.push(("largest error estimate".to_owned(), format!("{:.1e} (relative)", effort.largest_error_estimate)));
    }
    let mut parts = vec![pairs("What the run took.", rows)];
    if let Some(stopping) = &result.stopping {
        let (kind, mark) = match stopping.target_met {
            Some(true) => ("Target met", Mark::Good),
            Some(false) => ("Target not met", Mark::Mixed),
            None => ("Why the run ended", Mark::Plain),
        };
        parts.push(Part::Notice { mark, kind: kind.to_owned(), texts: vec![format!("{}.", stopping.reason)] });
    }
    parts
}

/// What was asked: the factors, the choices, the file.
pub(super) fn study(result: &ResultFile) -> Vec<Part> {
    let study = &result.study;
    let mut parts = Vec::new();
    let shown = &result.factors[..result.factors.len().min(FACTORS)];
    let row = |factor: &FactorRecord| {
        let mut row = vec![Cell::plain(name(&factor.name)), Cell::plain(distribution(factor))];
        row.push(Cell::plain(factor.group.as_deref().unwrap_or("–")));
        row.push(Cell::plain(value(factor.nominal, &factor.unit)));
        row
    };
    let mut caption = "The factors with their distributions.".to_owned();
    if shown.len() < result.factors.len() {
        caption.push_str(&format!(" The first {} of {}, all in the JSON file.", shown.len(), result.factors.len()));
    }
    let rows = shown.iter().map(row).collect();
    parts.push(table(caption, &["factor", "distribution", "group", "nominal value"], (3, rows)));
    let mut choices = vec![("model".to_owned(), format!("`{}`", study.model))];
    choices.extend(study.settings.iter().map(|(key, json)| (name(key), plain(json))));
    choices.extend(study.overrides.iter().map(|text| ("changed on the command line".to_owned(), format!("`{text}`"))));
    parts.push(pairs("The choices in force.", choices));
    if !study.constants.is_empty() {
        let constant = |constant: &crate::report::result::ConstantRecord| {
            (name(&constant.name), value(constant.value, &constant.unit))
        };
        let table = pairs("Inputs that are fixed in the study.", study.constants.iter().map(constant).collect());
        parts.push(Part::Details { summary: "Fixed inputs".to_owned(), parts: vec![table] });
    }
    parts.push(Part::Details { summary: "The study file".to_owned(), parts: vec![Part::Code(study.source.clone())] });
    parts
}

/// A distribution in words: its name, then its parameters with the unit.
fn distribution(factor: &FactorRecord) -> String {
    let Value::Object(keys) = &factor.distribution else { return "unknown".to_owned() };
    let family = keys.get("name").and_then(Value::as_str).unwrap_or("unknown");
    let parameters = keys.iter().filter(|(key, _)| *key != "name");
    let parameters: Vec<String> =
        parameters.map(|(key, json)| format!("{} {}", key.replace('_', " "), plain(json))).collect();
    let unit = match factor.unit.as_str() {
        "" | "1" => String::new(),
        unit => format!(" ({unit})"),
    };
    if parameters.is_empty() { family.to_owned() } else { format!("{family}, {}{unit}", parameters.join(", ")) }
}

/// A value of JSON as people write it.
fn plain(json: &Value) -> String {
    match json {
        Value::Null => "none".to_owned(),
        Value::Bool(true) => "yes".to_owned(),
        Value::Bool(false) => "no".to_owned(),
        Value::Number(number) => number.as_f64().map_or_else(|| number.to_string(), |number| value(number, "")),
        Value::String(text) => text.clone(),
        Value::Array(values) => {
            let more = if values.len() > VALUES { format!("; … ({} in all)", values.len()) } else { String::new() };
            values.iter().take(VALUES).map(plain).collect::<Vec<_>>().join("; ") + &more
        }
        Value::Object(keys) => {
            let pairs = keys.iter().take(VALUES).map(|(key, json)| format!("{key} {}", plain(json)));
            pairs.collect::<Vec<_>>().join("; ")
        }
    }
}

/// How the answer came about.
pub(super) fn provenance(result: &ResultFile) -> Vec<Part> {
    let provenance = &result.provenance;
    let interval = provenance.interval.clone().unwrap_or_else(|| "none: a single replicate".to_owned());
    let rows = [
        ("program", format!("apportion {}", provenance.apportion_version)),
        ("sampler", provenance.sampler.clone()),
        ("seed", provenance.seed.to_string()),
        ("base points", grouped(provenance.base_samples)),
        ("replicates", provenance.replicates.to_string()),
        ("first-order indices", provenance.first_order_estimator.clone()),
        ("total indices", provenance.total_estimator.clone()),
        ("intervals", interval),
        ("study file, SHA-256", format!("`{}`", provenance.study_sha256)),
    ];
    let mixed = provenance.mixed_models.iter().map(|mixed| {
        let runs = mixed.runs.map_or_else(|| "an unknown number of runs".to_owned(), |runs| count(runs, "run", "runs"));
        ("another version of the model", format!("answered {runs} ({})", mixed.files))
    });
    let rows = rows.into_iter().chain(mixed).map(|(label, text)| (label.to_owned(), text)).collect();
    let text = "The same study file, seed and version give the same numbers, on any number of threads.";
    vec![Part::Text(text.to_owned()), pairs("How the answer came about.", rows)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distributions_are_said_with_their_units() {
        let factor = |distribution: Value, unit: &str| FactorRecord {
            name: "x".to_owned(),
            unit: unit.to_owned(),
            group: None,
            distribution,
            nominal: 1.0,
        };
        let uniform = serde_json::json!({"name": "uniform", "min": 0.25, "max": 2.5});
        assert_eq!(distribution(&factor(uniform.clone(), "um")), "uniform, min 0.25, max 2.5 (um)");
        assert_eq!(distribution(&factor(uniform, "1")), "uniform, min 0.25, max 2.5");
        let many = serde_json::json!({"name": "discrete", "values": [1, 2, 3, 4, 5, 6, 7, 8, 9]});
        assert_eq!(distribution(&factor(many, "1")), "discrete, values 1; 2; 3; 4; 5; 6; 7; 8; … (9 in all)");
        assert_eq!(distribution(&factor(Value::Null, "1")), "unknown");
    }
}
