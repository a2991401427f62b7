//! Plain random points, addressed by index.

use rand::distr::{Distribution, Open01};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Independent uniform points: one ChaCha stream per replicate, with random access to rows.
#[derive(Debug, Clone)]
pub struct RandomPoints {
    stream: ChaCha8Rng,
    dimensions: usize,
}

/// A draw from [`Open01`] takes one `u64`, two words of the stream.
const WORDS_PER_DRAW: u128 = 2;

impl RandomPoints {
    /// Creates the stream of `replicate` with `seed`, for rows of `dimensions` coordinates.
    pub fn new(dimensions: usize, seed: u64, replicate: u64) -> Self {
        let mut stream = ChaCha8Rng::seed_from_u64(seed);
        stream.set_stream(replicate);
        Self { stream, dimensions }
    }

    /// Writes the rows `first`, `first + 1`, ... to `columns` (one slice per dimension, all of one length), in (0, 1).
    pub fn fill(&self, first: u64, columns: &mut [Vec<f64>]) {
        let mut rng = self.stream.clone();
        rng.set_word_pos(u128::from(first) * self.dimensions as u128 * WORDS_PER_DRAW);
        let rows = columns.first().map_or(0, Vec::len);
        for row in 0..rows {
            for column in columns.iter_mut() {
                column[row] = Open01.sample(&mut rng);
            }
        }
    }
}

/// Puts `items` in random order, in the same way on every platform.
pub(crate) fn shuffle<T>(items: &mut [T], rng: &mut ChaCha8Rng) {
    for k in (1..items.len()).rev() {
        items.swap(k, rng.random_range(0..=k as u64) as usize);
    }
}

#[cfg(test)]
#[path = "tests/random.rs"]
mod tests;
