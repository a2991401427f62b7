//! Errors of indices whose rows show no spread.
//!
//! An output with few values, such as 0 and 1, can give an index without any spread: a first-order index of exactly 0
//! because no base point changed the output in both of its rows, or an index that is the same in every part. The spread
//! is then 0, although the index may be wrong. All that is known is that n rows did not show a contribution of another
//! kind: by the rule of three (Hanley and Lippman-Hand 1983, JAMA 249, 1743-1745), such rows are fewer than 3 in n, at
//! 95 %. Each moves the index by at most what the range of the output allows. The same holds for a factor that leaves the
//! output unchanged in every row: only one that the model does not read has an error of 0.

use super::standard_error::PartInfluences;
use crate::effect::{Effect, EffectQuantities, IndexPair, Layout, NoisePairing, Quantities};
use crate::estimate::{Moments, SwapMoments};

/// Upper bound at 95 % of the expected number of rows of a kind not seen in n rows: -ln 0.05.
pub(crate) const RULE_OF_THREE: f64 = 2.995_732_273_553_991;

/// Influences up to this share of the size of an index are rounding: at most about 64 units in the last place, times
/// n/n_p for leaving out one of 256 parts.
const ROUNDING: f64 = 1e-11;

/// Minimum part of B in the sum of squares of A and B for which the spread of first-order indices by rows AB is valid.
const MIN_PART: f64 = 0.2;

/// Returns whether the sample B has hardly any of the large outputs: the formula sum (y_B - f0)(y_AB - y_A) then misses
/// their contribution to a first-order index, and its spread does not show it. With rows BA no single sample decides.
pub(crate) fn half_seen(moments: &Moments, swap: usize) -> bool {
    let sums = moments.swap(swap);
    sums.ba.is_none() && sums.base.bb < MIN_PART * (sums.base.aa + sums.base.bb)
}

/// The possible error of an estimate without spread.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unseen {
    /// Half width of its interval; 0 if the estimate is exact, or if no bound applies.
    pub half_width: f64,
    /// Influences up to this size are rounding.
    pub rounding: f64,
}

impl Unseen {
    const NONE: Self = Self { half_width: 0.0, rounding: 0.0 };

    fn map(self, change: impl Fn(f64) -> f64) -> Self {
        Self { half_width: change(self.half_width), rounding: change(self.rounding) }
    }

    /// Returns whether no part moves the estimate although rows might have.
    pub fn applies(&self, parts: &PartInfluences) -> bool {
        self.half_width > 0.0 && parts.iter().flatten().all(|influence| influence.abs() <= self.rounding)
    }
}

/// Returns the possible error of every quantity if its influences show no spread; `values` are the quantities, and
/// `unread` the effects that the model does not read, by position. Differences between estimators have none.
pub(crate) fn unseen(
    layout: &Layout,
    moments: &Moments,
    values: &Quantities<f64>,
    unread: &[bool],
) -> Quantities<Unseen> {
    let mut all = values.clone().map(|_, _| Unseen::NONE);
    let Some((low, high)) = moments.range() else { return all };
    // In two steps: the square of the range may overflow.
    let sd = moments.variance().sqrt();
    let spread = (high - low) / sd * ((high - low) / sd);
    let inputs = layout.inputs();
    let is_unread = |at: usize, sums: &SwapMoments| {
        sums.inert() && (layout.effects[at] == Effect::Dummy || unread.get(at).is_some_and(|unread| *unread))
    };
    let is_alone = (0..inputs).filter(|at| !is_unread(*at, moments.swap(*at))).count() <= 1;
    for (at, (unseen, value)) in all.effects.iter_mut().zip(&values.effects).enumerate() {
        let sums = moments.swap(layout.swap(at));
        if !is_unread(at, sums) {
            // The share of the only factor with an effect is exactly 100 %.
            unseen.allow_for_rows(sums, spread, value.total, !(is_alone && value.effect.is_input()));
        }
    }
    for (at, (unseen, value)) in all.redrawn.iter_mut().zip(&values.redrawn).enumerate() {
        let sums = moments.swap(layout.redrawn_swap(at));
        if !is_unread(at, sums) {
            unseen.allow_for_rows(sums, spread, value.total, true);
        }
    }
    let largest = all.effects[..inputs].iter().map(|effect| effect.first_order.half_width).fold(0.0, f64::max);
    let of_sum = Unseen { half_width: largest, rounding: ROUNDING };
    all.sums = IndexPair { first_order: of_sum, total: of_sum };
    for pair in &mut all.pairs {
        let (j, k) = (moments.swap(pair.factors.0), moments.swap(pair.factors.1));
        if !is_unread(pair.factors.0, j) && !is_unread(pair.factors.1, k) {
            let total = |factor: usize| values.effects[factor].total.abs().min(1.0);
            let rounding = ROUNDING * (total(pair.factors.0) * total(pair.factors.1)).sqrt();
            pair.value = Unseen { half_width: bound(j.base.n.min(k.base.n), spread, 1.0), rounding };
        }
    }
    if let (Some(noise), Some(share)) = (&layout.noise, values.mean_share) {
        all.mean_share = Some(all.effects[noise.factor].total);
        if share > 0.0 {
            allow_for_mean(&mut all.effects, &noise.pairings, share);
        }
    }
    all
}

/// Returns the largest change of an index by rows of a kind not seen in `n` rows, each of which adds at most `part` of
/// R^2/V, the square of the range over the variance.
fn bound(n: u64, spread: f64, part: f64) -> f64 {
    (RULE_OF_THREE / n as f64 * spread * part).min(1.0)
}

/// Sets the possible errors of indices of the mean over the noise, which has the `share` of the variance.
fn allow_for_mean(effects: &mut [EffectQuantities<Unseen>], pairings: &[NoisePairing], share: f64) {
    let totals: Vec<Unseen> = effects.iter().map(|effect| effect.total).collect();
    for (effect, pairing) in effects.iter_mut().zip(pairings) {
        let Some(of_mean) = &mut effect.of_mean else { continue };
        of_mean.first_order = effect.first_order.map(|x| x / share);
        if let NoisePairing::PairedWith(joined) = *pairing {
            of_mean.total = Some(totals[joined].map(|x| x / share));
        }
    }
}

impl EffectQuantities<Unseen> {
    /// Sets the possible errors of an effect with these sums and `total` index.
    fn allow_for_rows(&mut self, sums: &SwapMoments, spread: f64, total: f64, has_share: bool) {
        let total = total.abs().min(1.0);
        // A row adds at most R^2/V to a first-order index by Saltelli's formula, and half of that to the others.
        let part = if sums.ba.is_some() { 0.5 } else { 1.0 };
        self.first_order = Unseen { half_width: bound(sums.base.n, spread, part), rounding: ROUNDING * total.sqrt() };
        self.total = Unseen { half_width: bound(sums.base.n, spread, 0.5), rounding: ROUNDING * total };
        if sums.inert() {
            self.interaction = self.total;
        }
        if has_share {
            self.shares =
                IndexPair { first_order: self.first_order.map(|x| 100.0 * x), total: self.total.map(|x| 100.0 * x) };
        }
        for other in &mut self.others {
            (other.first_order, other.total) = (self.first_order, self.total);
        }
    }
}

#[cfg(test)]
#[path = "tests/unseen.rs"]
mod tests;
