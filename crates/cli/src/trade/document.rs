//! A comparison of settings as a document.

use apportion::result::json;
use apportion_report::chart::{Axis, Chart, Colour, Panel, Point, Series, Shape, Spacing, Stroke};
use apportion_report::document::{Document, Figure, Part, Report, Section, Table};
use apportion_report::format::{count, grouped, significant};
use apportion_report::two_digits;

use super::curve::Axis as Varied;
use super::{Advice, Comparison, Measured};

/// Errors below this are drawn at this value.
const MIN_ERROR: f64 = 1e-6;

/// Maximum number of curves that are drawn: the study's curve and the chosen ones, then the other rungs.
const CURVES: usize = 6;

/// Builds the document of a comparison.
pub fn settings_document(file: &Comparison) -> Document {
    let (headline, name) = (file.study.headline(), format!("{}-trade", file.study.name));
    let advice = vec![Figure::unnumbered(chart(file, headline), name.clone()).into(), advice_table(file)];
    let truth = &file.truth;
    Report {
        kicker: "Accuracy against time",
        title: headline.to_owned(),
        lead: lead(file),
        then: vec![
            Section::new("advice", "The cheapest setting for an accuracy", advice),
            Section::new("lines", "Lines to paste", lines(file)),
            Section::new("rungs", "What the rungs cost", rung_table(file).into_iter().collect()),
            Section::new("all", "Every setting", vec![all(file)]),
        ],
        study: Some((&file.study).into()),
        version: &file.apportion_version,
        provenance: vec![
            ("threads", file.threads.to_string()),
            ("reference", truth.words.clone()),
            ("time and runs of the reference", format!("{}, {}", seconds(truth.seconds), grouped(truth.runs))),
        ],
        json: json(file),
        name,
        ..Report::default()
    }
    .document()
}

fn setting<'a>(file: &'a Comparison, advice: &Advice) -> Option<&'a Measured> {
    file.settings.get(advice.setting?)
}

/// Describes a setting.
fn describe_setting(of: &Measured) -> String {
    format!("{} with {} base samples", of.curve, grouped(of.base_samples))
}

fn seconds(seconds: f64) -> String {
    // Rounded to two digits, 0.996 is 1.
    match seconds {
        s if s < 0.995e-3 => format!("{} µs", two_digits(s * 1e6)),
        s if s < 0.995 => format!("{} ms", two_digits(s * 1e3)),
        s => format!("{} s", two_digits(s)),
    }
}

fn short_error(error: Option<f64>) -> String {
    error.map_or_else(|| "no indices".to_owned(), |error| format!("{error:.1e}"))
}

fn lead(file: &Comparison) -> Vec<String> {
    let truth = match file.truth.error {
        Some(0.0) => format!("Errors are distances from {}.", file.truth.words),
        error => format!(
            "Errors are distances from {}, which is known to ± {}; this error is added when a setting is chosen.",
            file.truth.words,
            short_error(error)
        ),
    };
    let settings: Vec<(&Advice, &Measured)> =
        file.advice.iter().filter_map(|advice| Some((advice, setting(file, advice)?))).collect();
    let cheapest = match settings.iter().find(|(advice, _)| advice.accuracy <= 0.01).or(settings.last()) {
        Some((advice, of)) => format!(
            "For an accuracy of {}, the cheapest setting is {}: {} in {} runs.",
            significant(advice.accuracy),
            describe_setting(of),
            seconds(of.seconds),
            grouped(of.runs)
        ),
        None => "No setting that was measured reaches an accuracy of 0.1.".to_owned(),
    };
    vec![cheapest, truth]
}

fn advice_table(file: &Comparison) -> Part {
    let caption = "The cheapest setting whose largest error, over all indices and seeds, is no more than the accuracy; the study's \
                   own where it differs from that by no more than the noise of time and error.";
    let rows = file.advice.iter().map(|advice| (advice.accuracy, setting(file, advice)));
    Table::from_rows(caption, rows)
        .number("accuracy", |(accuracy, _)| significant(accuracy))
        .text("setting", |(_, of)| of.map_or("none of those measured", |of| &of.curve))
        .number("base samples", |(_, of)| of.map_or_else(String::new, |of| grouped(of.base_samples)))
        .number("runs", |(_, of)| of.map_or_else(String::new, |of| grouped(of.runs)))
        .number("time", |(_, of)| of.map_or_else(String::new, |of| seconds(of.seconds)))
        .number("largest error", |(_, of)| of.map_or_else(String::new, |of| short_error(of.error)))
        .into()
}

fn lines(file: &Comparison) -> Vec<Part> {
    let mut parts = Vec::new();
    for alike in file.advice.chunk_by(|a, b| a.setting == b.setting) {
        let Some(of) = setting(file, &alike[0]) else { continue };
        let (accuracy, setting) = (significant(alike[0].accuracy), describe_setting(of));
        parts.push(Part::Text(format!("For an accuracy of {accuracy}: {setting}.")));
        parts.push(Part::Code(of.lines.clone()));
    }
    let text = "Alternatively, with the line `accuracy = 0.01` a run chooses its settings and continues until its intervals reach \
                the accuracy.";
    parts.push(Part::Text(text.to_owned()));
    parts
}

/// Returns the settings curve by curve.
fn curves(file: &Comparison) -> Vec<&[Measured]> {
    file.settings.chunk_by(|a, b| a.curve == b.curve).collect()
}

