//! A comparison of settings as a document.

use super::Measured;
use super::curve::Axis as Varied;
use super::record::{AdviceRecord, SettingsFile};
use crate::report::chart::{Axis, Chart, Colour, Panel, Series, Spacing, Stroke};
use crate::report::csv::{Field, Value};
use crate::report::document::{Cell, Column, DataFile, Document, Figure, Part, Section, Table};
use crate::report::format::{grouped, significant};
use crate::report::study_section;
use crate::result::json;

/// Errors below this are drawn there.
const LEAST_ERROR: f64 = 1e-6;

/// What the names of curves with surrogates end in.
const SURROGATES: &str = ", surrogates";

/// The document of a comparison.
pub fn settings_document(file: &SettingsFile) -> Document {
    let study = &file.study.name;
    let headline = file.study.headline();
    let data = format!("{study}-trade.csv");
    let charts = [("-trade", chart(file, headline)), ("-trade-formulas", formulas_chart(file, headline))];
    let charts = charts.map(|(suffix, chart)| (suffix.to_owned(), chart));
    let mut figures = Figure::numbered(charts, (study, headline), &data).into_iter();
    let mut advice: Vec<Part> = vec![advice_table(file).into()];
    advice.extend(figures.next().map(Part::from));
    let mut others: Vec<Part> = figures.map(Part::from).collect();
    others.push(all(file, &data).into());
    let mut sections = vec![
        Section::new("advice", "The cheapest setting for an accuracy", advice),
        Section::new("lines", "Lines to paste", lines(file)),
        Section::new("rungs", "What the rungs cost", rung_table(file).map(Part::from).into_iter().collect()),
        Section::new("all", "Every setting", others),
        study_section(&file.study, &file.study.factors),
        Section::new("provenance", "Provenance", vec![Part::OnPage(vec![provenance(file).into()])]),
    ];
    sections.retain(|section| !section.parts.is_empty());
    Document {
        name: format!("{study}-trade"),
        kicker: "Accuracy against time".to_owned(),
        title: headline.to_owned(),
        lead: lead(file),
        sections,
        footer: format!("Made by apportion {}.", file.apportion_version),
        files: vec![DataFile::new(format!("{study}-trade.json"), json(file))],
        ..Document::default()
    }
}

fn setting<'a>(file: &'a SettingsFile, advice: &AdviceRecord) -> Option<&'a Measured> {
    file.settings.get(advice.setting?)
}

/// A setting in words.
fn said(of: &Measured) -> String {
    format!("{} with {} base samples", of.curve, grouped(of.base_samples))
}

fn seconds(seconds: f64) -> String {
    let two: f64 = format!("{seconds:.1e}").parse().unwrap_or(seconds);
    match two {
        s if s < 1e-3 => format!("{} µs", significant(s * 1e6)),
        s if s < 1.0 => format!("{} ms", significant(s * 1e3)),
        s => format!("{} s", significant(s)),
    }
}

fn short_error(error: Option<f64>) -> String {
    error.map_or_else(|| "no indices".to_owned(), |error| format!("{error:.1e}"))
}

fn lead(file: &SettingsFile) -> Vec<String> {
    let truth = match file.truth.error {
        Some(0.0) => format!("Errors are distances from {}.", file.truth.words),
        error => format!(
            "Errors are distances from {}, which itself is known to ± {}; that is added where a setting is chosen.",
            file.truth.words,
            short_error(error)
        ),
    };
    let found: Vec<(&AdviceRecord, &Measured)> =
        file.advice.iter().filter_map(|advice| Some((advice, setting(file, advice)?))).collect();
    let cheapest = match found.iter().find(|(advice, _)| advice.accuracy <= 0.01).or(found.last()) {
        Some((advice, of)) => format!(
            "For an accuracy of {} the cheapest setting is {}: {} in {} runs.",
            significant(advice.accuracy),
            said(of),
            seconds(of.seconds),
            grouped(of.runs)
        ),
        None => "No setting that was measured reaches an accuracy of 0.1.".to_owned(),
    };
    let times = file.settings.iter().map(|of| of.seconds);
    let (least, most) = times.fold((f64::INFINITY, 0.0_f64), |(low, high), s| (low.min(s), high.max(s)));
    let span = format!("{} settings took from {} to {} each.", file.settings.len(), seconds(least), seconds(most));
    vec![format!("{cheapest} {span}"), truth]
}

