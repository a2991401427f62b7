//! Other measures of influence in the document of given data, and their tables for other documents.

use std::collections::BTreeMap;

use super::record::{GivenFile, GivenOutputRecord};
use crate::given::{InputMeasures, MOST_ROWS_OF_KERNELS, Measure, NoVariance, PERMUTATIONS};
use crate::report::chart::{Axis, Chart, Colour, Panel, Series, Shape, Tile};
use crate::report::csv::Field;
use crate::report::document::{Cell, Column, Figure, Part, Section, Table, Value};
use crate::report::factor_bars::MOST;
use crate::report::format::{fixed, index as of_error};
use crate::report::result::measures::{GivenMeasuresRecord, SIGNIFICANT};

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
    GivenMeasuresRecord::of(of, &Measure::ALL)
}

/// The section of the measures of all outputs; `None` if there are none. `figures` counts the figures before it.
pub(super) fn section(result: &GivenFile, name: &str, figures: usize) -> Option<Section> {
    let outputs: Vec<(&GivenOutputRecord, &[GivenMeasuresRecord])> =
        result.outputs.iter().filter_map(|output| Some((output, output.measures.as_deref()?))).collect();
    let mut parts = Vec::new();
    for (number, (output, inputs)) in outputs.iter().enumerate() {
        parts.push(Part::Text(agreement(&output.name, inputs, &Measure::ALL)));
        let mut table = table(&output.name, ("input", inputs), &Measure::ALL);
        table.file = file_name(name);
        parts.push(table.into());
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
pub(in crate::report) fn agreement(output: &str, inputs: &[GivenMeasuresRecord], measures: &[Measure]) -> String {
    let mut first: BTreeMap<usize, Vec<&str>> = BTreeMap::new();
    let is_known = |measure: &&Measure| inputs.iter().any(|of| of.get(**measure).is_some());
    let measures: Vec<Measure> = measures.iter().filter(is_known).copied().collect();
    for &measure in &measures {
        if let Some(lead) = ranks(inputs, measure).iter().position(|rank| *rank == 1) {
            first.entry(lead).or_default().push(measure.heading());
        }
    }
    let mut leads: Vec<(usize, Vec<&str>)> = first.into_iter().collect();
    leads.sort_by_key(|(_, by)| std::cmp::Reverse(by.len()));
    let mut text = match &leads[..] {
        [(lead, _)] if measures.len() > 1 => format!("All measures put {} first for {output}.", inputs[*lead].input),
        [] => String::new(),
        [(lead, _)] => format!("{} comes first for {output}.", inputs[*lead].input),
        leads => {
            let one = |(lead, by): &(usize, Vec<&str>)| format!("{} by {}", inputs[*lead].input, by.join(", "));
            let all: Vec<String> = leads.iter().map(one).collect();
            format!("The measures do not agree on what comes first for {output}: {}.", all.join("; "))
        }
    };
    let no_influence = |of: &&GivenMeasuresRecord| measures.iter().all(|measure| of.may_be_chance(*measure));
    let idle: Vec<&str> = inputs.iter().filter(no_influence).map(|of| of.input.as_str()).collect();
    if !idle.is_empty() {
        text.push_str(&format!(" No measure tells {} from an input without influence.", idle.join(", ")));
    }
    text
}

/// The `measures` of an output, a row for each input or factor, as `what` says.
pub(in crate::report) fn table(
    output: &str,
    (what, inputs): (&'static str, &[GivenMeasuresRecord]),
    measures: &[Measure],
) -> Table {
    let mut columns = vec![Column::in_file(Field::new("output")), Column::text(what).named(Field::new(what))];
    for measure in measures {
        columns.push(Column::number(measure.heading()).named(Field::estimate(measure.name())));
        columns.push(Column::in_file(Field::new(format!("{}_p", measure.name()))));
    }
    let row = |of: &GivenMeasuresRecord| {
        let mut row = vec![Cell::from(output), Cell::from(&of.input)];
        for &measure in measures {
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
    let has = |measure| measures.contains(&measure);
    let chance = match (measures == [Measure::Hsic], has(Measure::Hsic)) {
        (true, _) => "by a gamma distribution".to_owned(),
        (false, true) => format!("by {PERMUTATIONS} permutations of the output, of R2-HSIC by a gamma distribution"),
        (false, false) => format!("by {PERMUTATIONS} permutations of the output"),
    };
    let article = if what == "input" { "an" } else { "a" };
    let found = || inputs.iter().flat_map(|of| of.measures.values());
    let mut caption = if found().any(|found| found.p_value.is_some()) {
        format!(
            "In brackets is what {article} {what} without influence reaches in more than {:.0} of 100 tables: {chance}.",
            100.0 * SIGNIFICANT
        )
    } else {
        "The rows are no independent draws, so that nothing is said of chance: there are no p-values.".to_owned()
    };
    if found().any(|found| found.estimate.low.is_some()) {
        caption.push_str(" Delta has its 95 % interval.");
    }
    if has(Measure::Hsic) {
        caption.push_str(&format!(" R2-HSIC is of {MOST_ROWS_OF_KERNELS} rows at most, drawn at random from more."));
        if inputs.iter().any(|of| of.get(Measure::Hsic).is_none()) {
            caption.push_str(" It is empty where these rows have one value only.");
        }
    }
    Table::new(caption, columns).with_rows(inputs.iter().map(row))
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
    // Narrow columns show the beginning of a name.
    let column = |measure: Measure| match measure {
        Measure::PawnMedian => "median PAWN",
        Measure::PawnMax => "largest PAWN",
        other => other.heading(),
    };
    let columns = Measure::ALL.map(|measure| column(measure).to_owned()).to_vec();
    let rows = inputs.iter().map(|of| of.input.clone()).collect();
    let keys: Vec<f64> =
        (0..inputs.len()).map(|input| -by_measure.iter().map(|ranks| ranks[input] as f64).sum::<f64>()).collect();
    let panel = Panel::new(Axis::from_names("measure", columns), Axis::from_names("", rows)).with(marks);
    let caption =
        "Numbers are ranks by each measure, 1 for the largest; what may be chance is so in 5 of 100 tables or more.";
    Chart::new(format!("Ranks of the inputs of {} by measure", output.name), caption)
        .panels([panel.ranked(&keys, MOST)])
}
