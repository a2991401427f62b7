//! What a study file may say in two ways, brought to one before it is read: `[factors]` becomes a list of `[[factor]]`, and
//! `noise` one more factor. Every value keeps its place in the file. Forms of former versions are refused with those of today.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::context::{Context, Fault, wrong};
use super::error::Problem;

/// Brings `root`, a study file, to the form that `StudyFile` has.
pub(super) fn normalise(context: &Context<'_>, root: &mut DeTable<'_>) -> Result<(), Fault> {
    refuse_old_forms(context, root)?;
    factors(context, root)?;
    noise(context, root)
}

/// Factors and outputs as they were written in former versions.
fn refuse_old_forms(context: &Context<'_>, root: &DeTable<'_>) -> Result<(), Fault> {
    let factors = "[factors]\nx1 = { min = 0, max = 1 }\nx2 = { min = 0, max = 1 }";
    let mut old = Vec::new();
    match (root.get_key_value("factor"), root.get_key_value("factors")) {
        (Some((key, value)), _) if value.get_ref().is_table() => old.push((key, "[factor]".to_owned(), factors)),
        (_, Some((key, value))) if value.get_ref().is_array() => {
            old.push((key, "a list `factors`".to_owned(), factors))
        }
        _ => (),
    }
    for section in ["expression", "command", "external"] {
        let table = root.get(section).and_then(|value| value.get_ref().as_table());
        if let Some((key, _)) = table.and_then(|table| table.get_key_value("outputs")) {
            let lines = "outputs.y = ...\nabove the first table of the file";
            old.push((key, format!("outputs in [{section}]"), lines));
        }
    }
    let Some((key, form, lines)) = old.into_iter().next() else { return Ok(()) };
    let message = format!("{form}: factors and outputs are written in another way today");
    Err(context.fault(key.span(), Problem::with_help(message, format!("write\n{lines}"))))
}

pub(super) fn is_bare(key: &str) -> bool {
    !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c))
}

fn key(name: &'static str, span: Range<usize>) -> Spanned<Cow<'static, str>> {
    Spanned::new(span, Cow::Borrowed(name))
}

/// The tables of `[factors]` become a list in the order of the file, each with its name inside.
fn factors(context: &Context<'_>, root: &mut DeTable<'_>) -> Result<(), Fault> {
    let Some((plural, value)) = root.remove_entry("factors") else { return Ok(()) };
    if root.contains_key("factor") {
        let right = "factors stand in `[[factor]]` too: keep one of the two";
        return Err(context.fault(plural.span(), Problem::misplaced("factors", right)));
    }
    let span = value.span();
    let DeValue::Table(table) = value.into_inner() else {
        let expected = "a table with a line for each factor, as in x1 = { min = 0, max = 1 }";
        return Err(context.fault(span, wrong("factors", expected, "a single value".to_owned())));
    };
    let mut entries: Vec<_> = table.into_iter().collect();
    entries.sort_by_key(|(name, _)| name.span().start);
    let mut factors = Vec::with_capacity(entries.len());
    for (name, mut value) in entries {
        let DeValue::Table(fields) = value.get_mut() else {
            let expected = "a table, as in { min = 0, max = 1 }";
            let problem = wrong(name.get_ref(), expected, value.get_ref().type_str().to_owned());
            return Err(context.fault(value.span(), problem));
        };
        let inside = Spanned::new(name.span(), DeValue::String(name.get_ref().clone()));
        if let Some(twice) = fields.insert(key("name", name.span()), inside) {
            let right = "the name of this factor stands before its table";
            return Err(context.fault(twice.span(), Problem::misplaced("name", right)));
        }
        factors.push(value);
    }
    root.insert(key("factor", plural.span()), Spanned::new(span, DeValue::Array(DeArray::from_iter(factors))));
    Ok(())
}

/// `noise = "seed"`, or a table: one more factor, the last one, of the distribution `seed`.
fn noise(context: &Context<'_>, root: &mut DeTable<'_>) -> Result<(), Fault> {
    let Some(value) = root.get_mut("noise") else { return Ok(()) };
    let place = value.span();
    let text = |text: String| Spanned::new(place.clone(), DeValue::String(Cow::Owned(text)));
    let name = match value.get_ref() {
        DeValue::String(name) => name.to_string(),
        DeValue::Table(table) => {
            table.get("name").and_then(|name| name.get_ref().as_str()).unwrap_or("seed").to_owned()
        }
        other => {
            let expected = "the name under which the model gets its seed, as in noise = \"seed\", or a table [noise]";
            return Err(context.fault(place, wrong("noise", expected, other.type_str().to_owned())));
        }
    };
    if value.get_ref().is_str() {
        *value.get_mut() = DeValue::Table(DeTable::new());
    }
    let fields = [("name", text(name)), ("distribution", text("seed".to_owned()))];
    let fields = fields.map(|(name, value)| (key(name, place.clone()), value));
    let factor = Spanned::new(place.clone(), DeValue::Table(DeTable::from_iter(fields)));
    match root.get_mut("factor").map(Spanned::get_mut) {
        Some(DeValue::Array(factors)) => factors.push(factor),
        Some(_) => (),
        None => {
            let list = DeValue::Array(DeArray::from_iter([factor]));
            root.insert(key("factor", place.clone()), Spanned::new(place, list));
        }
    }
    Ok(())
}
