//! The key `outputs` of programs and of external models: names, or a table of units, of series, and of the positions of
//! a program's numbers after a run.

use std::ops::Range;

use apportion::model::{Input, Output, OutputSeries, SeriesAxis, SeriesError};
use apportion::study::ExternalSubject;
use apportion_base::names::{SHORT_TEXT, is_short_text};
use apportion_base::quantity::Unit;
use regex_lite::Regex;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Map, Value as Json, json};
use toml::Value;

use super::at::{At, ListOrTable, in_order};
use super::context::{Context, Fault, shown, wrong};
use super::distribution::{output_unit, own_inputs};
use super::error::Problem;
use super::key_schemas::names;
use super::resolve;
use super::sections::{FactorSection, Outputs};
use crate::{CommandOutput, Match, Pick, Source, Way};

/// The table of an output: its formula, the place of its number after a run, the axis of a series.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct OutputTable {
    /// Formula of the factors.
    pub formula: Option<String>,
    /// Unit of the output's numbers.
    pub unit: Option<String>,
    /// File that a run writes in its directory; standard output by default.
    pub file: Option<String>,
    /// Regular expression, whose first group is the number.
    pub regex: Option<String>,
    /// Column of a CSV table with a header.
    pub column: Option<String>,
    /// JSON pointer (RFC 6901), as in "/result/force".
    pub pointer: Option<String>,
    /// Which match of the regex, or row of the table, to use; a series uses all.
    #[serde(rename = "match")]
    #[schemars(extend("enum" = names(&Match::ALL, Match::name), "default" = "last"))]
    pub which: Option<String>,
    /// The number of values, if the output is a series along an axis.
    #[schemars(range(min = 2, max = 10000))]
    pub length: Option<u64>,
    /// Name of the axis.
    #[schemars(extend("default" = "index"))]
    pub axis: Option<String>,
    /// Unit of the positions.
    pub axis_unit: Option<String>,
    /// The first position and the step, or the position of every value; 0, 1, 2, ... by default.
    pub positions: Option<Vec<f64>>,
}

impl OutputTable {
    /// Reads the table `typed`, which is the value of an output.
    pub(super) fn read(context: &Context<'_>, value: &At<Value>, typed: &toml::Table) -> Result<Self, Fault> {
        context.at(value, typed.clone().try_into().map_err(|error| resolve::problem(&error)))
    }
}

/// The outputs of the user's own model.
#[derive(Default)]
pub(super) struct OwnOutputs {
    /// In the order of the file.
    pub outputs: Vec<CommandOutput>,
    /// The outputs that are series.
    pub series: Vec<OutputSeries>,
    /// The position of the first output with a pick.
    pub first_pick: Option<Range<usize>>,
    /// The settings for results: what the numbers depend on, so the length of a series and not its axis.
    pub stated: Map<String, Json>,
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

    /// Refuses two outputs of the same name, including values of series, and a series and an output.
    fn refuse_repeated(&self) -> Result<(), Problem> {
        let mut seen = std::collections::BTreeSet::new();
        let outputs = self.outputs.iter().map(|output| &output.name);
        let mut all = outputs.chain(self.series.iter().map(|series| &series.name));
        let repeated = all.find(|name| !seen.insert(*name));
        repeated.map_or(Ok(()), |name| Err(Problem::Repeated { what: "output", name: name.clone() }))
    }
}

