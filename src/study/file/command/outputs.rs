//! The outputs of a program: their names and units, and where each stands after a run.

use regex::Regex;
use serde_json::{Value as Json, json};
use toml::Value;

use super::file::{CommandKey, CommandSection};
use crate::model::{CommandOutput, Match, Pick, Source, Way};
use crate::names::nearest;
use crate::quantity::Unit;
use crate::study::file::at::At;
use crate::study::file::context::wrong;
use crate::study::file::context::{Context, Fault, chosen};
use crate::study::file::error::Problem;
use crate::study::file::units::output_unit;

const KEYS: [&str; 6] = ["unit", "file", "regex", "column", "pointer", "match"];

/// The outputs in the order of the program, and those that say where they stand: by `[command] outputs`, else by the names
/// asked for.
pub(super) fn outputs<'a>(
    context: &Context<'_>,
    key: &At<CommandKey>,
    section: &'a CommandSection,
    asked: Option<&At<Vec<At<String>>>>,
) -> Result<(Vec<CommandOutput>, Vec<&'a At<Value>>), Fault> {
    let mut entries: Vec<(&At<String>, &At<Value>)> = section.outputs.iter().collect();
    if entries.is_empty() {
        let Some(asked) = asked else { return Err(context.fault(key.span(), Problem::NoProgramOutputs)) };
        let output = |name: &At<String>| {
            refuse_name(context, name)?;
            Ok(CommandOutput { name: name.get_ref().clone(), unit: Unit::dimensionless(), pick: None })
        };
        return Ok((asked.get_ref().iter().map(output).collect::<Result<_, Fault>>()?, Vec::new()));
    }
    // In the order of the file.
    entries.sort_by_key(|(name, _)| name.span().start);
    let (mut outputs, mut picks) = (Vec::with_capacity(entries.len()), Vec::new());
    for (name, value) in entries {
        refuse_name(context, name)?;
        let output = output(context, name, value)?;
        if output.pick.is_some() {
            picks.push(value);
        }
        outputs.push(output);
    }
    Ok((outputs, picks))
}

fn refuse_name(context: &Context<'_>, name: &At<String>) -> Result<(), Fault> {
    if super::fits_a_line(name.get_ref()) {
        return Ok(());
    }
    let expected = "not empty, and without line breaks and control characters";
    Err(context.fault(name.span(), wrong("name of an output", expected, format!("{:?}", name.get_ref()))))
}

/// Places of the outputs asked for; all if nothing is asked.
pub(super) fn places(
    context: &Context<'_>,
    section: &CommandSection,
    outputs: &[CommandOutput],
    asked: Option<&At<Vec<At<String>>>>,
) -> Result<Vec<usize>, Fault> {
    let Some(asked) = asked else { return Ok((0..outputs.len()).collect()) };
    let mut names: Vec<&str> = outputs.iter().map(|output| output.name.as_str()).collect();
    if section.outputs.is_empty() {
        // They are what was asked for, apart from repetitions.
        names.dedup();
    }
    chosen(context, &names, asked)
}

/// Of a program that runs once for each row, every output says where it stands.
pub(super) fn refuse_without_pick(
    context: &Context<'_>,
    key: &At<CommandKey>,
    outputs: &[CommandOutput],
) -> Result<(), Fault> {
    let Some(output) = outputs.iter().find(|output| output.pick.is_none()) else { return Ok(()) };
    let expected = "a table that says where the number stands, as in { file = \"out.txt\", regex = \"force = (\\\\S+)\" }, \
                    { file = \"out.csv\", column = \"y\" } or { file = \"out.json\", pointer = \"/result/y\" }";
    let problem = wrong(&format!("outputs.{}", output.name), expected, "without that beside `template`".to_owned());
    Err(context.fault(key.span(), problem))
}

