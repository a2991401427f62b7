//! Errors of indices whose rows show no spread.
//!
//! An output with few values, such as 0 and 1, can give an index without any spread: a first-order index of exactly 0
//! because no base point changed the output in both of its rows, or an index that is the same in every part. The spread
//! is then 0, although the index may be wrong. All that is known is that n rows did not show a contribution of another
//! kind: by the rule of three (Hanley and Lippman-Hand 1983, JAMA 249, 1743-1745), such rows are fewer than 3 in n, at
//! 95 %. Each moves the index by at most what the range of the output allows. Only a factor that leaves the output
//! unchanged in every row keeps an error of 0.

use super::estimates::{Layout, Number, OtherNumber, Quantity, SwapNoise};
use super::net_decay::PartInfluences;
use crate::estimate::Moments;

/// Upper bound at 95 % of the expected number of rows of a kind not seen in n rows: -ln 0.05.
const RULE_OF_THREE: f64 = 2.995_732_273_553_991;

/// Influences up to this share of the size of an index are rounding: at most about 64 units in the last place, times
/// n/n_p for leaving out one of 256 parts.
const ROUNDING: f64 = 1e-11;

/// Minimum part of B in the sum of squares of A and B for which the spread of first-order indices by rows AB is valid.
const MIN_PART: f64 = 0.2;

/// Returns whether the sample B has hardly any of the large outputs: the formula sum (y_B - f0)(y_AB - y_A) then misses
/// their contribution to a first-order index, and its spread does not show it. With rows BA no single sample decides.
pub(super) fn half_seen(moments: &Moments, swap: usize) -> bool {
    let sums = moments.swap(swap);
    sums.ba.is_none() && sums.base.bb < MIN_PART * (sums.base.aa + sums.base.bb)
}

/// The possible error of an estimate without spread.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unseen {
    /// Half width of its interval; 0 if the estimate is exact, or if no bound applies.
    pub half_width: f64,
    /// Influences up to this size are rounding.
    pub rounding: f64,
}

impl Unseen {
    const NONE: Self = Self { half_width: 0.0, rounding: 0.0 };

    /// Returns whether no part moves the estimate although rows might have.
    pub fn applies(&self, parts: &PartInfluences) -> bool {
        self.half_width > 0.0 && parts.iter().flatten().all(|influence| influence.abs() <= self.rounding)
    }
}

/// Returns for every quantity of [`super::estimates::quantities`] its possible error if its influences show no spread;
/// `values` are the quantities. Differences between estimators have none.
pub(super) fn unseen(layout: &Layout, moments: &Moments, values: &[f64]) -> Vec<Unseen> {
    let mut list = vec![Unseen::NONE; values.len()];
    let Some((low, high)) = moments.range() else { return list };
    // In two steps: the square of the range may overflow.
    let sd = moments.variance().sqrt();
    let spread = (high - low) / sd * ((high - low) / sd);
    let bound = |n: u64, part: f64| (RULE_OF_THREE / n as f64 * spread * part).min(1.0);
    let acts: Vec<bool> = (0..layout.swaps()).map(|swap| !moments.swap(swap).inert()).collect();
    let active = acts[..layout.factors].iter().filter(|acts| **acts).count();
    let place = |swap: usize, number: Number| layout.place(Quantity::Swap(swap, number));
    let mut most = 0.0f64;
    for swap in (0..layout.swaps()).filter(|swap| acts[*swap]) {
        let sums = moments.swap(swap);
        let total = values[place(swap, Number::Total)].abs().min(1.0);
        // A row adds at most R^2/V to a first-order index by Saltelli's formula, and half of that to the others.
        let first = bound(sums.base.n, if sums.ba.is_some() { 0.5 } else { 1.0 });
        let half = bound(sums.base.n, 0.5);
        let of_first = Unseen { half_width: first, rounding: ROUNDING * total.sqrt() };
        let of_total = Unseen { half_width: half, rounding: ROUNDING * total };
        for (number, unseen) in [(Number::FirstOrder, of_first), (Number::Total, of_total)] {
            list[place(swap, number)] = unseen;
        }
        // The share of the only factor with an effect is exactly 100 %.
        if active > 1 || swap >= layout.factors {
            let percent =
                |unseen: Unseen| Unseen { half_width: 100.0 * unseen.half_width, rounding: 100.0 * unseen.rounding };
            for (number, unseen) in [(Number::ShareFirstOrder, of_first), (Number::ShareTotal, of_total)] {
                list[place(swap, number)] = percent(unseen);
            }
        }
        for estimator in 0..layout.estimators.len() {
            for (number, unseen) in [(OtherNumber::FirstOrder, of_first), (OtherNumber::Total, of_total)] {
                list[layout.place(Quantity::Other(estimator, swap, number))] = unseen;
            }
        }
        if swap < layout.factors {
            most = most.max(first);
        }
    }
    for sum in [Quantity::SumFirstOrder, Quantity::SumTotal] {
        list[layout.place(sum)] = Unseen { half_width: most, rounding: ROUNDING };
    }
    if layout.second_order {
        for (pair, (j, k)) in layout.pair_list().into_iter().enumerate().filter(|(_, (j, k))| acts[*j] && acts[*k]) {
            let total = |swap: usize| values[place(swap, Number::Total)].abs().min(1.0);
            let n = moments.swap(j).base.n.min(moments.swap(k).base.n);
            let rounding = ROUNDING * (total(j) * total(k)).sqrt();
            list[layout.place(Quantity::Pair(pair))] = Unseen { half_width: bound(n, 1.0), rounding };
        }
    }
    if let Some(noise) = &layout.noise {
        let share_place = layout.place(Quantity::MeanShare);
        let share = values[share_place];
        let over_share = |of: Unseen| Unseen { half_width: of.half_width / share, rounding: of.rounding / share };
        list[share_place] = list[place(noise.factor, Number::Total)];
        for (swap, beside) in noise.swaps.iter().enumerate().filter(|_| share > 0.0) {
            if *beside != SwapNoise::Holds {
                list[layout.place(Quantity::MeanFirstOrder(swap))] = over_share(list[place(swap, Number::FirstOrder)]);
            }
            if let SwapNoise::With(joined) = *beside {
                list[layout.place(Quantity::MeanTotal(swap))] = over_share(list[place(joined, Number::Total)]);
            }
        }
    }
    list
}

#[cfg(test)]
mod tests;
