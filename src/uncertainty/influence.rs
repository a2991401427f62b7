//! The influence of each part of the runs on the estimates.

use super::standard_error::PartInfluences;
use crate::estimate::{MomentParts, Moments, merged};

/// Quantities estimated from all parts of all replicates together, and the influence of each part on them.
#[derive(Debug, Clone, PartialEq)]
pub struct Influences {
    /// The estimates.
    pub estimates: Vec<f64>,
    /// For each quantity: the mean influence of the points of every part, `[replicate][part]`; not finite if the
    /// quantity is undefined without a part.
    pub parts: Vec<PartInfluences>,
}

impl Influences {
    /// Computes influences on `quantities`, a function from the moments of an output to a list of numbers of fixed
    /// length, or `None` if undefined. Returns `None` if they are undefined on all parts.
    pub fn from_moments(
        replicates: &[&MomentParts],
        quantities: &dyn Fn(&Moments) -> Option<Vec<f64>>,
    ) -> Option<Self> {
        let LeftOut { of_all, without, points, points_of_parts } = LeftOut::new(replicates, quantities);
        Some(Self::new(replicates, of_all?, &without, points, &points_of_parts))
    }

    /// Computes influences from the `estimates` of all parts and those `without` each part of the replicates.
    ///
    /// The influence of a part of n_p of the n points is computed by leaving it out: (theta - theta_without) (n -
    /// n_p)/n_p, to first order the mean of the influence function (Hampel 1974) over its points.
    pub fn new(
        replicates: &[&MomentParts],
        estimates: Vec<f64>,
        without: &[Option<Vec<f64>>],
        n: f64,
        of_parts: &[f64],
    ) -> Self {
        let mut parts = Vec::with_capacity(estimates.len());
        for (q, theta) in estimates.iter().enumerate() {
            let without = without.iter().map(|without| without.as_ref().map_or(f64::NAN, |without| without[q]));
            let mut influences = without.zip(of_parts).map(|(without, n_p)| influence(theta - without, n, *n_p));
            parts.push(replicates.iter().map(|r| influences.by_ref().take(r.parts().len()).collect()).collect());
        }
        Self { estimates, parts }
    }
}

/// A function of the moments of an output, evaluated on all parts and on all but each.
#[derive(Debug, Clone)]
pub struct LeftOut<T> {
    /// The value on all parts.
    pub of_all: T,
    /// The values on all but each part, the parts of all replicates in a row.
    pub without: Vec<T>,
    /// Total number of base points.
    pub points: f64,
    /// Number of base points of each part.
    pub points_of_parts: Vec<f64>,
}

impl<T> LeftOut<T> {
    /// Evaluates `of` on the parts of `replicates`.
    pub fn new(replicates: &[&MomentParts], of: &dyn Fn(&Moments) -> T) -> Self {
        let parts: Vec<&Moments> = replicates.iter().flat_map(|replicate| replicate.parts()).collect();
        let sums: Vec<Moments> = replicates.iter().map(|replicate| replicate.sum()).collect();
        let all = merged(&sums);
        // The parts before each part, and (from the back) after it: two passes instead of one per part.
        let mut before = vec![Moments::default()];
        for part in &parts[..parts.len().saturating_sub(1)] {
            let mut sum = before[before.len() - 1].clone();
            sum.merge(part);
            before.push(sum);
        }
        let mut after = Moments::default();
        let mut without = Vec::with_capacity(parts.len());
        for (part, mut rest) in parts.iter().zip(before).rev() {
            rest.merge(&after);
            without.push(of(&rest));
            let mut sum = (*part).clone();
            sum.merge(&after);
            after = sum;
        }
        without.reverse();
        let points_of_parts = parts.iter().map(|part| part.count() as f64).collect();
        Self { of_all: of(&all), without, points: all.count() as f64, points_of_parts }
    }
}

fn influence(difference: f64, n: f64, n_p: f64) -> f64 {
    if n_p == 0.0 { 0.0 } else { difference * ((n - n_p) / n_p) }
}
