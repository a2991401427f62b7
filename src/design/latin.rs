//! Latin hypercube points, addressed by index: the permutations are computed, not stored.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::random::RandomPoints;
use crate::space::distribution::mixed;

/// A Latin hypercube of `n` points: in every dimension each of the `n` cells of width 1/n contains exactly one point,
/// at a random position in its cell (McKay, Beckman and Conover 1979, Technometrics 21, 239-245).
#[derive(Debug, Clone)]
pub struct LatinHypercube {
    n: u64,
    permutations: Vec<Permutation>,
    jitter: RandomPoints,
}

impl LatinHypercube {
    /// Creates the hypercube of `replicate` with `seed`.
    ///
    /// # Panics
    /// If `n` is 0.
    pub fn new(dimensions: usize, n: u64, seed: u64, replicate: u64) -> Self {
        assert!(n > 0, "a hypercube has at least one point");
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        // The upper half of the streams, so that permutations and jitter share no number.
        rng.set_stream(replicate | 1 << 63);
        let permutations = (0..dimensions).map(|_| Permutation::random(n, &mut rng)).collect();
        Self { n, permutations, jitter: RandomPoints::new(dimensions, seed, replicate) }
    }

    /// Writes the rows `first`, `first + 1`, ... (below `n`) to `columns` (one slice per dimension), in (0, 1).
    pub fn fill(&self, first: u64, columns: &mut [Vec<f64>]) {
        self.jitter.fill(first, columns);
        for (column, permutation) in columns.iter_mut().zip(&self.permutations) {
            for (u, row) in column.iter_mut().zip(first..) {
                *u = place(permutation.place(row), *u, self.n);
            }
        }
    }
}

/// Returns the coordinate of a point at `jitter`, in (0, 1), of its cell, out of `n` cells. With very many cells the
/// sum rounds up to n in the last one: the result must stay below 1.
fn place(cell: u64, jitter: f64, n: u64) -> f64 {
    const BELOW_ONE: f64 = 1.0 - f64::EPSILON / 2.0;
    ((cell as f64 + jitter) / n as f64).min(BELOW_ONE)
}

/// A pseudo-random permutation of 0 .. n: a Feistel network on the next even power of two, iterated until the result is
/// below n (Black and Rogaway 2002, "Ciphers with arbitrary finite domains": fewer than four steps on average).
#[derive(Debug, Clone)]
struct Permutation {
    n: u64,
    half_bits: u32,
    keys: [u64; ROUNDS],
}

/// Four rounds make a Feistel network of random functions indistinguishable from a random permutation (Luby and Rackoff
/// 1988); six allow for the round function being a hash.
const ROUNDS: usize = 6;

impl Permutation {
    fn random(n: u64, rng: &mut impl Rng) -> Self {
        let bits = u64::BITS - n.saturating_sub(1).leading_zeros();
        Self { n, half_bits: bits.div_ceil(2).max(1), keys: std::array::from_fn(|_| rng.next_u64()) }
    }

    fn place(&self, row: u64) -> u64 {
        debug_assert!(row < self.n);
        let mut value = self.step(row);
        while value >= self.n {
            value = self.step(value);
        }
        value
    }

    fn step(&self, value: u64) -> u64 {
        let mask = (1 << self.half_bits) - 1;
        let (mut left, mut right) = (value >> self.half_bits, value & mask);
        for key in self.keys {
            (left, right) = (right, left ^ (mixed(right ^ key) & mask));
        }
        left << self.half_bits | right
    }
}

#[cfg(test)]
#[path = "tests/latin.rs"]
mod tests;
