//! Moments of the rows A and B, shared by those of every swap.

use apportion_base::sum::{centred_product, mean};

/// Means and sums of centred products of y_A and y_B over some base points.
///
/// Blocks are summed about their own means and merged by the update of Chan, Golub and LeVeque (1983, Am. Stat. 37,
/// 242-247), so that no offset of the output, however large, costs digits.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BaseMoments {
    /// Base points.
    pub n: u64,
    /// Mean of y_A.
    pub mean_a: f64,
    /// Mean of y_B.
    pub mean_b: f64,
    /// Sum of (y_A - mean_a)^2.
    pub aa: f64,
    /// Sum of (y_B - mean_b)^2.
    pub bb: f64,
    /// Sum of (y_A - mean_a)(y_B - mean_b).
    pub ab: f64,
}

/// The shift between the means of two sets of base points that are merged, and its weight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shift {
    /// Their share of the base points.
    pub share: f64,
    /// n m/(n + m): the product of two shifts of means times this is added to a sum of centred products.
    pub weight: f64,
    /// Shift of the mean of y_A.
    pub a: f64,
    /// Shift of the mean of y_B.
    pub b: f64,
}

impl BaseMoments {
    /// Computes the moments of two columns of one length.
    pub(super) fn from_columns(a: &[f64], b: &[f64]) -> Self {
        let (ca, cb) = ((a, mean(a)), (b, mean(b)));
        Self {
            n: a.len() as u64,
            mean_a: ca.1,
            mean_b: cb.1,
            aa: centred_product(ca, ca),
            bb: centred_product(cb, cb),
            ab: centred_product(ca, cb),
        }
    }

    /// Adds other base points. Both sides must have base points.
    pub(super) fn merge(&mut self, other: &Self) -> Shift {
        let (n, m) = (self.n as f64, other.n as f64);
        let shift = Shift {
            share: m / (n + m),
            weight: n * m / (n + m),
            a: other.mean_a - self.mean_a,
            b: other.mean_b - self.mean_b,
        };
        self.aa += other.aa + shift.a * shift.a * shift.weight;
        self.bb += other.bb + shift.b * shift.b * shift.weight;
        self.ab += other.ab + shift.a * shift.b * shift.weight;
        self.mean_a += shift.a * shift.share;
        self.mean_b += shift.b * shift.share;
        self.n += other.n;
        shift
    }

    /// Returns half of mean_b - mean_a: the pooled mean f0 minus mean_a, and mean_b minus f0.
    pub fn half_gap(&self) -> f64 {
        (self.mean_b - self.mean_a) / 2.0
    }

    /// Returns the mean f0 of the output over the rows A and B pooled.
    pub fn mean(&self) -> f64 {
        self.mean_a + self.half_gap()
    }

    /// Returns the variance of the output over the rows A and B pooled (two-pass; divided by the number of rows 2n).
    pub fn variance(&self) -> f64 {
        (self.aa + self.bb) / (2.0 * self.n as f64) + self.half_gap() * self.half_gap()
    }
}
