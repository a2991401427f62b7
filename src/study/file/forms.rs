//! What a study file may say in several ways, brought to one before it is read: factors as a list or as tables by name,
//! outputs with their formulas or units above the table of the model. Every value keeps its place in the file.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::context::wrong;
use super::context::{Context, Fault};
use super::error::{Problem, meant};
use crate::names::nearest;

/// Brings `root`, a study file, to the form that `StudyFile` has.
pub(super) fn normalise(context: &Context<'_>, root: &mut DeTable<'_>) -> Result<(), Fault> {
    if let Some(value) = root.get_mut("dependence").filter(|value| value.get_ref().is_table()) {
        let one = std::mem::replace(value.get_mut(), DeValue::Boolean(false));
        *value.get_mut() = DeValue::Array(DeArray::from_iter([Spanned::new(value.span(), one)]));
    }
    factors(context, root)?;
    noise(context, root)?;
    distributions(context, root)?;
    outputs_above(context, root)?;
    outputs_below(context, root)?;
    formulas(context, root)
}

fn key(name: &'static str, span: Range<usize>) -> Spanned<Cow<'static, str>> {
    Spanned::new(span, Cow::Borrowed(name))
}

fn type_of(value: &DeValue<'_>) -> String {
    match value.type_str() {
        "array" => "a list".to_owned(),
        "string" => "a text".to_owned(),
        other => format!("a value of type {other}"),
    }
}

/// `[[factor]]`, `[factor]` of a single one, or `[factor.NAME]`; each also with `factors`. Their order is that of the file.
fn factors(context: &Context<'_>, root: &mut DeTable<'_>) -> Result<(), Fault> {
    if let Some((plural, value)) = root.remove_entry("factors") {
        if root.contains_key("factor") {
            let problem = Problem::TwoForms { what: "factors", one: "factor", other: "factors" };
            return Err(context.fault(plural.span(), problem));
        }
        root.insert(key("factor", plural.span()), value);
    }
    let Some(value) = root.get_mut("factor") else { return Ok(()) };
    let span = value.span();
    let DeValue::Table(table) = value.get_mut() else { return Ok(()) };
    let table = std::mem::take(table);
    let is_list = |value: &Spanned<DeValue<'_>>| value.get_ref().is_array();
    let lists_alone = !table.is_empty() && table.values().all(is_list);
    let by_name = lists_alone || table.values().any(|value| value.get_ref().is_table());
    let factors = if by_name { by_order(context, table)? } else { vec![Spanned::new(span, DeValue::Table(table))] };
    *value.get_mut() = DeValue::Array(DeArray::from_iter(factors));
    Ok(())
}

/// The tables `[factor.NAME]` in the order of the file, each with its name inside.
fn by_order<'a>(context: &Context<'_>, table: DeTable<'a>) -> Result<Vec<Spanned<DeValue<'a>>>, Fault> {
    let mut entries: Vec<_> = table.into_iter().collect();
    entries.sort_by_key(|(name, _)| name.span().start);
    let mut factors = Vec::with_capacity(entries.len());
    for (name, mut value) in entries {
        let place = value.span();
        let DeValue::Table(fields) = value.get_mut() else {
            if let found @ (DeValue::Array(_) | DeValue::Integer(_) | DeValue::Float(_)) = value.get_ref() {
                let expected = format!("a table, as a factor is written: {{ {} }}", range_of(context, found));
                return Err(context.fault(place, wrong(name.get_ref(), &expected, type_of(found))));
            }
            let right = "beside [factor.NAME] every factor is such a table, with its own keys";
            let problem = Problem::Misplaced { name: name.get_ref().to_string(), right: right.to_owned() };
            return Err(context.fault(name.span(), problem));
        };
        match fields.get("name") {
            Some(inside) if inside.get_ref().as_str() != Some(name.get_ref()) => {
                let expected = format!("\"{}\", as its table is called, or left out", name.get_ref());
                return Err(context.fault(inside.span(), wrong("name", &expected, "another one".to_owned())));
            }
            Some(_) => (),
            None => {
                let inside = Spanned::new(name.span(), DeValue::String(name.get_ref().clone()));
                fields.insert(key("name", name.span()), inside);
            }
        }
        factors.push(value);
    }
    Ok(factors)
}

/// The keys of a range, with the numbers of a list of two.
fn range_of(context: &Context<'_>, list: &DeValue<'_>) -> String {
    let text = |end: &Spanned<DeValue<'_>>| context.text.get(end.span()).unwrap_or_default().to_owned();
    let [min, max] = match list.as_array().map(|ends| ends.iter().map(text).collect::<Vec<_>>()).as_deref() {
        Some([min, max]) => [min.clone(), max.clone()],
        _ => ["..".to_owned(), "..".to_owned()],
    };
    format!("min = {min}, max = {max}")
}

/// `noise = "seed"`, or a table: one more factor, the last one, of the distribution `seed`.
fn noise(context: &Context<'_>, root: &mut DeTable<'_>) -> Result<(), Fault> {
    const NAME: &str = "seed";
    let Some(value) = root.get_mut("noise") else { return Ok(()) };
    let span = value.span();
    let name = match value.get_mut() {
        DeValue::String(_) => {
            let name = std::mem::replace(value.get_mut(), DeValue::Table(DeTable::new()));
            Spanned::new(span, name)
        }
        DeValue::Table(table) => match table.get("name") {
            Some(name) if name.get_ref().is_str() => Spanned::new(
                name.span(),
                DeValue::String(Cow::Owned(name.get_ref().as_str().unwrap_or(NAME).to_owned())),
            ),
            // What is no text is told of by the reader.
            Some(_) => return Ok(()),
            None => Spanned::new(span, DeValue::String(Cow::Borrowed(NAME))),
        },
        other => {
            let expected = "the name under which the model gets its seed, as in noise = \"seed\", or a table [noise]";
            return Err(context.fault(span, wrong("noise", expected, type_of(other))));
        }
    };
    let place = name.span();
    let law = Spanned::new(place.clone(), DeValue::String(Cow::Borrowed("seed")));
    let table = DeTable::from_iter([(key("name", place.clone()), name), (key("distribution", place.clone()), law)]);
    let factor = Spanned::new(place.clone(), DeValue::Table(table));
    match root.get_mut("factor").map(Spanned::get_mut) {
        Some(DeValue::Array(factors)) => factors.push(factor),
        Some(_) => (),
        None => {
            root.insert(
                key("factor", place.clone()),
                Spanned::new(place, DeValue::Array(DeArray::from_iter([factor]))),
            );
        }
    }
    Ok(())
}

/// Components of mixtures get the name of their factor, after which messages are told; what is another factor where a number
/// stands is refused with the reason.
fn distributions(context: &Context<'_>, root: &mut DeTable<'_>) -> Result<(), Fault> {
    let Some(DeValue::Array(factors)) = root.get_mut("factor").map(Spanned::get_mut) else { return Ok(()) };
    let name_of = |factor: &Spanned<DeValue<'_>>| {
        let name = factor.get_ref().as_table().and_then(|fields| fields.get("name"));
        name.and_then(|name| name.get_ref().as_str()).map(str::to_owned)
    };
    let names: Vec<String> = factors.iter().filter_map(name_of).collect();
    for factor in factors.iter_mut() {
        let name = name_of(factor).unwrap_or_default();
        if let DeValue::Table(fields) = factor.get_mut() {
            distribution(context, fields, &name, &names)?;
        }
    }
    Ok(())
}

