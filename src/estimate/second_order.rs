//! Second-order indices: the joint effect of two factors beyond their individual effects.

use super::{Moments, SwapMoments};
use apportion_base::names::named;

named! {
/// An estimator of second-order indices, the default first. Both need the rows BA and the sums of pairs.
pub enum SecondOrder {
    /// S_jk = 1/(2n) sum [(y_BAj - y_B)(y_ABk - y_A) + (y_BAk - y_B)(y_ABj - y_A)]/V: the default.
    ///
    /// BA_j and AB_k share the columns j and k, BA_j and A the column j, B and AB_k the column k, and B and A none, so
    /// that the mean of the four products tends to V_{jk}^closed - V_j - V_k = V_jk. Nothing large is subtracted, and a
    /// factor without effect has exactly 0.
    Difference = "difference",
    /// S_jk = 1/n sum [(y_BAj - f0)(y_ABk - f0) - (y_A - f0)(y_B - f0)]/V - S_j - S_k with j < k and S by Saltelli et
    /// al. 2010: the closed index minus the first-order ones, as in other programs (SALib, on outputs minus their
    /// mean).
    ///
    /// Its noise is that of the first-order indices. Where runs failed, each mean is over its own base points.
    ClosedMinusFirst = "closed-minus-first",
}
}

impl SecondOrder {
    /// Computes the index of the swaps `j` and `k`; NaN unless they are paired, have base points, and the output
    /// varies.
    pub fn estimate(self, moments: &Moments, j: usize, k: usize) -> f64 {
        self.by_pair(moments, j.min(k), j.max(k)).unwrap_or(f64::NAN)
    }

    fn by_pair(self, moments: &Moments, j: usize, k: usize) -> Option<f64> {
        let pairs = moments.pairs()?;
        let mean = |j, k| pairs.mean(j, k).filter(|(_, n)| *n > 0).map(|(mean, _)| mean);
        let variance = moments.variance();
        match self {
            Self::Difference => Some((mean(j, k)? + mean(k, j)?) / (2.0 * variance)),
            Self::ClosedMinusFirst => {
                // The first-order part of k is in both terms and cancels; that of j is estimated from two series.
                let (of_j, ba) = (moments.swap(j), moments.swap(j).ba.as_ref()?);
                let from_ba = ba.ae / of_j.n() - of_j.base.half_gap() * ba.mean_e;
                Some((mean(j, k)? + from_ba - partial_variance(of_j)) / variance)
            }
        }
    }
}

/// Computes 1/n sum (y_B - f0)(y_AB - y_A).
fn partial_variance(swap: &SwapMoments) -> f64 {
    swap.bd / swap.n() + swap.base.half_gap() * swap.mean_d
}
