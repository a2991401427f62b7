//! Formulas of differences between rows: they do not cancel, and a factor without effect has exactly 0.

use crate::estimate::SwapMoments;

/// Computes S = 1/n sum (y_B - f0)(y_AB - y_A)/V.
pub fn saltelli_2010(swap: &SwapMoments) -> f64 {
    (swap.bd / swap.n() + swap.base.half_gap() * swap.mean_d) / swap.base.variance()
}

/// Computes S = N/(S V_B,AB + (1 - S) V3 - c), N = 1/n sum (y_B - f0)(y_AB - y_A), c = cov(y_A, y_B).
pub fn saltelli_pooled(swap: &SwapMoments) -> f64 {
    let (base, n) = (&swap.base, swap.n());
    let [_, b, ab] = variances(swap);
    let mean_gap = base.mean_a + swap.mean_d - base.mean_b;
    let (all, with_b) = (pooled_variance(swap), (b + ab) / 2.0 + mean_gap * mean_gap / 4.0);
    let covariance = base.ab / n - base.half_gap() * base.half_gap();
    // Independent rows have a covariance of the order of V n^-1/2. If few rows determine the output it can reach V.
    let covariance = covariance.clamp(-all / 2.0, all / 2.0);
    let numerator = swap.bd / n + base.half_gap() * swap.mean_d;
    over_own_mixture(numerator, all - covariance, with_b - covariance)
}

/// Computes ST = N/(ST V_A,AB + (1 - ST) V3), N = 1/(2n) sum (y_A - y_AB)^2; never negative.
pub fn jansen_pooled(swap: &SwapMoments) -> f64 {
    let [a, _, ab] = variances(swap);
    let with_a = (a + ab) / 2.0 + swap.mean_d * swap.mean_d / 4.0;
    over_own_mixture(half_mean_square_d(swap), pooled_variance(swap), with_a)
}

/// Solves for the index x = n/(x of_one + (1 - x) of_none), its weight x clamped to between 0 and 1: the denominator
/// `of_one` removes the error of the numerator where the index is 1, and `of_none`, from most rows, suits small ones.
fn over_own_mixture(numerator: f64, of_none: f64, of_one: f64) -> f64 {
    // Below this the equation could have no solution; this happens only if few rows determine the output.
    let of_one = of_one.max(of_none / 2.0);
    if numerator <= 0.0 {
        numerator / of_none
    } else if numerator >= of_one {
        numerator / of_one
    } else {
        // In units of the larger one, so that the square does not overflow.
        let ratio = numerator / of_none;
        2.0 * ratio / (1.0 + (1.0 + 4.0 * (of_one / of_none - 1.0) * ratio).max(0.0).sqrt())
    }
}

/// Returns the variances of y_A, y_B and y_AB.
fn variances(swap: &SwapMoments) -> [f64; 3] {
    [swap.base.aa / swap.n(), swap.base.bb / swap.n(), swap.variance_ab()]
}

/// Returns the variance V3 of y_A, y_B and y_AB pooled, divided by the number of rows 3n.
fn pooled_variance(swap: &SwapMoments) -> f64 {
    // The means relative to that of y_A, so that an offset costs no digits.
    let gaps = [0.0, swap.base.mean_b - swap.base.mean_a, swap.mean_d];
    let centre = gaps.iter().sum::<f64>() / 3.0;
    let between: f64 = gaps.iter().map(|gap| (gap - centre) * (gap - centre)).sum();
    (variances(swap).iter().sum::<f64>() + between) / 3.0
}

/// Computes S = 1 - 1/(2n) sum (y_B - y_AB)^2/V: a difference from 1, good for factors with nearly all of the effect.
pub fn jansen_first_order(swap: &SwapMoments) -> f64 {
    let (n, base) = (swap.n(), &swap.base);
    let gap = base.mean_b - base.mean_a - swap.mean_d;
    let spread = base.bb / n + swap.variance_ab() - 2.0 * swap.covariance_b_ab();
    1.0 - (spread + gap * gap) / (2.0 * base.variance())
}

/// Computes ST = 1/(2n) sum (y_A - y_AB)^2/V, never negative.
pub fn jansen_total(swap: &SwapMoments) -> f64 {
    half_mean_square_d(swap) / swap.base.variance()
}

/// Computes ST = 1 - (1/n sum y_A y_AB - m^2)/(1/n sum (y_A^2 + y_AB^2)/2 - m^2), m the mean of y_A and y_AB pooled, as
/// 1/(2n) sum (y_A - y_AB)^2 over the same denominator, which is equal.
pub fn janon_monod_total(swap: &SwapMoments) -> f64 {
    let half_gap = swap.mean_d / 2.0;
    let variance = (swap.base.aa / swap.n() + swap.variance_ab()) / 2.0 + half_gap * half_gap;
    half_mean_square_d(swap) / variance
}

/// Computes 1/(2n) sum (y_AB - y_A)^2.
fn half_mean_square_d(swap: &SwapMoments) -> f64 {
    (swap.dd / swap.n() + swap.mean_d * swap.mean_d) / 2.0
}