fn distribution(context: &Context<'_>, fields: &mut DeTable<'_>, name: &str, names: &[String]) -> Result<(), Fault> {
    const WORDS: [&str; 5] = ["name", "distribution", "unit", "group", "nominal"];
    for (key, value) in fields.iter().filter(|(key, _)| !WORDS.contains(&&**key.get_ref())) {
        let list = std::slice::from_ref(value);
        let numbers =
            if **key.get_ref() == *"truncate" { value.get_ref().as_array().map_or(list, |list| list) } else { list };
        let text = |value: &Spanned<DeValue<'_>>| Some((value.get_ref().as_str()?.to_owned(), value.span()));
        let other = numbers.iter().filter_map(text).find(|(text, _)| names.contains(text));
        if let Some((other, span)) = other.filter(|_| !matches!(&**key.get_ref(), "file" | "column")) {
            let (factor, key) = (name.to_owned(), key.get_ref().to_string());
            return Err(context.fault(span, Problem::DependsOnFactor { factor, key, other }));
        }
    }
    if let Some(quantiles) = fields.get("quantiles").and_then(|value| value.get_ref().as_table())
        && let Some((key, _)) = quantiles.iter().find(|(_, value)| value.get_ref().is_table())
    {
        let expected = "probabilities in quotes, as in { \"0\" = 1, \"0.5\" = 2, \"1\" = 5 }";
        return Err(context
            .fault(key.span(), wrong("quantiles", expected, "a key with a dot, which begins a table".to_owned())));
    }
    let Some(DeValue::Array(components)) = fields.get_mut("components").map(Spanned::get_mut) else { return Ok(()) };
    for component in components.iter_mut() {
        let span = component.span();
        let DeValue::Table(fields) = component.get_mut() else { continue };
        if let Some((name, _)) = fields.get_key_value("name") {
            let right = "a component is a distribution of the factor, which alone has a name";
            let problem = Problem::Misplaced { name: "name".to_owned(), right: right.to_owned() };
            return Err(context.fault(name.span(), problem));
        }
        distribution(context, fields, name, names)?;
        let inside = Spanned::new(span.clone(), DeValue::String(Cow::Owned(name.to_owned())));
        fields.insert(key("name", span), inside);
    }
    Ok(())
}

