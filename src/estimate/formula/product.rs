//! Formulas that subtract a squared mean from a mean of products, or do not centre the outputs. They serve comparisons
//! with other programs: their error grows with the offset of the output, as m (m_AB - m_B) or similarly, and that of
//! the first three is of the order n^-1/2 even for a factor without effect.

use crate::estimate::SwapMoments;

/// Computes S = (1/n sum y_B y_AB - m_B^2)/(1/n sum y_B^2 - m_B^2): everything but the product from sample B only.
pub fn sobol_1993(swap: &SwapMoments) -> f64 {
    let base = &swap.base;
    let gap = base.mean_a + swap.mean_d - base.mean_b;
    (swap.covariance_b_ab() + base.mean_b * gap) / (base.bb / swap.n())
}

/// Computes S = (1/n sum y_B y_AB - f0^2)/V.
pub fn homma_saltelli_first_order(swap: &SwapMoments) -> f64 {
    (swap.covariance_b_ab() + beyond_mean_square(swap, swap.base.mean_b)) / swap.base.variance()
}

/// Computes ST = (V - 1/n sum y_A y_AB + f0^2)/V.
pub fn homma_saltelli_total(swap: &SwapMoments) -> f64 {
    let variance = swap.base.variance();
    (variance - swap.covariance_a_ab() - beyond_mean_square(swap, swap.base.mean_a)) / variance
}

/// Computes m m_AB - f0^2, without the difference of squares.
fn beyond_mean_square(swap: &SwapMoments, m: f64) -> f64 {
    let f0 = swap.base.mean();
    let mean_ab = swap.base.mean_a + swap.mean_d;
    (m - f0) * mean_ab + f0 * (mean_ab - f0)
}

/// Computes S = (1/(n-1) sum y_B y_AB - 1/n sum y_A y_B)/V_A, V_A the variance of y_A with the divisor n - 1. The two
/// divisors add f0^2/n: an offset biases it.
pub fn saltelli_2002(swap: &SwapMoments) -> f64 {
    let (n, base) = (swap.n(), &swap.base);
    let product = swap.covariance_b_ab() + base.mean_b * (base.mean_a + swap.mean_d);
    let difference = swap.bd / n + base.mean_b * swap.mean_d;
    (difference + product / (n - 1.0)) / (base.aa / (n - 1.0))
}

/// Computes S = 1/n sum y_B (y_AB - y_A)/V, not centred.
pub fn sobol_2007_first_order(swap: &SwapMoments) -> f64 {
    (swap.bd / swap.n() + swap.base.mean_b * swap.mean_d) / swap.base.variance()
}

/// Computes ST = 1/n sum y_A (y_A - y_AB)/V, not centred.
pub fn sobol_2007_total(swap: &SwapMoments) -> f64 {
    -(swap.ad / swap.n() + swap.base.mean_a * swap.mean_d) / swap.base.variance()
}
