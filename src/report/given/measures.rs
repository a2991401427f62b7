//! Other measures of influence, in the result file of given data and on its page.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{GivenFile, GivenOutputRecord};
use crate::given::{InputMeasures, MOST_ROWS_OF_KERNELS, Measure, NoVariance, PERMUTATIONS};
use crate::report::chart::{Axis, Chart, Colour, Panel, Series, Shape, Tile};
use crate::report::csv::Field;
use crate::report::document::{Cell, Column, Figure, Part, Section, Table, Value};
use crate::report::factor_bars::MOST;
use crate::report::format::{fixed, index as of_error};
use crate::report::records::estimate_record;
use crate::report::result::EstimateRecord;

/// Probability below which an input is taken to have an influence.
const SIGNIFICANT: f64 = 0.05;

/// The measures of one input.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GivenMeasuresRecord {
    /// The input.
    pub input: String,
    /// By the names of [`Measure`].
    pub measures: BTreeMap<String, MeasuredRecord>,
}

/// A measure of one input.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MeasuredRecord {
    /// The measure, with the bounds of its interval where it has one.
    #[serde(flatten)]
    pub estimate: EstimateRecord,
    /// Probability of so large a measure of an input without influence; `null` where it is not known.
    pub p_value: Option<f64>,
}

impl GivenFile {
    /// The result with what `measures` found of each of its outputs.
    #[must_use]
    pub fn with_measures(mut self, measures: &[Result<Vec<InputMeasures>, NoVariance>]) -> Self {
        for (output, measures) in self.outputs.iter_mut().zip(measures) {
            output.measures = measures.as_ref().ok().map(|inputs| inputs.iter().map(record).collect());
        }
        self
    }
}

fn record(of: &InputMeasures) -> GivenMeasuresRecord {
    let measured = |measure: Measure| {
        let found = of.get(measure);
        let record = MeasuredRecord { estimate: estimate_record(found.estimate), p_value: found.p_value };
        (measure.name().to_owned(), record)
    };
    GivenMeasuresRecord { input: of.input.clone(), measures: Measure::ALL.into_iter().map(measured).collect() }
}

impl GivenMeasuresRecord {
    fn get(&self, measure: Measure) -> Option<MeasuredRecord> {
        self.measures.get(measure.name()).copied()
    }

    /// Whether the measure cannot be told from that of an input without influence.
    fn may_be_chance(&self, measure: Measure) -> bool {
        self.get(measure).and_then(|found| found.p_value).is_some_and(|p_value| p_value > SIGNIFICANT)
    }
}

/// The section of the measures of all outputs; `None` if there are none. `figures` counts the figures before it.
pub(super) fn section(result: &GivenFile, name: &str, figures: usize) -> Option<Section> {
    let outputs: Vec<(&GivenOutputRecord, &[GivenMeasuresRecord])> =
        result.outputs.iter().filter_map(|output| Some((output, output.measures.as_deref()?))).collect();
    let mut parts = Vec::new();
    for (number, (output, inputs)) in outputs.iter().enumerate() {
        parts.push(Part::Text(agreement(output, inputs)));
        parts.push(table(output, inputs, name).into());
        let stem = if result.outputs.len() == 1 { String::new() } else { format!("-{}", number + 1) };
        let chart = chart(output, inputs);
        parts.push(Figure::new(figures + number + 1, chart, format!("{name}-measures{stem}"), file_name(name)).into());
    }
    (!parts.is_empty()).then(|| Section::new("measures", "Other measures", parts))
}

fn file_name(name: &str) -> String {
    format!("{name}-measures.csv")
}

/// The rank of every input by a measure, 1 for the largest.
fn ranks(inputs: &[GivenMeasuresRecord], measure: Measure) -> Vec<usize> {
    let value = |k: usize| inputs[k].get(measure).map_or(f64::NEG_INFINITY, |found| found.estimate.estimate);
    let mut order: Vec<usize> = (0..inputs.len()).collect();
    order.sort_by(|&a, &b| value(b).total_cmp(&value(a)));
    let mut ranks = vec![0; inputs.len()];
    order.into_iter().enumerate().for_each(|(rank, input)| ranks[input] = rank + 1);
    ranks
}