/// `[outputs]` above the table of the model, or `outputs.y = "..."` there: the same as in that table.
fn outputs_above(context: &Context<'_>, root: &mut DeTable<'_>) -> Result<(), Fault> {
    let Some(value) = root.get("outputs").filter(|value| value.get_ref().is_table()) else { return Ok(()) };
    let place = value.span();
    let is_model = |key: &str| meant(key, ["model"]).is_some();
    if !root.contains_key("model") && root.keys().any(|key| is_model(key.get_ref())) {
        // The reader tells of a `modle`, without which the outputs have no meaning.
        root.remove("outputs");
        return Ok(());
    }
    let model = root.get("model").and_then(|model| model.get_ref().as_str()).unwrap_or_default();
    let Some(section) = ["expression", "command", "external"].into_iter().find(|section| *section == model) else {
        let expected =
            "a list of names, as in outputs = [\"y\"] (a table of formulas stands beside model = \"expression\")";
        return Err(context.fault(place, wrong("outputs", expected, "a table".to_owned())));
    };
    let Some((name, outputs)) = root.remove_entry("outputs") else { return Ok(()) };
    let Some(model) = root.get_mut(section) else {
        if section == "command" {
            return Err(context.fault(0..0, Problem::NoProgram));
        }
        let table = DeTable::from_iter([(name, outputs)]);
        root.insert(key(section, place.clone()), Spanned::new(place, DeValue::Table(table)));
        return Ok(());
    };
    let span = model.span();
    match model.get_mut() {
        DeValue::Table(table) if table.contains_key("outputs") => {
            let (one, other) = match section {
                "expression" => ("[outputs]", "[expression] outputs"),
                "command" => ("[outputs]", "[command] outputs"),
                _ => ("[outputs]", "[external] outputs"),
            };
            return Err(context.fault(name.span(), Problem::TwoForms { what: "outputs", one, other }));
        }
        DeValue::Table(table) => {
            table.insert(name, outputs);
        }
        // `command = ["python3", "my_model.py"]`.
        program @ DeValue::Array(_) if section == "command" => {
            let list = std::mem::replace(program, DeValue::Boolean(false));
            let program_key = key("program", span.clone());
            *program = DeValue::Table(DeTable::from_iter([(program_key, Spanned::new(span, list)), (name, outputs)]));
        }
        other => {
            let found = type_of(other);
            return Err(context.fault(span, wrong(section, "a table", found)));
        }
    }
    Ok(())
}

/// `outputs = ["y"]` below a table: it has become part of that table.
fn outputs_below(context: &Context<'_>, root: &DeTable<'_>) -> Result<(), Fault> {
    for section in ["expression", "command", "external"] {
        let table = root.get(section).and_then(|value| value.get_ref().as_table());
        let Some((name, _)) =
            table.and_then(|table| table.get_key_value("outputs").filter(|(_, outputs)| outputs.get_ref().is_array()))
        else {
            continue;
        };
        let example = if section == "expression" { "outputs.y = \"x1 + x2\"" } else { "outputs.y = \"nN\"" };
        let expected = format!(
            "a table in [{section}], as in {example}: a list of names stands at the top of the file, above the first \
             table"
        );
        return Err(context.fault(name.span(), wrong("outputs", &expected, "a list".to_owned())));
    }
    Ok(())
}

/// `y = "x1 + x2"` in `[expression]`, which wants to be an output, and `a = 7`, which wants to be a constant.
fn formulas(context: &Context<'_>, root: &DeTable<'_>) -> Result<(), Fault> {
    const KEYS: [&str; 2] = ["outputs", "constants"];
    let Some(table) = root.get("expression").and_then(|value| value.get_ref().as_table()) else { return Ok(()) };
    let misplaced = table.iter().filter_map(|(name, value)| match value.get_ref() {
        _ if KEYS.contains(&&**name.get_ref()) || nearest(name.get_ref(), KEYS).is_some() => None,
        DeValue::String(_) => Some((name, "outputs")),
        DeValue::Integer(_) | DeValue::Float(_) => Some((name, "constants")),
        _ => None,
    });
    let first = misplaced.min_by_key(|(name, _)| name.span().start);
    first.map_or(Ok(()), |(name, table)| {
        let what = if table == "outputs" { "an output with its formula" } else { "a constant" };
        let written = context.text.get(name.span()).unwrap_or_default();
        let right = format!("{what} is written {table}.{written} = ..., or stands below [expression.{table}]");
        Err(context.fault(name.span(), Problem::Misplaced { name: name.get_ref().to_string(), right }))
    })
}
