//! The base points of a replicate.

use std::sync::Arc;

use super::mixed::MixedColumns;
use super::{DesignSettings, LatinHypercube, RandomPoints, Rows, Sampler, SobolSequence};

/// Plain rows have a random stream of their own, for every sampler: replicates count below 2^12, and the permutations
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
        let DesignSettings { sampler, seed, .. } = *settings;
        let plain_rows = rows.plain_rows as usize;
        let length = settings.base_samples / settings.replicates;
        let of = |dimensions, length, stream| match sampler {
            Sampler::Sobol => Points::Sobol(SobolSequence::scrambled(dimensions, seed, stream)),
            Sampler::LatinHypercube => Points::Latin(LatinHypercube::new(dimensions, length, seed, stream)),
            Sampler::Random => Points::Random(RandomPoints::new(dimensions, seed, stream)),
        };
        let plain_points = || of(factors, length * plain_rows as u64, replicate | PLAIN_STREAM);
        let plain = (plain_rows > 0).then(|| (plain_points(), plain_rows));
        let points = of(2 * factors, length, replicate);
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
        let (own, plain) = columns.split_at_mut((2 * self.factors).min(columns.len()));
        self.points.fill(first, own);
        if let (Some((points, rows)), Some(length)) = (&self.plain, plain.first().map(Vec::len)) {
            let mut all = vec![vec![0.0; length * rows]; self.factors];
            points.fill(first * *rows as u64, &mut all);
            for (number, column) in plain.iter_mut().enumerate().take(self.factors * rows) {
                let points = all[number % self.factors].iter().skip(number / self.factors).step_by(*rows);
                column.iter_mut().zip(points).for_each(|(slot, u)| *slot = *u);
            }
        }
    }
}

impl Points {
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
