//! Grouped bars on a phone: panels whose bars would be too thin are broken into several.

use super::layout::FILL;
use super::{GroupedBars, Panel, Series};

/// Width that the plot of a panel has at least, px.
const PLOT: f64 = 264.0;
/// Least distance of groups, px: their upright names stand clear of each other.
const PITCH: f64 = 13.0;
/// Least distance of the bars of a group, px.
const SLOT: f64 = 5.0;

/// The chart with its panels broken into as few rows of about equal length as their bars and names need.
pub(super) fn in_rows(chart: &GroupedBars) -> GroupedBars {
    GroupedBars { panels: chart.panels.iter().flat_map(rows).collect(), ..chart.clone() }
}

fn rows(panel: &Panel) -> Vec<Panel> {
    let pitch = PITCH.max(panel.series.len() as f64 * SLOT / FILL);
    let most = ((PLOT / pitch) as usize).max(1);
    let count = panel.categories.len();
    if count <= most {
        return vec![panel.clone()];
    }
    let rows = count.div_ceil(most);
    let length = count.div_ceil(rows);
    (0..count)
        .step_by(length)
        .map(|from| {
            let range = from..(from + length).min(count);
            let series = |series: &Series| Series {
                values: series.values[range.clone()].to_vec(),
                published: series.published.get(range.clone()).map_or_else(Vec::new, <[_]>::to_vec),
                ..series.clone()
            };
            Panel {
                title: title(&panel.title, (from / length + 1, count.div_ceil(length))),
                categories: panel.categories[range.clone()].to_vec(),
                series: panel.series.iter().map(series).collect(),
            }
        })
        .collect()
}

fn title(whole: &str, (number, rows): (usize, usize)) -> String {
    match whole.trim() {
        "" => String::new(),
        title => format!("{title} ({number} of {rows})"),
    }
}
