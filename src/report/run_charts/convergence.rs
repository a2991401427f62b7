//! How the indices settled.

use super::super::chart::{Axis, Chart, LineChart, LinePanel, LineSeries, Role, Spacing, Stroke};
use super::super::format::the;
use super::super::result::{EstimateRecord, OutputRecord, ResultFile, StageIndexRecord, StageRecord};
use super::super::shares_chart::label;
use super::super::significant;
use super::headline;

/// Factors with a line of their own: as many as there are colours.
const LINES: usize = 8;

/// How the total indices and the half widths of their intervals changed with the number of model runs, for the factors with
/// the largest total indices (at most eight). With a target, its line stands among the half widths.
pub fn convergence_chart(result: &ResultFile, output: &OutputRecord) -> Chart {
    let factors = largest(output);
    let stages = &output.convergence;
    let axis = |label: &str, spacing| Axis { label: label.to_owned(), unit: String::new(), spacing };
    let totals = factors.iter().enumerate().map(|(place, &factor)| total_series(stages, (place, factor)));
    let widths = factors.iter().enumerate().map(|(place, &factor)| width_series(stages, (place, factor)));
    let target = result.stopping.as_ref().and_then(|stopping| stopping.target_half_width);
    let mut widths: Vec<LineSeries> = widths.collect();
    widths.push(largest_width(stages));
    widths.extend(target.map(|target| target_line(stages, target)));
    let panel = |title: &str, y: Axis, series: Vec<LineSeries>| LinePanel {
        title: title.to_owned(),
        y,
        series,
        markers: Vec::new(),
    };
    Chart::Lines(LineChart {
        names: Vec::new(),
        title: format!("{}: how the indices of {} settled", headline(result), the(&output.name)),
        caption: caption(result, output, factors.len()),
        x: axis("model runs", Spacing::Logarithmic),
        panels: vec![
            panel("Total indices with their 95 % intervals", axis("total index", Spacing::Linear), totals.collect()),
            panel(
                "Half widths of the intervals of the total indices",
                axis("half width", Spacing::Logarithmic),
                widths,
            ),
        ],
    })
}

/// Numbers of the factors with the largest total indices, in the order of the study.
fn largest(output: &OutputRecord) -> Vec<usize> {
    let Some(indices) = &output.indices else { return Vec::new() };
    let mut order: Vec<usize> = (0..indices.len()).collect();
    order.sort_by(|&a, &b| indices[b].effect.total.estimate.total_cmp(&indices[a].effect.total.estimate));
    order.truncate(LINES);
    order.sort_unstable();
    order
}

/// The first colours are those that are told apart best.
fn role(place: usize) -> Role {
    match place {
        0 => Role::Coulomb,
        1 => Role::Other(0),
        2 => Role::LuGre,
        3 => Role::HurtadoKim,
        n => Role::Other(n - 3),
    }
}

fn series(stages: &[StageRecord], (place, factor): (usize, usize)) -> LineSeries {
    let name = stages.first().and_then(|stage| stage.indices.get(factor)).map(|index| label(&index.factor));
    LineSeries {
        name: name.unwrap_or_default(),
        role: role(place),
        stroke: Stroke::SolidWithPoints,
        points: Vec::new(),
        band: Vec::new(),
    }
}

/// Runs and index of `factor` at every stage.
fn steps(stages: &[StageRecord], factor: usize) -> impl Iterator<Item = (f64, &StageIndexRecord)> {
    stages.iter().filter_map(move |stage| Some((stage.model_runs as f64, stage.indices.get(factor)?)))
}

fn total_series(stages: &[StageRecord], factor: (usize, usize)) -> LineSeries {
    let steps = || steps(stages, factor.1);
    let bounds = |(runs, index): (f64, &StageIndexRecord)| Some((runs, index.total.low?, index.total.high?));
    LineSeries {
        points: steps().map(|(runs, index)| (runs, index.total.estimate)).collect(),
        band: steps().filter_map(bounds).collect(),
        ..series(stages, factor)
    }
}

fn width_series(stages: &[StageRecord], factor: (usize, usize)) -> LineSeries {
    let width = |(runs, index): (f64, &StageIndexRecord)| Some((runs, half_width(index.total)?));
    LineSeries { points: steps(stages, factor.1).filter_map(width).collect(), ..series(stages, factor) }
}

fn half_width(index: EstimateRecord) -> Option<f64> {
    Some((index.high? - index.low?) / 2.0)
}

fn reference(name: &str, stroke: Stroke, points: Vec<(f64, f64)>) -> LineSeries {
    LineSeries { name: name.to_owned(), role: Role::Reference, stroke, points, band: Vec::new() }
}

fn largest_width(stages: &[StageRecord]) -> LineSeries {
    let points = stages.iter().filter_map(|stage| Some((stage.model_runs as f64, stage.largest_half_width?)));
    reference("largest half width of all indices", Stroke::Dashed, points.collect())
}

fn target_line(stages: &[StageRecord], target: f64) -> LineSeries {
    let points = stages.iter().map(|stage| (stage.model_runs as f64, target));
    reference("target", Stroke::Solid, points.collect())
}

/// What is seen, in a sentence or two.
fn caption(result: &ResultFile, output: &OutputRecord, lines: usize) -> String {
    let Some(last) = output.convergence.last() else {
        let reason = output.reason.as_deref().unwrap_or("too few base samples to be looked at in parts");
        return format!("Nothing to see: {reason}.");
    };
    let mut caption = match last.largest_half_width {
        Some(width) => format!(
            "After {} model runs every first-order and total index is known to {} or better",
            last.model_runs,
            significant(format!("{width:.1e}").parse().unwrap_or(width))
        ),
        None => format!("After {} model runs there are indices without an interval", last.model_runs),
    };
    if let Some(stopping) = &result.stopping
        && let (Some(target), Some(met)) = (stopping.target_half_width, stopping.target_met)
    {
        caption.push_str(&format!("; the target of {target} is {}", if met { "met" } else { "not met" }));
    }
    caption.push('.');
    if result.factors.len() > lines && lines > 0 {
        caption.push_str(&format!(" The {lines} factors with the largest total indices are drawn."));
    }
    caption
}
