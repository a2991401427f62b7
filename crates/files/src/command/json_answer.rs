//! JSON replies: an object with the outputs by name, where a list holds those of a series.

use apportion::model::OutputSeries;
use std::sync::LazyLock;

use apportion_base::text::{masked, shortened};
use regex_lite::{Captures, Regex};
use serde_json::Value;

/// The content of an object under one key: a single output, or a list of several.
struct Key<'a> {
    /// The name of the list, if there are several outputs.
    list: Option<&'a str>,
    names: &'a [String],
}

/// Iterates over the keys of an object with `outputs`, in order: `y[0]`, `y[1]` and so on are the items of a list `y`.
fn keys(outputs: &[String]) -> impl Iterator<Item = Key<'_>> {
    outputs.chunk_by(|name, next| is_next_item(name, next)).flat_map(|names| {
        let list = OutputSeries::item_of_list(&names[0]).filter(|(_, first)| *first == 0 && names.len() > 1);
        // An item that does not start a list is named by itself.
        let length = if list.is_some() { names.len() } else { 1 };
        names.chunks(length).map(move |names| Key { list: list.map(|(list, _)| list), names })
    })
}

/// Returns whether `next` is the item after `name` of the same list.
fn is_next_item(name: &str, next: &str) -> bool {
    match (OutputSeries::item_of_list(name), OutputSeries::item_of_list(next)) {
        (Some((list, place)), Some((same, following))) => list == same && following == place + 1,
        _ => false,
    }
}

/// Lists the keys of an object with `outputs`, as in `peak, infected (a list of 365)`.
pub(super) fn keys_in_words(outputs: &[String]) -> String {
    let words = keys(outputs).map(|key| match key.list {
        Some(list) => format!("{list} (a list of {})", key.names.len()),
        None => key.names[0].clone(),
    });
    words.collect::<Vec<_>>().join(", ")
}

pub(super) fn json(text: &str) -> Result<Value, String> {
    let parsed = serde_json::from_str(text).or_else(|_| serde_json::from_str(&without_nan(text)));
    parsed.map_err(|_| format!("`{}`", masked(text)))
}

/// Returns the first value of a key `id` in a whole object that [`json`] cannot read.
pub(super) fn number_of_invalid(text: &str) -> Option<&str> {
    static ID: LazyLock<Regex> =
        LazyLock::new(|| Regex::new(r#"^\{.*?"id"\s*:\s*"?([0-9.eE+]+)"?\s*[,}]"#).expect("a regular expression"));
    Some(ID.captures(text).filter(|_| text.ends_with('}'))?.get(1)?.as_str())
}

/// Converts `parsed` to a reply: one value for each of `outputs`, or why the row failed. The error describes it.
pub(super) fn json_answer(outputs: &[String], parsed: &Value) -> Result<Answer, String> {
    let mut values = Vec::with_capacity(outputs.len());
    let Value::Object(object) = parsed else { return Err(kind(parsed).to_owned()) };
    match object.get("error") {
        Some(Value::String(reason)) => return Ok(failed(reason)),
        None | Some(Value::Null) => (),
        Some(_) if outputs.iter().any(|name| name == "error") => (),
        Some(other) => return Err(format!("{} as `error`, which is a text", kind(other))),
    }
    for key in keys(outputs) {
        let list = key.list.filter(|_| !object.contains_key(&key.names[0]));
        match list.and_then(|list| Some((list, object.get(list)?))) {
            None => {
                for name in key.names {
                    let value = object.get(name);
                    let value = value.ok_or_else(|| format!("an object without `{}`", key.list.unwrap_or(name)))?;
                    values.push(number(value, name)?);
                }
            }
            Some((list, Value::Array(items))) if items.len() == key.names.len() => {
                for item in items {
                    values.push(number(item, list)?);
                }
            }
            Some((list, Value::Array(items))) => return Err(format!("a list of {} as `{list}`", items.len())),
            Some((list, other)) => return Err(format!("{} as `{list}`", kind(other))),
        }
    }
    Ok(Ok(values))
}

/// Returns the number `value` of the output or list `name`; NaN for a missing one.
fn number(value: &Value, name: &str) -> Result<f64, String> {
    match value {
        Value::Null => Ok(f64::NAN),
        Value::Number(number) => Ok(number.as_f64().unwrap_or(f64::NAN)),
        other => Err(format!("{} as `{name}`", kind(other))),
    }
}

fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "a text",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}

/// Replaces `NaN` and `Infinity`, which Python writes although JSON does not have them, by null.
fn without_nan(text: &str) -> String {
    static TEXT_OR_WORD: LazyLock<Regex> =
        LazyLock::new(|| Regex::new(r#"(?s)"(?:[^"\\]|\\.)*"|-?Infinity|NaN"#).expect("a regular expression"));
    let replaced = TEXT_OR_WORD.replace_all(text, |part: &Captures<'_>| match part[0].starts_with('"') {
        true => part[0].to_owned(),
        false => "null".to_owned(),
    });
    replaced.into_owned()
}

/// The reply of a program to a row: a value for every output, NaN for a missing one; or why there are none.
pub(super) type Answer = Result<Vec<f64>, String>;

/// Returns the reply of a program that says why a row has no values.
pub(super) fn failed(reason: &str) -> Answer {
    let reason = shortened(reason);
    Err(if reason.is_empty() { "the program reported an error without a reason".to_owned() } else { reason })
}
