//! The centred sums from which every estimator reads: constant in size, mergeable in any fixed tree.

use crate::sum::{centred_product, mean};

/// First and second moments of the outputs of a Saltelli design, all centred on their own means.
///
/// With y_A, y_B the outputs of the rows A and B, and D_j = y_ABj - y_A, it holds the means of y_A, y_B and every D_j,
/// and the sums of centred products among y_A, y_B and with each D_j. The differences D_j are kept instead of y_ABj
/// because a factor of little effect has a D_j near 0: forming it from sums of y_ABj would cancel.
///
/// Blocks are summed about their own means and merged by the update of Chan, Golub and LeVeque (1983, Am. Stat. 37,
/// 242-247), so that no offset of the output, however large, costs digits.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Moments {
    n: u64,
    mean_a: f64,
    mean_b: f64,
    aa: f64,
    bb: f64,
    ab: f64,
    /// Smallest and largest output among the rows A and B; `None` without any.
    range: Option<(f64, f64)>,
    swaps: Vec<SwapMoments>,
}

/// The part of [`Moments`] that belongs to one row AB_j.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct SwapMoments {
    mean: f64,
    dd: f64,
    ad: f64,
    bd: f64,
}

/// The outputs of a block of base points.
#[derive(Debug, Clone, Copy)]
pub struct BlockOutputs<'a> {
    /// Outputs of the rows A.
    pub a: &'a [f64],
    /// Outputs of the rows B.
    pub b: &'a [f64],
    /// Outputs of the rows AB_j, one slice per swap.
    pub swapped: &'a [&'a [f64]],
}

impl Moments {
    /// No base points, for `swaps` rows AB_j.
    pub fn empty(swaps: usize) -> Self {
        Self { swaps: vec![SwapMoments::default(); swaps], ..Self::default() }
    }

    /// The moments of one block; `scratch` is reused between calls to hold the differences.
    pub fn of_block(outputs: BlockOutputs<'_>, scratch: &mut Vec<f64>) -> Self {
        let BlockOutputs { a, b, swapped } = outputs;
        let (ca, cb) = ((a, mean(a)), (b, mean(b)));
        let swaps = swapped
            .iter()
            .map(|y| {
                scratch.clear();
                scratch.extend(y.iter().zip(a).map(|(y, a)| y - a));
                let cd = (&scratch[..], mean(scratch));
                SwapMoments {
                    mean: cd.1,
                    dd: centred_product(cd, cd),
                    ad: centred_product(ca, cd),
                    bd: centred_product(cb, cd),
                }
            })
            .collect();
        Self {
            n: a.len() as u64,
            mean_a: ca.1,
            mean_b: cb.1,
            aa: centred_product(ca, ca),
            bb: centred_product(cb, cb),
            ab: centred_product(ca, cb),
            range: (!a.is_empty()).then(|| {
                let both = || a.iter().chain(b).copied();
                (both().fold(f64::INFINITY, f64::min), both().fold(f64::NEG_INFINITY, f64::max))
            }),
            swaps,
        }
    }

    /// Adds the base points of `other`, which has the same number of swaps.
    pub fn merge(&mut self, other: &Self) {
        if other.n == 0 {
            return;
        }
        if self.n == 0 {
            self.clone_from(other);
            return;
        }
        debug_assert_eq!(self.swaps.len(), other.swaps.len());
        if let (Some((low, high)), Some((other_low, other_high))) = (self.range, other.range) {
            self.range = Some((low.min(other_low), high.max(other_high)));
        }
        let (n, m) = (self.n as f64, other.n as f64);
        let (share, weight) = (m / (n + m), n * m / (n + m));
        let (da, db) = (other.mean_a - self.mean_a, other.mean_b - self.mean_b);
        self.aa += other.aa + da * da * weight;
        self.bb += other.bb + db * db * weight;
        self.ab += other.ab + da * db * weight;
        self.mean_a += da * share;
        self.mean_b += db * share;
        for (mine, theirs) in self.swaps.iter_mut().zip(&other.swaps) {
            let dd = theirs.mean - mine.mean;
            mine.dd += theirs.dd + dd * dd * weight;
            mine.ad += theirs.ad + da * dd * weight;
            mine.bd += theirs.bd + db * dd * weight;
            mine.mean += dd * share;
        }
        self.n += other.n;
    }

    /// Base points counted.
    pub fn count(&self) -> u64 {
        self.n
    }

    /// Number of rows AB_j.
    pub fn swaps(&self) -> usize {
        self.swaps.len()
    }

    /// Whether every row A and B has the same output.
    pub fn constant(&self) -> bool {
        self.range.is_none_or(|(low, high)| low == high)
    }

    /// Mean of the output over the rows A and B.
    pub fn mean(&self) -> f64 {
        self.mean_a + (self.mean_b - self.mean_a) / 2.0
    }

    /// Variance of the output over the rows A and B pooled (two-pass; divided by the number of rows 2n).
    pub fn variance(&self) -> f64 {
        let half_gap = (self.mean_b - self.mean_a) / 2.0;
        (self.aa + self.bb) / (2.0 * self.n as f64) + half_gap * half_gap
    }

