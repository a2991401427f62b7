//! Formulas of products of two differences, which also need rows BA. All are NaN without those rows.

use crate::estimate::{BaMoments, SwapMoments};

/// Computes S = 2 sum (y_BA - y_B)(y_A - y_AB)/sum [(y_A - y_B)^2 + (y_BA - y_AB)^2].
pub fn azzini_first_order(swap: &SwapMoments) -> f64 {
    let Some(ba) = &swap.ba else { return f64::NAN };
    let product = ba.de / swap.n() + ba.mean_e * swap.mean_d;
    -2.0 * product / azzini_denominator(swap, ba)
}

/// Computes ST = sum [(y_B - y_BA)^2 + (y_A - y_AB)^2]/sum [(y_A - y_B)^2 + (y_BA - y_AB)^2].
pub fn azzini_total(swap: &SwapMoments) -> f64 {
    let Some(ba) = &swap.ba else { return f64::NAN };
    let squares = (ba.ee + swap.dd) / swap.n() + ba.mean_e * ba.mean_e + swap.mean_d * swap.mean_d;
    squares / azzini_denominator(swap, ba)
}

/// Computes 1/n sum [(y_A - y_B)^2 + (y_BA - y_AB)^2], which tends to 4 V.
fn azzini_denominator(swap: &SwapMoments, ba: &BaMoments) -> f64 {
    let base = &swap.base;
    let gap = base.mean_b - base.mean_a;
    let swapped_gap = gap + ba.mean_e - swap.mean_d;
    let squares = base.aa + base.bb - 2.0 * base.ab;
    // (B + E - A - D)^2, of which the square of B - A is known.
    let swapped = squares + ba.ee + swap.dd + 2.0 * (ba.be - swap.bd - ba.ae + swap.ad - ba.de);
    (squares + swapped) / swap.n() + gap * gap + swapped_gap * swapped_gap
}
