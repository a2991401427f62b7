//! Formulas of differences between rows: nothing large is subtracted, and a factor that does nothing has exactly 0.

use crate::estimate::SwapMoments;

/// S = 1/n sum (y_B - f0)(y_AB - y_A)/V.
pub fn saltelli_2010(swap: &SwapMoments) -> f64 {
    (swap.bd / swap.n() + swap.base.half_gap() * swap.mean_d) / swap.base.variance()
}

/// S = 1/n sum (y_B - f0)(y_AB - y_A)/(V3 - cov(y_A, y_B)), V3 the variance of y_A, y_B and y_AB pooled.
pub fn saltelli_pooled(swap: &SwapMoments) -> f64 {
    let (base, variance) = (&swap.base, pooled_variance(swap));
    let covariance = base.ab / swap.n() - base.half_gap() * base.half_gap();
    // Independent rows have a covariance of the order of V n^-1/2. Where few rows carry the output it can reach V.
    let covariance = covariance.clamp(-variance / 2.0, variance / 2.0);
    (swap.bd / swap.n() + base.half_gap() * swap.mean_d) / (variance - covariance)
}

/// ST = 1/(2n) sum (y_A - y_AB)^2/V3, never negative.
pub fn jansen_pooled(swap: &SwapMoments) -> f64 {
    half_mean_square_d(swap) / pooled_variance(swap)
}

/// Variance of y_A, y_B and y_AB pooled, divided by the number of rows 3n.
fn pooled_variance(swap: &SwapMoments) -> f64 {
    let base = &swap.base;
    // The means relative to that of y_A, so that an offset costs no digits.
    let gaps = [0.0, base.mean_b - base.mean_a, swap.mean_d];
    let centre = gaps.iter().sum::<f64>() / 3.0;
    let between: f64 = gaps.iter().map(|gap| (gap - centre) * (gap - centre)).sum();
    ((base.aa + base.bb) / swap.n() + swap.variance_ab() + between) / 3.0
}

/// S = 1 - 1/(2n) sum (y_B - y_AB)^2/V: a difference from 1, good for factors that do nearly everything.
pub fn jansen_first_order(swap: &SwapMoments) -> f64 {
    let (n, base) = (swap.n(), &swap.base);
    let gap = base.mean_b - base.mean_a - swap.mean_d;
    let spread = base.bb / n + swap.variance_ab() - 2.0 * swap.covariance_b_ab();
    1.0 - (spread + gap * gap) / (2.0 * base.variance())
}

/// ST = 1/(2n) sum (y_A - y_AB)^2/V, never negative.
pub fn jansen_total(swap: &SwapMoments) -> f64 {
    half_mean_square_d(swap) / swap.base.variance()
}

/// ST = 1 - (1/n sum y_A y_AB - m^2)/(1/n sum (y_A^2 + y_AB^2)/2 - m^2), m the mean of y_A and y_AB pooled; which is
/// 1/(2n) sum (y_A - y_AB)^2 over that same denominator, and computed so.
pub fn janon_monod_total(swap: &SwapMoments) -> f64 {
    let half_gap = swap.mean_d / 2.0;
    let variance = (swap.base.aa / swap.n() + swap.variance_ab()) / 2.0 + half_gap * half_gap;
    half_mean_square_d(swap) / variance
}

/// 1/(2n) sum (y_AB - y_A)^2.
fn half_mean_square_d(swap: &SwapMoments) -> f64 {
    (swap.dd / swap.n() + swap.mean_d * swap.mean_d) / 2.0
}
