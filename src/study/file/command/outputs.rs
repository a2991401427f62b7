//! The outputs of a program: their names and units, and where each stands after a run.

use regex::Regex;
use serde_json::{Value as Json, json};
use toml::Value;

use super::file::{CommandKey, CommandSection};
use crate::model::{CommandOutput, Match, OutputSeries, Pick, SeriesAxis, Source, Way};
use crate::names::nearest;
use crate::quantity::Unit;
use crate::study::file::at::At;
use crate::study::file::context::wrong;
use crate::study::file::context::{Context, Fault};
use crate::study::file::error::Problem;
use crate::study::file::paths::refuse_outside_of_run;
use crate::study::file::series::{self, SERIES_KEYS, refuse_repeated};
use crate::study::file::units::output_unit;

const KEYS: [&str; 6] = ["unit", "file", "regex", "column", "pointer", "match"];

/// What a program gives.
#[derive(Default)]
pub(super) struct Outputs<'a> {
    /// In the order of the program.
    pub outputs: Vec<CommandOutput>,
    /// Those of them that are series.
    pub series: Vec<OutputSeries>,
    /// The values of those that say where they stand.
    pub picks: Vec<&'a At<Value>>,
}

impl Outputs<'_> {
    /// Adds the values of `output` along `axis`.
    fn add_series(&mut self, output: CommandOutput, axis: SeriesAxis) {
        let names = OutputSeries::value_names(&output.name, axis.positions().len()).enumerate();
        let first = self.outputs.len();
        self.outputs.extend(names.map(|(number, name)| {
            let pick = output.pick.as_ref().map(|pick| pick.of_value(number));
            CommandOutput { name, unit: output.unit.clone(), pick }
        }));
        self.series.push(OutputSeries { name: output.name, first, axis });
    }
}

