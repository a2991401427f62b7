//! The base points of a replicate.

use std::sync::Arc;

use super::mixed::MixedColumns;
use super::{DesignSettings, LatinHypercube, RandomPoints, Rows, Sampler, SobolSequence};

/// Plain rows have a separate random stream, for every sampler: replicates count below 2^12, and the permutations
/// of the hypercube have bit 63.
const PLAIN_STREAM: u64 = 1 << 61;

/// The base points of one replicate: a column for each dimension, the first d for A, the next d for B, and the last
/// ones for the plain rows. The columns of A and B do not depend on the others.
#[derive(Debug, Clone)]
pub struct BasePoints {
    points: Points,
    /// The points of the plain rows, those of a base point one after the other, and their number per base point.
    plain: Option<(Points, usize)>,
    factors: usize,
    /// The columns of dependent factors.
    mixed: Option<Arc<MixedColumns>>,
}

#[derive(Debug, Clone)]
enum Points {
    Sobol(SobolSequence),
    Random(RandomPoints),
    Latin(LatinHypercube),
}

impl BasePoints {
    /// Creates the points of `replicate` in `factors` columns for each of A and B and the plain rows of `rows`, and the
    /// columns of dependent factors.
    pub(super) fn new(
        settings: &DesignSettings,
        replicate: u64,
        factors: usize,
        rows: &Rows,
        mixed: Option<Arc<MixedColumns>>,
    ) -> Self {
        let plain_rows = rows.plain_rows as usize;
        let length = settings.base_samples / settings.replicates;
        let points = Points::new(settings, 2 * factors, length, replicate);
        let plain_length = length * plain_rows as u64;
        let plain = (plain_rows > 0)
            .then(|| (Points::new(settings, factors, plain_length, replicate | PLAIN_STREAM), plain_rows));
        Self { points, plain, factors, mixed }
    }

    /// Writes the points `first`, `first + 1`, ... to `columns`, all of one length: one per dimension, or those of A
    /// and B only; values in (0, 1).
    pub fn fill(&self, first: u64, columns: &mut [Vec<f64>]) {
        self.fill_independent(first, columns);
        if let Some(mixed) = &self.mixed {
            mixed.fill(columns, self.factors);
        }
    }

    fn fill_independent(&self, first: u64, columns: &mut [Vec<f64>]) {
        let (a_and_b, plain) = columns.split_at_mut((2 * self.factors).min(columns.len()));
        self.points.fill(first, a_and_b);
        if let (Some((points, rows)), Some(length)) = (&self.plain, plain.first().map(Vec::len)) {
            let mut all = vec![vec![0.0; length * rows]; self.factors];
            points.fill(first * *rows as u64, &mut all);
            for (number, column) in plain.iter_mut().enumerate().take(self.factors * rows) {
                let points = all[number % self.factors].iter().skip(number / self.factors).step_by(*rows);
                for (slot, u) in column.iter_mut().zip(points) {
                    *slot = *u;
                }
            }
        }
    }
}

impl Points {
    /// Creates points of `dimensions` coordinates; `length` is the number of them, which a hypercube needs.
    fn new(settings: &DesignSettings, dimensions: usize, length: u64, stream: u64) -> Self {
        let seed = settings.seed;
        match settings.sampler {
            Sampler::Sobol => Self::Sobol(SobolSequence::scrambled(dimensions, seed, stream).permuted(seed, stream)),
            Sampler::LatinHypercube => Self::Latin(LatinHypercube::new(dimensions, length, seed, stream)),
            Sampler::Random => Self::Random(RandomPoints::new(dimensions, seed, stream)),
        }
    }

    fn fill(&self, first: u64, columns: &mut [Vec<f64>]) {
        match self {
            Self::Sobol(sequence) => {
                for (dimension, column) in columns.iter_mut().enumerate() {
                    sequence.fill(dimension, first, column);
                }
            }
            Self::Random(points) => points.fill(first, columns),
            Self::Latin(points) => points.fill(first, columns),
        }
    }
}