fn advice_table(file: &SettingsFile) -> Table {
    let row = |advice: &AdviceRecord| -> Vec<Cell> {
        let accuracy = significant(advice.accuracy);
        match setting(file, advice) {
            Some(of) => vec![
                accuracy.into(),
                of.curve.clone().into(),
                grouped(of.base_samples).into(),
                grouped(of.runs).into(),
                seconds(of.seconds).into(),
                short_error(of.error).into(),
            ],
            None => vec![accuracy.into(), "none of those measured".into(), "".into(), "".into(), "".into(), "".into()],
        }
    };
    let columns = [
        Column::number("accuracy"),
        Column::text("setting"),
        Column::number("base samples"),
        Column::number("runs"),
        Column::number("time"),
        Column::number("largest error"),
    ];
    let caption = "The cheapest setting whose largest error, over all indices and seeds, is no more than the accuracy.";
    Table::new(caption, columns).with_rows(file.advice.iter().map(row))
}

fn lines(file: &SettingsFile) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut before = None;
    for advice in &file.advice {
        let Some(of) = setting(file, advice) else { continue };
        if before != advice.setting {
            parts.push(Part::Text(format!("For an accuracy of {}: {}.", significant(advice.accuracy), said(of))));
            parts.push(Part::Code(of.lines.clone()));
        }
        before = advice.setting;
    }
    let text = "In any case the line `accuracy = 0.01` lets a run choose by itself, and it goes on until its own intervals say that \
                the accuracy is reached.";
    parts.push(Part::Text(text.to_owned()));
    parts
}

/// The settings of one curve after the other.
fn curves(file: &SettingsFile, axis: Varied) -> Vec<Vec<&Measured>> {
    let mut curves: Vec<Vec<&Measured>> = Vec::new();
    for of in file.settings.iter().filter(|of| of.axis == axis) {
        match curves.last_mut() {
            Some(curve) if curve[0].curve == of.curve => curve.push(of),
            _ => curves.push(vec![of]),
        }
    }
    curves
}

/// Below what is known of the truth there is nothing to see.
fn least_drawn(file: &SettingsFile) -> f64 {
    file.truth.error.unwrap_or(0.0).max(LEAST_ERROR)
}

fn points(file: &SettingsFile, curve: &[&Measured]) -> Vec<(f64, f64)> {
    let least = least_drawn(file);
    curve.iter().filter_map(|of| Some((of.seconds, of.error?.max(least)))).collect()
}

/// Seconds of a run on a curve: what more runs take more, so that the estimates do not count; of a rung so slow that it was
/// measured once, all of it.
fn seconds_of_run(curve: &[&Measured]) -> Option<f64> {
    let (first, last) = (curve.first()?, curve.last()?);
    let (seconds, runs) = match curve.len() {
        1 => (last.seconds, last.runs),
        _ => (last.seconds - first.seconds, last.runs - first.runs),
    };
    (seconds > 0.0 && runs > 0).then(|| seconds / runs as f64)
}

/// The rungs without surrogates; `None` where there is a single one.
fn rung_table(file: &SettingsFile) -> Option<Table> {
    let curves = curves(file, Varied::Fidelity).into_iter().filter(|curve| !curve[0].has_surrogate);
    let rungs: Vec<_> = curves.filter_map(|curve| Some((seconds_of_run(&curve)?, curve))).collect();
    let cheapest = rungs.iter().map(|(seconds, _)| *seconds).fold(f64::INFINITY, f64::min);
    let row = |(of_run, curve): &(f64, Vec<&Measured>)| -> Vec<Cell> {
        let least = curve.iter().filter_map(|of| of.error).reduce(f64::min);
        let times = format!("{:.1e}", of_run / cheapest).parse().unwrap_or(f64::INFINITY);
        vec![
            curve[0].curve.clone().into(),
            seconds(*of_run).into(),
            significant(times).into(),
            short_error(least).into(),
        ]
    };
    let columns = [
        Column::text("rung"),
        Column::number("time of a model run"),
        Column::number("times the cheapest"),
        Column::number("least error"),
    ];
    let caption = "The time of one model run on all threads, and the least error that any number of runs reached.";
    (rungs.len() > 1).then(|| Table::new(caption, columns).with_rows(rungs.iter().map(row)))
}

fn panel() -> Panel {
    let x = Axis::new("Time of a run", "s").spaced(Spacing::Logarithmic);
    let y = Axis::new("Largest error of an index", "").spaced(Spacing::Logarithmic);
    Panel::new(x, y)
}

