//! Formulas of products of two differences, from rows beside A, B and AB. All are `None` without those rows.

use crate::estimate::SwapMoments;

/// S = 2 sum (y_BA - y_B)(y_A - y_AB)/sum [(y_A - y_B)^2 + (y_BA - y_AB)^2].
pub fn azzini_first_order(swap: &SwapMoments) -> Option<f64> {
    let ba = swap.ba.as_ref()?;
    let product = ba.de / swap.n() + ba.mean_e * swap.mean_d;
    Some(-2.0 * product / azzini_denominator(swap)?)
}

/// ST = sum [(y_B - y_BA)^2 + (y_A - y_AB)^2]/sum [(y_A - y_B)^2 + (y_BA - y_AB)^2].
pub fn azzini_total(swap: &SwapMoments) -> Option<f64> {
    let ba = swap.ba.as_ref()?;
    let squares = (ba.ee + swap.dd) / swap.n() + ba.mean_e * ba.mean_e + swap.mean_d * swap.mean_d;
    Some(squares / azzini_denominator(swap)?)
}

/// 1/n sum [(y_A - y_B)^2 + (y_BA - y_AB)^2], which tends to 4 V.
fn azzini_denominator(swap: &SwapMoments) -> Option<f64> {
    let (ba, base) = (swap.ba.as_ref()?, &swap.base);
    let gap = base.mean_b - base.mean_a;
    let swapped_gap = gap + ba.mean_e - swap.mean_d;
    let squares = base.aa + base.bb - 2.0 * base.ab;
    // (B + E - A - D)^2, of which the square of B - A is known.
    let swapped = squares + ba.ee + swap.dd + 2.0 * (ba.be - swap.bd - ba.ae + swap.ad - ba.de);
    Some((squares + swapped) / swap.n() + gap * gap + swapped_gap * swapped_gap)
}

/// S = 1/n sum (y_B - y_BC)(y_AB - y_A)/V.
pub fn owen_first_order(swap: &SwapMoments) -> Option<f64> {
    let bc = swap.bc.as_ref()?;
    Some(-(bc.df / swap.n() + bc.mean_f * swap.mean_d) / swap.base.variance())
}

/// ST = 1 - 1/n sum (y_B - y_CB)(y_BA - y_A)/V: the first-order formula for all other columns.
pub fn owen_total(swap: &SwapMoments) -> Option<f64> {
    let (ba, cb, base) = (swap.ba.as_ref()?, swap.cb.as_ref()?, &swap.base);
    let centred = (cb.bg + cb.eg - cb.ag) / swap.n();
    let closed = -(centred + cb.mean_g * (base.mean_b - base.mean_a + ba.mean_e));
    Some(1.0 - closed / base.variance())
}
