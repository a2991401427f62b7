//! The base points of a replicate.

use std::sync::Arc;

use super::mixed::MixedColumns;
use super::{DesignSettings, LatinHypercube, RandomPoints, Sampler, SobolSequence};

/// The base points of one replicate: a column for each dimension, the first d for A, the next d for B.
#[derive(Debug, Clone)]
pub struct BasePoints {
    points: Points,
    factors: usize,
    /// The columns that the coordinates of the points fill, in rising order: those of A and B but for constants.
    varying: Vec<usize>,
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
    /// Creates the points of `replicate` in `factors` columns for each of A and B, of which `varying` have coordinates, and the
    /// columns of dependent factors.
    pub(super) fn new(
        settings: &DesignSettings,
        replicate: u64,
        factors: usize,
        varying: &[usize],
        mixed: Option<Arc<MixedColumns>>,
    ) -> Self {
        let length = settings.base_samples / settings.replicates;
        let varying: Vec<usize> =
            [0, factors].iter().flat_map(|first| varying.iter().map(move |j| first + j)).collect();
        Self { points: Points::new(settings, varying.len(), length, replicate), factors, varying, mixed }
    }

    /// Writes the points `first`, `first + 1`, ... to `columns`, all of one length: one per dimension, or those of A
    /// and B only; values in (0, 1), 0.5 for constants.
    pub fn fill(&self, first: u64, columns: &mut [Vec<f64>]) {
        let independent = (2 * self.factors).min(columns.len());
        if self.varying.len() == 2 * self.factors {
            self.points.fill(first, &mut columns[..independent]);
        } else {
            columns[..independent].iter_mut().for_each(|column| column.fill(0.5));
            let varying = self.varying.iter().filter(|column| **column < independent);
            let mut filled: Vec<Vec<f64>> =
                varying.clone().map(|column| std::mem::take(&mut columns[*column])).collect();
            self.points.fill(first, &mut filled);
            varying.zip(filled).for_each(|(column, values)| columns[*column] = values);
        }
        if let Some(mixed) = &self.mixed {
            mixed.fill(columns, self.factors);
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
