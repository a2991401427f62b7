//! What the document says of a series: its indices along the axis and as a whole.

use super::figures::{Figures, SERIES_SUFFIXES};
use super::output::definitions;
use super::overview;
use crate::report::document::{Part, Section, Table};
use crate::report::format::{heading, name, significant};
use crate::report::listed;
use crate::report::output_axis::OutputAxis;
use crate::report::result::{AggregateRecord, OutputRecord, ResultFile, SeriesRecord};
use crate::report::run_charts::{SeriesOf, along_chart, layers_chart, map_chart, together_chart};

/// Series that are told with all their charts, and whose single values are told too.
const IN_FULL: usize = 4;
/// Bytes of the page that may be tables of single values, of all series together.
const BYTES: usize = 800_000;
/// Most stretches of the axis in a sentence.
const STRETCHES: usize = 5;

/// How values are weighed against each other.
const WEIGHTING: &str = "each value counts by its variance (Gamboa et al. 2014)";

/// The values of `series` alone, as a result of its own.
fn values_alone(of: SeriesOf<'_>) -> ResultFile {
    let SeriesOf { result, series } = of;
    let outputs = of.values().to_vec();
    let aggregate = AggregateRecord {
        outputs: outputs.iter().map(|output| output.name.clone()).collect(),
        weighting: WEIGHTING.to_owned(),
        indices: series.indices.clone(),
        noise: None,
        reason: series.reason.clone(),
    };
    with_outputs(result, outputs, Some(aggregate))
}

/// The outputs of `result` that belong to no series, as a result of its own.
pub(super) fn single_outputs(result: &ResultFile) -> ResultFile {
    let single = |place: usize| !result.series.iter().any(|series| series.places().contains(&place));
    let outputs = result.outputs.iter().enumerate().filter(|(place, _)| single(*place));
    with_outputs(result, outputs.map(|(_, output)| output.clone()).collect(), result.aggregate.clone())
}

/// `result` as if the study had the output or the series of that name alone; without a name, or where there is none of it, the
/// first one.
pub fn one_output(result: &ResultFile, name: Option<&str>) -> ResultFile {
    let series = |found: &dyn Fn(&SeriesRecord) -> bool| result.series.iter().find(|series| found(series));
    let place = name.and_then(|name| result.outputs.iter().position(|output| output.name == name));
    let named = name.and_then(|name| series(&|series| series.name == name));
    let first = || series(&|series| series.first_output == 0);
    match named.or_else(|| if place.is_none() { first() } else { None }) {
        Some(series) => ResultFile {
            series: vec![SeriesRecord { first_output: 0, ..series.clone() }],
            ..with_outputs(result, result.outputs[series.places()].to_vec(), None)
        },
        None => {
            let place = place.unwrap_or(0);
            with_outputs(result, result.outputs.get(place).cloned().into_iter().collect(), None)
        }
    }
}

/// The same with other outputs, none of which is a series.
fn with_outputs(result: &ResultFile, outputs: Vec<OutputRecord>, aggregate: Option<AggregateRecord>) -> ResultFile {
    ResultFile {
        format: result.format.clone(),
        version: result.version,
        study: result.study.clone(),
        provenance: result.provenance.clone(),
        factors: result.factors.clone(),
        outputs,
        validity: result.validity.clone(),
        effort: result.effort.clone(),
        aggregate,
        series: Vec::new(),
        stopping: result.stopping.clone(),
        spending: result.spending.clone(),
        lows: result.lows.clone(),
    }
}

/// The sections of all series of `result`, and how many figures they have.
pub(super) fn sections(result: &ResultFile, stems: &[[String; SERIES_SUFFIXES.len()]]) -> (Vec<Section>, usize) {
    let (mut sections, mut figures) = (Vec::new(), 0);
    for (number, series) in result.series.iter().enumerate() {
        let of = SeriesOf { result, series };
        let alone = values_alone(of);
        let mut drawn = Figures::of_series(&alone, number + 1, figures);
        let (parts, values) = if number < IN_FULL {
            let few = result.series.len().min(IN_FULL);
            (in_full(of, &mut drawn, &stems[number], number == 0), single_values(&mut drawn, BYTES / few))
        } else {
            let text = format!("Its single values are in `{}.csv`, and all else in the JSON file.", result.study.name);
            (vec![Part::Text(text), overview::factors(&alone).into()], Vec::new())
        };
        figures = drawn.count();
        let (id, axis) = (format!("series-{}", number + 1), name(&series.axis));
        let title = format!("{} along {axis}", heading(&series.name, &series.unit));
        sections.push(Section::new(&id, &title, parts));
        if !values.is_empty() {
            let title = format!("{}: its values one by one", name(&series.name));
            sections.push(Section::new(&format!("{id}-values"), &title, vec![Part::OnPage(values)]));
        }
    }
    (sections, figures)
}

