//! Owen-scrambled Sobol' points, addressed by index.

use multiversion::multiversion;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sobol_burley::parts::owen_scramble_rev;

use super::joe_kuo::{BITS, Directions, directions};
use super::shuffle;

/// Permutations have a separate random stream.
const PERMUTATION_STREAM: u64 = 1 << 62;

/// One randomised Sobol' sequence of up to 2^32 points: every call for the same index returns the same point.
///
/// Each coordinate is a 32-bit Sobol' number (Joe-Kuo direction numbers; Gray-code order of Antonov and Saleev 1979,
/// as in SciPy and in Joe and Kuo's own program), scrambled by a hash that acts as a nested uniform (Owen) scramble
/// (Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4); hash of `sobol_burley`), and placed in the middle
/// of its cell of width 2^-32: never 0, never 1.
///
/// Pairs of dimensions are as good as their direction numbers: excellent for low ones; but among many dimensions some
/// pairs share leading digits over the first points, which no such sequence can avoid with more than 2^(m-1) dimensions
/// for 2^m points. No pair is correlated by more than 0.1 among the first 60 dimensions (30 factors) from 2^10 points
/// on, 100 (50 factors) from 2^12 and 200 (100 factors) from 2^14. Of the 1000 pairs (A_j, B_j) of a design of 1000
/// factors, 20 may be at 2^10 points, by up to 0.75; seven at 2^12, one at 2^14. The scramble randomises the sign of
/// such a correlation, so that estimates remain unbiased and the spread of replicates shows it.
#[derive(Debug, Clone)]
pub struct SobolSequence {
    /// Per dimension: the direction numbers.
    directions: Vec<&'static Directions>,
    /// Per dimension: the key of its scramble, none for the plain sequence.
    scrambles: Option<Vec<u32>>,
}

impl SobolSequence {
    /// Creates the scrambled sequence of `dimensions` coordinates; independent for another `seed` or `replicate`.
    pub fn scrambled(dimensions: usize, seed: u64, replicate: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(replicate);
        Self { scrambles: Some((0..dimensions).map(|_| rng.next_u32()).collect()), ..Self::plain(dimensions) }
    }

    /// Assigns the coordinates to the dimensions of the sequence in a random order, another one for each `replicate`.
    ///
    /// The first digits of all coordinates are linear functions of the few digits of the point's number, and a scramble
    /// only flips them: without this, all replicates share the same dependences among factors with few levels.
    #[must_use]
    pub fn permuted(mut self, seed: u64, replicate: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(replicate | PERMUTATION_STREAM);
        shuffle(&mut self.directions, &mut rng);
        self
    }

    /// Creates the sequence without scrambling, as published, for tests and comparisons; its first point is (nearly) 0.
    pub fn plain(dimensions: usize) -> Self {
        Self { directions: directions(dimensions).iter().collect(), scrambles: None }
    }

    /// Writes coordinate `dimension` of the points `first`, `first + 1`, ... to `out`.
    ///
    /// # Panics
    /// If an index would reach 2^32, where the sequence would repeat itself.
    pub fn fill(&self, dimension: usize, first: u64, out: &mut [f64]) {
        assert!(first + out.len() as u64 <= 1 << BITS, "the sequence ends at 2^32 points");
        let directions = self.directions[dimension];
        let tile = first_tile(directions);
        let scramble = self.scrambles.as_ref().map(|keys| keys[dimension]);
        let (mut index, mut rest) = (first, out);
        while !rest.is_empty() {
            let skipped = index as usize % TILE;
            let (part, others) = rest.split_at_mut(rest.len().min(TILE - skipped));
            // Gray code is linear: the points of a tile differ from those of the first one by an XOR with one number.
            let points = coordinates(at_index(directions, index - skipped as u64), &tile, scramble);
            part.copy_from_slice(&points[skipped..][..part.len()]);
            index += part.len() as u64;
            rest = others;
        }
    }
}

/// Number of points computed at once.
const TILE: usize = 64;

/// Returns the bit-reversed coordinates of the first points.
fn first_tile(directions: &Directions) -> [u32; TILE] {
    let mut tile = [0; TILE];
    for (bit, direction) in directions.iter().enumerate().take(TILE.ilog2() as usize) {
        // Points with this bit of the Gray code follow in Gray-code order: the others backwards.
        let (before, after) = tile[..2 << bit].split_at_mut(1 << bit);
        for (point, other) in after.iter_mut().zip(before.iter().rev()) {
            *point = other ^ direction;
        }
    }
    tile
}

/// Returns the coordinates of the points of a tile, whose first one is at `origin`, scrambled by a key.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn coordinates(origin: u32, tile: &[u32; TILE], scramble: Option<u32>) -> [f64; TILE] {
    let mut coordinates = [0.0; TILE];
    match scramble {
        Some(key) => {
            for (slot, point) in coordinates.iter_mut().zip(tile) {
                *slot = in_cell(owen_scramble_rev(origin ^ point, key));
            }
        }
        None => coordinates.iter_mut().zip(tile).for_each(|(slot, point)| *slot = in_cell(origin ^ point)),
    }
    coordinates
}

/// Returns the middle of the cell of a bit-reversed coordinate.
#[inline(always)]
fn in_cell(reversed: u32) -> f64 {
    (f64::from(reversed.reverse_bits()) + 0.5) * CELL
}

const CELL: f64 = 1.0 / (1u64 << BITS) as f64;

/// Returns the bit-reversed coordinate of point `index`.
fn at_index(directions: &Directions, index: u64) -> u32 {
    let gray = index ^ (index >> 1);
    directions.iter().enumerate().fold(0, |sum, (k, direction)| sum ^ if gray >> k & 1 == 1 { *direction } else { 0 })
}

#[cfg(test)]
#[path = "tests/sobol.rs"]
mod tests;
