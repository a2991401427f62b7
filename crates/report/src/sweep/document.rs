//! Sweeps as a document, with their charts: every output against each factor, and the effect of each factor on each output.

use apportion::StudyResult;
use apportion::result::json;
use apportion::sweep::{NominalOutput, Sweep, SweptOutput};
use apportion_base::text::listed;

use super::record::{value_in_words, width};
use super::{SweepFile, gap_lines};
use crate::chart::{Axis, Bar, Chart, Colour, Mark as ChartMark, Panel, Series, Shape, Spacing, Stroke};
use crate::document::{Document, Figure, Mark, OutputReport, Part, Report, Section, Table, Value};
use crate::factor_bars::{MAX_BARS, not_drawn};
use crate::file_stems;
use crate::format::{axis_unit, grouped, heading, name, or_dash, printed, short, short_with_unit, value, words};

/// Builds the document of sweeps.
pub fn sweep_document(file: &SweepFile) -> Document {
    let (ranges, curves) = figures(file);
    let outputs = file.nominal.iter().zip(ranges).enumerate().map(|(place, (nominal, ranges))| OutputReport {
        name: &nominal.output,
        unit: &nominal.unit,
        answer: widest(file, nominal, place),
        parts: vec![Part::Text(at_nominal(nominal)), effects(file, nominal, place), ranges.into()],
        ..OutputReport::default()
    });
    let mut parts: Vec<Part> = Part::warnings(&file.warnings).into_iter().collect();
    let texts: Vec<String> = file.sweeps.iter().flat_map(gap_lines).map(|line| format!("{line}.")).collect();
    let failed = Part::Notice { mark: Mark::Mixed, kind: "Failed".to_owned(), texts };
    parts.extend(file.sweeps.iter().any(|sweep| !gap_lines(sweep).is_empty()).then_some(failed));
    parts.extend(curves.into_iter().zip(&file.sweeps).map(|(figure, sweep)| match file.nominal.len() {
        ..StudyResult::MIN_OUTPUTS_TOGETHER => figure.into(),
        _ => Part::Details { summary: name(&sweep.factor), parts: vec![figure.into()] },
    }));
    Report {
        name: format!("{}-sweep", file.study.name),
        kicker: "One factor at a time",
        title: file.study.headline().to_owned(),
        outputs: outputs.collect(),
        then: vec![Section::new("curves", "Outputs against each factor", parts)],
        validity: &file.validity,
        study: Some((&file.study).into()),
        version: &file.provenance.apportion_version,
        provenance: vec![("model runs", grouped(file.provenance.model_runs))],
        json: json(file),
        csv: Some(all_values(file)),
        ..Report::default()
    }
    .document()
}

/// Says which factor changes an output most.
fn widest(file: &SweepFile, nominal: &NominalOutput, number: usize) -> String {
    let output = name(&nominal.output);
    match by_width(file, number).first() {
        Some((sweep, SweptOutput { low: Some(low), high: Some(high), .. })) if high > low => format!(
            "With all other factors nominal, {} changes {output} most: between {} and {}.",
            name(&sweep.factor),
            value(*low, ""),
            value(*high, &nominal.unit)
        ),
        Some(_) => format!("No factor alone changes {output}, where it has values."),
        None => format!("No factor was swept for {output}."),
    }
}

/// Returns the sweeps with their effect on an output, the widest first.
fn by_width(file: &SweepFile, number: usize) -> Vec<(&Sweep, &SweptOutput)> {
    let mut sweeps: Vec<(&Sweep, &SweptOutput)> =
        file.sweeps.iter().filter_map(|sweep| Some((sweep, sweep.outputs.get(number)?))).collect();
    sweeps.sort_by(|a, b| width(b.1).total_cmp(&width(a.1)));
    sweeps
}

fn at_nominal(nominal: &NominalOutput) -> String {
    match (nominal.value, &nominal.reason) {
        (Some(value), _) => {
            format!(
                "{} = {} where every factor is nominal.",
                name(&nominal.output),
                short_with_unit(value, &nominal.unit)
            )
        }
        (None, reason) => format!(
            "{} has no value where every factor is nominal: {}.",
            name(&nominal.output),
            reason.as_deref().unwrap_or("the run failed")
        ),
    }
}

/// Tabulates how far each factor changes an output, the widest first.
fn effects(file: &SweepFile, nominal: &NominalOutput, number: usize) -> Part {
    let caption = format!(
        "Effect of each factor alone on {}, with all others nominal, the widest range first.",
        name(&nominal.output)
    );
    let [from, to, least, largest] = ["output from", "to", "least", "largest"].map(|what| heading(what, &nominal.unit));
    Table::from_rows(caption, by_width(file, number))
        .text("factor", |(sweep, _)| name(&sweep.factor))
        .number("from", |(sweep, _)| value_in_words(sweep, 0))
        .number("to", |(sweep, _)| value_in_words(sweep, sweep.values.len().saturating_sub(1)))
        .number(from, |(_, effect)| or_dash(effect.values.first().copied().flatten(), short))
        .number(to, |(_, effect)| or_dash(effect.values.last().copied().flatten(), short))
        .number(least, |(_, effect)| or_dash(effect.low, short))
        .number(largest, |(_, effect)| or_dash(effect.high, short))
        .number("moves by %", |(_, effect)| or_dash(effect.percent, short))
        .into()
}

