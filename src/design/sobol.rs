//! Owen-scrambled Sobol' points, addressed by index.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sobol_burley::parts::owen_scramble_rev;

use super::joe_kuo::{BITS, Directions, directions};

/// One randomised Sobol' sequence of up to 2^32 points: every call for the same index gives the same point.
///
/// Each coordinate is a 32-bit Sobol' number (Joe-Kuo direction numbers; Gray-code order of Antonov and Saleev 1979,
/// as in SciPy and in Joe and Kuo's own program), scrambled by a hash that acts as a nested uniform (Owen) scramble
/// (Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4); hash of `sobol_burley`), and placed in the middle
/// of its cell of width 2^-32: never 0, never 1.
///
/// Pairs of dimensions are as good as their direction numbers: excellent for low ones; but among many dimensions some pairs
/// share leading digits over the first points, which no such sequence can avoid with more than 2^(m-1) dimensions for 2^m
/// points. No pair is correlated by more than 0.1 among the first 60 dimensions (30 factors) from 2^10 points on, 100
/// (50 factors) from 2^12 and 200 (100 factors) from 2^14. Of the 1000 pairs (A_j, B_j) of a design of 1000 factors,
/// 20 may be at 2^10 points, by up to 0.75; seven at 2^12, one at 2^14. The scramble draws the sign of such a
/// correlation, so that estimates stay unbiased and the spread of replicates shows it.
///
/// A scrambled sequence also deals out the dimensions to its coordinates at random. Some pairs fit badly at some numbers of
/// points, whatever the scramble (dimensions 5 and 34 at 2^12 points are spread no better than 2^6 could be). Dealt
/// in order, every replicate of a study hits the same pairs: the error of one index then stays put while N grows
/// fourfold, and no spread between replicates, no trend within one, tells. Dealt at random, bad luck differs from
/// replicate to replicate, and intervals hold (`benches/coverage.rs`).
#[derive(Debug, Clone)]
pub struct SobolSequence {
    /// Per coordinate: the direction numbers of its dimension.
    directions: Vec<&'static Directions>,
    /// Per dimension: the key of its scramble, none for the plain sequence.
    scrambles: Option<Vec<u32>>,
}

impl SobolSequence {
    /// The scrambled sequence of `dimensions` coordinates. Sequences of another `seed` or `replicate` are independent.
    pub fn scrambled(dimensions: usize, seed: u64, replicate: u64) -> Self {
        Self::scrambled_in(&[dimensions], seed, replicate)
    }

    /// The scrambled sequence whose first `deals[0]` coordinates share out the first `deals[0]` dimensions among them, the
    /// next `deals[1]` coordinates the next `deals[1]` dimensions, and so on: coordinates of an earlier deal do not depend
    /// on how many follow.
    pub fn scrambled_in(deals: &[usize], seed: u64, replicate: u64) -> Self {
        let dimensions = deals.iter().sum();
        let mut sequence = Self::in_order(dimensions, seed, replicate);
        // Far behind the keys of the scrambles, which take one word each.
        let mut rng = stream(seed, replicate);
        rng.set_word_pos(1 << 40);
        let mut first = 0;
        for &deal in deals {
            shuffle(&mut sequence.directions[first..first + deal], &mut rng);
            first += deal;
        }
        sequence
    }

    /// The scrambled sequence whose coordinate j is dimension j of the Sobol' sequence.
    pub fn in_order(dimensions: usize, seed: u64, replicate: u64) -> Self {
        let mut rng = stream(seed, replicate);
        let scrambles = Some((0..dimensions).map(|_| rng.next_u32()).collect());
        Self { scrambles, ..Self::plain(dimensions) }
    }

    /// The sequence without scrambling, as published: for tests and comparisons, its first point is (nearly) 0.
    pub fn plain(dimensions: usize) -> Self {
        Self { directions: directions(dimensions).iter().collect(), scrambles: None }
    }

    /// Coordinate `dimension` of the points `first`, `first + 1`, ... into `out`.
    ///
    /// # Panics
    /// If an index would reach 2^32, where the sequence would repeat itself.
    pub fn fill(&self, dimension: usize, first: u64, out: &mut [f64]) {
        assert!(first + out.len() as u64 <= 1 << BITS, "the sequence ends at 2^32 points");
        let directions = self.directions[dimension];
        let mut coordinate = at_index(directions, first);
        let scramble = self.scrambles.as_ref().map(|keys| keys[dimension]);
        for (slot, next) in out.iter_mut().zip(first + 1..) {
            let digits = scramble.map_or(coordinate, |key| owen_scramble_rev(coordinate, key));
            *slot = (f64::from(digits.reverse_bits()) + 0.5) * CELL;
            coordinate ^= directions[(next.trailing_zeros() as usize).min(BITS - 1)];
        }
    }
}

fn stream(seed: u64, replicate: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(replicate);
    rng
}

/// Fisher and Yates' shuffle; 32 random bits a step, whose bias of 2^-20 at most (4096 dimensions) nobody will see.
fn shuffle<T>(items: &mut [T], rng: &mut impl Rng) {
    for last in (1..items.len()).rev() {
        let other = (u64::from(rng.next_u32()) * (last as u64 + 1)) >> 32;
        items.swap(last, other as usize);
    }
}

const CELL: f64 = 1.0 / (1u64 << BITS) as f64;

/// The bit-reversed coordinate of point `index`.
fn at_index(directions: &Directions, index: u64) -> u32 {
    let gray = index ^ (index >> 1);
    (0..BITS).filter(|k| gray >> k & 1 == 1).fold(0, |sum, k| sum ^ directions[k])
}

#[cfg(test)]
mod tests;
