//! Formulas of correlation coefficients.

use crate::estimate::SwapMoments;

/// Computes S = (1/n sum y_B y_AB - m^2)/(1/n sum (y_B^2 + y_AB^2)/2 - m^2), m the mean of y_B and y_AB pooled.
pub fn janon_monod_first_order(swap: &SwapMoments) -> f64 {
    let base = &swap.base;
    let half_gap = (base.mean_b - base.mean_a - swap.mean_d) / 2.0;
    let covariance = swap.covariance_b_ab() - half_gap * half_gap;
    let variance = (base.bb / swap.n() + swap.variance_ab()) / 2.0 + half_gap * half_gap;
    covariance / variance
}

/// Computes S = r(y_B, y_AB), Pearson's correlation.
pub fn martinez_first_order(swap: &SwapMoments) -> f64 {
    swap.covariance_b_ab() / (swap.base.bb / swap.n()).sqrt() / swap.variance_ab().sqrt()
}

/// Computes ST = 1 - r(y_A, y_AB).
pub fn martinez_total(swap: &SwapMoments) -> f64 {
    one_minus_correlation(swap.base.aa / swap.n(), swap.ad / swap.n(), swap.dd / swap.n())
}

/// Computes 1 - r(x, x + d) from the variance of x, its covariance with d and the variance of d: with s and t the
/// standard deviations of x and x + d it is (var d - (s - t)^2)/(2 s t), which has no cancellation for a small d.
fn one_minus_correlation(xx: f64, xd: f64, dd: f64) -> f64 {
    let (s, t) = (xx.sqrt(), (xx + 2.0 * xd + dd).sqrt());
    let gap = (2.0 * xd + dd) / (s + t);
    (dd - gap * gap) / (2.0 * s * t)
}

/// Computes the first-order and total index with the correction for spurious correlations.
///
/// The total index is formula D3 as in the script published with Lo Piano et al. (2021, Reliab. Eng. Syst. Saf. 206,
/// 107300), except that it uses Pearson's correlations where that script standardises all rows by one mean and
/// variance; the first-order index is the same with the parts of the swap and of the other columns exchanged.
///
/// With r Pearson's correlation, each averaged over the two pairs of rows that estimate it:
/// c = (r(B, AB) + r(A, BA))/2, which tends to S; q = 1 - (r(A, AB) + r(B, BA))/2, which tends to ST; and
/// p = (r(A, B) + r(AB, BA))/2, which tends to 0 but in a finite sample adds to the others. Solving
/// c = u + p v, 1 - q = v + p u for the corrected u and v gives u = (c - p (1 - q))/(1 - p^2) and
/// v = (1 - q - p c)/(1 - p^2), and
/// S = c - p v/(1 - u v), ST = q + p u/(1 - u v).
///
/// NaN without the rows BA.
fn glen_isaacs(swap: &SwapMoments) -> (f64, f64) {
    let Some(ba) = &swap.ba else { return (f64::NAN, f64::NAN) };
    let (n, base) = (swap.n(), &swap.base);
    let (s_a, s_b) = ((base.aa / n).sqrt(), (base.bb / n).sqrt());
    let (s_ab, s_ba) = (swap.variance_ab().sqrt(), ((base.bb + 2.0 * ba.be + ba.ee) / n).sqrt());
    let correlation = |sum: f64, s: f64, t: f64| sum / n / s / t;
    let c = (correlation(base.ab + swap.bd, s_b, s_ab) + correlation(base.ab + ba.ae, s_a, s_ba)) / 2.0;
    let p = (correlation(base.ab, s_a, s_b) + correlation(base.ab + ba.ae + swap.bd + ba.de, s_ab, s_ba)) / 2.0;
    let q = (one_minus_correlation(base.aa / n, swap.ad / n, swap.dd / n)
        + one_minus_correlation(base.bb / n, ba.be / n, ba.ee / n))
        / 2.0;
    let independent = 1.0 - p * p;
    let (u, v) = ((c - p + p * q) / independent, (1.0 - q - p * c) / independent);
    (c - p * v / (1.0 - u * v), q + p * u / (1.0 - u * v))
}

/// Computes the first-order index of [`glen_isaacs`].
pub fn glen_isaacs_first_order(swap: &SwapMoments) -> f64 {
    glen_isaacs(swap).0
}

/// Computes the total index of [`glen_isaacs`].
pub fn glen_isaacs_total(swap: &SwapMoments) -> f64 {
    glen_isaacs(swap).1
}