/// Returns whether a curve is that of a rung without surrogates.
fn is_rung(curve: &[Measured]) -> bool {
    curve[0].axis == Varied::Fidelity && !curve[0].has_surrogate
}

/// Returns the seconds of a run on a curve: the time per additional run, without the estimates; the total time if the
/// rung is so slow that it was measured only once.
fn seconds_of_run(curve: &[Measured]) -> Option<f64> {
    let (first, last) = (curve.first()?, curve.last()?);
    let (seconds, runs) = match curve.len() {
        1 => (last.seconds, last.runs),
        _ => (last.seconds - first.seconds, last.runs - first.runs),
    };
    (seconds > 0.0 && runs > 0).then(|| seconds / runs as f64)
}

/// Tabulates the rungs without surrogates; `None` if there is only one.
fn rung_table(file: &Comparison) -> Option<Part> {
    let curves = curves(file).into_iter().filter(|curve| is_rung(curve));
    let rungs: Vec<_> = curves.filter_map(|curve| Some((seconds_of_run(curve)?, curve))).collect();
    let cheapest = rungs.iter().map(|(seconds, _)| *seconds).fold(f64::INFINITY, f64::min);
    let caption = "The time of one model run on all threads, and the smallest error for any number of runs.";
    let table = Table::from_rows(caption, &rungs)
        .text("rung", |(_, curve)| &curve[0].curve)
        .number("time of a model run", |(of_run, _)| seconds(*of_run))
        .number("times the cheapest", |(of_run, _)| two_digits(*of_run / cheapest))
        .number("least error", |(_, curve)| short_error(curve.iter().filter_map(|of| of.error).reduce(f64::min)));
    (rungs.len() > 1).then(|| table.into())
}

/// Draws the error of the reference over the range of times.
fn floor(file: &Comparison) -> Option<apportion_report::chart::Mark> {
    let error = file.truth.error.filter(|error| *error > MIN_ERROR)?;
    let times = file.settings.iter().map(|of| of.seconds);
    let (least, most) = (times.clone().reduce(f64::min)?, times.reduce(f64::max)?);
    let series = Series::new("error of the reference", Colour::Reference).stroke(Stroke::Dotted);
    Some(series.line(vec![(least, error), (most, error)]))
}

fn chart(file: &Comparison, headline: &str) -> Chart {
    // Errors below that of the reference cannot be distinguished.
    let least = file.truth.error.unwrap_or(0.0).max(MIN_ERROR);
    let mut drawn = curves(file);
    let mut first = vec![file.own.as_str()];
    first.extend(file.advice.iter().filter_map(|advice| Some(setting(file, advice)?.curve.as_str())));
    drawn.sort_by_key(|curve| (!first.contains(&curve[0].curve.as_str()), !is_rung(curve)));
    let more = drawn.len().saturating_sub(CURVES);
    drawn.truncate(CURVES);
    let lines = drawn.into_iter().enumerate().map(|(place, curve)| {
        let series = Series::new(&curve[0].curve, Colour::Series(place)).stroke(Stroke::SolidWithPoints);
        series.line(curve.iter().filter_map(|of| Some((of.seconds, of.error?.max(least)))).collect())
    });
    let choices = file.advice.chunk_by(|a, b| a.setting == b.setting).filter_map(|alike| {
        let of = setting(file, &alike[0])?;
        let accuracies: Vec<String> = alike.iter().map(|one| significant(one.accuracy)).collect();
        let label = format!("{}: {}, {}", accuracies.join(", "), of.curve, grouped(of.base_samples));
        let (x, y) = (of.seconds, of.error?.max(least));
        let series = Series::new("the setting to choose for an accuracy", Colour::Reference);
        Some(series.mark(Shape::Point(Point { x, y, label })))
    });
    let caption = format!(
        "Every curve grows from 16 base samples by factors of 4. Where it levels off, the model is what errs, not the number of \
         its runs. Errors below {:.0e} are drawn there.{}",
        least,
        if more > 0 {
            format!(" {} in the table.", count(more as u64, "more curve is", "more curves are"))
        } else {
            String::new()
        }
    );
    let x = Axis::new("Time of a run", "s").spaced(Spacing::Logarithmic);
    let y = Axis::new("Largest error of an index", "").spaced(Spacing::Logarithmic);
    let panel = Panel::new(x, y).with(lines).with(floor(file)).with(choices);
    Chart::new(format!("{headline}: error against time"), caption).panels([panel])
}

fn all(file: &Comparison) -> Part {
    Table::from_rows("Every setting that was measured.", &file.settings)
        .text("setting", |of| &of.curve)
        .named("setting")
        .file("axis", |of| of.axis.name())
        .number("base samples", |of| grouped(of.base_samples))
        .value("base_samples", |of| of.base_samples)
        .number("runs", |of| grouped(of.runs))
        .value("model_runs", |of| of.runs)
        .number("time", |of| seconds(of.seconds))
        .value("seconds", |of| of.seconds)
        .file("seeds", |of| of.seeds as u64)
        .number("largest error", |of| short_error(of.error))
        .value("largest_error", |of| of.error)
        .text("on the front", |of| if of.is_on_front { "yes" } else { "" })
        .value("is_on_front", |of| of.is_on_front)
        .into()
}
