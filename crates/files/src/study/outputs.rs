//! The key `outputs` of programs and of external models: names, or a table of units, of series, and of the positions of
//! a program's numbers after a run.

use std::ops::Range;
use std::sync::Arc;

use apportion::model::{Input, Output, OutputSeries, SeriesAxis, SeriesError};
use apportion::space::Space;
use apportion::study::ExternalSubject;
use apportion_base::names::{SHORT_TEXT, is_short_text};
use apportion_base::quantity::Unit;
use regex_lite::Regex;
use serde_json::{Map, Value as Json, json};
use toml::Value;

use super::at::{At, in_order};
use super::context::{Context, Fault, shown, wrong};
use super::error::Problem;
use super::output_table::{OutputTable, Outputs};
use super::parse;
use super::reading::{Configured, Reading};
use super::units::factor_inputs;
use crate::{CommandOutput, Match, Pick, PickMethod, Source};

/// The outputs that a study states for a program or an external model.
#[derive(Default)]
pub(super) struct StatedOutputs {
    /// In the order of the file.
    pub outputs: Vec<CommandOutput>,
    /// The outputs that are series.
    pub series: Vec<OutputSeries>,
    /// The position of the first output with a pick.
    pub first_pick: Option<Range<usize>>,
    /// The settings for results: what the numbers depend on, so the length of a series and not its axis.
    pub stated: Map<String, Json>,
}

impl StatedOutputs {
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

    /// Refuses two outputs of the same name, including values of series, and a series and an output.
    fn refuse_repeated(&self) -> Result<(), Problem> {
        let mut seen = std::collections::BTreeSet::new();
        let outputs = self.outputs.iter().map(|output| &output.name);
        let mut all = outputs.chain(self.series.iter().map(|series| &series.name));
        let repeated = all.find(|name| !seen.insert(*name));
        repeated.map_or(Ok(()), |name| Err(Problem::Repeated { what: "output", name: name.clone() }))
    }
}

/// Reads the table `typed`, which is the value of an output.
pub(super) fn output_table(context: &Context, value: &At<Value>, typed: &toml::Table) -> Result<OutputTable, Fault> {
    context.at(value, typed.clone().try_into().map_err(|error| parse::problem(&error)))
}

