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
#[derive(Debug, Clone)]
pub struct SobolSequence {
    /// Per dimension: the direction numbers with their bits reversed, as the scramble wants them.
    directions: Vec<Directions>,
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
        let mut directions = directions(dimensions);
        for entry in directions.iter_mut().flatten() {
            *entry = entry.reverse_bits();
        }
        Self { directions, scrambles: None }
    }

    /// Coordinate `dimension` of the points `first`, `first + 1`, ... into `out`.
    ///
    /// # Panics
    /// If an index would reach 2^32, where the sequence would repeat itself.
    pub fn fill(&self, dimension: usize, first: u64, out: &mut [f64]) {
        assert!(first + out.len() as u64 <= 1 << BITS, "the sequence ends at 2^32 points");
        let directions = &self.directions[dimension];
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
mod tests {
    use super::*;

    fn points(sequence: &SobolSequence, first: u64, n: usize) -> Vec<Vec<f64>> {
        let dimensions = sequence.directions.len();
        let mut columns = vec![vec![0.0; n]; dimensions];
        for (dimension, column) in columns.iter_mut().enumerate() {
            sequence.fill(dimension, first, column);
        }
        columns
    }

    #[test]
    fn unscrambled_points_are_the_published_ones() {
        // The first points of the example of Joe and Kuo's program, which SciPy's unscrambled sequence repeats.
        let expected = [
            [0.0, 0.5, 0.75, 0.25, 0.375, 0.875, 0.625, 0.125],
            [0.0, 0.5, 0.25, 0.75, 0.375, 0.875, 0.125, 0.625],
            [0.0, 0.5, 0.25, 0.75, 0.625, 0.125, 0.875, 0.375],
        ];
        for (column, expected) in points(&SobolSequence::plain(3), 0, 8).iter().zip(expected) {
            for (x, e) in column.iter().zip(expected) {
                assert_eq!(*x, e + 0.5 * CELL);
            }
        }
    }

    #[test]
    fn unscrambled_points_of_high_dimensions_are_those_of_scipy() {
        // scipy.stats.qmc.Sobol(1000, scramble=False, bits=32).random(2048), SciPy 1.17.
        let columns = points(&SobolSequence::plain(1000), 0, 2048);
        let frozen = [
            (5, 99, 0.375),
            (777, 1, 0.9365234375),
            (777, 99, 0.5107421875),
            (777, 999, 0.3837890625),
            (2047, 99, 0.86083984375),
            (2047, 998, 0.13330078125),
            (2047, 999, 0.44873046875),
        ];
        for (index, dimension, expected) in frozen {
            assert_eq!(columns[dimension][index], expected + 0.5 * CELL);
        }
    }

    #[test]
    fn dimensions_are_dealt_out_within_their_deal() {
        let dealt = SobolSequence::scrambled_in(&[40, 20], 3, 1);
        let plain = SobolSequence::plain(60);
        let place = |k: usize| plain.directions.iter().position(|d| *d == dealt.directions[k]).unwrap();
        let mut places: Vec<usize> = (0..60).map(place).collect();
        assert_ne!(places[..40], (0..40).collect::<Vec<_>>());
        assert_eq!(dealt.directions[..40], SobolSequence::scrambled(40, 3, 1).directions[..]);
        assert_eq!(dealt.scrambles.as_ref().unwrap()[..40], SobolSequence::scrambled(40, 3, 1).scrambles.unwrap()[..]);
        places[..40].sort_unstable();
        places[40..].sort_unstable();
        assert_eq!(places, (0..60).collect::<Vec<_>>());
        // Every coordinate meets every dimension in the long run: 600 deals of 6 leave each pair near 100, sd 9.
        let mut counts = [[0; 6]; 6];
        let six = SobolSequence::plain(6);
        for replicate in 0..600 {
            let dealt = SobolSequence::scrambled(6, 0, replicate);
            for (k, row) in counts.iter_mut().enumerate() {
                row[six.directions.iter().position(|d| *d == dealt.directions[k]).unwrap()] += 1;
            }
        }
        assert!(counts.iter().flatten().all(|&count| (55..145).contains(&count)), "{counts:?}");
    }

    #[test]
    fn any_index_gives_the_point_of_the_running_sequence() {
        let sequence = SobolSequence::scrambled(5, 7, 3);
        let whole = points(&sequence, 0, 1000);
        for first in [0, 1, 2, 255, 256, 511, 998] {
            for (column, expected) in points(&sequence, first, 2).iter().zip(&whole) {
                assert_eq!(column[..], expected[first as usize..first as usize + 2]);
            }
        }
    }

    #[test]
    fn no_repetition_past_two_to_the_sixteen() {
        // The reference library's own sampler drops the index's high bits; ours must not.
        let sequence = SobolSequence::scrambled(2, 1, 0);
        let mut seen: Vec<u64> = points(&sequence, (1 << 16) - 512, 1024)[1].iter().map(|x| x.to_bits()).collect();
        seen.extend(points(&sequence, (1 << 32) - 1024, 1024)[1].iter().map(|x| x.to_bits()));
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), 2048);
    }

    #[test]
    fn every_elementary_interval_of_a_scrambled_net_holds_one_point() {
        // Dimensions 1 and 2 of the sequence form a (0, m, 2)-net in base 2, scrambled or not.
        for m in 1..=10 {
            let n = 1usize << m;
            let columns = points(&SobolSequence::scrambled(2, 11, m), 5 * n as u64, n);
            for split in 0..=m {
                let (nx, ny) = (1usize << split, 1usize << (m - split));
                let mut counts = vec![0; n];
                for (x, y) in columns[0].iter().zip(&columns[1]) {
                    counts[(x * nx as f64) as usize * ny + (y * ny as f64) as usize] += 1;
                }
                assert!(counts.iter().all(|&c| c == 1), "m = {m}, split = {split}");
            }
        }
    }

    #[test]
    fn points_lie_strictly_inside_the_unit_interval() {
        for replicate in 0..64 {
            for column in points(&SobolSequence::scrambled(4, 0, replicate), 0, 4096) {
                assert!(column.iter().all(|&x| x > 0.0 && x < 1.0));
            }
        }
        assert_eq!((f64::from(u32::MAX) + 0.5) * CELL, 1.0 - CELL / 2.0);
    }

    #[test]
    fn integrals_converge_faster_than_random_points_allow() {
        // Variance of the mean of a smooth product over scrambles: N^-3 for scrambled nets, N^-1 for random points
        // (Owen 1997). From 2^8 to 2^12 points (16 times as many) the standard error must fall by well over 16.
        let standard_error = |m: u32| {
            let n = 1usize << m;
            let squares: f64 = (0..64)
                .map(|replicate| {
                    let columns = points(&SobolSequence::scrambled(3, 5, replicate), 0, n);
                    let sum: f64 = (0..n).map(|i| columns.iter().map(|c| 1.0 + (c[i] - 0.5)).product::<f64>()).sum();
                    (sum / n as f64 - 1.0).powi(2)
                })
                .sum();
            (squares / 64.0).sqrt()
        };
        let ratio = standard_error(8) / standard_error(12);
        assert!(ratio > 25.0, "the error fell by {ratio} only");
    }
}
