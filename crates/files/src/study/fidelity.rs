//! The table `[fidelity]`: low-fidelity models.

use std::str::FromStr;
use std::sync::Arc;

use apportion::study::{LowFidelity, Study, Subject};
use apportion_base::names::refused_name;
use toml_edit::{DocumentMut, Item, TableLike};

use super::context::{Context, Fault, unknown_name, wrong};
use super::error::Problem;
use super::models::TABLES;
use super::sections::{At, StudyFile};

/// A function that makes the study of a text.
type Resolve = fn(&Context<'_>) -> Result<(Study, Vec<String>), Fault>;

/// Returns the low-fidelity models of `file` for its model `subject`. `resolve` makes a study of each one in the file.
pub(super) fn lows(
    context: &Context<'_>,
    file: &StudyFile,
    subject: &dyn Subject,
    resolve: Resolve,
) -> Result<Vec<LowFidelity>, Fault> {
    let Some(section) = &file.fidelity else { return Ok(Vec::new()) };
    if subject.is_external() {
        let right = "the model of this study runs outside this program, so its cheaper models cannot be run";
        return Err(context.fault(section.span(), Problem::misplaced("fidelity", right)));
    }
    let section = section.get_ref();
    let base_samples = section.base_samples.as_ref().map(|samples| *samples.get_ref());
    let low = |entry: &At<toml::Value>| {
        let low = match entry.get_ref() {
            toml::Value::String(name) => named(subject, name),
            toml::Value::Table(table) => described(context, table, resolve),
            other => Err(wrong("low", "the name of a cheaper model, or a table", other.to_string())),
        };
        Ok(LowFidelity { base_samples, ..context.at(entry, low)? })
    };
    section.low.get_ref().iter().map(low).collect()
}

/// Returns the low-fidelity model that comes with the model, by its name.
fn named(subject: &dyn Subject, name: &str) -> Result<LowFidelity, Problem> {
    let own = subject.cheaper();
    own.iter().find(|low| low.name == name).cloned().ok_or_else(|| match own.is_empty() {
        true => wrong(
            "low",
            "a table of the keys that replace those of the model, as in { name = \"coarse\", command = \"./coarse\" }",
            format!("\"{name}\""),
        ),
        false => unknown_name("cheaper model", name, own.iter().map(|low| low.name.as_str())),
    })
}

/// Returns the low-fidelity model that the study describes, with the keys of `table` in place of its own.
fn described(context: &Context<'_>, table: &toml::Table, resolve: Resolve) -> Result<LowFidelity, Problem> {
    let Some(name) = table.get("name").and_then(toml::Value::as_str).map(str::to_owned) else {
        return Err(wrong("low", "a table with a name, as in { name = \"coarse\", .. }", "one without".to_owned()));
    };
    if let Some(expected) = refused_name(&name) {
        return Err(wrong("name of a cheaper model", &expected, format!("\"{name}\"")));
    }
    let of_low = |why: &str| Problem::new(format!("cheaper model `{name}`: {why}"));
    let mut document: DocumentMut = context.text.parse().map_err(|_| of_low("the study cannot be rewritten"))?;
    for key in ["fidelity", "accuracy"] {
        document.remove(key);
    }
    let own = |key: &str| table.contains_key(key);
    if own("model") || TABLES.iter().any(|known| own(known.name) && !document.contains_key(known.name)) {
        TABLES.iter().for_each(|known| drop(document.remove(known.name)));
    }
    for (key, value) in table.iter().filter(|(key, _)| *key != "name") {
        let value = toml_edit::Value::from_str(&value.to_string()).map_err(|_| of_low("it cannot be rewritten"))?;
        put(document.as_table_mut(), key, value);
    }
    let context = Context { path: context.path.clone(), text: &document.to_string() };
    let (study, _) = resolve(&context).map_err(|diagnostic| of_low(&diagnostic.problem.to_string()))?;
    Ok(LowFidelity { name, subject: Arc::clone(study.subject()), base_samples: None })
}

/// Sets `key` to `value`; a table replaces only its own keys.
fn put(table: &mut dyn TableLike, key: &str, value: toml_edit::Value) {
    match (table.get_mut(key).and_then(Item::as_table_like_mut), value) {
        (Some(there), toml_edit::Value::InlineTable(more)) => {
            for (key, value) in more {
                put(there, &key, value);
            }
        }
        (_, value) => {
            table.insert(key, Item::Value(value));
        }
    }
}
