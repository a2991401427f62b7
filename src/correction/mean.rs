//! Corrected indices of the mean of a stochastic model over its noise.
//!
//! The mean has the variance V(E[y|x]) = V (1 - ST_n), n the noise. Its closed first-order indices are S/(1 - ST_n),
//! since the noise adds nothing to the variance of E[y|x_s]; its total indices are (ST_sn - ST_n)/(1 - ST_n), since all
//! effects of the other factors without s and the noise have the variance V (1 - ST_sn).

use super::error::CorrectionError;
use super::influenced::EstimateWithInfluences;
use super::kind::Corrected;
use crate::effect::{EffectQuantities, Layout, NoisePairing, Quantities};
use crate::uncertainty::{Estimate, Interval, Judgement};

/// The variance of the mean over the noise, as a share of the variance of a single run.
struct MeanShare<'a> {
    share: Estimate,
    /// The corrected total index of the noise, from which the share follows, and the error of such a difference.
    of_noise: Option<(&'a EstimateWithInfluences, CorrectionError)>,
}

/// Puts the corrected indices of the mean over the noise, if there is one, into `new`.
pub(super) fn correct_mean(
    layout: &Layout,
    corrected: &Corrected<'_>,
    plain: &Quantities<Judgement>,
    new: &mut Quantities<Option<Judgement>>,
) {
    let (Some(noise), Some(plain_share)) = (&layout.noise, &plain.mean_share) else { return };
    let of_noise = corrected.total.map(|of_kind| (&of_kind.list[noise.factor], of_kind.error.even()));
    let mut mean = MeanShare { share: plain_share.estimate, of_noise };
    if let Some((total, error)) = of_noise {
        let share = error.judgement(&EstimateWithInfluences::linear(1.0 - total.estimate, &[(-1.0, total)]));
        mean.share = share.estimate;
        new.mean_share = Some(Some(share));
    }
    for (at, (plain, pairing)) in plain.effects.iter().zip(&noise.pairings).enumerate() {
        let Some(of_mean) = &mut new.effects[at].of_mean else { continue };
        of_mean.first_order = mean.first_order(corrected.first_order.map(|of| (&of.list[at], of.error)), plain);
        if let (NoisePairing::PairedWith(joined), Some(total)) = (*pairing, corrected.total) {
            of_mean.total = Some(mean.total(&total.list[joined], plain));
        }
    }
}

impl MeanShare<'_> {
    /// Returns the first-order index of an effect with these `plain` quantities and this corrected first-order index.
    fn first_order(
        &self,
        corrected: Option<(&EstimateWithInfluences, CorrectionError)>,
        plain: &EffectQuantities<Judgement>,
    ) -> Option<Judgement> {
        let plain_index = &plain.of_mean.as_ref()?.first_order;
        if corrected.is_none() && self.of_noise.is_none() {
            return None;
        }
        if self.share.estimate <= 0.0 || self.share.estimate.is_nan() {
            return Some(Judgement::new(Estimate::alone(f64::NAN), plain_index.error, Vec::new()));
        }
        let index = match (corrected, self.of_noise) {
            (Some((first_order, _)), Some((of_noise, error))) => {
                let index = first_order.estimate / self.share.estimate;
                let terms = [(1.0 / self.share.estimate, first_order), (index / self.share.estimate, of_noise)];
                return Some(error.judgement(&EstimateWithInfluences::linear(index, &terms)));
            }
            (Some((first_order, error)), None) => quotient(error.estimate(first_order), self.share),
            (None, _) => quotient(plain.first_order.estimate, self.share),
        };
        // Errors of unknown correlation may be larger than those of the plain index, whose correlation is known.
        let is_narrower = width(index) < width(plain_index.estimate);
        is_narrower.then(|| Judgement::new(index, plain_index.error, Vec::new()))
    }

    /// Returns the total index of an effect with these `plain` quantities and this corrected `joint` index with the noise.
    fn total(&self, joint: &EstimateWithInfluences, plain: &EffectQuantities<Judgement>) -> Option<Judgement> {
        let (of_noise, error) = self.of_noise?;
        if self.share.estimate <= 0.0 || self.share.estimate.is_nan() {
            let error = plain.of_mean.as_ref()?.first_order.error;
            return Some(Judgement::new(Estimate::alone(f64::NAN), error, Vec::new()));
        }
        let index = (joint.estimate - of_noise.estimate) / self.share.estimate;
        let terms = [(1.0 / self.share.estimate, joint), ((index - 1.0) / self.share.estimate, of_noise)];
        Some(error.judgement(&EstimateWithInfluences::linear(index, &terms)))
    }
}

fn width(estimate: Estimate) -> f64 {
    estimate.interval.map_or(f64::INFINITY, Interval::width)
}

/// Returns the quotient of two numbers of unknown joint distribution, whose errors are of independent kinds.
fn quotient(a: Estimate, b: Estimate) -> Estimate {
    let estimate = a.estimate / b.estimate;
    let interval = a.interval.zip(b.interval).map(|(of_a, of_b)| {
        let below = [(a.estimate - of_a.low) / b.estimate, estimate * (of_b.high - b.estimate) / b.estimate];
        let above = [(of_a.high - a.estimate) / b.estimate, estimate * (b.estimate - of_b.low) / b.estimate];
        Interval { low: estimate - libm::hypot(below[0], below[1]), high: estimate + libm::hypot(above[0], above[1]) }
    });
    Estimate { estimate, interval }
}

#[cfg(test)]
#[path = "tests/mean.rs"]
mod tests;
