//! A comparison as charts: the indices side by side, and their differences.

use super::index::ComparedIndex;
use super::record::{ComparedFactor, ComparedOutput, ComparisonFile};
use crate::names::file_stems;
use crate::report::Drawing;
use crate::report::chart::{Bar, Chart, GroupedBars, Panel, Role, Series};
use crate::report::format::{sentence, the};
use crate::report::result::EstimateRecord;
use crate::report::shares_chart::label;

/// Most factors in a chart; the caption counts the rest.
const MOST: usize = 30;
/// Colours of A and B, and of first-order and total indices as in the other charts.
const A: Role = Role::Other(0);
const B: Role = Role::Coulomb;
const FIRST_ORDER: Role = Role::Other(2);
const TOTAL: Role = Role::Other(0);

/// For every output its indices side by side, then the differences. Of more than 30 factors, those with the largest total
/// indices in either result.
pub fn comparison_charts(file: &ComparisonFile) -> Vec<Drawing> {
    let names: Vec<&str> = file.outputs.iter().map(|output| output.name.as_str()).collect();
    let drawn = file.outputs.iter().zip(file_stems("", &names, &["", "-differences"])).flat_map(|(output, stem)| {
        [
            Drawing { suffix: stem.clone(), chart: side_by_side(file, output) },
            Drawing { suffix: format!("{stem}-differences"), chart: differences(file, output) },
        ]
    });
    drawn.collect()
}

fn side_by_side(file: &ComparisonFile, output: &ComparedOutput) -> Chart {
    let drawn = drawn(output);
    let categories: Vec<String> = drawn.iter().map(|factor| label(&factor.name)).collect();
    let panel = |title: &str, of: fn(&ComparedFactor) -> &ComparedIndex| Panel {
        title: title.to_owned(),
        categories: categories.clone(),
        series: vec![
            series((&file.a.label, A), drawn.iter().map(|factor| of(factor).a)),
            series((&file.b.label, B), drawn.iter().map(|factor| of(factor).b)),
        ],
    };
    Chart::Bars(GroupedBars {
        title: format!("Indices of {}: {} and {}", the(&output.name), file.a.label, file.b.label),
        caption: caption(output, drawn.len()),
        y_label: "Sobol' index (% of the variance)".to_owned(),
        interval_label: "95 % interval".to_owned(),
        published_label: String::new(),
        panels: vec![
            panel("First-order indices", |factor| &factor.first_order),
            panel("Total indices", |factor| &factor.total),
        ],
    })
}

fn differences(file: &ComparisonFile, output: &ComparedOutput) -> Chart {
    let drawn = drawn(output);
    let shared = if file.shared_points { " Both use the same points: the intervals are rather too wide." } else { "" };
    Chart::Bars(GroupedBars {
        title: format!("Indices of {}: {} minus {}", the(&output.name), file.b.label, file.a.label),
        caption: caption(output, drawn.len()) + shared,
        y_label: "difference (percentage points of the variance)".to_owned(),
        interval_label: "95 % interval".to_owned(),
        published_label: String::new(),
        panels: vec![Panel {
            title: String::new(),
            categories: drawn.iter().map(|factor| label(&factor.name)).collect(),
            series: vec![
                series(("first order: alone", FIRST_ORDER), drawn.iter().map(|f| f.first_order.difference)),
                series(("total: with all interactions", TOTAL), drawn.iter().map(|f| f.total.difference)),
            ],
        }],
    })
}

fn series((name, role): (&str, Role), values: impl Iterator<Item = Option<EstimateRecord>>) -> Series {
    Series { name: name.to_owned(), role, values: values.map(|v| v.map(bar)).collect(), published: Vec::new() }
}

fn bar(index: EstimateRecord) -> Bar {
    let interval = index.low.zip(index.high).map(|(low, high)| (100.0 * low, 100.0 * high));
    Bar { value: 100.0 * index.estimate, interval }
}

/// The factors that are drawn; groups are not.
fn drawn(output: &ComparedOutput) -> Vec<&ComparedFactor> {
    let mut factors: Vec<&ComparedFactor> = output.factors.iter().filter(|factor| !factor.group).collect();
    if factors.len() > MOST {
        factors.sort_by(|a, b| larger_total(b).total_cmp(&larger_total(a)));
        factors.truncate(MOST);
    }
    factors
}

fn larger_total(factor: &ComparedFactor) -> f64 {
    [factor.total.a, factor.total.b].into_iter().flatten().map(|index| index.estimate).fold(0.0, f64::max)
}

/// The largest change and whether it is more than the errors, then what is left out.
fn caption(output: &ComparedOutput, drawn: usize) -> String {
    let singles = || output.factors.iter().filter(|factor| !factor.group);
    let known = singles().filter_map(|factor| Some((factor, factor.total.difference?)));
    let largest = known.max_by(|a, b| a.1.estimate.abs().total_cmp(&b.1.estimate.abs()));
    let mut caption = match largest {
        None => {
            let reason = output.reasons.iter().flatten().next().map_or("no factor is in both", String::as_str);
            return format!("No differences of {}: {reason}.", the(&output.name));
        }
        Some((_, change)) if change.estimate == 0.0 => "No total index differs".to_owned(),
        Some((factor, change)) => {
            let verb = if change.estimate > 0.0 { "rises" } else { "falls" };
            let certain = match factor.total.differs {
                Some(true) => ", more than the errors of both",
                Some(false) => ", no more than the errors of both",
                None => "",
            };
            format!(
                "The total index of {} differs most: it {verb} by {:.1} percentage points{certain}",
                the(&factor.name),
                100.0 * change.estimate.abs()
            )
        }
    };
    caption.push('.');
    let all = singles().count();
    if all > drawn {
        caption.push_str(&format!(" Of {all} factors, the {drawn} with the largest total indices are drawn."));
    }
    sentence(&caption)
}
