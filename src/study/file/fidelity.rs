//! `accuracy` and the table `[fidelity]`: how well the indices must be known, and cheaper models that help.

use std::str::FromStr;
use std::sync::Arc;

use toml_edit::{DocumentMut, Item, TableLike};

use super::context::{Context, Fault, unknown_name, wrong};
use super::error::Problem;
use super::models::TABLES;
use super::sections::{At, StudyFile};
use crate::design::Sampler;
use crate::names::refused_name;
use crate::space::Space;
use crate::study::{LowFidelity, Study, Subject, Target};

/// The target with the `accuracy` of `file`, if it has one.
pub(super) fn accuracy(
    context: &Context<'_>,
    file: &StudyFile,
    target: Target,
    sampler: Sampler,
) -> Result<Target, Fault> {
    let Some(accuracy) = &file.accuracy else { return Ok(target) };
    let value = *accuracy.get_ref();
    if !(value > 0.0 && value.is_finite()) {
        let problem = wrong("accuracy", "a number above 0, as in 0.01", value.to_string());
        return Err(context.fault(accuracy.span(), problem));
    }
    if sampler == Sampler::LatinHypercube {
        return Err(context.fault(accuracy.span(), Problem::CannotGrow));
    }
    let design = &file.design;
    let chosen = [
        ("base_samples", design.base_samples.as_ref().map(At::span)),
        ("plain_rows", design.plain_rows.as_ref().map(At::span)),
        ("budget_runs", design.budget_runs.as_ref().map(At::span)),
        ("target", design.target.as_ref().map(At::span)),
    ];
    if let Some((key, Some(span))) = chosen.into_iter().find(|(_, span)| span.is_some()) {
        let expected =
            "nothing beside `accuracy`, with which the run chooses its design; `budget` and `max_runs` bound it";
        return Err(context.fault(span, wrong(key, expected, format!("`{key}`"))));
    }
    Ok(Target { half_width: Some(value), is_free: true, ..target })
}

/// Makes the study of a text.
type Resolve = fn(&Context<'_>) -> Result<Study, Fault>;

/// The cheaper models of `file`, for its model `subject` on `space`. `resolve` makes a study of each that stands in the file.
pub(super) fn lows(
    context: &Context<'_>,
    file: &StudyFile,
    subject: &dyn Subject,
    space: &Space,
    target: &Target,
    resolve: Resolve,
) -> Result<Vec<LowFidelity>, Fault> {
    let Some(section) = &file.fidelity else { return Ok(Vec::new()) };
    let section = section.get_ref();
    let base_samples = match &section.base_samples {
        None => None,
        Some(samples) if target.is_free => {
            let expected = "nothing beside `accuracy`, with which the run chooses it";
            return Err(context.fault(samples.span(), wrong("base_samples", expected, samples.get_ref().to_string())));
        }
        Some(samples) => Some(*samples.get_ref()),
    };
    if subject.is_external() {
        let right = "the model of this study runs outside of this program, and so would the cheaper one";
        let problem = Problem::Misplaced { name: "fidelity".to_owned(), right: right.to_owned() };
        return Err(context.fault(file.fidelity.as_ref().map_or(0..0, At::span), problem));
    }
    let model = subject.model(space);
    let mut lows: Vec<LowFidelity> = Vec::new();
    for entry in section.low.get_ref() {
        let low = match entry.get_ref() {
            toml::Value::String(name) => {
                let own = subject.cheaper();
                let found = own.iter().find(|low| low.name == *name).cloned();
                found.ok_or_else(|| match own.is_empty() {
                    true => wrong(
                        "low",
                        "a table with what stands in the place of the model's own, as in { name = \"coarse\", command = \"./coarse\" }",
                        format!("\"{name}\""),
                    ),
                    false => unknown_name("cheaper model", name, own.iter().map(|low| low.name.as_str())),
                })
            }
            toml::Value::Table(table) => described(context, table, resolve),
            other => Err(wrong("low", "the name of a cheaper model, or a table", other.to_string())),
        };
        let low = low.map(|low| LowFidelity { base_samples, ..low });
        let problem = match low {
            Err(problem) => problem,
            Ok(low) if lows.iter().any(|other| other.name == low.name) => {
                Problem::Repeated { what: "cheaper model", name: low.name }
            }
            Ok(low) => match low.refused(&*model, space) {
                Some(problem) => Problem::Syntax(format!("cheaper model `{}`: {problem}", low.name)),
                None => {
                    lows.push(low);
                    continue;
                }
            },
        };
        return Err(context.fault(entry.span(), problem));
    }
    Ok(lows)
}

/// The cheaper model that the study describes with the keys of `table` in the place of its own.
fn described(context: &Context<'_>, table: &toml::Table, resolve: Resolve) -> Result<LowFidelity, Problem> {
    let Some(name) = table.get("name").and_then(toml::Value::as_str).map(str::to_owned) else {
        const LONGEST: usize = 30;
        let value = |value: &toml::Value| Some(value.to_string()).filter(|text| text.len() <= LONGEST);
        let own = |(key, of): (&String, &toml::Value)| format!(", {key} = {}", value(of).as_deref().unwrap_or("..."));
        let own = table.iter().map(own).collect::<String>();
        let expected = format!("a table with a name, as in {{ name = \"coarse\"{own} }}");
        return Err(wrong("low", &expected, "a table without `name`".to_owned()));
    };
    if let Some(expected) = refused_name(&name) {
        return Err(wrong("name of a cheaper model", &expected, format!("\"{name}\"")));
    }
    let of_low = |why: &str| Problem::Syntax(format!("cheaper model `{name}`: {why}"));
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
    let study = resolve(&context).map_err(|diagnostic| of_low(&diagnostic.problem.to_string()))?;
    Ok(LowFidelity { name, subject: Arc::clone(&study.subject), base_samples: None })
}

/// Puts `value` at `key`; a table changes those keys alone that it has.
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
