//! The means used to compute second-order indices.

use super::workspace::{Difference, PairedColumns, Workspace};
use crate::sum::{centred_product, mean};

/// Means of E_j D_k over the ordered pairs j != k of the paired swaps, with D = y_AB - y_A and E = y_BA - y_B.
#[derive(Debug, Clone, PartialEq)]
pub struct PairMoments {
    /// The paired swaps, in rising order.
    swaps: Vec<usize>,
    /// Row by row without the diagonal: for each j all k.
    means: Vec<PairMean>,
}

/// A mean, and the number of its base points.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct PairMean {
    n: u64,
    mean: f64,
}

impl Difference {
    fn set(&mut self, y: &[f64], origin: &[f64]) {
        self.succeeded.clear();
        self.values.clear();
        self.values.extend(y.iter().zip(origin).map(|(y, origin)| y - origin));
        if mean(&self.values).is_finite() {
            return;
        }
        let succeeded = |(y, origin): (&f64, &f64)| y.is_finite() && origin.is_finite();
        self.succeeded.extend(y.iter().zip(origin).map(|row| f64::from(u8::from(succeeded(row)))));
        for (value, succeeded) in self.values.iter_mut().zip(&self.succeeded) {
            if *succeeded == 0.0 {
                *value = 0.0;
            }
        }
    }
}

impl PairMoments {
    /// Computes the means of one block for `swaps`: `a` and `b` are the outputs of A and B, `ab` and `ba` those of all
    /// swaps.
    pub(super) fn from_columns(
        swaps: &[usize],
        (a, b): (&[f64], &[f64]),
        (ab, ba): (&[&[f64]], &[&[f64]]),
        work: &mut Workspace,
    ) -> Self {
        work.paired.resize_with(swaps.len(), PairedColumns::default);
        for (columns, &swap) in work.paired.iter_mut().zip(swaps) {
            columns.d.set(ab[swap], a);
            columns.e.set(ba[swap], b);
        }
        let mut means = Vec::with_capacity(swaps.len() * swaps.len().saturating_sub(1));
        for (j, of_j) in work.paired.iter().enumerate() {
            for (k, of_k) in work.paired.iter().enumerate() {
                if j != k {
                    means.push(PairMean::new(&of_j.e, &of_k.d));
                }
            }
        }
        Self { swaps: swaps.to_vec(), means }
    }

    /// Creates moments from the means of all ordered pairs of `swaps`, each with its number of base points.
    pub(super) fn from_means(swaps: &[usize], means: impl Iterator<Item = (f64, u64)>) -> Self {
        Self { swaps: swaps.to_vec(), means: means.map(|(mean, n)| PairMean { n, mean }).collect() }
    }

    /// Adds other base points of the same swaps.
    pub(super) fn merge(&mut self, other: &Self) {
        for (mine, theirs) in self.means.iter_mut().zip(&other.means) {
            mine.merge(theirs);
        }
    }

    /// Returns the swaps whose pairs are counted, in rising order.
    pub fn swaps(&self) -> &[usize] {
        &self.swaps
    }

    /// Returns the mean of E_j D_k and the number of its base points; `None` unless `j` and `k` are two of the paired
    /// swaps.
    pub fn mean(&self, j: usize, k: usize) -> Option<(f64, u64)> {
        let (row, column) = (self.swaps.binary_search(&j).ok()?, self.swaps.binary_search(&k).ok()?);
        if row == column {
            return None;
        }
        let PairMean { n, mean } = self.means[row * (self.swaps.len() - 1) + column - usize::from(column > row)];
        Some((mean, n))
    }
}

impl PairMean {
    fn new(e: &Difference, d: &Difference) -> Self {
        let n = match (&e.succeeded[..], &d.succeeded[..]) {
            ([], []) => e.values.len() as u64,
            ([], some) | (some, []) => some.iter().sum::<f64>() as u64,
            (some, others) => centred_product((some, 0.0), (others, 0.0)) as u64,
        };
        let sum = centred_product((&e.values, 0.0), (&d.values, 0.0));
        Self { n, mean: if n == 0 { 0.0 } else { sum / n as f64 } }
    }

    fn merge(&mut self, other: &Self) {
        if other.n > 0 {
            self.n += other.n;
            self.mean += (other.mean - self.mean) * (other.n as f64 / self.n as f64);
        }
    }
}
