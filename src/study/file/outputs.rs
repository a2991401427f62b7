//! The key `outputs` of programs and of models outside: names, or a table of units, of series, and of where the numbers of a
//! program stand after a run.

use std::ops::Range;

use regex::Regex;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value as Json, json};
use toml::Value;

use super::at::{At, ListOrTable, in_order};
use super::context::{Context, Fault, wrong};
use super::error::Problem;
use super::key_schemas::names;
use super::read;
use super::sections::Outputs;
use super::series;
use super::units::output_unit;
use crate::model::{CommandOutput, Match, OutputSeries, Pick, SeriesAxis, Source, Way};
use crate::quantity::Unit;

/// What a table says of an output: its formula, where its number stands after a run, along which axis it is a series.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct OutputTable {
    /// Formula of the factors.
    pub formula: Option<String>,
    /// Unit of the output's numbers.
    pub unit: Option<String>,
    /// File that a run leaves in its directory; its standard output if not said.
    pub file: Option<String>,
    /// Regular expression, whose first group is the number.
    pub regex: Option<String>,
    /// Column of a CSV table with a header.
    pub column: Option<String>,
    /// JSON pointer (RFC 6901), as in "/result/force".
    pub pointer: Option<String>,
    /// Which match of the regex, or row of the table, is taken; of a series every one.
    #[serde(rename = "match")]
    #[schemars(extend("enum" = names(&Match::ALL, Match::name), "default" = "last"))]
    pub which: Option<String>,
    /// The output is a series of so many values along an axis.
    #[schemars(range(min = 2, max = 10000))]
    pub length: Option<u64>,
    /// What the axis is called.
    #[schemars(extend("default" = "index"))]
    pub axis: Option<String>,
    /// Unit of the positions.
    pub axis_unit: Option<String>,
    /// The first position and the step, or the position of every value; 0, 1, 2, ... if not said.
    pub positions: Option<Vec<f64>>,
}

impl OutputTable {
    /// The table `typed`, which is the value of an output.
    pub(super) fn read(context: &Context<'_>, value: &At<Value>, typed: &toml::Table) -> Result<Self, Fault> {
        context.at(value, typed.clone().try_into().map_err(|error| read::problem(&error)))
    }
}

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
    let missing = Problem::missing("outputs", "outputs = [\"y\"]; or with its unit: outputs.y = \"nN\"");
    let Some(key) = key else { return Err(context.fault(0..0, missing)) };
    let mut all = OwnOutputs::default();
    match key.get_ref() {
        ListOrTable::List(names) => {
            for name in names {
                let output = CommandOutput { name: name.get_ref().clone(), unit: Unit::dimensionless(), pick: None };
                all.outputs.push(output);
            }
        }
        ListOrTable::Table(table) => {
            for (name, value) in in_order(table) {
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
    context.at(key, all.refuse_repeated())?;
    Ok(all)
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
        Value::String(unit) => (unit.clone(), None, None),
        Value::Table(typed) => {
            let table = OutputTable::read(context, value, typed)?;
            if table.formula.is_some() {
                let expected = "only of model = \"expression\"";
                return Err(fault(wrong(&format!("{key}.formula"), expected, "of another model".to_owned())));
            }
            let axis = series::axis(&key, &table).map_err(fault)?;
            let pick = pick(&key, &table).map_err(fault)?;
            if axis.is_some() && table.which.is_some() {
                let expected = "only of a single number: a series takes every match or row, from the first on";
                return Err(fault(wrong(&format!("{key}.match"), expected, "beside `length`".to_owned())));
            }
            (table.unit.unwrap_or_default(), pick, axis)
        }
        other => {
            let expected = "a unit, as in \"nN\" or \"1\", or a table such as { unit = \"nN\" }";
            return Err(fault(wrong(&key, expected, other.type_str().to_owned())));
        }
    };
    let unit = output_unit(context, value, &unit)?;
    Ok((CommandOutput { name: name.get_ref().clone(), unit, pick }, axis))
}

fn pick(key: &str, table: &OutputTable) -> Result<Option<Pick>, Problem> {
    let OutputTable { file, regex, column, pointer, which, .. } = table;
    let taken = match which {
        None => Match::Last,
        Some(name) => Match::ALL
            .into_iter()
            .find(|taken| taken.name() == name)
            .ok_or_else(|| wrong(&format!("{key}.match"), "\"first\" or \"last\"", format!("{name:?}")))?,
    };
    let way = match (regex, column, pointer) {
        (Some(regex), None, None) => {
            let regex = Regex::new(regex).map_err(|error| {
                let reason = error.to_string();
                let reason = reason.lines().last().unwrap_or_default().trim_start_matches("error: ").to_owned();
                wrong(&format!("{key}.regex"), "a regular expression", format!("{regex:?}: {reason}"))
            })?;
            Way::Regex(regex, taken)
        }
        (None, Some(column), None) => Way::Column(column.clone(), taken),
        (None, None, Some(pointer)) if pointer.is_empty() || pointer.starts_with('/') => Way::Pointer(pointer.clone()),
        (None, None, Some(pointer)) => {
            let expected = "a JSON pointer, which begins with a slash, as in \"/result/force\"";
            return Err(wrong(&format!("{key}.pointer"), expected, format!("{pointer:?}")));
        }
        (None, None, None) => {
            let alone = [("file", file), ("match", which)].into_iter().find(|(_, text)| text.is_some());
            if let Some((left, _)) = alone {
                let expected = "only beside `regex`, `column` or `pointer`";
                return Err(wrong(&format!("{key}.{left}"), expected, "without one of them".to_owned()));
            }
            return Ok(None);
        }
        _ => {
            return Err(wrong(key, "a table with one of `regex`, `column`, `pointer`", "one with several".to_owned()));
        }
    };
    if let (Way::Pointer(_), Some(_)) = (&way, which) {
        return Err(wrong(&format!("{key}.match"), "only beside `regex` or `column`", "beside `pointer`".to_owned()));
    }
    let source = file.clone().map_or(Source::Stdout, Source::File);
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
