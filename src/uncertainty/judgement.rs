//! Estimates with all known facts about their errors.

use super::by_points::Bounds;
use super::concentration::interval;
use super::influence::Influences;
use super::method::IntervalMethod;
use super::standard_error::{ErrorKind, PartInfluences, StandardError};
use super::unseen::Unseen;
use super::{Estimate, Interval, NORMAL_QUANTILE};
use crate::effect::{EffectQuantities, IndexPair};

/// An estimate, its interval, its error, and the influences of the parts of the runs on it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Judgement {
    pub estimate: Estimate,
    pub error: StandardError,
    pub parts: PartInfluences,
    /// Whether its error is a bound on what the rows cannot show, since they show no spread.
    pub is_bound: bool,
}

impl Judgement {
    /// Returns the judgement of a number with this interval and error.
    pub fn new(estimate: Estimate, error: StandardError, parts: PartInfluences) -> Self {
        Self { estimate, error, parts, is_bound: false }
    }

    /// Computes errors of these kinds from the nets.
    pub fn from_nets(influences: Influences, method: IntervalMethod, kinds: &[ErrorKind]) -> Vec<Self> {
        let errors = method.errors(&influences.parts, kinds);
        let mut judgements = Vec::with_capacity(errors.len());
        for (((estimate, parts), error), kind) in
            influences.estimates.into_iter().zip(influences.parts).zip(errors).zip(kinds)
        {
            let interval = interval(estimate, error, &parts, kind.side);
            judgements.push(Self::new(Estimate { estimate, interval }, error, parts));
        }
        judgements
    }

    /// Combines estimates with errors and intervals from elsewhere.
    pub fn with_bounds(influences: Influences, bounds: Vec<Bounds>) -> Vec<Self> {
        let numbers = influences.estimates.into_iter().zip(influences.parts).zip(bounds);
        numbers
            .map(|((estimate, parts), (error, interval))| Self::new(Estimate { estimate, interval }, error, parts))
            .collect()
    }

    /// Sets the error that the rows cannot show if no part has an influence, or if the nets agree to rounding. An index
    /// of 0 is missed only above.
    pub fn allow_for_unseen(&mut self, unseen: Unseen) {
        let estimate = self.estimate.estimate;
        let is_equal = unseen.applies(&self.parts) || self.error.error <= unseen.rounding;
        if unseen.half_width > 0.0 && estimate.is_finite() && self.error.error.is_finite() && is_equal {
            let low = if estimate == 0.0 { 0.0 } else { estimate - unseen.half_width };
            self.estimate.interval = Some(Interval { low, high: estimate + unseen.half_width });
            self.error.error = unseen.half_width / NORMAL_QUANTILE;
            self.is_bound = true;
        }
    }
}

impl EffectQuantities<Judgement> {
    /// Lowers the bounds of an effect that no row shows to `most`, the largest total index that a surrogate leaves it.
    pub(crate) fn bound(&mut self, most: f64) {
        let IndexPair { first_order, total } = &mut self.shares;
        let indices = [&mut self.first_order, &mut self.total, &mut self.interaction].map(|index| (index, most));
        for (judgement, most) in indices.into_iter().chain([first_order, total].map(|share| (share, 100.0 * most))) {
            if let Some(interval) = &mut judgement.estimate.interval {
                interval.high = interval.high.min(most);
                judgement.error.error = judgement.error.error.min(most / NORMAL_QUANTILE);
            }
        }
    }

    /// Bounds the first-order index from above only by the total index, and the interaction accordingly; returns by how
    /// much the bound rises.
    pub(crate) fn allow_for_half_seen(&mut self) -> f64 {
        let (Some(total), Some(first)) = (self.total.estimate.interval, &mut self.first_order.estimate.interval) else {
            return 0.0;
        };
        let more = total.high - first.high;
        if more <= 0.0 {
            return 0.0;
        }
        first.high = total.high;
        if let Some(interaction) = &mut self.interaction.estimate.interval {
            interaction.low -= more;
        }
        more
    }
}