/// Whether the measures agree on the input that matters most, and which inputs none of them tells from chance.
fn agreement(output: &GivenOutputRecord, inputs: &[GivenMeasuresRecord]) -> String {
    let mut first: BTreeMap<usize, Vec<&str>> = BTreeMap::new();
    for measure in Measure::ALL {
        if let Some(lead) = ranks(inputs, measure).iter().position(|rank| *rank == 1) {
            first.entry(lead).or_default().push(measure.heading());
        }
    }
    let mut leads: Vec<(usize, Vec<&str>)> = first.into_iter().collect();
    leads.sort_by_key(|(_, by)| std::cmp::Reverse(by.len()));
    let mut text = match &leads[..] {
        [(lead, _)] => format!("All measures put {} first for {}.", inputs[*lead].input, output.name),
        leads => {
            let one = |(lead, by): &(usize, Vec<&str>)| format!("{} by {}", inputs[*lead].input, by.join(", "));
            let all: Vec<String> = leads.iter().map(one).collect();
            format!("The measures do not agree on what comes first for {}: {}.", output.name, all.join("; "))
        }
    };
    let no_influence = |of: &&GivenMeasuresRecord| Measure::ALL.into_iter().all(|measure| of.may_be_chance(measure));
    let idle: Vec<&str> = inputs.iter().filter(no_influence).map(|of| of.input.as_str()).collect();
    if !idle.is_empty() {
        text.push_str(&format!(" No measure tells {} from an input without influence.", idle.join(", ")));
    }
    text
}

fn table(output: &GivenOutputRecord, inputs: &[GivenMeasuresRecord], name: &str) -> Table {
    let mut columns = vec![Column::in_file(Field::new("output")), Column::text("input").named(Field::new("input"))];
    for measure in Measure::ALL {
        columns.push(Column::number(measure.heading()).named(Field::estimate(measure.name())));
        columns.push(Column::in_file(Field::new(format!("{}_p", measure.name()))));
    }
    let row = |of: &GivenMeasuresRecord| {
        let mut row = vec![Cell::from(&output.name), Cell::from(&of.input)];
        for measure in Measure::ALL {
            let found = of.get(measure);
            let said = found.map_or_else(String::new, |found| match found.estimate.low {
                Some(_) => of_error(found.estimate),
                None => fixed(found.estimate.estimate, 3),
            });
            let said = if of.may_be_chance(measure) { format!("({said})") } else { said };
            row.push(Cell::valued(said, Value::Estimate(found.map(|found| found.estimate))));
            let p_value = found.and_then(|found| found.p_value);
            row.push(Cell::valued("", p_value.map_or(Value::Empty, Value::Number)));
        }
        row
    };
    let caption = format!(
        "In brackets is what an input without influence reaches in more than {:.0} of 100 tables: by {PERMUTATIONS} permutations of \
         the output, of R2-HSIC by a gamma distribution. Delta has its 95 % interval. R2-HSIC is of the first {MOST_ROWS_OF_KERNELS} \
         rows at most.",
        100.0 * SIGNIFICANT
    );
    let mut table = Table::new(caption, columns).with_rows(inputs.iter().map(row));
    table.file = file_name(name);
    table
}

/// The rank of every input by every measure.
fn chart(output: &GivenOutputRecord, inputs: &[GivenMeasuresRecord]) -> Chart {
    const KINDS: [(&str, Colour); 5] = [
        ("first", Colour::Series(3)),
        ("second", Colour::Series(5)),
        ("third", Colour::Series(9)),
        ("further down", Colour::Series(10)),
        ("may be chance", Colour::Series(6)),
    ];
    let by_measure: Vec<Vec<usize>> = Measure::ALL.iter().map(|measure| ranks(inputs, *measure)).collect();
    let mut tiles = Vec::new();
    for (row, of) in inputs.iter().enumerate() {
        for (column, measure) in Measure::ALL.into_iter().enumerate() {
            let rank = by_measure[column][row];
            let kind = if of.may_be_chance(measure) { 4 } else { rank.min(4) - 1 };
            let value = of.get(measure).map_or(f64::NAN, |found| found.estimate.estimate);
            let tip = format!("{} of {}: {}", measure.heading(), of.input, fixed(value, 3));
            tiles.push((kind, Tile { row, column, letter: rank.to_string(), tip }));
        }
    }
    // The legend is in the order of the marks.
    tiles.sort_by_key(|(kind, _)| *kind);
    let marks = tiles.into_iter().map(|(kind, tile)| {
        let (words, colour) = KINDS[kind];
        Series::new(words, colour).mark(Shape::Tile(tile))
    });
    let columns = Measure::ALL.map(|measure| measure.heading().to_owned()).to_vec();
    let rows = inputs.iter().map(|of| of.input.clone()).collect();
    let keys: Vec<f64> =
        (0..inputs.len()).map(|input| -by_measure.iter().map(|ranks| ranks[input] as f64).sum::<f64>()).collect();
    let panel = Panel::new(Axis::from_names("measure", columns), Axis::from_names("", rows)).with(marks);
    let caption =
        "Numbers are ranks by each measure, 1 for the largest; what may be chance is so in 5 of 100 tables or more.";
    Chart::new(format!("Ranks of the inputs of {} by measure", output.name), caption)
        .panels([panel.ranked(&keys, MOST)])
}
