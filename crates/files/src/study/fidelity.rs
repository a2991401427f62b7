//! The table `[fidelity]`: low-fidelity models.

use std::sync::Arc;

use apportion::study::{LowFidelity, Study, StudySource, Subject};
use apportion_base::names::refused_name;
use toml_edit::{DocumentMut, Item, TableLike, TomlError, Value};

use super::at::copied;
use super::context::{Context, Fault, unknown_name, wrong};
use super::error::Problem;
use super::models::TABLES;
use super::reading::Reading;

/// A function that makes the study of a text.
type Resolve = fn(Context) -> Result<(Study, StudySource), Fault>;

/// Returns the low-fidelity models of `file` for its model `subject`. `resolve` makes a study of each one in the file.
pub(super) fn low_fidelity_models(
    Reading { context, file, .. }: &Reading,
    subject: &dyn Subject,
    resolve: Resolve,
) -> Result<Vec<LowFidelity>, Fault> {
    let Some(section) = &file.fidelity else { return Ok(Vec::new()) };
    if subject.is_external() {
        let right = "the model of this study runs outside this program, so its cheaper models cannot be run";
        return Err(context.fault(section.span(), Problem::misplaced("fidelity", right)));
    }
    let section = section.get_ref();
    let base_samples = copied(&section.base_samples);
    let mut models = Vec::new();
    for entry in section.low.get_ref() {
        let model = match entry.get_ref() {
            toml::Value::String(name) => named(subject, name),
            toml::Value::Table(table) => described(context, table, resolve),
            other => Err(wrong("low", "the name of a cheaper model, or a table", other)),
        };
        models.push(LowFidelity { base_samples, ..context.at(entry, model)? });
    }
    Ok(models)
}

/// Returns the low-fidelity model that comes with the model, by its name.
fn named(subject: &dyn Subject, name: &str) -> Result<LowFidelity, Problem> {
    let models = subject.cheaper();
    models.iter().find(|model| model.name == name).cloned().ok_or_else(|| match models.is_empty() {
        true => wrong(
            "low",
            "a table of the keys that replace those of the model, as in { name = \"coarse\", command = \"./coarse\" }",
            format!("\"{name}\""),
        ),
        false => unknown_name("cheaper model", name, models.iter().map(|model| model.name.as_str())),
    })
}

/// Returns the low-fidelity model that the study describes, with the keys of `table` in place of those of the study.
fn described(context: &Context, table: &toml::Table, resolve: Resolve) -> Result<LowFidelity, Problem> {
    let Some(name) = table.get("name").and_then(toml::Value::as_str) else {
        return Err(wrong("low", "a table with a name, as in { name = \"coarse\", .. }", "one without"));
    };
    if let Some(expected) = refused_name(name) {
        return Err(wrong("name of a cheaper model", &expected, format!("\"{name}\"")));
    }
    let study = match with_keys(&context.text, table) {
        Ok(text) => resolve(Context::new(&context.path, text)).map_err(|fault| fault.problem.to_string()),
        Err(_) => Err("the study cannot be rewritten".to_owned()),
    };
    let (study, _) = study.map_err(|reason| Problem::new(format!("cheaper model `{name}`: {reason}")))?;
    Ok(LowFidelity { name: name.to_owned(), subject: Arc::clone(study.subject()), base_samples: None })
}

/// Returns the text of a study with the keys of `table` in place of its own.
fn with_keys(text: &str, table: &toml::Table) -> Result<String, TomlError> {
    let mut document: DocumentMut = text.parse()?;
    for key in ["fidelity", "accuracy"] {
        document.remove(key);
    }
    let mut names = TABLES.iter().map(|model| model.name);
    if table.contains_key("model") || names.any(|name| table.contains_key(name) && !document.contains_key(name)) {
        for model in &TABLES {
            document.remove(model.name);
        }
    }
    for (key, value) in table.iter().filter(|(key, _)| *key != "name") {
        put(document.as_table_mut(), key, value.to_string().parse()?);
    }
    Ok(document.to_string())
}

/// Sets `key` to `value`; a table replaces only its own keys.
fn put(table: &mut dyn TableLike, key: &str, value: Value) {
    match (table.get_mut(key).and_then(Item::as_table_like_mut), value) {
        (Some(table), Value::InlineTable(keys)) => keys.into_iter().for_each(|(key, value)| put(table, &key, value)),
        (_, value) => drop(table.insert(key, Item::Value(value))),
    }
}
