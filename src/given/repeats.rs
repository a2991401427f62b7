//! Detection of values repeated in other rows, a sign of designs whose rows are not independent.

use super::order::Order;
use super::shared::{around_base, close_pairs};
use super::{Alike, GivenError};

/// Rows of the most frequent value up to which draws of dependent columns seldom agree in several of them.
const MAX_ROWS_OF_A_VALUE: usize = 20;

/// Refuses rows that repeat each other, one-at-a-time designs and pick-freeze designs. `inputs` are those that vary.
///
/// Each test compares the number of pairs of rows that agree in several inputs with the number that independent columns
/// with the same ties would give.
pub(super) fn check(inputs: &[(&str, &Order)], rows: usize) -> Result<(), GivenError> {
    if inputs.len() < 2 {
        // A single input may take each value any number of times.
        return Ok(());
    }
    let labels: Vec<Vec<usize>> = inputs.iter().map(|(_, order)| order.labels()).collect();
    let all_pairs = rows as f64 * (rows as f64 - 1.0) / 2.0;
    let tied: Vec<f64> = inputs.iter().map(|(_, order)| order.tied_pairs()).collect();
    if tied.iter().all(|&pairs| pairs == 0.0) {
        return Ok(());
    }
    let (equal_pairs, repeated) = equal(&labels);
    let expected = all_pairs * tied.iter().map(|pairs| pairs / all_pairs).product::<f64>();
    let least_tied = tied.iter().copied().fold(f64::INFINITY, f64::min);
    let most = inputs.iter().flat_map(|(_, order)| order.iter().map(<[usize]>::len)).max().unwrap_or(0);
    let are_many = most <= MAX_ROWS_OF_A_VALUE.max(2 * inputs.len());
    let excess = equal_pairs > 4.0 * expected + 10.0 && (are_many || equal_pairs >= 0.5 * least_tied);
    if excess && repeated as f64 > 0.02 * rows as f64 {
        return Err(GivenError::RepeatedRows { repeated, rows });
    }
    if let Some(pairs) = single_steps(&labels, &tied, all_pairs) {
        return Err(GivenError::OneAtATime { pairs, how: Alike::Consecutive, rows });
    }
    let pairs = close_pairs(&labels, are_many);
    if same_multiplicities(inputs, rows) || pairs.is_some() && are_many && around_base(&labels).is_none() {
        return Err(GivenError::PickFreeze);
    }
    if let Some(pairs) = pairs {
        return Err(GivenError::OneAtATime { pairs, how: Alike::Pairs, rows });
    }
    if let Some(pairs) = around_base(&labels) {
        return Err(GivenError::OneAtATime { pairs, how: Alike::Base, rows });
    }
    Ok(())
}

/// Returns the number of pairs of rows that are equal in every input, and that of rows that equal an earlier one.
fn equal(labels: &[Vec<usize>]) -> (f64, usize) {
    let mut order: Vec<usize> = (0..labels[0].len()).collect();
    order.sort_unstable_by(|&a, &b| row(labels, a).cmp(row(labels, b)));
    let groups = order.chunk_by(|&a, &b| row(labels, a).eq(row(labels, b))).map(<[usize]>::len);
    groups.fold((0.0, 0), |(pairs, repeats), rows| (pairs + rows as f64 * (rows - 1) as f64 / 2.0, repeats + rows - 1))
}

fn row(labels: &[Vec<usize>], row: usize) -> impl Iterator<Item = usize> {
    labels.iter().map(move |column| column[row])
}

/// Returns the number of rows that differ from the previous row in exactly one input, if far too many.
fn single_steps(labels: &[Vec<usize>], tied: &[f64], all_pairs: f64) -> Option<usize> {
    let rows = labels[0].len();
    let differing = (1..rows).map(|k| labels.iter().filter(|column| column[k] != column[k - 1]).count());
    let observed = differing.filter(|count| *count == 1).count();
    let agree: Vec<f64> = tied.iter().map(|pairs| pairs / all_pairs).collect();
    let mut chance = 0.0;
    for (j, of_input) in agree.iter().enumerate() {
        let others: f64 = agree.iter().enumerate().filter(|(i, _)| *i != j).map(|(_, p)| p).product();
        chance += (1.0 - of_input) * others;
    }
    // A sorted table with few levels also has many such steps, but few of its columns then have many values.
    let rich = labels.iter().filter(|column| column.iter().max().is_some_and(|last| *last + 1 >= 4));
    let rich = 2 * rich.count() > labels.len();
    let enough = observed as f64 > 0.5 * rows as f64 && observed as f64 > 4.0 * chance * rows as f64;
    (enough && rich && labels.len() > 2).then_some(observed)
}

/// Returns whether all inputs have the same two multiplicities equally often, or a single one, as the values of A and
/// of B do in a pick-freeze design, even with few inputs. A full grid, which [`PointSet`](super::PointSet) detects, has
/// few values, each many times.
fn same_multiplicities(inputs: &[(&str, &Order)], rows: usize) -> bool {
    let first = multiplicities(inputs[0].1);
    let two_halves = matches!(first[..], [(2.., _)]) || matches!(first[..], [(_, a), (_, b)] if a == b);
    // Each base point gives two values, in at most 2 d + 2 rows.
    let values = inputs[0].1.groups();
    let plausible = values >= 16 && values * (inputs.len() + 1) >= rows;
    plausible && two_halves && inputs.iter().all(|(_, order)| multiplicities(order) == first)
}

/// Returns the multiplicities of values, and for each the number of values that have it.
fn multiplicities(order: &Order) -> Vec<(usize, usize)> {
    let mut counts: Vec<usize> = order.iter().map(<[usize]>::len).collect();
    counts.sort_unstable();
    counts.chunk_by(|a, b| a == b).map(|equal| (equal[0], equal.len())).collect()
}
