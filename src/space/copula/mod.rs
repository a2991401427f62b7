//! How factors depend on each other: by a Gaussian copula, and by kernels around joint measurements.

mod chain;
mod cholesky;
mod gaussian;
mod kernel;

pub(crate) use chain::Chain;
pub(crate) use cholesky::CholeskyFactor;
pub(crate) use gaussian::GaussianCopula;
pub(crate) use kernel::{Joint, KernelCopula};

use super::distribution::{LARGEST_U, SMALLEST_U};
use crate::special::{normal_below, normal_quantile};

/// The copula of the factors of a space: a Gaussian one of all of them, and beside it kernel copulas of factors that it leaves
/// independent, no factor in two.
#[derive(Debug, Clone, PartialEq)]
pub struct Copula {
    gaussian: GaussianCopula,
    kernels: Vec<KernelCopula>,
}

// Their numbers equal themselves.
impl Eq for Copula {}

impl Copula {
    pub(crate) fn new(gaussian: GaussianCopula, kernels: Vec<KernelCopula>) -> Self {
        Self { gaussian, kernels }
    }

    /// Number of factors.
    pub(crate) fn factors(&self) -> usize {
        self.gaussian.factors()
    }

    /// The part that is Gaussian.
    pub(crate) fn gaussian(&self) -> &GaussianCopula {
        &self.gaussian
    }

    /// The parts that joint measurements have made.
    pub(crate) fn kernels(&self) -> &[KernelCopula] {
        &self.kernels
    }

    /// Points of the unit cube, a column for each factor, whose coordinates are independent, become dependent: of factors that depend
    /// on each other the first one keeps its coordinates.
    pub(crate) fn correlate(&self, columns: &mut [Vec<f64>]) {
        self.gaussian.correlate(columns);
        self.kernels.iter().for_each(|kernel| kernel.correlate(columns));
    }

    /// The scores of points of the unit cube, a column for each factor: empty for one that depends on no other.
    pub(crate) fn scores(&self, columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut scores = vec![Vec::new(); columns.len()];
        for &factor in self.gaussian.dependent() {
            scores[factor] = normal_scores(&columns[factor]);
        }
        for kernel in &self.kernels {
            for (place, &factor) in kernel.factors().iter().enumerate() {
                scores[factor] = columns[factor].iter().map(|&u| kernel.score(place, u)).collect();
            }
        }
        scores
    }
}

#[cfg(test)]
impl From<GaussianCopula> for Copula {
    fn from(gaussian: GaussianCopula) -> Self {
        Self::new(gaussian, Vec::new())
    }
}

/// Normal scores of coordinates of the unit cube.
pub(crate) fn normal_scores(u: &[f64]) -> Vec<f64> {
    u.iter().map(|&u| normal_quantile(u)).collect()
}

/// The coordinate of the unit cube with this normal score, inside the range of all coordinates.
pub(crate) fn from_score(score: f64) -> f64 {
    normal_below(score).clamp(SMALLEST_U, LARGEST_U)
}
