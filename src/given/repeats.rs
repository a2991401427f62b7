//! Detection of values repeated in other rows, a sign of designs whose rows are not independent.

use super::GivenError;
use super::order::Order;

/// Columns with fewer values than this always contain repetitions.
const MAX_LISTED_VALUES: usize = 10;

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
    let equal = Equal::new(&labels);
    let expected = all_pairs * tied.iter().map(|pairs| pairs / all_pairs).product::<f64>();
    let least_tied = tied.iter().copied().fold(f64::INFINITY, f64::min);
    let excess = equal.pairs > 4.0 * expected + 10.0 && equal.pairs >= 0.5 * least_tied;
    if excess && equal.repeats as f64 > 0.02 * rows as f64 {
        return Err(GivenError::RepeatedRows { repeated: equal.repeats, rows });
    }
    if let Some(pairs) = single_steps(&labels, &tied, all_pairs) {
        return Err(GivenError::OneAtATime { pairs, rows });
    }
    if joint_repeats(inputs, &labels, equal.pairs, rows) || same_multiplicities(inputs, rows) {
        return Err(GivenError::PickFreeze);
    }
    Ok(())
}

/// Rows that are equal in every input.
struct Equal {
    /// Pairs of them.
    pairs: f64,
    /// Rows that equal an earlier one.
    repeats: usize,
}

impl Equal {
    fn new(labels: &[Vec<usize>]) -> Self {
        let rows = labels[0].len();
        let mut order: Vec<usize> = (0..rows).collect();
        order.sort_unstable_by(|&a, &b| row(labels, a).cmp(row(labels, b)));
        let (mut pairs, mut repeats) = (0.0, 0);
        for group in order.chunk_by(|&a, &b| row(labels, a).eq(row(labels, b))) {
            pairs += group.len() as f64 * (group.len() - 1) as f64 / 2.0;
            repeats += group.len() - 1;
        }
        Self { pairs, repeats }
    }
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
    // A sorted table with few levels also has many such steps, but none of its columns then has many values.
    let rich = labels.iter().all(|column| column.iter().max().is_some_and(|last| *last + 1 >= 4));
    let enough = observed as f64 > 0.5 * rows as f64 && observed as f64 > 4.0 * chance * rows as f64;
    (enough && rich && labels.len() > 2).then_some(observed)
}

/// Returns whether equal values of two inputs coincide in too many pairs of rows: in a pick-freeze design of three
/// inputs or more, A and AB_j share all but one.
fn joint_repeats(inputs: &[(&str, &Order)], labels: &[Vec<usize>], equal_pairs: f64, rows: usize) -> bool {
    let many: Vec<usize> = (0..inputs.len()).filter(|&j| inputs[j].1.groups() >= MAX_LISTED_VALUES).collect();
    if many.len() < 3 {
        return false;
    }
    let all_pairs = rows as f64 * (rows as f64 - 1.0) / 2.0;
    let (mut observed, mut expected, mut possible) = (0.0, 0.0, 0.0);
    // Neighbouring columns suffice, closed to a ring: a design treats all equally.
    for (place, &j) in many.iter().enumerate() {
        let i = many[(place + 1) % many.len()];
        let (a, b) = (inputs[i].1.tied_pairs() - equal_pairs, inputs[j].1.tied_pairs() - equal_pairs);
        observed += jointly_tied(inputs[j].1, &labels[i]) - equal_pairs;
        expected += a * b / all_pairs;
        possible += (a * b).max(0.0).sqrt();
    }
    observed >= rows as f64 / 8.0 && observed > 4.0 * expected && observed > 0.15 * possible
}

/// Returns the number of pairs of rows that agree in both columns.
fn jointly_tied(order: &Order, other: &[usize]) -> f64 {
    let mut pairs = 0.0;
    for group in order.iter().filter(|group| group.len() > 1) {
        let mut values: Vec<usize> = group.iter().map(|&row| other[row]).collect();
        values.sort_unstable();
        for equal in values.chunk_by(|a, b| a == b) {
            pairs += equal.len() as f64 * (equal.len() - 1) as f64 / 2.0;
        }
    }
    pairs
}

/// Returns whether all inputs have the same two multiplicities equally often, or a single one, as the values of A and
/// of B do in a pick-freeze design, even with few inputs. A full grid, which [`PointSet`](super::PointSet) detects, has
/// few values, each many times.
fn same_multiplicities(inputs: &[(&str, &Order)], rows: usize) -> bool {
    let first = multiplicities(inputs[0].1);
    let two_halves = match first[..] {
        [(multiplicity, _)] => multiplicity > 1,
        [(_, a), (_, b)] => a == b,
        _ => false,
    };
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