/// Returns a line per factor, curve, output and value; a missing number is empty, with the reason in the last column.
fn all_values(file: &SweepFile) -> Table {
    let outputs = file.sweeps.iter().flat_map(|sweep| sweep.outputs.iter().map(move |output| (sweep, output)));
    let rows = outputs.flat_map(|row| (0..row.0.values.len()).map(move |place| (row, place)));
    Table::from_rows("", rows)
        .file("factor", |((sweep, _), _)| &sweep.factor)
        .file("unit", |((sweep, _), _)| &sweep.unit)
        .file("value", |((sweep, _), place)| match &sweep.labels {
            Some(labels) => Value::from(&labels[place]),
            None => sweep.values[place].into(),
        })
        .file("output", |((_, output), _)| &output.name)
        .file("output_unit", |((_, output), _)| &output.unit)
        .file("output_value", |((_, output), place)| output.values[place])
        .file("failure", |((_, output), place)| {
            output.gaps.iter().find(|gap| gap.place == place).map(|gap| gap.reason.as_str())
        })
        .into()
}

/// Maximum number of values for which each is marked by a point.
const MAX_MARKED_VALUES: usize = 12;
/// Ratio of the largest to the smallest value from which on an axis is logarithmic.
const WIDE: f64 = 50.0;
/// Colours of the low and the high end of a factor, and of whole ranges.
const LOW_END: Colour = Colour::Series(5);
const HIGH_END: Colour = Colour::Series(1);
const WHOLE_RANGE: Colour = Colour::Series(6);

/// Draws per output the ranges of all factors, `STUDY-sweep-ranges`, with the output's name at the end if there are
/// several; and one line chart per factor, `STUDY-sweep-FACTOR`, with a panel per output.
pub(super) fn figures(file: &SweepFile) -> (Vec<Figure>, Vec<Figure>) {
    let of_outputs = file.nominal.iter().enumerate().map(|(number, nominal)| ranges(file, number, nominal));
    let charts = of_outputs.chain(file.sweeps.iter().map(|sweep| lines(file, sweep)));
    let names = file.nominal.iter().map(|nominal| match file.nominal.len() {
        1 => "ranges".to_owned(),
        _ => format!("ranges-{}", nominal.output),
    });
    let names: Vec<String> = names.chain(file.sweeps.iter().map(|sweep| sweep.factor.clone())).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let stems = file_stems(&format!("{}-sweep", file.study.name), &names, &[""]);
    let mut figures: Vec<Figure> = charts.zip(stems).map(|(chart, stem)| Figure::unnumbered(chart, stem)).collect();
    let curves = figures.split_off(file.nominal.len());
    (figures, curves)
}

fn lines(file: &SweepFile, sweep: &Sweep) -> Chart {
    let logarithmic = sweep.spacing == "logarithmic" && sweep.values.iter().all(|value| *value > 0.0);
    let x = match &sweep.labels {
        // Names have no unit.
        Some(labels) => Axis::from_names(words(&sweep.factor), labels.clone()),
        None => Axis::new(words(&sweep.factor), axis_unit(&sweep.unit)).spaced(if logarithmic {
            Spacing::Logarithmic
        } else {
            Spacing::Linear
        }),
    };
    let (mut panels, mut axes) = (Vec::new(), Vec::new());
    for (nominal, output) in file.nominal.iter().zip(&sweep.outputs) {
        let mut y = Axis::new(words(&nominal.output), axis_unit(&nominal.unit));
        if is_wide(output) {
            y.spacing = Spacing::Logarithmic;
            axes.push(name(&nominal.output));
        }
        // The label of the nominal value is above the first panel.
        let rule = place_of(sweep, sweep.nominal).filter(|_| panels.is_empty()).map(|x| ChartMark::rule(x, "nominal"));
        panels.push(Panel::new(x.clone(), y).with([line(sweep, output)]).with(rule));
    }
    if logarithmic {
        axes.insert(0, words(&sweep.factor));
    }
    let logarithmic_axes = match axes.len() {
        0 => String::new(),
        1 => format!(" The axis of {} is logarithmic.", axes[0]),
        _ => format!(" The axes of {} are logarithmic.", listed(&axes)),
    };
    Chart::new(format!("{}: {}", file.study.headline(), words(&sweep.factor)), caption(sweep) + &logarithmic_axes)
        .panels(panels)
}

