//! Values that rows share: sweeps around a base point, trajectories, and mixtures of them with random rows, in any order
//! and for any number of values.

use super::drawn_rows;

/// Comparisons of labels that each count of pairs may take.
const MAX_COMPARISONS: usize = 10_000_000;

/// Orders of the columns with which the pairs are compared.
const ORDERS: u64 = 10;

/// Standard deviations above independent columns that are clear.
const CLEAR: f64 = 6.0;

/// Returns how many pairs of rows agree in all inputs but one or two, if columns in other orders have far fewer of them:
/// neighbours in a trajectory. Rows that are dependent draws would repeat each other too, unless values `are_many`.
pub(super) fn close_pairs(labels: &[Vec<usize>], are_many: bool) -> Option<usize> {
    let (rows, inputs) = (labels[0].len(), labels.len());
    if inputs < 3 {
        return None;
    }
    let sample = drawn_rows(rows, ((2 * MAX_COMPARISONS / inputs) as f64).sqrt() as usize, 0);
    let columns: Vec<Vec<usize>> = labels.iter().map(|of| sample.iter().map(|&row| of[row]).collect()).collect();
    let [equal, close] = counts(&columns);
    let (mut sum, mut squares) = (0.0, 0.0);
    for order in 0..ORDERS {
        let shuffled = columns.iter().enumerate().map(|(j, column)| {
            let places = drawn_rows(sample.len(), sample.len(), 1 + order * inputs as u64 + j as u64);
            places.iter().map(|&place| column[place]).collect()
        });
        let by_chance = counts(&shuffled.collect::<Vec<_>>())[1];
        (sum, squares) = (sum + by_chance, squares + by_chance * by_chance);
    }
    let mean = sum / ORDERS as f64;
    let sd = (squares / ORDERS as f64 - mean * mean).max(mean).max(1.0).sqrt();
    // Seven in eight rows of a trajectory have such a neighbour, of which the sample has a part.
    let part = sample.len() as f64 / rows as f64;
    // What dependent columns share more than others.
    let dependent = if are_many { 4.0 } else { 2.5 };
    let is_clear = close > dependent * mean + CLEAR * sd && close - mean > 0.125 * part * sample.len() as f64;
    (is_clear && (are_many || equal < 0.02 * close)).then_some((close / (part * part)) as usize)
}

/// Returns the numbers of pairs of rows that are equal, and that differ in one or two columns.
fn counts(columns: &[Vec<usize>]) -> [f64; 2] {
    let rows = columns[0].len();
    let mut differing = vec![0u8; rows];
    let mut counts = [0.0; 2];
    for row in 1..rows {
        differing[..row].fill(0);
        for column in columns {
            for (count, label) in differing[..row].iter_mut().zip(column) {
                *count = count.saturating_add(u8::from(*label != column[row]));
            }
        }
        counts[0] += differing[..row].iter().filter(|count| **count == 0).count() as f64;
        // Of few columns, two are nearly all.
        let far = if columns.len() < 5 { 1 } else { 2 };
        counts[1] += differing[..row].iter().filter(|count| (1..=far).contains(*count)).count() as f64;
    }
    counts
}

/// Returns how many rows leave a base point, the most frequent value of each input, in a few inputs only, if this is far
/// more often than independent columns would. Draws that are often 0 together would be at the base point itself.
pub(super) fn around_base(labels: &[Vec<usize>]) -> Option<usize> {
    const MIN_SHARE: f64 = 0.25;
    let rows = labels[0].len();
    let (mut away, mut shares) = (vec![0; rows], Vec::new());
    for column in labels {
        let mut counts = vec![0; column.iter().max().map_or(0, |last| last + 1)];
        column.iter().for_each(|label| counts[*label] += 1);
        let base = (0..counts.len()).max_by_key(|label| counts[*label])?;
        // A column of two values has no base.
        if counts.len() > 2 && counts[base] as f64 >= MIN_SHARE * rows as f64 {
            shares.push(1.0 - counts[base] as f64 / rows as f64);
            away.iter_mut().zip(column).for_each(|(away, label)| *away += usize::from(*label != base));
        }
    }
    if shares.len() < 3 {
        return None;
    }
    // The distribution of the number of inputs away from their base.
    let mut chance = vec![1.0];
    for share in &shares {
        chance.push(0.0);
        for k in (0..chance.len()).rev() {
            chance[k] = chance[k] * (1.0 - share) + if k > 0 { chance[k - 1] * share } else { 0.0 };
        }
    }
    let few = (shares.len() / 3).max(1);
    let expected = chance[1..=few].iter().sum::<f64>();
    let observed = away.iter().filter(|away| (1..=few).contains(*away)).count();
    let at_base = away.iter().filter(|away| **away == 0).count() as f64 / rows as f64;
    let sd = (expected * (1.0 - expected) * rows as f64).sqrt();
    let is_clear = observed as f64 > expected * rows as f64 + 5.0 * sd + 0.02 * rows as f64;
    (is_clear && at_base < 1.5 * chance[0] + 0.05).then_some(observed)
}
