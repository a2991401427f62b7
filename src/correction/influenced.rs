//! A number with the influence of each part of the runs on it.

use crate::uncertainty::PartInfluences;

/// A number and its influences from the parts of every net.
#[derive(Debug, Clone, PartialEq)]
pub struct EstimateWithInfluences {
    /// The number.
    pub estimate: f64,
    /// The mean influence of the points of every part, `[net][part]`.
    pub parts: PartInfluences,
    /// The same for the runs of a low-fidelity model, which are independent of the others; empty without one.
    pub low: PartInfluences,
    /// Standard error that no runs show, from the tails of a surrogate.
    pub beyond: f64,
}

impl EstimateWithInfluences {
    /// Returns the exact number `estimate`, independent of the rows.
    pub(super) fn exactly(&self, estimate: f64) -> Self {
        Self { estimate, parts: zeros(&self.parts), low: zeros(&self.low), beyond: 0.0 }
    }

    /// Returns a weighted sum of numbers.
    pub fn combined(list: &[(f64, &Self)]) -> Self {
        Self::linear(list.iter().map(|(weight, of)| weight * of.estimate).sum(), list)
    }

    /// Returns its quotient by `whole`.
    pub fn over(&self, whole: &Self) -> Self {
        let (estimate, scale) = (self.estimate / whole.estimate, 1.0 / whole.estimate);
        Self::linear(estimate, &[(scale, self), (-estimate * scale, whole)])
    }

    /// Returns the number `estimate`, which changes by a weighted sum of the changes of others.
    pub fn linear(estimate: f64, list: &[(f64, &Self)]) -> Self {
        // These errors have a common cause, so they add linearly.
        let beyond = list.iter().map(|(weight, of)| weight.abs() * of.beyond).sum();
        let parts = weighted_sum(list.iter().map(|(weight, of)| (*weight, &of.parts)));
        let low = weighted_sum(list.iter().map(|(weight, of)| (*weight, &of.low)));
        Self { estimate, parts, low, beyond }
    }
}

/// Returns a weighted sum of influences of parts of the same sizes.
fn weighted_sum<'a>(list: impl Iterator<Item = (f64, &'a PartInfluences)>) -> PartInfluences {
    let mut list = list.peekable();
    let mut sums = list.peek().map_or_else(Vec::new, |(_, parts)| zeros(parts));
    for (weight, parts) in list {
        for (sums, more) in sums.iter_mut().zip(parts) {
            for (sum, more) in sums.iter_mut().zip(more) {
                *sum += weight * more;
            }
        }
    }
    sums
}

/// Returns parts of the same sizes without influence.
fn zeros(parts: &PartInfluences) -> PartInfluences {
    parts.iter().map(|net| vec![0.0; net.len()]).collect()
}
