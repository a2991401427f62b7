//! What a study file may say in two ways, brought to one before it is read: `[factors]` becomes a list of `[[factor]]`, and
//! `noise` one more factor. Every value keeps its place in the file. Forms of former versions are refused with today's lines.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::context::{Context, Fault, wrong};
use super::error::Problem;
use crate::design::{DesignError, MAX_FACTORS};
use crate::study::BuildError;

/// Brings `root`, a study file, to the form that `StudyFile` has.
pub(super) fn normalise(context: &Context<'_>, root: &mut DeTable<'_>) -> Result<(), Fault> {
    refuse_old_forms(context, root)?;
    refuse_too_many(context, root)?;
    factors(context, root)?;
    noise(context, root)?;
    name_components(root);
    Ok(())
}

/// More factors than any study can have, before any of them is worked on.
fn refuse_too_many(context: &Context<'_>, root: &DeTable<'_>) -> Result<(), Fault> {
    let (count, place) = match (root.get("factor").map(Spanned::get_ref), root.get_key_value("factors")) {
        (Some(DeValue::Array(list)), _) => (list.len(), list.get(MAX_FACTORS).map(Spanned::span)),
        (_, Some((key, table))) => (table.get_ref().as_table().map_or(0, DeTable::len), Some(key.span())),
        _ => return Ok(()),
    };
    if count <= MAX_FACTORS {
        return Ok(());
    }
    let problem = BuildError::Design(DesignError::FarTooManyFactors { factors: count });
    Err(context.fault(place.unwrap_or_default(), problem.into()))
}

/// Factors and outputs as they were written in former versions.
fn refuse_old_forms(context: &Context<'_>, root: &DeTable<'_>) -> Result<(), Fault> {
    let old = |place: Range<usize>, form: String, lines: String| {
        let message = format!("{form}: factors and outputs are written in another way today");
        Err(context.fault(place, Problem::with_help(message, format!("write\n{lines}"))))
    };
    let written = |range: Range<usize>| context.text.get(range).unwrap_or_default().to_owned();
    let entry = |(key, value): Entry<'_, '_>| format!("{} = {}", written(key.span()), written(value.span()));
    let fields = |table: &DeTable<'_>| {
        let others = in_order(table).into_iter().filter(|(key, _)| **key.get_ref() != *"name");
        others.map(entry).collect::<Vec<_>>().join(", ")
    };
    let name_of = |table: &DeTable<'_>| {
        let name = table.get("name").map_or_else(|| "NAME".to_owned(), |name| written(name.span()));
        let bare = name.trim_matches(['"', '\'']);
        if is_bare(bare) { bare.to_owned() } else { name }
    };
    let line = |name: &str, table: &DeTable<'_>| format!("{name} = {{ {} }}", fields(table));
    let joined = |lines: Vec<String>| format!("[factors]\n{}", lines.join("\n"));
    if let Some((key, value)) = root.get_key_value("factor")
        && let Some(table) = value.get_ref().as_table()
    {
        let of = |(key, value): Entry<'_, '_>| Some(line(&written(key.span()), value.get_ref().as_table()?));
        let lines: Vec<String> = in_order(table).into_iter().filter_map(of).collect();
        return match lines.is_empty() {
            true => old(key.span(), "[factor]".to_owned(), joined(vec![line(&name_of(table), table)])),
            false => old(key.span(), "[factor.NAME]".to_owned(), joined(lines)),
        };
    }
    if let Some((key, value)) = root.get_key_value("factors")
        && let Some(list) = value.get_ref().as_array()
    {
        let tables = list.iter().filter_map(|value| value.get_ref().as_table());
        let lines = tables.map(|table| line(&name_of(table), table)).collect();
        return old(key.span(), "a list of `factors`".to_owned(), joined(lines));
    }
    for section in ["expression", "command", "external"] {
        let table = root.get(section).and_then(|value| value.get_ref().as_table());
        let Some((key, outputs)) = table.and_then(|table| table.get_key_value("outputs")) else { continue };
        let lines = match outputs.get_ref().as_table() {
            Some(outputs) => {
                let line = |output| format!("outputs.{}", entry(output));
                in_order(outputs).into_iter().map(line).collect::<Vec<_>>().join("\n")
            }
            None => format!("outputs = {}", written(outputs.span())),
        };
        let lines = format!("{lines}\n(above the first table of the file)");
        return old(key.span(), format!("outputs in [{section}]"), lines);
    }
    Ok(())
}

type Entry<'a, 'i> = (&'a Spanned<Cow<'i, str>>, &'a Spanned<DeValue<'i>>);

/// The entries of a table in the order of the file.
fn in_order<'a, 'i>(table: &'a DeTable<'i>) -> Vec<Entry<'a, 'i>> {
    let mut entries: Vec<Entry<'a, 'i>> = table.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    entries
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

/// Components of mixtures get the name of their factor, which messages tell.
fn name_components(root: &mut DeTable<'_>) {
    fn name_inside(fields: &mut DeTable<'_>, name: &str) {
        let Some(DeValue::Array(components)) = fields.get_mut("components").map(Spanned::get_mut) else { return };
        for component in components.iter_mut() {
            let span = component.span();
            if let DeValue::Table(fields) = component.get_mut() {
                if !fields.contains_key("name") {
                    let text = Spanned::new(span.clone(), DeValue::String(Cow::Owned(name.to_owned())));
                    fields.insert(key("name", span), text);
                }
                name_inside(fields, name);
            }
        }
    }
    let Some(DeValue::Array(factors)) = root.get_mut("factor").map(Spanned::get_mut) else { return };
    for factor in factors.iter_mut() {
        if let DeValue::Table(fields) = factor.get_mut() {
            let name = fields.get("name").and_then(|name| name.get_ref().as_str()).unwrap_or_default().to_owned();
            name_inside(fields, &name);
        }
    }
}
