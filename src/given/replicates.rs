//! Replicates: rows that repeat all inputs but a seed.

use std::collections::HashMap;

use super::{Column, GivenError};

/// Names, in lower case and without `_`, of a column that numbers replicates.
const SEEDS: [&str; 9] =
    ["seed", "rngseed", "randomseed", "replicate", "replication", "rep", "repeat", "repetition", "realization"];

/// Number of values of a column, and of different rows, from which they do not agree by chance.
const MIN_VALUES: usize = 10;

/// Replicates that were averaged.
#[derive(Debug, Clone, PartialEq)]
pub struct Replicates {
    /// The column that numbers them.
    pub seed: String,
    /// Different rows of the other inputs.
    pub rows: usize,
    /// For each output: the part of its variance that is between the replicates of a row.
    pub scatter: Vec<f64>,
}

/// Averages the outputs of rows that repeat all inputs but one, a column of seeds, and removes it; `None` if no rows
/// do.
///
/// # Errors
/// [`GivenError::AllButOne`] if the column is not called a seed: a time, perhaps.
pub fn average_replicates(inputs: &mut Vec<Column>, outputs: &mut [Column]) -> Result<Option<Replicates>, GivenError> {
    let rows = outputs.first().map_or(0, |output| output.values.len());
    let counts: Vec<usize> = inputs.iter().map(|input| count_values(&input.values)).collect();
    for place in 0..inputs.len() {
        let name = inputs[place].name.clone();
        let most = (0..inputs.len()).filter(|other| *other != place).map(|other| counts[other]).max().unwrap_or(0);
        if counts[place] < 2 || most < MIN_VALUES || 3 * most > 2 * rows {
            continue;
        }
        let mut group_of: HashMap<Vec<u64>, usize> = HashMap::new();
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for row in 0..rows {
            let others = (0..inputs.len()).filter(|other| *other != place);
            let key = others.map(|other| inputs[other].values.get(row).map_or(0, |value| value.to_bits())).collect();
            let group = *group_of.entry(key).or_insert(groups.len());
            groups.resize(groups.len().max(group + 1), Vec::new());
            groups[group].push(row);
        }
        // Of few values, all combinations recur.
        let is_repeated = groups.len() >= MIN_VALUES
            && groups.iter().filter(|group| group.len() > 1).count() * 10 >= 9 * groups.len();
        let is_seed = SEEDS.contains(&&*name.to_lowercase().replace(['_', ' ', '-'], ""));
        // A time has the same few values for every run; values of a pick-freeze design are of two rows.
        if !is_repeated || !is_seed && counts[place] * groups.len() > 2 * rows {
            continue;
        }
        if !is_seed {
            return Err(GivenError::AllButOne { input: name, groups: groups.len(), rows });
        }
        let scatter = outputs.iter_mut().map(|output| average(output, &groups)).collect();
        inputs.remove(place);
        for input in inputs {
            input.values = groups.iter().map(|group| input.values[group[0]]).collect();
        }
        return Ok(Some(Replicates { seed: name, rows: groups.len(), scatter }));
    }
    Ok(None)
}

/// Returns the number of different values of a column.
fn count_values(values: &[f64]) -> usize {
    let mut bits: Vec<u64> = values.iter().map(|value| value.to_bits()).collect();
    bits.sort_unstable();
    bits.dedup();
    bits.len()
}

/// Replaces a column by its means over `groups` of rows; returns the part of its variance within them.
fn average(column: &mut Column, groups: &[Vec<usize>]) -> f64 {
    let mean = apportion_base::sum::mean(&column.values);
    let all: f64 = column.values.iter().map(|y| (y - mean) * (y - mean)).sum();
    let mut within = 0.0;
    let mut means = Vec::with_capacity(groups.len());
    for group in groups {
        let of_group = group.iter().map(|&row| column.values[row]).sum::<f64>() / group.len() as f64;
        within += group.iter().map(|&row| (column.values[row] - of_group).powi(2)).sum::<f64>();
        means.push(of_group);
    }
    column.values = means;
    if all > 0.0 { within / all } else { 0.0 }
}
