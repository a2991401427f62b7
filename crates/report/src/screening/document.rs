//! A screening as a document, with its charts: mu* against sigma, and mu* with its intervals.

use apportion::result::json;
use apportion::screening::Screening;
use apportion::screening::{Reading, ScreenedFactor, ScreenedOutput};
use apportion::uncertainty::Estimate;
use apportion_base::text::listed;

use super::ScreeningFile;
use crate::chart::{Axis, Bar, Chart, Colour, Panel, Point, Series, Shape, Stroke};
use crate::document::{Document, OutputReport, Report, Table};
use crate::factor_bars::{MAX_BARS, not_drawn};
use crate::format::{axis_unit, grouped, index, index_with_unit, name, or_dash, short, words};
use crate::leading::{self, Contender, NAMES};
use crate::run_document::{FACTORS, IN_CSV};
use crate::study_sections::{failures, inputs};

/// Builds the document of a screening.
pub fn screening_document(file: &ScreeningFile) -> Document {
    let outputs = file.outputs.iter().map(|output| {
        let failed = output.failures.iter().map(|f| (&*f.reason, inputs(&f.first_inputs), f.runs));
        OutputReport {
            name: &output.name,
            unit: &output.unit,
            warnings: &output.warnings,
            answer: format!("{} {}", leader(output), fixable(output)),
            parts: failures(failed).into_iter().chain([effects(output).into()]).collect(),
            charts: [("-bars", bars(file, output))].into_iter().chain(scatter(file, output).map(|c| ("", c))).collect(),
        }
    });
    let provenance = &file.provenance;
    let mut rows = vec![("design", provenance.design.clone())];
    rows.extend(provenance.sampler.iter().map(|sampler| ("sampler", sampler.clone())));
    rows.extend(provenance.levels.iter().map(|levels| ("levels", levels.to_string())));
    rows.extend([
        ("trajectories", grouped(provenance.trajectories)),
        ("seed", or_dash(provenance.seed, |seed| seed.to_string())),
        ("model runs", grouped(provenance.model_runs)),
        ("runs that failed", grouped(provenance.failed_runs)),
        ("threads", provenance.threads.to_string()),
        ("time", format!("{} s", short(provenance.wall_seconds))),
        ("intervals", provenance.interval.clone()),
    ]);
    Report {
        name: format!("{}-screen", file.study.name),
        kicker: "Screening of a study",
        title: file.study.headline().to_owned(),
        outputs: outputs.collect(),
        notes: &file.notes,
        validity: &file.validity,
        failed_runs: (provenance.failed_runs, provenance.model_runs),
        study: Some((&file.study).into()),
        version: &provenance.apportion_version,
        provenance: rows,
        json: json(file),
        ..Report::default()
    }
    .document()
}

/// Tabulates the factors of an output by rank.
fn effects(output: &ScreenedOutput) -> Table {
    let caption = format!(
        "Elementary effects on {} per full range of each factor: mean size μ* with its 95 % interval, mean μ, standard \
         deviation σ.",
        name(&output.name)
    );
    let mut ranked: Vec<usize> = (0..output.factors.len()).collect();
    ranked.sort_by_key(|&place| output.factors[place].rank);
    let rows = Table::from_rows(caption, &output.factors)
        .file("output", |_| &output.name)
        .file("unit", |_| &output.unit)
        .text("factor", |factor| name(&factor.factor))
        .value("factor", |factor| &factor.factor)
        .file("rank", |factor| factor.rank as u64)
        .number("μ*", |factor| or_dash(factor.mu_star, index))
        .estimate("mu_star", |factor| factor.mu_star)
        .number("μ", |factor| without_error(factor.mu))
        .estimate("mu", |factor| factor.mu)
        .number("σ", |factor| without_error(factor.sigma))
        .estimate("sigma", |factor| factor.sigma)
        .number("σ/μ*", |factor| without_error(factor.ratio))
        .estimate("ratio", |factor| factor.ratio)
        .text("reading", |factor| factor.reading.map_or("–", Reading::words))
        .value("reading", |factor| factor.reading.map(Reading::words))
        .text("could be fixed", |factor| factor.could_be_fixed.map_or("–", |fixed| if fixed { "yes" } else { "no" }))
        .value("could_be_fixed", |factor| factor.could_be_fixed)
        .file("effects", |factor| factor.effects)
        .file("dropped", |factor| factor.dropped);
    rows.largest(ranked, FACTORS, IN_CSV).into()
}

/// Formats an estimate without its error; a dash for `None`.
fn without_error(estimate: Option<Estimate>) -> String {
    or_dash(estimate, |estimate| short(estimate.estimate))
}

/// Says which factors could be fixed, and by which rule.
fn fixable(output: &ScreenedOutput) -> String {
    let fixable = output.factors.iter().filter(|f| f.could_be_fixed == Some(true)).map(|f| words(&f.factor));
    let fixable: Vec<String> = fixable.collect();
    let names = match fixable.len() {
        0 => "none".to_owned(),
        1..=NAMES => listed(&fixable),
        many => format!("{many} of {} factors", output.factors.len()),
    };
    format!(
        "Could be fixed for {}: {names} (the upper bound of μ* below {} % of the largest μ*, by at least half of the effects).",
        name(&output.name),
        100.0 * Screening::FIXABLE
    )
}

