//! The convergence of the indices during the run.

use apportion::result::{OutputResult, PlainIndexRecord, StageRecord, StudyResult};

use super::super::chart::{Axis, Chart, Colour, Mark, Panel, Series, Spacing, Stroke};
use super::super::factor_bars::not_drawn;
use super::super::format::{grouped, name, two_digits};
use super::super::interval_widths::widest_of;
use super::super::leading::by_total;

/// Factors with a line of their own.
const LINES: usize = 8;

/// Draws the total indices and the half widths of their intervals against the number of model runs, for the factors
/// with the largest total indices (at most eight). A target is drawn as a line among the half widths.
pub fn convergence_chart(result: &StudyResult, output: &OutputResult) -> Chart {
    let factors: Vec<usize> =
        by_total(output).unwrap_or_default().into_iter().map(|(factor, _)| factor).take(LINES).collect();
    let stages = &output.convergence;
    let axis = |label: &str, spacing| Axis::new(label, "").spaced(spacing);
    let totals = factors.iter().enumerate().flat_map(|(place, &factor)| total_lines(stages, place, factor));
    let widths = factors.iter().enumerate().map(|(place, &factor)| width_line(stages, place, factor));
    let target = result.stopping.as_ref().and_then(|stopping| stopping.target_half_width);
    let references = [Some(largest_width(stages)), target.map(|target| target_line(stages, target))];
    let panel = |title: &str, y| Panel::new(axis("model runs", Spacing::Logarithmic), y).titled(title);
    let totals = panel("Total indices with their 95 % intervals", axis("total index", Spacing::Linear)).with(totals);
    let widths = panel("Half widths of the intervals of the total indices", axis("half width", Spacing::Logarithmic))
        .with(widths);
    let title = format!("{}: convergence of the indices of {}", result.study.headline(), name(&output.name));
    Chart::new(title, caption(result, output)).panels([totals, widths.with(references.into_iter().flatten())])
}

/// Returns the series of the factor at `place` among the drawn ones.
fn series(stages: &[StageRecord], place: usize, factor: usize) -> Series {
    let index = stages.first().and_then(|stage| stage.indices.get(factor));
    let name = index.map_or_else(String::new, |index| self::name(&index.factor));
    Series::new(name, Colour::Series(place)).stroke(Stroke::SolidWithPoints)
}

/// Iterates over the number of runs and the index of `factor` at every stage.
fn steps(stages: &[StageRecord], factor: usize) -> impl Iterator<Item = (f64, &PlainIndexRecord)> {
    stages.iter().filter_map(move |stage| Some((stage.model_runs as f64, stage.indices.get(factor)?)))
}

fn total_lines(stages: &[StageRecord], place: usize, factor: usize) -> [Mark; 2] {
    let series = series(stages, place, factor);
    let bounds = |(runs, index): (f64, &PlainIndexRecord)| index.total.interval.map(|i| (runs, i.low, i.high));
    let band = steps(stages, factor).filter_map(bounds).collect();
    [series.band(band), series.line(steps(stages, factor).map(|(runs, index)| (runs, index.total.estimate)).collect())]
}

fn width_line(stages: &[StageRecord], place: usize, factor: usize) -> Mark {
    let width = |(runs, index): (f64, &PlainIndexRecord)| Some((runs, index.total.interval?.width() / 2.0));
    series(stages, place, factor).line(steps(stages, factor).filter_map(width).collect())
}

fn largest_width(stages: &[StageRecord]) -> Mark {
    let points = stages.iter().filter_map(|stage| Some((stage.model_runs as f64, stage.largest_half_width?)));
    let series = Series::new("largest half width of all indices", Colour::Reference).stroke(Stroke::Dashed);
    series.line(points.collect())
}

fn target_line(stages: &[StageRecord], target: f64) -> Mark {
    let points = stages.iter().map(|stage| (stage.model_runs as f64, target));
    Series::new("target", Colour::Reference).line(points.collect())
}

/// States the precision of the indices at the end.
fn caption(result: &StudyResult, output: &OutputResult) -> String {
    let known = match (output.convergence.last(), widest_of(output)) {
        (Some(last), Some(width)) => format!("After {} model runs: ± {}.", grouped(last.model_runs), two_digits(width)),
        (Some(last), None) => {
            format!("After {} model runs there are indices without an interval.", grouped(last.model_runs))
        }
        (None, _) => "There are too few base samples to estimate the indices from parts of them.".to_owned(),
    };
    known + &not_drawn(result.indexed_names().len(), LINES)
}
