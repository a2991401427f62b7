//! Combinations of levels that no row has: a surrogate may be exact at all rows, and wrong at these.

use std::collections::{BTreeMap, BTreeSet};

use super::family::{Family, polynomials};
use super::terms::Term;
use crate::uncertainty::RULE_OF_THREE;
use apportion_base::sum::range;

/// Number of factors with levels in a term from which their combinations matter: those of fewer are among the rows. All do
/// for an output of two values, which is a product of high order.
const MIN_FACTORS: usize = 3;

/// Some rows.
pub(crate) struct Rows<'a> {
    /// The quantiles of every factor.
    pub quantiles: Vec<&'a [f64]>,
    pub outputs: &'a [f64],
    /// For every row the number of its part: each part has a fit without it.
    pub parts: Vec<usize>,
}

/// Returns the mean square by which a surrogate with `terms` that leaves `rest` of the variance may be wrong, by the range of the
/// outputs, at combinations of levels that no row has. Those in one part of the rows alone have tested it: at most three in
/// their number contradict it, but at least one.
pub(crate) fn unseen_combinations<'a>(
    terms: impl Iterator<Item = (&'a Term, f64)>,
    rest: f64,
    families: &[Family],
    rows: &[Rows],
) -> f64 {
    let outputs: Vec<f64> = rows.iter().flat_map(|rows| rows.outputs).copied().collect();
    let (low, high) = range(&outputs);
    let counts: Vec<Option<usize>> = families.iter().map(Family::levels).collect();
    let factors: BTreeSet<usize> = if outputs.iter().all(|y| *y == low || *y == high) {
        (0..families.len()).filter(|factor| counts[*factor].is_some()).collect()
    } else {
        let large = terms.filter(|(_, b)| b * b > rest).map(|(term, _)| term.iter().map(|(factor, _)| *factor));
        let members = large.map(|term| term.filter(|factor| counts[*factor].is_some()).collect::<Vec<_>>());
        members.filter(|members| members.len() >= MIN_FACTORS).flatten().collect()
    };
    if factors.is_empty() {
        return 0.0;
    }
    // The probability of each combination, and the part that has it if it is the only one.
    let mut seen: BTreeMap<Vec<u64>, (f64, Option<usize>)> = BTreeMap::new();
    for Rows { quantiles, parts, .. } in rows {
        let levels: Vec<_> = factors.iter().map(|factor| levels(&families[*factor], quantiles[*factor])).collect();
        for (row, part) in parts.iter().enumerate() {
            let combination = levels.iter().map(|level| level[row].0).collect();
            let probability = levels.iter().map(|level| level[row].1).product();
            let (_, only) = seen.entry(combination).or_insert((probability, Some(*part)));
            *only = only.filter(|only| only == part);
        }
    }
    let all: f64 = factors.iter().filter_map(|factor| counts[*factor]).map(|levels| levels as f64).product();
    let unseen = all - seen.len() as f64;
    if unseen < 1.0 {
        return 0.0;
    }
    let probability = 1.0 - seen.values().map(|(probability, _)| probability).sum::<f64>();
    let tests = seen.values().filter(|(_, only)| only.is_some()).count() as f64;
    let share = (RULE_OF_THREE / tests).max(1.0 / unseen).min(1.0);
    probability * share * (high - low) * (high - low)
}

/// Returns the levels of a factor at the quantiles `u`, each by a number of its own, and their probabilities.
fn levels(family: &Family, u: &[f64]) -> Vec<(u64, f64)> {
    let columns = polynomials(family.own(), u, family.own().degree());
    // All polynomials of a discrete distribution have at a level the sum of squares 1/p (Christoffel).
    let levels = (0..u.len()).map(|row| (columns[0][row], columns.iter().map(|p| p[row] * p[row]).sum::<f64>()));
    levels.map(|(first, squares)| (first.to_bits(), 1.0 / (1.0 + squares))).collect()
}

#[cfg(test)]
#[path = "tests/combinations.rs"]
mod tests;