/// Returns the series of a reading: the calmest colour for the simplest reading.
fn series(reading: Option<Reading>) -> Series {
    let colour = match reading {
        Some(Reading::NonLinearOrInteracting) => Colour::Series(1),
        Some(Reading::AlmostMonotone) => Colour::Series(4),
        Some(Reading::Monotone) => Colour::Series(5),
        Some(Reading::Linear) => Colour::Series(6),
        None => Colour::Reference,
    };
    Series::new(reading.map_or("no effect", Reading::words), colour)
}

fn title(file: &ScreeningFile, output: &ScreenedOutput) -> String {
    format!("{}: screening of {}", file.study.headline(), name(&output.name))
}

fn axis(symbol: &str, output: &ScreenedOutput) -> Axis {
    Axis::new(symbol, axis_unit(&output.unit))
}

/// Draws mu* against sigma; `None` where groups, which have no sigma, are all there is.
pub(super) fn scatter(file: &ScreeningFile, output: &ScreenedOutput) -> Option<Chart> {
    let effects: Vec<(&ScreenedFactor, f64, f64)> = output
        .factors
        .iter()
        .filter_map(|factor| Some((factor, factor.mu_star?.estimate, factor.sigma?.estimate)))
        .collect();
    effects.first()?;
    let points = readings().flat_map(|reading| {
        let members = effects.iter().filter(move |(factor, ..)| factor.reading == reading);
        members.map(move |&(factor, x, y)| {
            // Those without effect all lie at the origin; the caption names them.
            let label = reading.map_or_else(String::new, |_| words(&factor.factor));
            series(reading).mark(Shape::Point(Point { x, y, label }))
        })
    });
    let caption = format!(
        "Mean size μ* of the elementary effects per full range of each factor, and their standard deviation σ, from {} \
         trajectories. {}",
        file.provenance.trajectories,
        leader(output)
    );
    let (right, top) = effects.iter().fold((0.0, 0.0), |(right, top), (_, x, y)| (x.max(right), y.max(top)));
    let slopes =
        [(1.0, "σ = μ*", Stroke::Solid), (0.5, "σ = 0.5 μ*", Stroke::Dashed), (0.1, "σ = 0.1 μ*", Stroke::Dotted)];
    let slopes = slopes.map(|(slope, name, stroke)| {
        let end = f64::min(right, top / slope);
        Series::new(name, Colour::Reference).stroke(stroke).line(vec![(0.0, 0.0), (end, slope * end)])
    });
    let (x, y) = (axis("μ*, mean size of the effects", output), axis("σ, standard deviation of the effects", output));
    Some(Chart::new(title(file, output), caption).panels([Panel::new(x, y).with(points).with(slopes)]))
}

/// Iterates over the readings, that of factors without effect last.
fn readings() -> impl Iterator<Item = Option<Reading>> {
    Reading::ALL.into_iter().rev().map(Some).chain([None])
}

/// Draws mu* with its intervals.
pub(super) fn bars(file: &ScreeningFile, output: &ScreenedOutput) -> Chart {
    let bars = readings().flat_map(|reading| {
        let members = output.factors.iter().enumerate().filter(move |(_, factor)| factor.reading == reading);
        members.filter_map(move |(row, factor)| {
            let mu_star = factor.mu_star?;
            let fixed = if factor.could_be_fixed == Some(true) { ", could be fixed" } else { "" };
            let label = index_with_unit(mu_star, &output.unit) + fixed;
            let interval = mu_star.interval.map(|i| (i.low, i.high));
            let bar = Bar { row, to: mu_star.estimate, interval, value_text: label.clone(), label, ..Bar::default() };
            // A bar of zero length would still add a colour to the legend.
            let series = if reading.is_some() { series(reading) } else { Series::default() };
            Some(series.mark(Shape::Bar(bar)))
        })
    });
    let caption = format!(
        "Mean size μ* of the elementary effects per full range of each factor. A factor could be fixed where the upper \
         bound of μ* lies below {} % of the largest μ*. {}{}",
        100.0 * Screening::FIXABLE,
        leader(output),
        not_drawn(output.factors.len(), MAX_BARS)
    );
    let x = axis("μ*, mean size of the effects per full range of the factor", output);
    let rows = Axis::from_names("", output.factors.iter().map(|factor| words(&factor.factor)).collect());
    let keys: Vec<f64> = output.factors.iter().map(|factor| -(factor.rank as f64)).collect();
    Chart::new(title(file, output), caption).panels([Panel::new(x, rows).with(bars).ranked(&keys, MAX_BARS)])
}

/// Says which factor matters most.
pub(super) fn leader(output: &ScreenedOutput) -> String {
    let mut moving = Vec::new();
    for factor in &output.factors {
        let total = factor.mu_star.filter(|mu_star| mu_star.estimate > 0.0);
        moving.extend(total.map(|total| Contender::new(name(&factor.factor), total)));
    }
    let output_name = name(&output.name);
    let measure = "mean effect size μ*";
    let sentence = leading::leader(&moving, &format!("For {output_name}"), measure, &axis_unit(&output.unit));
    sentence.unwrap_or_else(|| format!("No factor has any effect on {output_name}."))
}