/// Returns the outputs that the study states.
pub(super) fn stated_outputs(Reading { context, file, .. }: &Reading) -> Result<StatedOutputs, Fault> {
    let missing = Problem::missing("outputs", "outputs = [\"y\"]; or with its unit: outputs.y = \"nN\"");
    let Some(key) = &file.outputs else { return Err(context.fault(0..0, missing)) };
    let mut all = StatedOutputs::default();
    match key.get_ref() {
        Outputs::Names(names) => {
            for name in names {
                let (name, unit) = (name.get_ref().clone(), Unit::dimensionless());
                all.stated.insert(name.clone(), json!({ "unit": unit.symbol() }));
                all.outputs.push(CommandOutput { name, unit, pick: None });
            }
        }
        Outputs::Table(table) => {
            for (name, value) in in_order(table) {
                let (output, axis, stated) = output(context, name, value)?;
                if output.pick.is_some() && all.first_pick.is_none() {
                    all.first_pick = Some(value.span());
                }
                all.stated.insert(output.name.clone(), stated);
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
    context.at(key, all.refuse_repeated())?;
    Ok(all)
}

/// Reads an output, its axis if it is a series, and its settings for results.
fn output(
    context: &Context,
    name: &At<String>,
    value: &At<Value>,
) -> Result<(CommandOutput, Option<SeriesAxis>, Json), Fault> {
    let key = format!("outputs.{}", name.get_ref());
    let table = match value.get_ref() {
        Value::String(unit) => OutputTable { unit: Some(unit.clone()), ..OutputTable::default() },
        Value::Table(typed) => output_table(context, value, typed)?,
        other => {
            let expected = "a unit, as in \"nN\" or \"1\", or a table such as { unit = \"nN\" }";
            return context.refuse(value, &key, expected, shown(other));
        }
    };
    if table.formula.is_some() {
        return context.refuse(value, &format!("{key}.formula"), "only of model = \"expression\"", "of another model");
    }
    let axis = context.at(value, axis(&key, &table))?;
    let pick = context.at(value, pick(&key, &table))?;
    if axis.is_some() && table.which.is_some() {
        let expected = "used only for a single number: a series takes every match or row, from the first on";
        return context.refuse(value, &format!("{key}.match"), expected, "with `length`");
    }
    let unit = table.unit.as_deref().unwrap_or_default();
    if !is_short_text(unit) {
        return context.refuse(value, "unit", SHORT_TEXT, format!("{unit:?}"));
    }
    let unit = Unit::label(unit);
    let stated = stated(&table, &unit, axis.as_ref());
    Ok((CommandOutput { name: name.get_ref().clone(), unit, pick }, axis, stated))
}

fn stated(table: &OutputTable, unit: &Unit, axis: Option<&SeriesAxis>) -> Json {
    let OutputTable { file, regex, column, pointer, which, .. } = table;
    let mut entry = Map::new();
    entry.insert("unit".to_owned(), json!(unit.symbol()));
    entry.extend(axis.map(|axis| ("length".to_owned(), json!(axis.positions().len()))));
    let texts = [("file", file), ("regex", regex), ("column", column), ("pointer", pointer)];
    entry.extend(texts.into_iter().filter_map(|(key, text)| Some((key.to_owned(), json!(text.as_ref()?)))));
    if axis.is_none() && (regex.is_some() || column.is_some()) {
        entry.insert("match".to_owned(), json!(which.as_deref().unwrap_or(Match::Last.name())));
    }
    Json::Object(entry)
}

fn pick(key: &str, table: &OutputTable) -> Result<Option<Pick>, Problem> {
    let OutputTable { file, regex, column, pointer, which, .. } = table;
    let name = which.as_deref().unwrap_or(Match::Last.name());
    let Some(taken) = Match::ALL.into_iter().find(|taken| taken.name() == name) else {
        return Err(wrong(&format!("{key}.match"), "\"first\" or \"last\"", format!("{name:?}")));
    };
    let method = match (regex, column, pointer) {
        (Some(regex), None, None) => match Regex::new(regex) {
            Ok(regex) => PickMethod::Regex(regex, taken),
            Err(error) => {
                let reason = error.to_string();
                let reason = reason.lines().last().unwrap_or_default().trim_start_matches("error: ");
                return Err(wrong(&format!("{key}.regex"), "a regular expression", format!("{regex:?}: {reason}")));
            }
        },
        (None, Some(column), None) => PickMethod::Column(column.clone(), taken),
        (None, None, Some(_)) if which.is_some() => {
            return Err(wrong(&format!("{key}.match"), "only with `regex` or `column`", "with `pointer`"));
        }
        (None, None, Some(pointer)) if pointer.is_empty() || pointer.starts_with('/') => {
            PickMethod::Pointer(pointer.clone())
        }
        (None, None, Some(pointer)) => {
            let expected = "a JSON pointer, which begins with a slash, as in \"/result/force\"";
            return Err(wrong(&format!("{key}.pointer"), expected, format!("{pointer:?}")));
        }
        (None, None, None) if file.is_none() && which.is_none() => return Ok(None),
        (None, None, None) => {
            let alone = if file.is_some() { "file" } else { "match" };
            let expected = "only with `regex`, `column` or `pointer`";
            return Err(wrong(&format!("{key}.{alone}"), expected, "without one of them"));
        }
        _ => return Err(wrong(key, "a table with one of `regex`, `column`, `pointer`", "one with several")),
    };
    Ok(Some(Pick { source: file.clone().map_or(Source::Stdout, Source::File), method }))
}

/// Returns the inputs of the model: the factors of the study, each in its own unit.
pub(super) fn inputs(reading: &Reading) -> Result<Vec<Input>, Fault> {
    for section in &reading.file.factor {
        let name = &section.get_ref().name;
        if name.get_ref().trim() != name.get_ref() || name.get_ref().is_empty() {
            let expected = "a text without spaces around it (it is the header of a column)";
            return reading.context.refuse(name, "name of a factor", expected, format!("{:?}", name.get_ref()));
        }
    }
    factor_inputs(reading)
}

/// Returns the outputs that the study states.
#[cfg_attr(target_family = "wasm", allow(dead_code, reason = "a page starts no programs"))]
pub(super) fn subject(reading: &Reading, _: &Space) -> Configured {
    let StatedOutputs { outputs, series, first_pick, .. } = stated_outputs(reading)?;
    if let Some(place) = first_pick {
        let (key, expected) =
            ("regex, column, pointer, file, match", "used only with a program that this program starts");
        return Err(reading.context.fault(place, wrong(key, expected, "with an external model")));
    }
    let outputs =
        outputs.into_iter().map(|output| Output::new(output.name, output.unit, "computed outside this program"));
    Ok((Arc::new(ExternalSubject { outputs: outputs.collect(), series }), Vec::new()))
}

/// Returns the axis of the output `key` from its `table`; `None` if it is not a series.
pub(super) fn axis(key: &str, table: &OutputTable) -> Result<Option<SeriesAxis>, Problem> {
    let OutputTable { length, axis, axis_unit, positions, .. } = table;
    let first = match (length, positions, axis, axis_unit) {
        (Some(_), ..) => "length",
        (_, Some(_), ..) => "positions",
        (.., Some(_), _) => "axis",
        (.., Some(_)) => "axis_unit",
        _ => return Ok(None),
    };
    for (name, text) in [("axis", axis), ("axis_unit", axis_unit)] {
        if let Some(text) = text.as_ref().filter(|text| !is_short_text(text)) {
            return Err(wrong(&format!("{key}.{name}"), SHORT_TEXT, format!("{text:?}")));
        }
    }
    let (label, unit) = (axis.as_deref().unwrap_or("index"), axis_unit.as_deref().unwrap_or_default());
    let length = length.map(|length| usize::try_from(length).unwrap_or(usize::MAX));
    let axis = match (positions.clone(), length) {
        (None, Some(length)) => SeriesAxis::even(label, unit, length, 0.0, 1.0),
        (Some(pair), Some(length)) if pair.len() == 2 => SeriesAxis::even(label, unit, length, pair[0], pair[1]),
        (Some(list), length) if list.len() != 2 && length.is_none_or(|length| length == list.len()) => {
            SeriesAxis::new(label, unit, list)
        }
        (Some(list), Some(length)) => {
            let expected = format!("a list of {length} numbers, or of two: the first position and the step");
            return Err(wrong(&format!("{key}.positions"), &expected, format!("a list of {}", list.len())));
        }
        (_, None) => {
            let expected = "the number of values, as in length = 365";
            return Err(wrong(&format!("{key}.length"), expected, format!("`{first}` without one")));
        }
    };
    axis.map(Some).map_err(|error| match error {
        SeriesError::Length { found } => wrong(&format!("{key}.length"), "2 to 10000 values", found),
        SeriesError::Position { place, found } => {
            let position = format!("{found} at place {place}");
            wrong(&format!("{key}.positions"), "finite numbers in rising order", position)
        }
    })
}
