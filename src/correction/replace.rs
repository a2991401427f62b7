//! Replacement of plain indices by corrected ones, if their errors are smaller.

use super::estimates::SurrogateEstimates;
use super::kind::{Corrected, OfKind};
use super::mean::correct_mean;
use super::surrogate_use::{Refusal, SurrogateUse};
use crate::effect::{Layout, OfPair, Quantities};
use crate::uncertainty::{Estimate, Interval, Judgement};

/// Distance of plain and corrected indices, relative to their intervals, above which the corrected ones are refused: of
/// one index, and the root mean square over those of one kind. For smooth functions, where the corrected ones are
/// right, the largest in several hundred runs at 16 to 1024 base samples was 6.0, and 2.4 jointly.
const CONTRADICTION: f64 = 10.0;
const JOINT_CONTRADICTION: f64 = 6.0;

/// The same distance above which intervals include both.
const DOUBT: f64 = 3.0;
const JOINT_DOUBT: f64 = 1.5;

/// Replaces the `plain` quantities by corrected ones where their errors are smaller; returns also the use of the
/// surrogates. The indices of the effects that are `exact`, by position, stay.
pub(crate) fn correct(
    plain: Quantities<Judgement>,
    layout: &Layout,
    surrogate: &SurrogateEstimates,
    exact: &[bool],
) -> (Quantities<Judgement>, SurrogateUse) {
    let first_order =
        OfKind::new(&plain.effects, exact, surrogate, |pair| &pair.first_order, |of| &of.first_order, false);
    let total = OfKind::new(&plain.effects, exact, surrogate, |pair| &pair.total, |of| &of.total, true);
    // A surrogate that equals the output at all rows of the other nets differs from plain indices by their error alone.
    let kinds: &[&[f64]] = if surrogate.is_exact() { &[] } else { &[&first_order.gaps, &total.gaps] };
    let gaps = Gaps::new(kinds);
    let refusal = surrogate.refusal().or_else(|| gaps.refusal());
    let used = SurrogateUse {
        explained: surrogate.explained,
        term_count: surrogate.term_count,
        terms: surrogate.terms.clone(),
        is_heavy_tailed: surrogate.is_heavy_tailed,
        corrects_first_order: refusal.is_none() && first_order.is_better(),
        corrects_total: refusal.is_none() && total.is_better(),
        gain_first_order: first_order.gain,
        gain_total: total.gain,
        is_doubted: false,
        refusal,
        low: surrogate.low.clone(),
    };
    let used = SurrogateUse { is_doubted: used.corrects() && gaps.is_doubt(), ..used };
    // What most of the variance is claimed for and no row shows is not excluded: intervals of plain indices include it.
    let is_claimed = surrogate.refusal().is_some();
    let corrected = Corrected {
        first_order: (used.corrects_first_order || is_claimed).then_some(&first_order),
        total: (used.corrects_total || is_claimed).then_some(&total),
    };
    let mut new = plain.clone().map(|_, _| None);
    if let Some(first_order) = corrected.first_order {
        first_order.put(&mut new, exact, |of| &mut of.first_order, |of| &mut of.shares.first_order);
        new.sums.first_order = Some(first_order.error.judgement(&first_order.sum_of_inputs(&plain.effects)));
        for (OfPair { factors: (j, k), value }, index) in new.pairs.iter_mut().zip(&surrogate.pairs) {
            *value = (!exact[*j] && !exact[*k]).then(|| first_order.error.judgement(index));
        }
    }
    if let Some(total) = corrected.total {
        total.put(&mut new, exact, |of| &mut of.total, |of| &mut of.shares.total);
        new.sums.total = Some(total.error.judgement(&total.sum_of_inputs(&plain.effects)));
    }
    for (at, new) in new.effects.iter_mut().enumerate().filter(|(at, _)| !exact[*at]) {
        new.interaction = corrected.interaction(at, &plain.effects[at]);
    }
    correct_mean(layout, &corrected, &plain, &mut new);
    let is_doubted = surrogate.is_uncertain() || gaps.is_doubt();
    let corrected = plain.zip(new.into_list()).map(|_, (plain, new)| match new {
        None => plain,
        Some(new) if is_claimed => {
            let interval = hull(new.estimate.interval, plain.estimate.interval).or(plain.estimate.interval);
            Judgement { estimate: Estimate { interval, ..plain.estimate }, ..plain }
        }
        Some(new) if is_doubted => {
            let interval = hull(new.estimate.interval, plain.estimate.interval);
            Judgement { estimate: Estimate { interval, ..new.estimate }, ..plain }
        }
        Some(new) if new.parts.is_empty() => Judgement { parts: plain.parts, ..new },
        Some(new) => new,
    });
    (corrected, used)
}

/// Distances of plain and corrected indices, relative to both errors.
struct Gaps {
    /// The largest distance of one index.
    largest: f64,
    /// The root mean square distance of the indices of one kind.
    joint: f64,
}

impl Gaps {
    /// Computes them from the distances of each kind.
    fn new(kinds: &[&[f64]]) -> Self {
        Self {
            largest: kinds.iter().copied().flatten().copied().fold(0.0, f64::max),
            joint: kinds.iter().map(|gaps| root_mean_square(gaps)).fold(0.0, f64::max),
        }
    }

    /// Returns a refusal if both cannot be true.
    fn refusal(&self) -> Option<Refusal> {
        let is_contradiction = self.largest > CONTRADICTION || self.joint > JOINT_CONTRADICTION;
        is_contradiction.then_some(Refusal::Contradiction { times: self.largest })
    }

    /// Returns whether one of them may be wrong.
    fn is_doubt(&self) -> bool {
        self.largest > DOUBT || self.joint > JOINT_DOUBT
    }
}

fn root_mean_square(list: &[f64]) -> f64 {
    (list.iter().map(|x| x * x).sum::<f64>() / list.len().max(1) as f64).sqrt()
}

/// Returns the interval that contains both, or `None` if one of them is unknown.
pub(crate) fn hull(a: Option<Interval>, b: Option<Interval>) -> Option<Interval> {
    a.zip(b).map(|(a, b)| Interval { low: a.low.min(b.low), high: a.high.max(b.high) })
}

#[cfg(test)]
#[path = "tests/replace.rs"]
mod tests;