fn in_full(
    of: SeriesOf<'_>,
    figures: &mut Figures<'_>,
    stems: &[String; SERIES_SUFFIXES.len()],
    is_first: bool,
) -> Vec<Part> {
    let (alone, study) = (figures.result, &of.result.study.name);
    let [along, layers, together, map] = stems;
    let mut parts = overview::mind(alone);
    if is_first {
        parts.extend(definitions(of.result));
        parts.push(Part::Text(format!(
            "The indices of every value are in `{study}.csv`, and whatever else is known of them in `{study}.json`."
        )));
    }
    parts.push(figures.add(along_chart(of), "along", along));
    parts.push(figures.add(layers_chart(of), "layers", layers));
    parts.push(Part::Heading("As a whole".to_owned()));
    parts.extend(
        of.series
            .reason
            .as_ref()
            .map(|reason| Part::no_indices(format!("There are no indices of the whole series: {reason}."))),
    );
    let mut chart = together_chart(alone);
    if of.series.indices.is_some() {
        chart.set_caption(format!("All {} values together: {WEIGHTING}.", of.series.positions.len()));
    }
    chart.set_title(chart.title().replace("all outputs together", &format!("{} as a whole", name(&of.series.name))));
    parts.push(figures.add(chart, "together", together));
    let caption = "Indices of the whole series, for how many of its values a factor surely matters most, and the median and \
                   largest of its total indices.";
    parts.push(Table { caption: caption.to_owned(), ..overview::factors(alone) }.into());
    let axis = OutputAxis {
        label: match of.series.axis_unit.as_str() {
            "" | "1" => of.series.axis.clone(),
            unit => format!("{} ({unit})", of.series.axis),
        },
        outputs: (0..of.series.positions.len()).collect(),
        numbers: Some(of.series.positions.clone()),
    };
    parts.push(figures.add(map_chart(alone, &axis), "map", map));
    parts
}

/// Some values with all that is known of them, and the indices of every one, in about so many `bytes` of the page.
fn single_values(figures: &mut Figures<'_>, bytes: usize) -> Vec<Part> {
    let told = [
        ("Some values in full", overview::in_full(figures)),
        ("Every value", overview::every_output(figures.result, bytes)),
    ];
    let told = told.into_iter().filter(|(_, parts)| !parts.is_empty());
    told.flat_map(|(title, parts)| std::iter::once(Part::Heading(title.to_owned())).chain(parts)).collect()
}

/// The paragraph at the top on a series: who leads over all of it, and where along its axis.
pub(super) fn answer(result: &ResultFile, series: &SeriesRecord) -> String {
    let of = SeriesOf { result, series };
    let Some(indices) = &series.indices else {
        let reason = series.reason.as_deref().unwrap_or("the result holds none");
        return format!("There are no indices of {} as a whole: {reason}.", name(&series.name));
    };
    let whole = format!("For {} as a whole ({} values)", name(&series.name), series.positions.len());
    let Some(mut text) = overview::leader_of_all(indices, &whole) else { return String::new() };
    text.extend(super::interactions::of_many(of.values()).map(|interactions| format!(" {interactions}")));
    let stretches = stretches(of);
    if (2..=STRETCHES).contains(&stretches.len()) {
        let unit = match series.axis_unit.as_str() {
            "" | "1" => String::new(),
            unit => format!(" {unit}"),
        };
        let words = stretches.iter().map(|&(factor, first, last)| {
            let [first, last] = [first, last].map(|place| significant(series.positions[place]));
            let range =
                if first == last { format!("at {first}{unit}") } else { format!("from {first} to {last}{unit}") };
            format!("{} {range}", name(&result.factors[factor].name))
        });
        text.push_str(&format!(
            " Along {}, the largest S_T is that of {}.",
            name(&series.axis),
            listed(&words.collect::<Vec<_>>())
        ));
    }
    text
}

/// Where along the axis each factor has the largest total index: the factor, and the first and the last value.
fn stretches(of: SeriesOf<'_>) -> Vec<(usize, usize, usize)> {
    let mut found: Vec<(usize, usize, usize)> = Vec::new();
    for (place, value) in of.values().iter().enumerate() {
        let totals = value.indices.iter().flatten().map(|index| index.effect.total.estimate).enumerate();
        let Some((leader, _)) = totals.reduce(|best, next| if next.1 > best.1 { next } else { best }) else { continue };
        match found.last_mut().filter(|(factor, ..)| *factor == leader) {
            Some((_, _, last)) => *last = place,
            None => found.push((leader, place, place)),
        }
    }
    found
}
