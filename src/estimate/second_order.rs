//! Second-order indices: what two factors do together beyond what each does alone.

use super::{Moments, SwapMoments};

/// An estimator of second-order indices. Both need the rows BA and the pairs' sums.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SecondOrder {
    /// S_jk = 1/(2n) sum [(y_BAj - y_B)(y_ABk - y_A) + (y_BAk - y_B)(y_ABj - y_A)]/V: the default.
    ///
    /// BA_j and AB_k share the columns j and k, BA_j and A the column j, B and AB_k the column k, and B and A none, so
    /// that the mean of the four products tends to V_{jk}^closed - V_j - V_k = V_jk. Nothing large is subtracted, and a
    /// factor that does nothing has exactly 0.
    Difference,
    /// S_jk = 1/n sum [(y_BAj - f0)(y_ABk - f0) - (y_A - f0)(y_B - f0)]/V - S_j - S_k with j < k and S by Saltelli et
    /// al. 2010: the closed index less the first-order ones, as other programs have it (SALib, on outputs less their
    /// mean).
    ///
    /// Its noise is that of the first-order indices. Where runs failed, each mean is over its own base points.
    ClosedMinusFirst,
}

/// The second-order index of two factors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairIndex {
    /// The numbers of their swaps, in rising order.
    pub swaps: (usize, usize),
    /// S_jk, not clamped.
    pub index: f64,
}

impl SecondOrder {
    /// Both, the default first.
    pub const ALL: [Self; 2] = [Self::Difference, Self::ClosedMinusFirst];

    /// The name used in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Difference => "difference",
            Self::ClosedMinusFirst => "closed-minus-first",
        }
    }

    /// Where the formula comes from.
    pub fn source(self) -> &'static str {
        match self {
            Self::Difference => "products of differences between rows; derived in this program's documentation",
            Self::ClosedMinusFirst => "Saltelli (2002), Comput. Phys. Commun. 145, 280-297, on centred outputs",
        }
    }

    /// The index of the swaps `j` and `k`; NaN unless they are two of the paired ones, have base points, and the output
    /// has variance.
    pub fn estimate(self, moments: &Moments, j: usize, k: usize) -> f64 {
        self.of(moments, j.min(k), j.max(k)).unwrap_or(f64::NAN)
    }

    fn of(self, moments: &Moments, j: usize, k: usize) -> Option<f64> {
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

    /// The indices of all pairs, j < k in rising order; empty if they were not asked for.
    pub fn all(self, moments: &Moments) -> Vec<PairIndex> {
        let swaps = moments.pairs().map_or(&[][..], |pairs| pairs.swaps());
        let pairs = swaps.iter().enumerate().flat_map(|(place, &j)| swaps[place + 1..].iter().map(move |&k| (j, k)));
        pairs.map(|(j, k)| PairIndex { swaps: (j, k), index: self.estimate(moments, j, k) }).collect()
    }
}

/// 1/n sum (y_B - f0)(y_AB - y_A).
fn partial_variance(swap: &SwapMoments) -> f64 {
    swap.bd / swap.n() + swap.base.half_gap() * swap.mean_d
}
