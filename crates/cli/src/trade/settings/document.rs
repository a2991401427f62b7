//! A comparison of settings as a document.

use apportion::result::json;
use apportion_report::chart::{Axis, Chart, Colour, Panel, Series, Spacing, Stroke};
use apportion_report::document::{Document, Figure, Part, Report, Section, Table};
use apportion_report::format::{grouped, significant};

use super::Measured;
use super::curve::Axis as Varied;
use super::record::{AdviceRecord, SettingsFile};

/// Errors below this are drawn at this value.
const MIN_ERROR: f64 = 1e-6;

/// Suffix of the names of curves with surrogates.
const SURROGATES: &str = ", surrogates";

/// Builds the document of a comparison.
pub fn settings_document(file: &SettingsFile) -> Document {
    let (headline, name) = (file.study.headline(), format!("{}-trade", file.study.name));
    let figure = |chart, ending: &str| Figure::unnumbered(chart, format!("{name}{ending}")).into();
    let advice = vec![advice_table(file), figure(chart(file, headline), "")];
    let others = vec![figure(formulas_chart(file, headline), "-formulas"), all(file)];
    let truth = &file.truth;
    Report {
        kicker: "Accuracy against time",
        title: headline.to_owned(),
        lead: lead(file),
        then: vec![
            Section::new("advice", "The cheapest setting for an accuracy", advice),
            Section::new("lines", "Lines to paste", lines(file)),
            Section::new("rungs", "What the rungs cost", rung_table(file).into_iter().collect()),
            Section::new("all", "Every setting", others),
        ],
        study: Some(&file.study),
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

fn setting<'a>(file: &'a SettingsFile, advice: &AdviceRecord) -> Option<&'a Measured> {
    file.settings.get(advice.setting?)
}

/// Describes a setting.
fn describe_setting(of: &Measured) -> String {
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
            "Errors are distances from {}, which is known to ± {}; this error is added when a setting is chosen.",
            file.truth.words,
            short_error(error)
        ),
    };
    let found: Vec<(&AdviceRecord, &Measured)> =
        file.advice.iter().filter_map(|advice| Some((advice, setting(file, advice)?))).collect();
    let cheapest = match found.iter().find(|(advice, _)| advice.accuracy <= 0.01).or(found.last()) {
        Some((advice, of)) => format!(
            "For an accuracy of {}, the cheapest setting is {}: {} in {} runs.",
            significant(advice.accuracy),
            describe_setting(of),
            seconds(of.seconds),
            grouped(of.runs)
        ),
        None => "No setting that was measured reaches an accuracy of 0.1.".to_owned(),
    };
    let (least, most) = times(file);
    let span = format!("{} settings took from {} to {} each.", file.settings.len(), seconds(least), seconds(most));
    vec![format!("{cheapest} {span}"), truth]
}

fn advice_table(file: &SettingsFile) -> Part {
    let caption = "The cheapest setting whose largest error, over all indices and seeds, is no more than the accuracy.";
    let of = |said: fn(&Measured) -> String, none: &'static str| {
        move |advice: &AdviceRecord| setting(file, advice).map_or_else(|| none.to_owned(), said)
    };
    Table::from_rows(caption, &file.advice)
        .number("accuracy", |advice| significant(advice.accuracy))
        .text("setting", of(|of| of.curve.clone(), "none of those measured"))
        .number("base samples", of(|of| grouped(of.base_samples), ""))
        .number("runs", of(|of| grouped(of.runs), ""))
        .number("time", of(|of| seconds(of.seconds), ""))
        .number("largest error", of(|of| short_error(of.error), ""))
        .into()
}

fn lines(file: &SettingsFile) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut before = None;
    for advice in &file.advice {
        let Some(of) = setting(file, advice) else { continue };
        if before != advice.setting {
            parts.push(Part::Text(format!(
                "For an accuracy of {}: {}.",
                significant(advice.accuracy),
                describe_setting(of)
            )));
            parts.push(Part::Code(of.lines.clone()));
        }
        before = advice.setting;
    }
    let text = "Alternatively, with the line `accuracy = 0.01` a run chooses its settings and continues until its intervals reach \
                the accuracy.";
    parts.push(Part::Text(text.to_owned()));
    parts
}