fn output(context: &Context<'_>, name: &At<String>, value: &At<Value>) -> Result<CommandOutput, Fault> {
    let key = format!("outputs.{}", name.get_ref());
    let (unit, pick) = match value.get_ref() {
        Value::String(unit) => (unit.as_str(), None),
        Value::Table(table) => {
            if let Some(unknown) = table.keys().find(|key| !KEYS.contains(&key.as_str())) {
                let problem = Problem::UnknownKey {
                    name: unknown.clone(),
                    nearest: nearest(unknown, KEYS),
                    expected: KEYS.map(str::to_owned).to_vec(),
                };
                return Err(context.fault(value.span(), problem));
            }
            if let Some((name, other)) = table.iter().find(|(_, value)| !value.is_str()) {
                let problem = wrong(&format!("{key}.{name}"), "a text", other.type_str().to_owned());
                return Err(context.fault(value.span(), problem));
            }
            let text = |key: &str| table.get(key).and_then(Value::as_str);
            let pick = pick(&key, &text).map_err(|problem| context.fault(value.span(), problem))?;
            (text("unit").unwrap_or_default(), pick)
        }
        other => {
            let expected = "a unit, or a table such as { unit = \"nN\" }";
            return Err(context.fault(value.span(), wrong(&key, expected, other.type_str().to_owned())));
        }
    };
    let unit = output_unit(context, value, unit)?;
    Ok(CommandOutput { name: name.get_ref().clone(), unit, pick })
}

fn pick<'a>(key: &str, text: &dyn Fn(&str) -> Option<&'a str>) -> Result<Option<Pick>, Problem> {
    let which = match text("match") {
        None => Match::Last,
        Some(name) => Match::ALL
            .into_iter()
            .find(|which| which.name() == name)
            .ok_or_else(|| wrong(&format!("{key}.match"), "\"first\" or \"last\"", format!("{name:?}")))?,
    };
    let way = match (text("regex"), text("column"), text("pointer")) {
        (Some(regex), None, None) => {
            let regex = Regex::new(regex).map_err(|error| {
                let reason = error.to_string();
                let reason = reason.lines().last().unwrap_or_default().trim_start_matches("error: ").to_owned();
                wrong(&format!("{key}.regex"), "a regular expression", format!("{regex:?}: {reason}"))
            })?;
            Way::Regex(regex, which)
        }
        (None, Some(column), None) => Way::Column(column.to_owned(), which),
        (None, None, Some(pointer)) if pointer.is_empty() || pointer.starts_with('/') => {
            Way::Pointer(pointer.to_owned())
        }
        (None, None, Some(pointer)) => {
            let expected = "a JSON pointer, which begins with a slash, as in \"/result/force\"";
            return Err(wrong(&format!("{key}.pointer"), expected, format!("{pointer:?}")));
        }
        (None, None, None) => {
            if let Some(left) = ["file", "match"].into_iter().find(|key| text(key).is_some()) {
                let expected = "only beside `regex`, `column` or `pointer`";
                return Err(wrong(&format!("{key}.{left}"), expected, "without one of them".to_owned()));
            }
            return Ok(None);
        }
        _ => {
            return Err(wrong(key, "a table with one of `regex`, `column`, `pointer`", "one with several".to_owned()));
        }
    };
    if let (Way::Pointer(_), Some(_)) = (&way, text("match")) {
        return Err(wrong(&format!("{key}.match"), "only beside `regex` or `column`", "beside `pointer`".to_owned()));
    }
    let source = text("file").map_or(Source::Stdout, |file| Source::File(file.to_owned()));
    Ok(Some(Pick { source, way }))
}

/// The outputs as settings in results.
pub(super) fn stated(outputs: &[CommandOutput]) -> Json {
    let entry = |output: &CommandOutput| {
        let mut entry = serde_json::Map::new();
        entry.insert("unit".to_owned(), json!(output.unit.symbol()));
        if let Some(Pick { source, way }) = &output.pick {
            if let Source::File(file) = source {
                entry.insert("file".to_owned(), json!(file));
            }
            let (key, text, which) = match way {
                Way::Regex(regex, which) => ("regex", regex.as_str(), Some(which)),
                Way::Column(column, which) => ("column", column.as_str(), Some(which)),
                Way::Pointer(pointer) => ("pointer", pointer.as_str(), None),
            };
            entry.insert(key.to_owned(), json!(text));
            if let Some(which) = which {
                entry.insert("match".to_owned(), json!(which.name()));
            }
        }
        (output.name.clone(), Json::Object(entry))
    };
    Json::Object(outputs.iter().map(entry).collect())
}
