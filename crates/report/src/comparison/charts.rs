//! A comparison as charts: the indices side by side, and their differences.

use super::record::{ComparedFactor, ComparedIndex, ComparedOutput, ComparisonFile};
use crate::chart::{Chart, Colour, Series};
use crate::factor_bars::{DIFFERENCES, INDEX, INDICES, MAX_BARS, both_orders, index_panel, not_drawn};
use crate::format::name;

/// Draws the indices side by side. Of more than 20 factors, those with the largest total indices in either result.
pub(super) fn side_by_side(file: &ComparisonFile, output: &ComparedOutput) -> Chart {
    let factors = single_factors(output);
    let panel = |title: &str, of: fn(&ComparedFactor) -> &ComparedIndex| {
        let a = factors.iter().map(|factor| of(factor).a).collect();
        let b = factors.iter().map(|factor| of(factor).b).collect();
        let series =
            [(Series::new(&file.a.label, Colour::Series(1)), a), (Series::new(&file.b.label, Colour::Series(0)), b)];
        index_panel(INDEX, names(&factors), series, INDICES, &keys(&factors)).titled(title)
    };
    let title = format!("Indices of {}: {} and {}", name(&output.name), file.a.label, file.b.label);
    let panels =
        [panel("First-order indices", |factor| &factor.first_order), panel("Total indices", |factor| &factor.total)];
    Chart::new(title, caption(output)).side_by_side().panels(panels)
}

/// Draws the differences.
pub(super) fn differences(file: &ComparisonFile, output: &ComparedOutput) -> Chart {
    let factors = single_factors(output);
    let shared = if file.shared_points { " Both use the same points: the intervals may be too wide." } else { "" };
    let first_order = factors.iter().map(|factor| factor.first_order.difference).collect();
    let total = factors.iter().map(|factor| factor.total.difference).collect();
    let label = "difference: parts of the variance";
    let title = format!("Indices of {}: {} minus {}", name(&output.name), file.b.label, file.a.label);
    let (names, keys) = (names(&factors), keys(&factors));
    let panel = index_panel(label, names, both_orders(first_order, total), DIFFERENCES, &keys);
    Chart::new(title, caption(output) + shared).panels([panel])
}

/// Returns the factors that are drawn; groups are not.
fn single_factors(output: &ComparedOutput) -> Vec<&ComparedFactor> {
    output.factors.iter().filter(|factor| !factor.group).collect()
}

fn names(factors: &[&ComparedFactor]) -> Vec<String> {
    factors.iter().map(|factor| name(&factor.name)).collect()
}

/// Returns the sort keys of both charts: the larger total index.
fn keys(factors: &[&ComparedFactor]) -> Vec<f64> {
    let larger_total = |factor: &&ComparedFactor| {
        [factor.total.a, factor.total.b].into_iter().flatten().map(|index| index.estimate).fold(0.0, f64::max)
    };
    factors.iter().map(larger_total).collect()
}

/// Says how many differences exceed the errors, and what is not drawn.
fn caption(output: &ComparedOutput) -> String {
    if let Some(reason) = output.reasons.iter().flatten().next() {
        return format!("No differences of {}: {reason}.", name(&output.name));
    }
    let singles = single_factors(output);
    let sure = singles.iter().filter(|factor| factor.total.differs == Some(true)).count();
    format!(
        "{sure} of {} total indices differ by more than the errors of both.{}",
        singles.len(),
        not_drawn(singles.len(), MAX_BARS)
    )
}