    /// Partial variance V_j of the swapped columns, centred on the pooled mean f0.
    ///
    /// Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (b): the mean of y_B (y_ABj - y_A), here
    /// (y_B - f0)(y_ABj - y_A).
    pub fn first_order(&self, swap: usize) -> f64 {
        let SwapMoments { mean, bd, .. } = self.swaps[swap];
        bd / self.n as f64 + (self.mean_b - self.mean_a) / 2.0 * mean
    }

    /// Total variance of the swapped columns: half the mean of (y_A - y_ABj)^2, never negative.
    ///
    /// Jansen (1999), Comput. Phys. Commun. 117, 35-43, eq. 14; Saltelli et al. (2010), table 2 (f).
    pub fn total(&self, swap: usize) -> f64 {
        let SwapMoments { mean, dd, .. } = self.swaps[swap];
        (dd / self.n as f64 + mean * mean) / 2.0
    }

    /// First-order index of the swapped columns by another formula, as a check on [`Moments::first_order`].
    ///
    /// Janon, Klein, Lagnoux, Nodet and Prieur (2014), ESAIM: PS 18, 342-364, eq. 6 (after Monod 2006), on the pairs
    /// (y_B, y_ABj), which share the swapped columns.
    pub fn janon_monod(&self, swap: usize) -> f64 {
        let SwapMoments { mean, dd, ad, bd } = self.swaps[swap];
        let n = self.n as f64;
        let half_gap = (self.mean_b - self.mean_a - mean) / 2.0;
        let covariance = (self.ab + bd) / n - half_gap * half_gap;
        let variance = (self.bb + self.aa + 2.0 * ad + dd) / (2.0 * n) + half_gap * half_gap;
        covariance / variance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Deterministic numbers without structure, about 0 with spread 1.
    fn noise(n: usize, salt: u64) -> Vec<f64> {
        let mut x = salt.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        (0..n)
            .map(|_| {
                x ^= x << 13;
                x ^= x >> 7;
                x ^= x << 17;
                (x >> 11) as f64 / (1u64 << 53) as f64 - 0.5
            })
            .collect()
    }

    fn columns(n: usize, offset: f64) -> [Vec<f64>; 3] {
        [1, 2, 3].map(|salt| noise(n, salt).iter().map(|y| y + offset).collect())
    }

    fn moments([a, b, c]: &[Vec<f64>; 3]) -> Moments {
        Moments::of_block(BlockOutputs { a, b, swapped: &[c] }, &mut Vec::new())
    }

    /// The textbook formulas, term by term.
    fn textbook([a, b, c]: &[Vec<f64>; 3]) -> [f64; 5] {
        let n = a.len() as f64;
        let f0 = a.iter().chain(b).sum::<f64>() / (2.0 * n);
        let variance = a.iter().chain(b).map(|y| (y - f0).powi(2)).sum::<f64>() / (2.0 * n);
        let first = (0..a.len()).map(|i| (b[i] - f0) * (c[i] - a[i])).sum::<f64>() / n;
        let total = (0..a.len()).map(|i| (a[i] - c[i]).powi(2)).sum::<f64>() / (2.0 * n);
        let m = (0..a.len()).map(|i| (b[i] + c[i]) / 2.0).sum::<f64>() / n;
        let covariance = (0..a.len()).map(|i| (b[i] - m) * (c[i] - m)).sum::<f64>() / n;
        let spread = (0..a.len()).map(|i| ((b[i] - m).powi(2) + (c[i] - m).powi(2)) / 2.0).sum::<f64>() / n;
        [f0, variance, first, total, covariance / spread]
    }

    fn read(m: &Moments) -> [f64; 5] {
        [m.mean(), m.variance(), m.first_order(0), m.total(0), m.janon_monod(0)]
    }

    #[track_caller]
    fn assert_close(got: [f64; 5], expected: [f64; 5], tolerance: f64) {
        for (g, e) in got.iter().zip(expected) {
            assert!((g - e).abs() <= tolerance, "{got:?} is not {expected:?}");
        }
    }

    #[test]
    fn reads_the_textbook_formulas() {
        // Both sides sum 1000 numbers of size 1: rounding of some 1e-16 sqrt(1000).
        assert_close(read(&moments(&columns(1000, 0.0))), textbook(&columns(1000, 0.0)), 1e-14);
    }

    #[test]
    fn merged_blocks_equal_one_block_wherever_they_are_cut() {
        let whole = columns(1000, 3.0);
        for cut in [1, 3, 500, 999] {
            let mut left = moments(&whole.each_ref().map(|c| c[..cut].to_vec()));
            left.merge(&moments(&whole.each_ref().map(|c| c[cut..].to_vec())));
            assert_eq!(left.count(), 1000);
            assert_close(read(&left), textbook(&whole), 1e-14);
        }
    }

    #[test]
    fn merging_nothing_changes_nothing() {
        let block = moments(&columns(10, 0.0));
        let (mut left, mut right) = (block.clone(), Moments::empty(1));
        left.merge(&Moments::empty(1));
        right.merge(&block);
        assert_eq!(left, block);
        assert_eq!(right, block);
    }

    #[test]
    fn an_inert_factor_has_exactly_no_effect_at_any_offset() {
        for offset in [0.0, 1e9, -1e15] {
            let [a, b, _] = columns(300, offset);
            let m = Moments::of_block(BlockOutputs { a: &a, b: &b, swapped: &[&a] }, &mut Vec::new());
            assert_eq!((m.first_order(0), m.total(0)), (0.0, 0.0));
        }
    }
}
