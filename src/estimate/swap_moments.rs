//! The sums used to compute the indices of one swap.

use super::base_moments::{BaseMoments, Shift};
use super::workspace::{Differences, Workspace, difference};
use apportion_base::sum::{centred_product, centred_products, mean};

/// Means and sums of centred products of the outputs of one swap s, over the base points at which all of its rows have
/// an output.
///
/// Differences are kept instead of outputs, D = y_AB - y_A and E = y_BA - y_B: D and E of a factor of little effect are
/// near 0, and computing them from sums of the outputs would cancel.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SwapMoments {
    /// Moments of y_A and y_B.
    pub base: BaseMoments,
    /// Mean of D.
    pub mean_d: f64,
    /// Sum of squares of D.
    pub dd: f64,
    /// Sum of products of y_A and D.
    pub ad: f64,
    /// Sum of products of y_B and D.
    pub bd: f64,
    /// Sums that need the row BA_s.
    pub ba: Option<BaMoments>,
}

/// Sums with E = y_BA - y_B.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BaMoments {
    /// Mean of E.
    pub mean_e: f64,
    /// Sum of squares of E.
    pub ee: f64,
    /// Sum of products of y_A and E.
    pub ae: f64,
    /// Sum of products of y_B and E.
    pub be: f64,
    /// Sum of products of D and E.
    pub de: f64,
}

/// Outputs of the rows of one swap, and of A and B.
#[derive(Clone, Copy)]
pub(super) struct Columns<'a> {
    pub a: &'a [f64],
    pub b: &'a [f64],
    pub ab: &'a [f64],
    pub ba: Option<&'a [f64]>,
}

impl SwapMoments {
    /// Computes the moments of one block. `base` are those of A and B if they have no failure in the block; an output
    /// that is not finite is a failure.
    pub(super) fn from_columns(base: Option<BaseMoments>, columns: Columns<'_>, work: &mut Workspace) -> Self {
        // A sum over a column is finite only if the column is, so that no separate pass for failures is needed.
        let complete = base.map(|base| Self::of_complete(base, columns, work)).filter(Self::finite);
        complete.unwrap_or_else(|| {
            let mut kept = std::mem::take(&mut work.kept);
            let columns = columns.without_failures(&mut kept);
            let moments = Self::of_complete(BaseMoments::from_columns(columns.a, columns.b), columns, work);
            work.kept = kept;
            moments
        })
    }

    fn finite(&self) -> bool {
        self.mean_d.is_finite() && self.ba.is_none_or(|ba| ba.mean_e.is_finite())
    }

    fn of_complete(base: BaseMoments, columns: Columns<'_>, work: &mut Workspace) -> Self {
        let Columns { a, b, ab, ba } = columns;
        let Differences { d: buffer_d, e: buffer_e } = &mut work.differences;
        let (a, b) = ((a, base.mean_a), (b, base.mean_b));
        difference(ab, a.0, buffer_d);
        let d = (&buffer_d[..], mean(buffer_d));
        let e = ba.map(|ba| {
            difference(ba, b.0, buffer_e);
            (&buffer_e[..], mean(buffer_e))
        });
        let ba = e.map(|e| {
            let [ae, be, ee] = centred_products(a, b, e);
            BaMoments { mean_e: e.1, ee, ae, be, de: centred_product(d, e) }
        });
        let [ad, bd, dd] = centred_products(a, b, d);
        Self { base, mean_d: d.1, dd, ad, bd, ba }
    }

    /// Adds other base points of the same swap.
    pub(super) fn merge(&mut self, other: &Self) {
        if other.base.n == 0 {
            return;
        }
        if self.base.n == 0 {
            *self = *other;
            return;
        }
        let shift = self.base.merge(&other.base);
        let Shift { share, weight, a, b } = shift;
        let d = other.mean_d - self.mean_d;
        self.dd += other.dd + d * d * weight;
        self.ad += other.ad + a * d * weight;
        self.bd += other.bd + b * d * weight;
        self.mean_d += d * share;
        if let (Some(mine), Some(theirs)) = (&mut self.ba, &other.ba) {
            let e = theirs.mean_e - mine.mean_e;
            mine.ee += theirs.ee + e * e * weight;
            mine.ae += theirs.ae + a * e * weight;
            mine.be += theirs.be + b * e * weight;
            mine.de += theirs.de + d * e * weight;
            mine.mean_e += e * share;
        }
    }

    /// Returns whether no row of the swap differs from its original row: the swapped columns have no effect.
    pub fn inert(&self) -> bool {
        self.mean_d == 0.0 && self.dd == 0.0 && self.ba.is_none_or(|ba| ba.mean_e == 0.0 && ba.ee == 0.0)
    }

    /// Returns the number of base points, as a divisor.
    pub fn n(&self) -> f64 {
        self.base.n as f64
    }

    /// Returns the variance of y_AB.
    pub fn variance_ab(&self) -> f64 {
        (self.base.aa + 2.0 * self.ad + self.dd) / self.n()
    }

    /// Returns the covariance of y_A and y_AB, which share all columns except those of the swap.
    pub fn covariance_a_ab(&self) -> f64 {
        (self.base.aa + self.ad) / self.n()
    }

    /// Returns the covariance of y_B and y_AB, which share the columns of the swap.
    pub fn covariance_b_ab(&self) -> f64 {
        (self.base.ab + self.bd) / self.n()
    }
}

impl<'a> Columns<'a> {
    fn all(&self) -> [Option<&'a [f64]>; 4] {
        [Some(self.a), Some(self.b), Some(self.ab), self.ba]
    }

    /// Copies the base points whose outputs are all finite to `kept`, and returns them.
    fn without_failures<'k>(&self, kept: &'k mut [Vec<f64>; 4]) -> Columns<'k> {
        let columns = self.all();
        for (kept, column) in kept.iter_mut().zip(columns) {
            kept.clear();
            let rows = column.into_iter().flatten().enumerate();
            let complete = rows.filter(|(row, _)| columns.iter().flatten().all(|column| column[*row].is_finite()));
            kept.extend(complete.map(|(_, y)| y));
        }
        let [a, b, ab, ba] = &*kept;
        Columns { a, b, ab, ba: self.ba.map(|_| &ba[..]) }
    }
}
