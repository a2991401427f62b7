//! The means used to compute second-order indices.

use super::workspace::{Differences, Workspace, difference};
use apportion_base::sum::centred_product;

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

impl PairMoments {
    /// Computes the means of one block for `swaps`: `a` and `b` are the outputs of A and B, `ab` and `ba` those of all
    /// swaps.
    pub(super) fn from_columns(
        swaps: &[usize],
        (a, b): (&[f64], &[f64]),
        (ab, ba): (&[&[f64]], &[&[f64]]),
        work: &mut Workspace,
    ) -> Self {
        work.paired.resize_with(swaps.len(), Default::default);
        for (Differences { d, e }, &swap) in work.paired.iter_mut().zip(swaps) {
            difference(ab[swap], a, d);
            difference(ba[swap], b, e);
        }
        let mut means = Vec::with_capacity(swaps.len() * swaps.len().saturating_sub(1));
        for (j, of_j) in work.paired.iter().enumerate() {
            let others = work.paired.iter().enumerate().filter(|(k, _)| *k != j);
            means.extend(others.map(|(_, of_k)| PairMean::new(&of_j.e, &of_k.d)));
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
    fn new(e: &[f64], d: &[f64]) -> Self {
        let (mut n, mut sum) = (e.len(), centred_product((e, 0.0), (d, 0.0)));
        if !sum.is_finite() {
            // Base points that failed count as 0 in the sum, and not at all in their number.
            n = e.iter().zip(d).filter(|(e, d)| e.is_finite() && d.is_finite()).count();
            let [e, d] =
                [e, d].map(|column| column.iter().map(|y| if y.is_finite() { *y } else { 0.0 }).collect::<Vec<f64>>());
            sum = centred_product((&e, 0.0), (&d, 0.0));
        }
        Self { n: n as u64, mean: if n == 0 { 0.0 } else { sum / n as f64 } }
    }

    fn merge(&mut self, other: &Self) {
        if other.n > 0 {
            self.n += other.n;
            self.mean += (other.mean - self.mean) * (other.n as f64 / self.n as f64);
        }
    }
}
