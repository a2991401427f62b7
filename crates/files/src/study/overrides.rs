//! `--set KEY=VALUE`: changes to a study file from the command line, applied to its text before it is read.

use apportion_base::names::did_you_mean;
use apportion_base::names::nearest;
use toml_edit::{DocumentMut, InlineTable, Item, Table, TableLike, Value};

use super::error::StudyError;
use crate::ModelKind;

/// Applies `overrides` in order. A key is a path of names joined by dots; `factor.NAME.KEY` is a key of the factor of
/// that name, and `factor.NAME` is all of it: a table replaces it, a value fixes it. A value is TOML if it can be
/// parsed as TOML, else a string: `afm.friction=hk` needs no quotes.
///
/// `None` if the text is not TOML: the reader then reports it, with the position.
pub(super) fn apply(text: &str, overrides: &[String]) -> Result<Option<String>, StudyError> {
    let Ok(mut document) = text.parse::<DocumentMut>() else { return Ok(None) };
    for text in overrides {
        set(document.as_table_mut(), text).map_err(|problem| StudyError::Override { text: text.clone(), problem })?;
    }
    Ok(Some(document.to_string()))
}

/// Maximum number of parts of a key. Those of a study have up to four; thousands of nested tables take the reader's
/// time and stack.
const MAX_PARTS: usize = 16;

const NAMES: &str = "names joined by dots, as in afm.friction";

fn set(root: &mut Table, text: &str) -> Result<(), String> {
    let (key, value) =
        text.split_once('=').ok_or("expected KEY=VALUE, as in afm.friction=hk or factor.length.max=500")?;
    let names: Vec<&str> = key.split('.').map(str::trim).collect();
    if names.iter().any(|name| name.is_empty()) {
        let key = key.trim();
        return Err(format!("the key `{key}` has an empty part: expected {NAMES}"));
    }
    if names.len() > MAX_PARTS {
        let count = names.len();
        return Err(format!("the key has {count} parts, too many for a study: expected {NAMES}"));
    }
    let value = value.trim();
    let value: Value = value.parse().unwrap_or_else(|_| Value::from(value));
    remove_others(root, &names.join("."));
    match names[..] {
        ["factor" | "factors", factor, ref rest @ ..] if !rest.is_empty() => {
            set_in(find_factor(root, factor)?, rest, value)
        }
        ["factor" | "factors", factor] => match value {
            Value::InlineTable(table) => {
                replace(find_factor(root, factor)?, &table);
                Ok(())
            }
            value => fix(root, factor, value),
        },
        ["outputs"] if root.get("outputs").is_some_and(Item::is_table_like) => Err(
            "`outputs` is a table of formulas or units in this study, and a list of names would replace it: change one with \
             outputs.NAME=..."
                .to_owned(),
        ),
        _ => set_in(root, &names, value),
    }
}

/// Keys that set the length of a run, each with those that it replaces.
const INSTEAD: [(&str, &[&str]); 5] = [
    ("accuracy", &["design.base_samples", "design.runs", "fidelity.base_samples"]),
    ("design.runs", &["accuracy", "smallest_region", "design.base_samples", "design.max_runs", "design.max_time"]),
    ("design.base_samples", &["accuracy", "smallest_region", "design.runs", "design.max_runs", "design.max_time"]),
    ("design.max_runs", &["design.base_samples", "design.runs"]),
    ("design.max_time", &["design.base_samples", "design.runs"]),
];

/// Removes the keys that `key` replaces.
fn remove_others(root: &mut Table, key: &str) {
    for other in INSTEAD.iter().filter(|(chosen, _)| key == *chosen).flat_map(|(_, others)| *others) {
        match other.split_once('.') {
            Some((table, key)) => {
                root.get_mut(table).and_then(Item::as_table_like_mut).and_then(|table| table.remove(key));
            }
            None => drop(root.remove(other)),
        }
    }
}

fn name_of(table: &dyn TableLike) -> Option<&str> {
    table.get("name").and_then(Item::as_str)
}

fn find_factor<'a>(root: &'a mut Table, name: &str) -> Result<&'a mut dyn TableLike, String> {
    let mut names = Vec::new();
    for (key, item) in root.iter_mut() {
        let tables: Vec<(String, &mut dyn TableLike)> = match (key.get(), item) {
            ("factor", Item::ArrayOfTables(tables)) => {
                let tables = tables.iter_mut();
                tables.filter_map(|table| Some((name_of(table)?.to_owned(), table as &mut dyn TableLike))).collect()
            }
            ("factors", item) => {
                let lines = item.as_table_like_mut().map(TableLike::iter_mut).into_iter().flatten();
                lines.filter_map(|(name, item)| Some((name.get().to_owned(), item.as_table_like_mut()?))).collect()
            }
            _ => continue,
        };
        for (factor, table) in tables {
            if factor == name {
                return Ok(table);
            }
            names.push(factor);
        }
    }
    let hint = did_you_mean(&nearest(name, names.iter().map(String::as_str)));
    Err(format!("the study has no factor `{name}`{hint}"))
}

/// Replaces the keys of a factor by those of `table`. It keeps its name.
fn replace(factor: &mut dyn TableLike, table: &InlineTable) {
    let keys: Vec<String> = factor.iter().map(|(key, _)| key.to_owned()).filter(|key| key != "name").collect();
    for key in keys {
        factor.remove(&key);
    }
    for (key, value) in table.iter().filter(|(key, _)| *key != "name") {
        let mut value = value.clone();
        value.decor_mut().clear();
        factor.insert(key, Item::Value(value));
    }
}

/// Removes the factor `name` from the study, and sets the input of that name to `value`.
fn fix(root: &mut Table, name: &str, value: Value) -> Result<(), String> {
    find_factor(root, name)?;
    let model = root.get("model").map_or(ModelKind::DEFAULT.name, |model| model.as_str().unwrap_or_default());
    let path: &[&str] = match ModelKind::from_name(model) {
        Some(kind) if kind == ModelKind::AFM => &[kind.table, name],
        Some(kind) if kind == ModelKind::EXPRESSION => &[kind.table, "constants", name],
        _ => {
            let others = format!("all inputs of the model `{model}` are factors");
            return Err(format!("factor.{name}=VALUE fixes an input of afm or of a formula; {others}"));
        }
    };
    if let Some(Item::ArrayOfTables(tables)) = root.get_mut("factor") {
        tables.retain(|table| name_of(table) != Some(name));
    }
    if let Some(factors) = root.get_mut("factors").and_then(Item::as_table_like_mut) {
        factors.remove(name);
    }
    set_in(root, path, value)
}

fn set_in(table: &mut dyn TableLike, names: &[&str], value: Value) -> Result<(), String> {
    let Some((last, path)) = names.split_last() else { return Ok(()) };
    let mut table = table;
    for name in path {
        let next = table.entry(name).or_insert_with(|| Item::Table(Table::new()));
        let next = next.as_table_like_mut();
        table = next.ok_or_else(|| format!("`{name}` is not a table of the study, so it has no keys to set"))?;
    }
    table.insert(last, Item::Value(value));
    Ok(())
}