/// Returns the settings curve by curve.
fn curves(file: &SettingsFile, axis: Varied) -> Vec<Vec<&Measured>> {
    let of_axis: Vec<&Measured> = file.settings.iter().filter(|of| of.axis == axis).collect();
    of_axis.chunk_by(|a, b| a.curve == b.curve).map(<[_]>::to_vec).collect()
}

/// Returns the shortest and the longest time of a setting.
fn times(file: &SettingsFile) -> (f64, f64) {
    file.settings.iter().fold((f64::INFINITY, 0.0), |(low, high), of| (low.min(of.seconds), high.max(of.seconds)))
}

/// Returns the smallest error that is drawn: that of the reference, below which errors cannot be distinguished.
fn least_drawn(file: &SettingsFile) -> f64 {
    file.truth.error.unwrap_or(0.0).max(MIN_ERROR)
}

fn points(file: &SettingsFile, curve: &[&Measured]) -> Vec<(f64, f64)> {
    let least = least_drawn(file);
    curve.iter().filter_map(|of| Some((of.seconds, of.error?.max(least)))).collect()
}

/// Returns the seconds of a run on a curve: the time per additional run, without the estimates; the whole time if the
/// rung is so slow that it was measured only once.
fn seconds_of_run(curve: &[&Measured]) -> Option<f64> {
    let (first, last) = (curve.first()?, curve.last()?);
    let (seconds, runs) = match curve.len() {
        1 => (last.seconds, last.runs),
        _ => (last.seconds - first.seconds, last.runs - first.runs),
    };
    (seconds > 0.0 && runs > 0).then(|| seconds / runs as f64)
}

/// Tabulates the rungs without surrogates; `None` if there is only one.
fn rung_table(file: &SettingsFile) -> Option<Part> {
    let curves = curves(file, Varied::Fidelity).into_iter().filter(|curve| !curve[0].has_surrogate);
    let rungs: Vec<_> = curves.filter_map(|curve| Some((seconds_of_run(&curve)?, curve))).collect();
    let cheapest = rungs.iter().map(|(seconds, _)| *seconds).fold(f64::INFINITY, f64::min);
    let caption = "The time of one model run on all threads, and the smallest error for any number of runs.";
    let times = |seconds: f64| format!("{:.1e}", seconds / cheapest).parse().unwrap_or(f64::INFINITY);
    let table = Table::from_rows(caption, &rungs)
        .text("rung", |(_, curve)| &curve[0].curve)
        .number("time of a model run", |(of_run, _)| seconds(*of_run))
        .number("times the cheapest", |(of_run, _)| significant(times(*of_run)))
        .number("least error", |(_, curve)| short_error(curve.iter().filter_map(|of| of.error).reduce(f64::min)));
    (rungs.len() > 1).then(|| table.into())
}

fn panel() -> Panel {
    let x = Axis::new("Time of a run", "s").spaced(Spacing::Logarithmic);
    let y = Axis::new("Largest error of an index", "").spaced(Spacing::Logarithmic);
    Panel::new(x, y)
}

/// Draws the error of the reference over the range of times.
fn floor(file: &SettingsFile) -> Option<apportion_report::chart::Mark> {
    let error = file.truth.error.filter(|error| *error > MIN_ERROR)?;
    let (least, most) = times(file);
    let series = Series::new("error of the reference", Colour::Reference).stroke(Stroke::Dotted);
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
    let best = Series::new("no other setting is faster and better", Colour::Reference);
    for panel in &mut panels {
        panel.marks.push(best.line(points(file, &front)));
        panel.marks.extend(floor(file));
    }
    let caption = format!(
        "Every curve grows from 16 base samples by factors of 4. Where it levels off, the error is that of the model, not of the number of \
         runs. Errors below {:.0e} are drawn there.",
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
    let caption = "All with the same model and without surrogates; the sampler and estimators of the study are in the \
                   other figure.";
    Chart::new(format!("{headline}: samplers and estimators"), caption)
        .panels([of_axis(Varied::Sampler, "Samplers"), of_axis(Varied::Estimator, "Estimators")])
}

fn all(file: &SettingsFile) -> Part {
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
        .number("largest error", |of| short_error(of.error))
        .value("largest_error", |of| of.error)
        .text("on the front", |of| if of.is_on_front { "yes" } else { "" })
        .value("is_on_front", |of| of.is_on_front)
        .into()
}