/// The error of the truth, over the times that are seen.
fn floor(file: &SettingsFile) -> Option<crate::report::chart::Mark> {
    let error = file.truth.error.filter(|error| *error > LEAST_ERROR)?;
    let times = file.settings.iter().map(|of| of.seconds);
    let (least, most) = times.fold((f64::INFINITY, 0.0_f64), |(low, high), s| (low.min(s), high.max(s)));
    let series = Series::new("not known of the truth", Colour::Reference).stroke(Stroke::Dotted);
    Some(series.line(vec![(least, error), (most, error)]))
}

fn chart(file: &SettingsFile, headline: &str) -> Chart {
    let mut rungs: Vec<String> = Vec::new();
    let mut panels = [panel().titled("Without surrogates"), panel().titled("With surrogates")];
    for curve in curves(file, Varied::Fidelity) {
        let rung = curve[0].curve.strip_suffix(SURROGATES).unwrap_or(&curve[0].curve).to_owned();
        let place = rungs.iter().position(|other| *other == rung).unwrap_or_else(|| {
            rungs.push(rung.clone());
            rungs.len() - 1
        });
        let series = Series::new(rung, Colour::Series(place)).stroke(Stroke::SolidWithPoints);
        panels[usize::from(curve[0].has_surrogate)].marks.push(series.line(points(file, &curve)));
    }
    let mut front: Vec<&Measured> = file.settings.iter().filter(|of| of.is_on_front).collect();
    front.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    let best = Series::new("nothing is both quicker and better", Colour::Reference);
    for panel in &mut panels {
        panel.marks.push(best.line(points(file, &front)));
        panel.marks.extend(floor(file));
    }
    let caption = format!(
        "Every curve grows from 16 base samples by factors of 4. Where it levels off, the model is what errs, not the number of \
         its runs. Errors below {:.0e} are drawn there.",
        least_drawn(file)
    );
    Chart::new(format!("{headline}: error against time"), caption).panels(panels)
}

fn formulas_chart(file: &SettingsFile, headline: &str) -> Chart {
    let of_axis = |axis, title: &str| {
        let lines = curves(file, axis).into_iter().enumerate();
        let lines = lines.map(|(place, curve)| {
            let series = Series::new(curve[0].curve.clone(), Colour::Series(place));
            series
                .stroke(if place % 2 == 0 { Stroke::SolidWithPoints } else { Stroke::Dashed })
                .line(points(file, &curve))
        });
        panel().titled(title).with(lines)
    };
    let caption = "The same model and no surrogates throughout; the study's own sampler and formulas are among the curves of the \
                   other figure.";
    Chart::new(format!("{headline}: samplers and estimators"), caption)
        .panels([of_axis(Varied::Sampler, "Samplers"), of_axis(Varied::Estimator, "Estimators")])
}

fn all(file: &SettingsFile, data: &str) -> Table {
    let columns = [
        Column::text("setting").named(Field::new("setting")),
        Column::in_file(Field::new("axis")),
        Column::number("base samples").named(Field::new("base_samples")),
        Column::number("runs").named(Field::new("model_runs")),
        Column::number("time").named(Field::new("seconds")),
        Column::number("largest error").named(Field::new("largest_error")),
        Column::text("on the front").named(Field::new("is_on_front")),
    ];
    let row = |of: &Measured| {
        vec![
            Cell::from(of.curve.clone()),
            Cell::from(of.axis.name()),
            Cell::valued(grouped(of.base_samples), Value::Count(of.base_samples)),
            Cell::valued(grouped(of.runs), Value::Count(of.runs)),
            Cell::valued(seconds(of.seconds), Value::Number(of.seconds)),
            Cell::valued(short_error(of.error), of.error.map_or(Value::Empty, Value::Number)),
            Cell::valued(if of.is_on_front { "yes" } else { "" }, Value::Flag(of.is_on_front)),
        ]
    };
    let mut table = Table::new("Every setting that was measured.", columns).with_rows(file.settings.iter().map(row));
    table.file = data.to_owned();
    table
}

fn provenance(file: &SettingsFile) -> Table {
    let rows = [
        ("program", format!("apportion {}", file.apportion_version)),
        ("threads", file.threads.to_string()),
        ("truth", file.truth.words.clone()),
        ("time and runs of the truth", format!("{}, {}", seconds(file.truth.seconds), grouped(file.truth.runs))),
        ("study file, SHA-256", format!("`{}`", file.study.sha256)),
    ];
    Table::pairs("How the answer came about.", rows)
}
