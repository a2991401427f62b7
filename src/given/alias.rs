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

/// Bits of information in the rows that agree, beyond those of the choice among all sets: by chance a column is decided
/// once in 2^12 tables.
const MIN_BITS: f64 = 12.0;

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
        let least = MIN_BITS + libm::log2((sets.len() * few.len()) as f64);
        for set in &sets {
            for &input in few.iter().filter(|input| !set.contains(input)) {
                if bits_decided(&labels, set, input) < least {
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

/// Returns the bits of `input` in rows that agree in the columns `set` with earlier ones, and in it too; 0 if some do not.
/// A value that most rows have says little.
fn bits_decided(labels: &[Vec<usize>], set: &[usize], input: usize) -> f64 {
    let mut counts = [0.0; MAX_VALUES];
    labels[input].iter().for_each(|value| counts[*value] += 1.0);
    let (rows, mut bits) = (labels[input].len() as f64, 0.0);
    let mut value_of: HashMap<usize, usize> = HashMap::new();
    for (row, value) in labels[input].iter().enumerate() {
        let combination = set.iter().fold(0, |number, &j| number * MAX_VALUES + labels[j][row]);
        match value_of.insert(combination, *value) {
            Some(before) if before != *value => return 0.0,
            Some(_) => bits += libm::log2(rows / counts[*value]),
            None => {}
        }
    }
    bits
}

#[cfg(test)]
#[path = "tests/alias.rs"]
mod tests;
