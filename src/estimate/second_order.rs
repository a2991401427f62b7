//! Second-order indices: the joint effect of two factors beyond their individual effects.

use super::Moments;

/// Computes the second-order index of the swaps `j` and `k`; NaN unless they are paired, have base points, and the
/// output varies. It needs the rows BA and the sums of pairs:
///
/// S_jk = 1/(2n) sum [(y_BAj - y_B)(y_ABk - y_A) + (y_BAk - y_B)(y_ABj - y_A)]/V.
///
/// BA_j and AB_k share the columns j and k, BA_j and A the column j, B and AB_k the column k, and B and A none, so that
/// the mean of the four products tends to V_{jk}^closed - V_j - V_k = V_jk. Nothing large is subtracted, and a factor
/// without effect has exactly 0.
pub fn second_order(moments: &Moments, j: usize, k: usize) -> f64 {
    let mean = |j, k| moments.pairs()?.mean(j, k).filter(|(_, n)| *n > 0).map(|(mean, _)| mean);
    let (j, k) = (j.min(k), j.max(k));
    let (Some(forth), Some(back)) = (mean(j, k), mean(k, j)) else { return f64::NAN };
    (forth + back) / (2.0 * moments.variance())
}