/// Returns the position of a value on the horizontal axis: categories are evenly spaced, numbers are at their value.
fn place_of(sweep: &Sweep, value: f64) -> Option<f64> {
    match &sweep.labels {
        Some(_) => sweep.values.iter().position(|other| *other == value).map(|place| place as f64),
        None => Some(value),
    }
}

/// Returns whether an output spans so much that a linear axis would hide the lower part.
fn is_wide(output: &SweptOutput) -> bool {
    output.low.zip(output.high).is_some_and(|(low, high)| low > 0.0 && high / low > WIDE)
}

/// Draws the curve of an output.
fn line(sweep: &Sweep, output: &SweptOutput) -> ChartMark {
    let points = sweep.values.iter().zip(&output.values);
    let points = points.filter_map(|(x, y)| Some((place_of(sweep, *x)?, y.unwrap_or(f64::NAN))));
    let stroke = match &sweep.labels {
        // Nothing is drawn between two categories.
        Some(_) => Stroke::Points,
        None if sweep.values.len() <= MAX_MARKED_VALUES => Stroke::SolidWithPoints,
        None => Stroke::Solid,
    };
    Series::new("", Colour::Series(0)).stroke(stroke).line(points.collect())
}

/// Describes the chart: the range of each output, and missing values.
fn caption(sweep: &Sweep) -> String {
    let mut text = format!("Over {}, {}; every other factor is nominal.", words(&sweep.factor), from_to(sweep));
    for output in &sweep.outputs {
        if let Some(percent) = output.percent {
            let (output, percent) = (name(&output.name), printed(percent));
            text.push_str(&format!(" It changes {output} by {percent} % of the nominal value in total."));
        }
    }
    for line in gap_lines(sweep) {
        text.push_str(&format!(" No {}.", words(&line)));
    }
    text
}

/// Formats the ends of a sweep with their unit.
fn from_to(sweep: &Sweep) -> String {
    if let Some(labels) = &sweep.labels {
        return labels.join(", ");
    }
    let (Some(from), Some(to)) = (sweep.values.first(), sweep.values.last()) else { return String::new() };
    let unit = axis_unit(&sweep.unit);
    let space = if unit.is_empty() { "" } else { " " };
    match from == to {
        true => format!("{}{space}{unit}", printed(*to)),
        false => format!("{} to {}{space}{unit}", printed(*from), printed(*to)),
    }
}

fn ranges(file: &SweepFile, number: usize, nominal: &NominalOutput) -> Chart {
    let output = name(&nominal.output);
    let caption = format!(
        "Values of {output} with one factor at either end of its range and all others at nominal values; the percentages are \
         of the nominal value.{}",
        not_drawn(file.sweeps.len(), MAX_BARS)
    );
    let x = Axis::new(words(&nominal.output), axis_unit(&nominal.unit));
    let (mut rows, mut marks, mut keys) = (Vec::new(), Vec::new(), Vec::new());
    if let Some(value) = nominal.value {
        marks.push(ChartMark::rule(value, format!("nominal: {}", short_with_unit(value, &nominal.unit))));
    }
    for sweep in &file.sweeps {
        let Some(effect) = sweep.outputs.get(number) else { continue };
        let percent = effect.percent.map_or_else(String::new, |percent| format!(" by {} %", printed(percent)));
        marks.extend(row_marks(rows.len(), sweep, effect, nominal.value));
        rows.push(format!("{}{percent}: {}", words(&sweep.factor), from_to(sweep)));
        keys.push(width(effect));
    }
    let panel = Panel::new(x, Axis::from_names("", rows)).with(marks);
    let title = format!("{}: effect of each factor on {output}", file.study.headline());
    Chart::new(title, caption).panels([panel.ranked(&keys, MAX_BARS)])
}

/// Draws the bars of a factor: its ends, or its whole range if these are not the extremes.
fn row_marks(row: usize, sweep: &Sweep, effect: &SweptOutput, nominal: Option<f64>) -> Vec<ChartMark> {
    let [first, last] = [effect.values.first(), effect.values.last()].map(|value| value.copied().flatten());
    let Some((low, high)) = effect.low.zip(effect.high) else { return Vec::new() };
    let mut ends = [first, last, nominal].into_iter().flatten();
    let is_extreme_inside = ends.clone().all(|end| end > low) || ends.all(|end| end < high);
    let bars = match nominal {
        Some(from) if sweep.labels.is_none() && !is_extreme_inside => vec![
            ("factor at its low end", LOW_END, from, first.unwrap_or(f64::NAN)),
            ("factor at its high end", HIGH_END, from, last.unwrap_or(f64::NAN)),
        ],
        _ => vec![("whole range, where the ends are not the extremes", WHOLE_RANGE, low, high)],
    };
    let bars = bars.into_iter();
    bars.map(|(name, colour, from, to)| {
        Series::new(name, colour).mark(Shape::Bar(Bar { row, from, to, ..Bar::default() }))
    })
    .collect()
}