/// Returns the outputs that the study states.
pub(super) fn own_outputs(context: &Context<'_>, key: Option<&At<Outputs>>) -> Result<OwnOutputs, Fault> {
    let missing = Problem::missing("outputs", "outputs = [\"y\"]; or with its unit: outputs.y = \"nN\"");
    let Some(key) = key else { return Err(context.fault(0..0, missing)) };
    let mut all = OwnOutputs::default();
    match key.get_ref() {
        ListOrTable::List(names) => {
            for name in names {
                let (name, unit) = (name.get_ref().clone(), Unit::dimensionless());
                all.stated.insert(name.clone(), json!({ "unit": unit.symbol() }));
                all.outputs.push(CommandOutput { name, unit, pick: None });
            }
        }
        ListOrTable::Table(table) => {
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
    context: &Context<'_>,
    name: &At<String>,
    value: &At<Value>,
) -> Result<(CommandOutput, Option<SeriesAxis>, Json), Fault> {
    let key = format!("outputs.{}", name.get_ref());
    let table = match value.get_ref() {
        Value::String(unit) => OutputTable { unit: Some(unit.clone()), ..OutputTable::default() },
        Value::Table(typed) => OutputTable::read(context, value, typed)?,
        other => {
            let expected = "a unit, as in \"nN\" or \"1\", or a table such as { unit = \"nN\" }";
            return context.refuse(value, &key, expected, shown(other));
        }
    };
    if table.formula.is_some() {
        let expected = "only of model = \"expression\"";
        return context.refuse(value, &format!("{key}.formula"), expected, "of another model".to_owned());
    }
    let axis = context.at(value, axis(&key, &table))?;
    let pick = context.at(value, pick(&key, &table))?;
    if axis.is_some() && table.which.is_some() {
        let expected = "used only for a single number: a series takes every match or row, from the first on";
        return context.refuse(value, &format!("{key}.match"), expected, "with `length`".to_owned());
    }
    let unit = output_unit(context, value, table.unit.as_deref().unwrap_or_default())?;
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
    let refused = |name: &str, expected: &str, found: String| Err(wrong(&format!("{key}{name}"), expected, found));
    let taken = match which.as_deref() {
        None => Match::Last,
        Some(name) => match Match::ALL.into_iter().find(|taken| taken.name() == name) {
            Some(taken) => taken,
            None => return refused(".match", "\"first\" or \"last\"", format!("{name:?}")),
        },
    };
    let way = match (regex, column, pointer) {
        (Some(regex), None, None) => match Regex::new(regex) {
            Ok(regex) => Way::Regex(regex, taken),
            Err(error) => {
                let reason = error.to_string();
                let reason = reason.lines().last().unwrap_or_default().trim_start_matches("error: ");
                return refused(".regex", "a regular expression", format!("{regex:?}: {reason}"));
            }
        },
        (None, Some(column), None) => Way::Column(column.clone(), taken),
        (None, None, Some(_)) if which.is_some() => {
            return refused(".match", "only with `regex` or `column`", "with `pointer`".to_owned());
        }
        (None, None, Some(pointer)) if pointer.is_empty() || pointer.starts_with('/') => Way::Pointer(pointer.clone()),
        (None, None, Some(pointer)) => {
            let expected = "a JSON pointer, which begins with a slash, as in \"/result/force\"";
            return refused(".pointer", expected, format!("{pointer:?}"));
        }
        (None, None, None) => {
            let alone = [(".file", file), (".match", which)].into_iter().find(|(_, text)| text.is_some());
            let expected = "only with `regex`, `column` or `pointer`";
            return alone.map_or(Ok(None), |(left, _)| refused(left, expected, "without one of them".to_owned()));
        }
        _ => return refused("", "a table with one of `regex`, `column`, `pointer`", "one with several".to_owned()),
    };
    Ok(Some(Pick { source: file.clone().map_or(Source::Stdout, Source::File), way }))
}

/// Returns the inputs of the model: the factors of the study, each in its own unit.
pub fn inputs(context: &Context<'_>, factors: &[At<FactorSection>]) -> Result<Vec<Input>, Fault> {
    for section in factors {
        let name = &section.get_ref().name;
        if name.get_ref().trim() != name.get_ref() || name.get_ref().is_empty() {
            let expected = "a text without spaces around it (it is the header of a column)";
            return context.refuse(name, "name of a factor", expected, format!("{:?}", name.get_ref()));
        }
    }
    own_inputs(context, factors)
}

/// Returns the outputs that the study states.
#[cfg_attr(target_family = "wasm", allow(dead_code, reason = "a page starts no programs"))]
pub(super) fn subject(context: &Context<'_>, outputs: Option<&At<Outputs>>) -> Result<ExternalSubject, Fault> {
    let own = own_outputs(context, outputs)?;
    if let Some(place) = own.first_pick {
        let expected = "used only with a program that this program starts";
        return Err(context.fault(
            place,
            wrong("regex, column, pointer, file, match", expected, "with an external model".to_owned()),
        ));
    }
    let output = |output: crate::CommandOutput| Output::new(output.name, output.unit, "computed outside this program");
    Ok(ExternalSubject { outputs: own.outputs.into_iter().map(output).collect(), series: own.series })
}

/// Returns the axis of the output `key` from its `table`; `None` if it is not a series.
pub(super) fn axis(key: &str, table: &OutputTable) -> Result<Option<SeriesAxis>, Problem> {
    let OutputTable { length, axis, axis_unit, positions, .. } = table;
    let texts = [("axis", axis), ("axis_unit", axis_unit)];
    let said = texts.map(|(name, text)| (name, text.is_some()));
    let said = [("length", length.is_some()), ("positions", positions.is_some())].into_iter().chain(said);
    let Some((first, _)) = said.into_iter().find(|(_, said)| *said) else { return Ok(None) };
    let is_wrong = |(_, text): &(&str, &Option<String>)| text.as_ref().is_some_and(|text| !is_short_text(text));
    if let Some((name, Some(text))) = texts.into_iter().find(is_wrong) {
        return Err(wrong(&format!("{key}.{name}"), SHORT_TEXT, format!("{text:?}")));
    }
    let (label, unit) = (axis.as_deref().unwrap_or("index"), axis_unit.as_deref().unwrap_or_default());
    let length = length.map(|length| usize::try_from(length).unwrap_or(usize::MAX));
    let refused = |error: SeriesError| {
        let (name, expected, found) = match error {
            SeriesError::Length { found } => ("length", "2 to 10000 values", found.to_string()),
            SeriesError::Position { place, found } => {
                ("positions", "finite numbers in rising order", format!("{found} at place {place}"))
            }
        };
        wrong(&format!("{key}.{name}"), expected, found)
    };
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
            let found = format!("`{first}` without one");
            return Err(wrong(&format!("{key}.length"), "the number of values, as in length = 365", found));
        }
    };
    axis.map(Some).map_err(refused)
}
