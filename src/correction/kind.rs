//! The corrected indices of one kind: first-order or total.

use super::error::CorrectionError;
use super::estimates::SurrogateEstimates;
use super::influenced::EstimateWithInfluences;
use crate::effect::{Effect, EffectQuantities, IndexPair, Quantities};
use crate::uncertainty::{Estimate, Judgement};

/// The kinds of indices that are corrected; `None` for a kind whose plain ones stay.
pub(super) struct Corrected<'a> {
    pub first_order: Option<&'a OfKind>,
    pub total: Option<&'a OfKind>,
}

/// The corrected indices of one kind, first-order or total, of all effects.
pub(super) struct OfKind {
    pub list: Vec<EstimateWithInfluences>,
    pub error: CorrectionError,
    /// The variance of the plain indices over that of the corrected ones; `None` if one of them is unknown.
    pub gain: Option<f64>,
    /// Distances of plain and corrected indices.
    pub gaps: Vec<f64>,
}

impl OfKind {
    /// Takes the kind that `read` and `read_plain` return. The indices of `exact` effects are the plain ones.
    pub fn new(
        plain: &[EffectQuantities<Judgement>],
        exact: &[bool],
        surrogate: &SurrogateEstimates,
        read: fn(&IndexPair<EstimateWithInfluences>) -> &EstimateWithInfluences,
        read_plain: fn(&EffectQuantities<Judgement>) -> &Judgement,
        is_total: bool,
    ) -> Self {
        let mut list: Vec<EstimateWithInfluences> = surrogate.effects.iter().map(|of| read(of).clone()).collect();
        for ((of, plain), _) in list.iter_mut().zip(plain).zip(exact).filter(|(_, exact)| **exact) {
            *of = of.exactly(read_plain(plain).estimate.estimate);
        }
        let is_moving = |at: &usize| !exact[*at] && plain[*at].effect != Effect::Dummy;
        let moving: Vec<usize> = (0..plain.len()).filter(is_moving).collect();
        let error = CorrectionError::new(moving.iter().map(|at| &list[*at].parts), is_total);
        let of_plain: f64 = moving.iter().map(|at| read_plain(&plain[*at]).error.error.powi(2)).sum();
        let prudent = error.prudent();
        let of_corrected: f64 = moving.iter().map(|at| prudent.error(&list[*at]).error.powi(2)).sum();
        let is_known = !moving.is_empty() && of_plain.is_finite() && of_corrected.is_finite();
        let gaps = moving.iter().map(|at| gap(read_plain(&plain[*at]).estimate, error.estimate(&list[*at]))).collect();
        Self { gain: is_known.then(|| of_plain / of_corrected.max(f64::MIN_POSITIVE)), list, error, gaps }
    }

    pub fn is_better(&self) -> bool {
        self.gain.is_some_and(|gain| gain > 1.0)
    }

    pub fn sum_of_inputs(&self, effects: &[EffectQuantities<Judgement>]) -> EstimateWithInfluences {
        sum(self.list.iter().zip(effects).filter(|(_, effect)| effect.effect.is_input()).map(|(of, _)| of))
    }

    /// Puts the indices of all effects, and the shares of factors and groups, into `new`, except those of `exact`
    /// effects. The noise of a stochastic model has no share.
    pub fn put(
        &self,
        new: &mut Quantities<Option<Judgement>>,
        exact: &[bool],
        index: fn(&mut EffectQuantities<Option<Judgement>>) -> &mut Option<Judgement>,
        share_of: fn(&mut EffectQuantities<Option<Judgement>>) -> &mut Option<Judgement>,
    ) {
        for ((new, of), _) in new.effects.iter_mut().zip(&self.list).zip(exact).filter(|(_, exact)| !**exact) {
            *index(new) = Some(self.error.judgement(of));
        }
        for is_of_kind in [Effect::is_factor, Effect::is_group] {
            let sharing: Vec<usize> = (0..exact.len()).filter(|at| is_of_kind(new.effects[*at].effect)).collect();
            let all = sum(sharing.iter().map(|at| &self.list[*at]));
            for &at in sharing.iter().filter(|at| !exact[**at] && all.estimate > 0.0) {
                *share_of(&mut new.effects[at]) = Some(self.error.even().judgement(&share(&self.list[at], &all)));
            }
        }
    }
}

impl Corrected<'_> {
    /// Returns the corrected interaction of the effect at `at` with these `plain` numbers.
    pub fn interaction(&self, at: usize, plain: &EffectQuantities<Judgement>) -> Option<Judgement> {
        // Of a corrected and a plain index the joint distribution is unknown, except that the errors are of independent
        // kinds.
        let estimate = match (self.first_order, self.total) {
            (Some(first_order), Some(total)) => {
                let terms = [(1.0, &total.list[at]), (-1.0, &first_order.list[at])];
                return Some(total.error.even().judgement(&EstimateWithInfluences::combined(&terms)));
            }
            (Some(first_order), None) => {
                Estimate::difference(first_order.error.estimate(&first_order.list[at]), plain.total.estimate)
            }
            (None, Some(total)) => {
                Estimate::difference(plain.first_order.estimate, total.error.estimate(&total.list[at]))
            }
            (None, None) => return None,
        };
        Some(Judgement::new(estimate, plain.interaction.error, Vec::new()))
    }
}

/// Returns the distance of two estimates of the same number, relative to their intervals; 0 if one of them has none.
pub(super) fn gap(plain: Estimate, corrected: Estimate) -> f64 {
    let (lower, upper) = if plain.estimate < corrected.estimate { (plain, corrected) } else { (corrected, plain) };
    let (Some(of_lower), Some(of_upper)) = (lower.interval, upper.interval) else { return 0.0 };
    let allowed = (of_lower.high - lower.estimate) + (upper.estimate - of_upper.low);
    if allowed > 0.0 { (upper.estimate - lower.estimate) / allowed } else { 0.0 }
}

fn sum<'a>(list: impl Iterator<Item = &'a EstimateWithInfluences>) -> EstimateWithInfluences {
    EstimateWithInfluences::combined(&list.map(|of| (1.0, of)).collect::<Vec<_>>())
}

/// Returns 100 part/all.
fn share(part: &EstimateWithInfluences, all: &EstimateWithInfluences) -> EstimateWithInfluences {
    let percent = 100.0 * part.estimate / all.estimate;
    EstimateWithInfluences::linear(percent, &[(100.0 / all.estimate, part), (-percent / all.estimate, all)])
}
