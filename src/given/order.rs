//! The rows of a table in the order of one column.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::shuffle;

/// Rows in classes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Partition {
    /// For every row the index of its class.
    pub labels: Vec<usize>,
    /// The number of classes.
    pub count: usize,
}

/// Rows sorted by a column, with its ties.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Order {
    /// Row numbers in ascending order of their values; rows of equal values in ascending order of their numbers.
    rows: Vec<usize>,
    /// The start of each group of equal values in `rows`; the last entry is the number of rows.
    starts: Vec<usize>,
}

impl Order {
    /// Computes the order of `values`, which are finite. -0 and 0 are equal.
    pub fn from_values(values: &[f64]) -> Self {
        Self::of_rounded(values, 0.0)
    }

    /// Does the same with neighbours equal that differ by at most this part of their size.
    pub fn of_rounded(values: &[f64], part: f64) -> Self {
        let mut rows: Vec<usize> = (0..values.len()).collect();
        rows.sort_unstable_by(|a, b| (values[*a] + 0.0).total_cmp(&(values[*b] + 0.0)).then(a.cmp(b)));
        let mut starts = if rows.is_empty() { Vec::new() } else { vec![0] };
        for (k, pair) in rows.windows(2).enumerate() {
            let (before, value) = (values[pair[0]], values[pair[1]]);
            if value != before && value - before > part * value.abs().max(before.abs()) {
                starts.push(k + 1);
            }
        }
        starts.push(rows.len());
        Self { rows, starts }
    }

    /// Returns the rows in ascending order of their values; of equal values in ascending order of their numbers.
    pub fn rows(&self) -> &[usize] {
        &self.rows
    }

    /// Returns the start of the rows of each value in [`rows`](Self::rows); the last entry is the number of rows.
    pub fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// Returns the number of different values.
    pub fn groups(&self) -> usize {
        self.starts.len() - 1
    }

    /// Iterates over the rows of each value, in ascending order of the values.
    pub fn iter(&self) -> impl Iterator<Item = &[usize]> {
        self.starts.windows(2).map(|ends| &self.rows[ends[0]..ends[1]])
    }

    /// Returns the number of pairs of rows with equal values.
    pub fn tied_pairs(&self) -> f64 {
        self.iter().map(|group| group.len() as f64 * (group.len() - 1) as f64 / 2.0).sum()
    }

    /// Returns the index of its value for every row.
    pub fn labels(&self) -> Vec<usize> {
        self.spread(|place, _| place)
    }

    /// Returns for every row the mean rank of its value, from 0, minus that of all rows.
    pub fn centred_ranks(&self) -> Vec<f64> {
        let middle = (self.rows.len() as f64 - 1.0) / 2.0;
        let mut before = 0;
        self.spread(|_, group| {
            let rank = before as f64 + (group.len() as f64 - 1.0) / 2.0 - middle;
            before += group.len();
            rank
        })
    }

    /// Returns the rows in order, ties shuffled.
    pub fn shuffled(&self, seed: u64, stream: u64) -> Vec<usize> {
        let mut rows = self.rows.clone();
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(stream);
        for ends in self.starts.windows(2) {
            shuffle(&mut rows[ends[0]..ends[1]], &mut rng);
        }
        rows
    }

    /// Returns at most `wanted` classes of about equal size that keep equal values
    /// together. None is smaller than half of the equal size.
    pub fn classes(&self, wanted: usize) -> Partition {
        let n = self.rows.len();
        let least = n.div_ceil(2 * wanted);
        // The class of each value: a new one when the middle of its ranks has passed a boundary.
        let mut class_of = Vec::with_capacity(self.groups());
        let (mut class, mut slot, mut size) = (0, 0, 0);
        for ends in self.starts.windows(2) {
            let middle = (ends[0] + ends[1] - 1) / 2;
            let target = middle * wanted / n;
            if target > slot && size >= least {
                (class, size) = (class + 1, 0);
            }
            slot = target;
            size += ends[1] - ends[0];
            class_of.push(class);
        }
        if size < least && class > 0 {
            class_of.iter_mut().rev().take_while(|c| **c == class).for_each(|c| *c -= 1);
            class -= 1;
        }
        Partition { labels: self.spread(|place, _| class_of[place]), count: class + 1 }
    }

    /// Returns a value per row from one per group.
    fn spread<T: Copy + Default>(&self, mut of: impl FnMut(usize, &[usize]) -> T) -> Vec<T> {
        let mut spread = vec![T::default(); self.rows.len()];
        for (place, group) in self.iter().enumerate() {
            let value = of(place, group);
            group.iter().for_each(|&row| spread[row] = value);
        }
        spread
    }
}

#[cfg(test)]
#[path = "tests/order.rs"]
mod tests;
