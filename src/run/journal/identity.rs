//! Differences between the identities of two journals.

use serde_json::Value;

/// Lists how the identity of a journal differs from that of a study, in a few sentences; empty if they are equal.
pub fn differences(journal: &Value, study: &Value) -> Vec<String> {
    const MAX_LISTED: usize = 3;
    let mut lines = Vec::new();
    compare("", journal, study, &mut lines);
    let more = lines.len().saturating_sub(MAX_LISTED);
    lines.truncate(MAX_LISTED);
    if more > 0 {
        lines.push(format!("and {more} more"));
    }
    lines
}

fn compare(key: &str, journal: &Value, study: &Value, lines: &mut Vec<String>) {
    match (journal, study) {
        (Value::Object(a), Value::Object(b)) => {
            for name in a.keys().chain(b.keys().filter(|key| !a.contains_key(*key))) {
                let inner = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                compare(&inner, a.get(name).unwrap_or(&Value::Null), b.get(name).unwrap_or(&Value::Null), lines);
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (place, (a, b)) in a.iter().zip(b).enumerate() {
                // Lists of named items are compared by name.
                let name = b.get("name").and_then(Value::as_str).map_or_else(|| (place + 1).to_string(), str::to_owned);
                compare(&format!("{key}.{name}"), a, b, lines);
            }
        }
        (a, b) if a == b => (),
        (a, b) => lines.push(match (a, b) {
            (Value::Null, b) => format!("{key} is {} in the study, and not in the journal", short(b)),
            (a, Value::Null) => format!("{key} was {} in the journal, and is not in the study", short(a)),
            (a, b) => format!("{key} was {} and is now {}", short(a), short(b)),
        }),
    }
}

fn short(value: &Value) -> String {
    const MAX_LISTED: usize = 60;
    let text = value.to_string();
    if text.chars().count() <= MAX_LISTED { text } else { text.chars().take(MAX_LISTED).chain("...".chars()).collect() }
}
