//! The key `outputs` of programs and of models outside: names, or a table of units, of series, and of where the numbers of a
//! program stand after a run.

use std::ops::Range;

use regex::Regex;
use serde_json::{Value as Json, json};
use toml::Value;

use super::at::{At, ListOrTable, in_order};
use super::context::{Context, Fault, unknown_key, wrong};
use super::error::Problem;
use super::sections::Outputs;
use super::series::{self, SERIES_KEYS};
use super::units::output_unit;
use crate::model::{CommandOutput, Match, OutputSeries, Pick, SeriesAxis, Source, Way};
use crate::quantity::Unit;

const KEYS: [&str; 6] = ["unit", "file", "regex", "column", "pointer", "match"];

/// What a model of the user's own gives.
#[derive(Default)]
pub(super) struct OwnOutputs {
    /// In the order of the file.
    pub outputs: Vec<CommandOutput>,
    /// Those of them that are series.
    pub series: Vec<OutputSeries>,
    /// The place of the first one that says where its number stands.
    pub first_pick: Option<Range<usize>>,
}

impl OwnOutputs {
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

    /// Refuses two outputs of one name, be it that of a value of a series, or a series and an output.
    fn refuse_repeated(&self) -> Result<(), Problem> {
        let mut seen = std::collections::BTreeSet::new();
        let outputs = self.outputs.iter().map(|output| &output.name);
        let mut all = outputs.chain(self.series.iter().map(|series| &series.name));
        let repeated = all.find(|name| !seen.insert(*name));
        repeated.map_or(Ok(()), |name| Err(Problem::Repeated { what: "output", name: name.clone() }))
    }
}

/// The outputs that the study states.
pub(super) fn own_outputs(context: &Context<'_>, key: Option<&At<Outputs>>) -> Result<OwnOutputs, Fault> {
    let missing =
        Problem::Missing { what: "outputs", example: "outputs = [\"y\"]; or with its unit: outputs.y = \"nN\"" };
    let Some(key) = key else { return Err(context.fault(0..0, missing)) };
    let mut all = OwnOutputs::default();
    match key.get_ref() {
        ListOrTable::List(names) => {
            for name in names {
                refuse_name(context, name)?;
                let output = CommandOutput { name: name.get_ref().clone(), unit: Unit::dimensionless(), pick: None };
                all.outputs.push(output);
            }
        }
        ListOrTable::Table(table) => {
            for (name, value) in in_order(table) {
                refuse_name(context, name)?;
                let (output, axis) = output(context, name, value)?;
                if output.pick.is_some() && all.first_pick.is_none() {
                    all.first_pick = Some(value.span());
                }
                match axis {
                    None => all.outputs.push(output),
                    Some(axis) => all.add_series(output, axis),
                }
            }
        }
    }
    if all.outputs.is_empty() {
        return Err(context.fault(key.span(), missing));
    }
    all.refuse_repeated().map_err(|problem| context.fault(key.span(), problem))?;
    Ok(all)
}

fn refuse_name(context: &Context<'_>, name: &At<String>) -> Result<(), Fault> {
    if !name.get_ref().trim().is_empty() && !name.get_ref().contains(char::is_control) {
        return Ok(());
    }
    let expected = "not empty, and without line breaks and control characters";
    Err(context.fault(name.span(), wrong("name of an output", expected, format!("{:?}", name.get_ref()))))
}

/// An output, and the axis of one that is a series.
fn output(
    context: &Context<'_>,
    name: &At<String>,
    value: &At<Value>,
) -> Result<(CommandOutput, Option<SeriesAxis>), Fault> {
    let key = format!("outputs.{}", name.get_ref());
    let fault = |problem| context.fault(value.span(), problem);
    let (unit, pick, axis) = match value.get_ref() {
        Value::String(unit) => (unit.as_str(), None, None),
        Value::Table(table) => {
            let known = || KEYS.into_iter().chain(SERIES_KEYS);
            if let Some(unknown) = table.keys().find(|key| !known().any(|known| known == key.as_str())) {
                return Err(fault(unknown_key(unknown, known())));
            }
            let axis = series::axis(&key, table).map_err(fault)?;
            let texts = || table.iter().filter(|(name, _)| KEYS.contains(&name.as_str()));
            if let Some((name, other)) = texts().find(|(_, value)| !value.is_str()) {
                return Err(fault(wrong(&format!("{key}.{name}"), "a text", other.type_str().to_owned())));
            }
            let text = |key: &str| table.get(key).and_then(Value::as_str);
            let pick = pick(&key, &text).map_err(fault)?;
            if axis.is_some() && table.contains_key("match") {
                let expected = "only of a single number: a series takes every match or row, from the first on";
                return Err(fault(wrong(&format!("{key}.match"), expected, "beside `length`".to_owned())));
            }
            (text("unit").unwrap_or_default(), pick, axis)
        }
        other => {
            let expected = "a unit, as in \"nN\" or \"1\", or a table such as { unit = \"nN\" }";
            return Err(fault(wrong(&key, expected, other.type_str().to_owned())));
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
pub(super) fn outputs_as_settings(OwnOutputs { outputs, series, .. }: &OwnOutputs) -> Json {
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
