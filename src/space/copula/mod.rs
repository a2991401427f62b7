//! Dependence of factors by a Gaussian copula.

mod gaussian;

pub use gaussian::GaussianCopula;

use super::distribution::{LARGEST_U, SMALLEST_U};
use crate::special::{normal_below, normal_quantile};

/// Returns the normal scores of coordinates of the unit cube.
pub(crate) fn normal_scores(u: &[f64]) -> Vec<f64> {
    u.iter().map(|&u| normal_quantile(u)).collect()
}

/// Returns the coordinate of the unit cube with this normal score, inside the range of all coordinates.
pub(crate) fn from_score(score: f64) -> f64 {
    normal_below(score).clamp(SMALLEST_U, LARGEST_U)
}
