//! What a study may ask for beside the indices of its factors, as text: pairs, other estimators, all outputs together.

use std::cmp::Ordering;

use super::number::give_or_take;
use super::table;
use crate::report::result::{EstimateRecord, OtherIndexRecord, OutputRecord, PairRecord, ResultFile};

/// Pairs shown.
const PAIRS: usize = 15;

/// Estimators side by side.
const COLUMNS: usize = 6;

/// Rows of a table of estimators.
const ROWS: usize = 20;

/// Estimates below 0 in words, which can be no index: whether 0 is within their error.
pub(super) fn below_zero(output: &OutputRecord) -> String {
    let factors = output.indices.iter().flatten().map(|index| (index.factor.clone(), &index.effect));
    let groups = output.groups.iter().flatten().map(|group| (format!("group {}", group.group), &group.effect));
    let subsets = output.subsets.iter().flatten().map(|subset| (subset.factors.join(" + "), &subset.effect));
    let dummy = output.dummy.iter().map(|effect| ("dummy".to_owned(), effect));
    let named = factors.chain(groups).chain(subsets).chain(dummy);
    let estimates =
        named.flat_map(|(name, e)| [(format!("S1 of {name}"), e.first_order), (format!("ST of {name}"), e.total)]);
    let negative: Vec<(String, EstimateRecord)> = estimates.filter(|(_, index)| index.estimate < 0.0).collect();
    let of_kind = |kind: Zero| {
        let names = negative.iter().filter(|(_, index)| zero(*index) == kind).map(|(name, _)| name.as_str());
        names.collect::<Vec<_>>().join(", ")
    };
    let sentence = |names: String, words: &str| {
        if names.is_empty() { String::new() } else { format!("below 0: {names}: {words}\n") }
    };
    sentence(of_kind(Zero::Inside), "the interval contains 0, which is within the error")
        + &sentence(
            of_kind(Zero::Outside),
            "the interval does NOT contain 0: chance, once in 20 times, or too few samples",
        )
        + &sentence(of_kind(Zero::Unknown), "without an interval nothing tells whether 0 is within the error")
}

/// Where 0 lies.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Zero {
    Inside,
    Outside,
    Unknown,
}

fn zero(index: EstimateRecord) -> Zero {
    match (index.low, index.high) {
        (Some(low), Some(high)) if low <= 0.0 && 0.0 <= high => Zero::Inside,
        (Some(_), Some(_)) => Zero::Outside,
        _ => Zero::Unknown,
    }
}

/// The largest second-order indices.
pub(super) fn second_order_summary(result: &ResultFile, output: &OutputRecord) -> String {
    let Some(pairs) = &output.second_order else { return String::new() };
    let mut sorted: Vec<&PairRecord> = pairs.iter().collect();
    sorted.sort_by(|a, b| b.index.estimate.total_cmp(&a.index.estimate));
    let mut table = table(&["pair", "second order S2", "0 within the interval"], &[0, 2]);
    for pair in sorted.iter().take(PAIRS) {
        let contains = match zero(pair.index) {
            Zero::Inside => "yes: none seen",
            Zero::Outside => "no",
            Zero::Unknown => "-",
        };
        table.add_row([pair.factors.join(" x "), give_or_take(pair.index), contains.to_owned()]);
    }
    let left = sorted.len().saturating_sub(PAIRS);
    let more = if left > 0 {
        format!("{left} smaller ones in {}-second-order.csv\n", result.study.name)
    } else {
        String::new()
    };
    format!("{table}\n{more}")
}

/// First-order and total indices by every estimator that the study lists, the default ones before them.
pub(super) fn estimator_tables(output: &OutputRecord) -> String {
    let tables = [
        ("first order by estimator", Column { of: |index| index.first_order, default: first_orders(output) }),
        ("total by estimator", Column { of: |index| index.total, default: totals(output) }),
    ];
    tables.iter().map(|(title, column)| estimator_table(output, title, column)).collect()
}

/// Which index of an estimator is shown, and the default estimates of it with their names.
struct Column {
    of: fn(&OtherIndexRecord) -> Option<EstimateRecord>,
    default: Vec<EstimateRecord>,
}

fn first_orders(output: &OutputRecord) -> Vec<EstimateRecord> {
    output.indices.iter().flatten().map(|index| index.effect.first_order).collect()
}

fn totals(output: &OutputRecord) -> Vec<EstimateRecord> {
    output.indices.iter().flatten().map(|index| index.effect.total).collect()
}

fn estimator_table(output: &OutputRecord, title: &str, column: &Column) -> String {
    let has = |index: &OtherIndexRecord| (column.of)(index).is_some();
    let shown: Vec<_> = output.estimators.iter().filter(|record| record.indices.iter().any(has)).collect();
    let factors: Vec<&str> = output.indices.iter().flatten().map(|index| index.factor.as_str()).collect();
    let mut order: Vec<usize> = (0..factors.len()).collect();
    // Of many factors the largest.
    if order.len() > ROWS {
        let largest =
            |a: &usize, b: &usize| -> Ordering { column.default[*b].estimate.total_cmp(&column.default[*a].estimate) };
        order.sort_by(largest);
        order.truncate(ROWS);
    }
    let mut text = String::new();
    for few in shown.chunks(COLUMNS) {
        let mut header = vec![title, "default"];
        header.extend(few.iter().map(|record| record.estimator.as_str()));
        let mut table = table(&header, &[0]);
        for &number in &order {
            let others = few.iter().map(|record| record.indices.get(number).and_then(column.of));
            let cells = [Some(column.default[number])].into_iter().chain(others);
            let cells = cells.map(|index| index.map_or_else(|| "-".to_owned(), give_or_take));
            table.add_row([factors[number].to_owned()].into_iter().chain(cells));
        }
        text.push_str(&format!("{table}\n"));
    }
    text
}

/// The indices over all outputs together.
pub(super) fn aggregate_summary(result: &ResultFile) -> String {
    let Some(aggregate) = &result.aggregate else { return String::new() };
    let mut text = format!("\n{} together: {}\n", aggregate.outputs.join(", "), aggregate.weighting);
    if let Some(indices) = &aggregate.indices {
        let mut table = table(&["factor", "first order", "total"], &[0]);
        for index in indices {
            table.add_row([index.factor.clone(), give_or_take(index.first_order), give_or_take(index.total)]);
        }
        text.push_str(&format!("{table}\n"));
    }
    if let Some(reason) = &aggregate.reason {
        text.push_str(&format!("no indices: {reason}\n"));
    }
    text
}