/// The outputs by `[command] outputs`, else by the names asked for.
pub(super) fn outputs<'a>(
    context: &Context<'_>,
    key: &At<CommandKey>,
    section: &'a CommandSection,
    asked: Option<&At<Vec<At<String>>>>,
) -> Result<Outputs<'a>, Fault> {
    let mut entries: Vec<(&At<String>, &At<Value>)> = section.outputs.iter().collect();
    if entries.is_empty() {
        let Some(asked) = asked else { return Err(context.fault(key.span(), Problem::NoProgramOutputs)) };
        let output = |name: &At<String>| {
            refuse_name(context, name)?;
            Ok(CommandOutput { name: name.get_ref().clone(), unit: Unit::dimensionless(), pick: None })
        };
        let outputs = asked.get_ref().iter().map(output).collect::<Result<_, Fault>>()?;
        return Ok(Outputs { outputs, ..Outputs::default() });
    }
    // In the order of the file.
    entries.sort_by_key(|(name, _)| name.span().start);
    let mut all = Outputs::default();
    for (name, value) in entries {
        refuse_name(context, name)?;
        let (output, axis) = output(context, name, value)?;
        if let Some(pick) = &output.pick {
            all.picks.push(value);
            if let Source::File(file) = &pick.source {
                refuse_outside_of_run(context, value.span(), file, super::reach(section))?;
            }
        }
        match axis {
            None => all.outputs.push(output),
            Some(axis) => all.add_series(output, axis),
        }
        if all.series.is_empty() {
            continue;
        }
        let names: Vec<&str> = all.outputs.iter().map(|output| output.name.as_str()).collect();
        refuse_repeated(&names, &all.series).map_err(|problem| context.fault(name.span(), problem))?;
    }
    Ok(all)
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
    Outputs { outputs, series, .. }: &Outputs<'_>,
    asked: Option<&At<Vec<At<String>>>>,
) -> Result<Vec<usize>, Fault> {
    let Some(asked) = asked else { return Ok((0..outputs.len()).collect()) };
    let mut names: Vec<&str> = outputs.iter().map(|output| output.name.as_str()).collect();
    if section.outputs.is_empty() {
        // They are what was asked for, apart from repetitions.
        names.dedup();
    }
    series::places(context, &names, series, asked).map_err(|mut fault| {
        // The nearest name is what was meant, if there is one.
        if let Problem::UnknownName { what: "output", name, nearest: None, .. } = &fault.problem
            && !section.outputs.is_empty()
        {
            fault.problem = Problem::NotInTable { name: name.clone(), known: names.join(", ") };
        }
        fault
    })
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

/// An output, and the axis of one that is a series.
fn output(
    context: &Context<'_>,
    name: &At<String>,
    value: &At<Value>,
) -> Result<(CommandOutput, Option<SeriesAxis>), Fault> {
    let key = format!("outputs.{}", name.get_ref());
    let (unit, pick, axis) = match value.get_ref() {
        Value::String(unit) => (unit.as_str(), None, None),
        Value::Table(table) => {
            let known = || KEYS.into_iter().chain(SERIES_KEYS);
            if let Some(unknown) = table.keys().find(|key| !known().any(|known| known == key.as_str())) {
                let problem = Problem::UnknownKey {
                    name: unknown.clone(),
                    nearest: nearest(unknown, known()),
                    expected: known().map(str::to_owned).collect(),
                };
                return Err(context.fault(value.span(), problem));
            }
            let axis = series::axis(&key, table).map_err(|problem| context.fault(value.span(), problem))?;
            let texts = || table.iter().filter(|(name, _)| KEYS.contains(&name.as_str()));
            if let Some((name, other)) = texts().find(|(_, value)| !value.is_str()) {
                let problem = wrong(&format!("{key}.{name}"), "a text", other.type_str().to_owned());
                return Err(context.fault(value.span(), problem));
            }
            let text = |key: &str| table.get(key).and_then(Value::as_str);
            let pick = pick(&key, &text).map_err(|problem| context.fault(value.span(), problem))?;
            if axis.is_some() && table.contains_key("match") {
                let expected = "only of a single number: a series takes every match or row, from the first on";
                let problem = wrong(&format!("{key}.match"), expected, "beside `length`".to_owned());
                return Err(context.fault(value.span(), problem));
            }
            (text("unit").unwrap_or_default(), pick, axis)
        }
        other => {
            let expected = "a unit, or a table such as { unit = \"nN\" }";
            return Err(context.fault(value.span(), wrong(&key, expected, other.type_str().to_owned())));
        }
    };
    let unit = output_unit(context, value, unit)?;
    Ok((CommandOutput { name: name.get_ref().clone(), unit, pick }, axis))
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

/// The outputs as settings in results: what their numbers depend on, so of a series its length and not its axis.
pub(super) fn stated(Outputs { outputs, series, .. }: &Outputs<'_>) -> Json {
    let entry = |(place, output): (usize, &CommandOutput)| {
        let series = series.iter().find(|series| series.places().contains(&place));
        // The first value stands for all.
        if series.is_some_and(|series| series.first != place) {
            return None;
        }
        let mut entry = serde_json::Map::new();
        entry.insert("unit".to_owned(), json!(output.unit.symbol()));
        if let Some(series) = series {
            entry.insert("length".to_owned(), json!(series.places().len()));
        }
        if let Some(Pick { source, way }) = &output.pick {
            if let Source::File(file) = source {
                entry.insert("file".to_owned(), json!(file));
            }
            let (key, text, which) = match way {
                Way::Regex(regex, which) => ("regex", regex.as_str(), Some(which)),
                Way::Column(column, which) => ("column", column.as_str(), Some(which)),
                Way::Pointer(pointer) => ("pointer", pointer.as_str(), None),
            };
            let text = if series.is_some() { text.strip_suffix("/0").unwrap_or(text) } else { text };
            entry.insert(key.to_owned(), json!(text));
            if let Some(which) = which.filter(|_| series.is_none()) {
                entry.insert("match".to_owned(), json!(which.name()));
            }
        }
        Some((series.map_or(&output.name, |series| &series.name).clone(), Json::Object(entry)))
    };
    Json::Object(outputs.iter().enumerate().filter_map(entry).collect())
}
