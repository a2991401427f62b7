//! Inputs that are functions of others in all rows, as in fractional factorial designs.

use std::collections::HashMap;

use super::GivenError;
use super::order::Order;

/// Largest number of values of a column that is compared.
const MAX_VALUES: usize = 8;

/// Largest number of columns that decide another: a fraction of higher order confounds interactions that seldom matter.
const MAX_DECIDING: usize = 4;

/// Largest number of sets of columns that are tried.
const MAX_SETS: usize = 20_000;

/// Rows beyond one for each combination of values: by chance a column agrees in all of them once in 2^12 tables.
const MIN_AGREEING: usize = 12;

/// Refuses inputs of which one is a function of two or more others in all rows: nothing tells the effect of the one from
/// an interaction of the others. (A function of one other depends on it, which is said.)
///
/// # Errors
/// [`GivenError::Alias`].
pub(super) fn check(inputs: &[(&str, &Order)]) -> Result<(), GivenError> {
    let few: Vec<usize> = (0..inputs.len()).filter(|&j| inputs[j].1.groups() <= MAX_VALUES).collect();
    let labels: Vec<Vec<usize>> = inputs.iter().map(|(_, order)| order.labels()).collect();
    let mut sets: Vec<Vec<usize>> = few.iter().map(|&j| vec![j]).collect();
    let mut decided_alone = Vec::new();
    for size in 1..=MAX_DECIDING.min(few.len().saturating_sub(1)) {
        for set in &sets {
            for &input in few.iter().filter(|input| !set.contains(input)) {
                if !decides(&labels, set, input) {
                    continue;
                }
                if size == 1 {
                    decided_alone.push(input);
                } else if !decided_alone.contains(&input) {
                    let others: Vec<String> = set.iter().map(|&j| format!("`{}`", inputs[j].0)).collect();
                    let input = inputs[input].0.to_owned();
                    return Err(GivenError::Alias { input, others: others.join(", ") });
                }
            }
        }
        let longer = sets.iter().flat_map(|set| {
            let after = few.iter().filter(|j| set.last().is_some_and(|last| *j > last));
            after.map(|&j| [set.as_slice(), &[j]].concat())
        });
        sets = longer.take(MAX_SETS).collect();
    }
    Ok(())
}

/// Returns whether rows that agree in the columns `set` also agree in `input`, and enough of them do.
fn decides(labels: &[Vec<usize>], set: &[usize], input: usize) -> bool {
    let mut value_of: HashMap<usize, usize> = HashMap::new();
    for (row, value) in labels[input].iter().enumerate() {
        let combination = set.iter().fold(0, |number, &j| number * MAX_VALUES + labels[j][row]);
        if value_of.insert(combination, *value).is_some_and(|before| before != *value) {
            return false;
        }
    }
    labels[input].len() >= value_of.len() + MIN_AGREEING
}
