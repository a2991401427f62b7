//! The base points of a replicate.

use super::{DesignSettings, LatinHypercube, RandomPoints, Sampler, SobolSequence};

/// Third matrices of random and Latin hypercube points come from streams of their own, so that A and B do not depend
/// on whether there is a third: replicates count below 2^12, and the permutations of the hypercube have bit 63.
const THIRD_STREAM: u64 = 1 << 62;

/// The base points of one replicate: a column for each dimension, the first d of A, the next d of B and, if there is a
/// third matrix, the last d of C. The columns of A and B are the same with and without C.
#[derive(Debug, Clone)]
pub struct BasePoints {
    points: Points,
    /// The third matrix, where it is not part of the same sequence.
    third: Option<Points>,
    /// Dimensions of `points`.
    dimensions: usize,
}

#[derive(Debug, Clone)]
enum Points {
    Sobol(SobolSequence),
    Random(RandomPoints),
    Latin(LatinHypercube),
}

impl BasePoints {
    /// The points of `replicate` in `factors` columns for each of `matrices` (2 or 3).
    pub(super) fn new(settings: &DesignSettings, replicate: u64, factors: usize, matrices: usize) -> Self {
        let DesignSettings { sampler, seed, .. } = *settings;
        let length = settings.base_samples / settings.replicates;
        if sampler.is_digital() {
            let sequence = if sampler == Sampler::Sobol {
                SobolSequence::scrambled(factors * matrices, seed, replicate)
            } else {
                SobolSequence::pick_freeze(factors, matrices, seed, replicate)
            };
            return Self { points: Points::Sobol(sequence), third: None, dimensions: factors * matrices };
        }
        let of = |dimensions, stream| {
            if sampler == Sampler::LatinHypercube {
                Points::Latin(LatinHypercube::new(dimensions, length, seed, stream))
            } else {
                Points::Random(RandomPoints::new(dimensions, seed, stream))
            }
        };
        let third = (matrices > 2).then(|| of(factors, replicate | THIRD_STREAM));
        Self { points: of(factors * 2, replicate), third, dimensions: factors * 2 }
    }

    /// The points `first`, `first + 1`, ... into `columns`: one per dimension, all of one length; values in (0, 1).
    pub fn fill(&self, first: u64, columns: &mut [Vec<f64>]) {
        let (own, rest) = columns.split_at_mut(self.dimensions.min(columns.len()));
        self.points.fill(first, own);
        if let Some(third) = &self.third {
            third.fill(first, rest);
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
