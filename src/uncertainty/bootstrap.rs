//! The bootstrap over base points (Efron 1979, Ann. Stat. 7, 1-26), as matrix products.
//!
//! A resample draws n of the n base points with replacement: it is a list of counts. The sums for the moments are then
//! counts times products of outputs ([`Products`]), so that all resamples together are a matrix product, which runs
//! near the peak speed of the machine. The counts of each resample and each chunk of points come from their own random
//! stream: the number that falls into the chunk is binomial given those before it, and its points are uniform. So the
//! result does not depend on the number of threads.

use nalgebra::DMatrix;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Binomial, Distribution};
use rayon::prelude::*;

use super::points::{Chunk, KeptPoints};
use crate::estimate::{Moments, Products};

/// Resamples that share a pass over the products.
const BATCH: usize = 32;

/// Resamples whose sums are in memory at a time.
const ROUND: usize = 1 << 12;

/// Returns the results of `quantities` on the moments of each of `resamples` resamples of `points`, in order.
pub(super) fn resampled<Q>(
    points: KeptPoints<'_>,
    products: &Products,
    seed: u64,
    resamples: usize,
    quantities: &(dyn Fn(&Moments) -> Option<Q> + Sync),
) -> Vec<Option<Q>>
where
    Q: Send,
{
    let chunks = points.chunks();
    let random = ChaCha8Rng::seed_from_u64(seed);
    let count = chunks.last().map_or(0, |chunk| chunk.points.end);
    let mut values = Vec::with_capacity(resamples);
    for first in (0..resamples).step_by(ROUND) {
        let round = first..(first + ROUND).min(resamples);
        let ranges = round.clone().step_by(BATCH).map(|start| start..(start + BATCH).min(round.end));
        let mut batches: Vec<Batch> = ranges.map(|range| Batch::new(range, count, products.columns())).collect();
        for (number, chunk) in chunks.iter().enumerate() {
            // Copied, not viewed: nalgebra 0.35 reads past the end of views with strides when a side is shorter than 6.
            let matrix = chunk.products(points.design, products).transpose();
            batches.par_iter_mut().for_each_init(Counts::default, |work, batch| {
                batch.add(&matrix, (chunk, number), &random, work);
            });
        }
        let sums: Vec<_> = batches.iter().flat_map(|batch| batch.sums.column_iter()).collect();
        values.par_extend(sums.par_iter().map(|sums| quantities(&products.moments(sums.as_slice()))));
    }
    values
}

/// Some resamples, processed chunk by chunk.
struct Batch {
    first: usize,
    /// Number of points that each resample still has to draw.
    left: Vec<u64>,
    /// Points in the chunks that follow.
    points: usize,
    /// Sums so far, a column for each resample.
    sums: DMatrix<f64>,
}

/// Counts of the points of a chunk: of one resample, and of all of a batch, a column each.
#[derive(Default)]
struct Counts {
    one: Vec<u8>,
    all: Vec<f64>,
}

impl Batch {
    fn new(resamples: std::ops::Range<usize>, points: usize, products: usize) -> Self {
        let left = vec![points as u64; resamples.len()];
        let sums = DMatrix::zeros(products, resamples.len());
        Self { first: resamples.start, left, points, sums }
    }

    /// Adds a chunk, whose `products` have a column per point.
    fn add(&mut self, products: &DMatrix<f64>, chunk: (&Chunk<'_>, usize), random: &ChaCha8Rng, work: &mut Counts) {
        let points = products.ncols();
        work.all.clear();
        for (place, left) in self.left.iter_mut().enumerate() {
            let mut stream = random.clone();
            stream.set_stream(stream_of(self.first + place, chunk.1));
            let drawn = drawn_here(*left, points, self.points, &mut stream);
            *left -= drawn;
            count(&mut work.one, drawn, points, &mut stream);
            work.all.extend(work.one.iter().map(|count| f64::from(*count)));
        }
        self.points -= points;
        let counts = nalgebra::DMatrixView::from_slice(&work.all, points, self.left.len());
        self.sums.gemm(1.0, products, &counts, 1.0);
    }
}

/// Returns the random stream of a resample and a chunk; those of random designs count up from 0.
fn stream_of(resample: usize, chunk: usize) -> u64 {
    1 << 63 | (resample as u64) << 32 | chunk as u64
}

/// Draws how many of `left` draws fall on `points` of the `of` points.
fn drawn_here(left: u64, points: usize, of: usize, random: &mut ChaCha8Rng) -> u64 {
    if points >= of {
        return left;
    }
    // The share is between 0 and 1.
    Binomial::new(left, points as f64 / of as f64).map_or(0, |binomial| binomial.sample(random))
}

/// Counts how often each of `points` points (at most 2^16) is drawn in `draws` draws, into `counts`.
fn count(counts: &mut Vec<u8>, draws: u64, points: usize, random: &mut ChaCha8Rng) {
    counts.clear();
    counts.resize(points, 0);
    // Lemire (2019, ACM Trans. Model. Comput. Simul. 29(1), 3) on 16-bit words: all points are equally likely.
    let points = points as u32;
    let uneven = (1 << 16) % points.max(1);
    let mut left = draws;
    while left > 0 {
        let word = random.next_u64();
        for shift in [0, 16, 32, 48] {
            let product = (word >> shift & 0xffff) as u32 * points;
            if left > 0 && product & 0xffff >= uneven {
                // The chance that one point is drawn 256 times or more is below 1/256!.
                let count = &mut counts[(product >> 16) as usize];
                *count = count.saturating_add(1);
                left -= 1;
            }
        }
    }
}

/// Returns how often resample number `resample` draws each of all points: for tests that resample the rows themselves.
#[cfg(test)]
pub(super) fn counts_of(points: KeptPoints<'_>, seed: u64, resample: usize) -> Vec<u8> {
    let random = ChaCha8Rng::seed_from_u64(seed);
    let chunks = points.chunks();
    let of = chunks.last().map_or(0, |chunk| chunk.points.end);
    let (mut left, mut all, mut one) = (of as u64, Vec::new(), Vec::new());
    for (number, chunk) in chunks.iter().enumerate() {
        let mut stream = random.clone();
        stream.set_stream(stream_of(resample, number));
        let here = chunk.points.len();
        let drawn = drawn_here(left, here, of - chunk.points.start, &mut stream);
        count(&mut one, drawn, here, &mut stream);
        left -= drawn;
        all.extend_from_slice(&one);
    }
    all
}

#[cfg(test)]
#[path = "tests/bootstrap.rs"]
mod tests;
