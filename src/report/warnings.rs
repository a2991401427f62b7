//! What a careful reader of a result should know, in sentences.

use super::result::OutputRecord;
use crate::study::Study;
use crate::uncertainty::{Estimate, ReplicatedIndices};

/// Warnings about the runs behind an output.
pub(super) fn of_runs(study: &Study, record: &OutputRecord) -> Vec<String> {
    let mut warnings = Vec::new();
    let design = &study.design;
    if record.runs_failed > 0 {
        let left_out = design.settings().base_samples - record.base_points_used;
        warnings.push(format!(
            "{} of {} runs failed, so {left_out} of {} base points are left out: the indices describe the part of the \
             factor space where every run succeeds",
            record.runs_failed,
            design.rows(),
            design.settings().base_samples
        ));
    }
    if !design.balanced() {
        let points = design.points_per_replicate();
        warnings.push(format!(
            "{points} base points in each replicate are not a power of two: Sobol' points lose much of their accuracy; \
             base_samples = {} or {} would be better",
            points.next_power_of_two() / 2 * design.settings().replicates,
            points.next_power_of_two() * design.settings().replicates
        ));
    }
    if design.settings().replicates == 1 {
        warnings.push("a single replicate says nothing about its error: no intervals".to_owned());
    }
    warnings
}

/// Warnings about indices that cannot all be right. Each compares an estimate with its interval, so that the noise of
/// a small sample does not raise it.
pub(super) fn of_indices(study: &Study, indices: &ReplicatedIndices) -> Vec<String> {
    let mut warnings = Vec::new();
    let names = study.space.factors().iter().map(|factor| factor.name.clone());
    let names = names.chain(study.space.groups().into_iter().map(|group| group.name));
    for (name, effect) in names.zip(indices.factors.iter().chain(&indices.groups)) {
        if clearly_above(effect.first_order, high(effect.total)) {
            warnings.push(format!(
                "{name}: the first-order index {:.4} exceeds the total index {:.4} beyond their intervals: too few samples",
                effect.first_order.estimate, effect.total.estimate
            ));
        }
        if differs_clearly(effect.check_gap) {
            warnings.push(format!(
                "{name}: two formulas for the first-order index differ by {:.2e}, beyond the error of their difference: \
                 too few samples, or a heavy-tailed output (its logarithm may serve better)",
                effect.check_gap.estimate.abs()
            ));
        }
    }
    if indices.sum_first_order.interval.is_some_and(|interval| interval.low <= 0.0) {
        warnings.push(
            "the sum of the first-order indices may be 0: the output comes from interactions, and shares of the \
             first-order indices mean nothing"
                .to_owned(),
        );
    }
    if clearly_above(indices.sum_first_order, Some(1.0)) {
        warnings.push(format!(
            "the first-order indices sum to {:.4}, beyond 1 by more than their error: too few samples",
            indices.sum_first_order.estimate
        ));
    }
    if high(indices.sum_total).is_some_and(|high| high < 1.0) {
        warnings.push(format!(
            "the total indices sum to {:.4}, below 1 by more than their error: too few samples",
            indices.sum_total.estimate
        ));
    }
    warnings
}

fn high(estimate: Estimate) -> Option<f64> {
    estimate.interval.map(|interval| interval.high)
}

fn clearly_above(estimate: Estimate, bound: Option<f64>) -> bool {
    matches!((estimate.interval, bound), (Some(interval), Some(bound)) if interval.low > bound)
}

/// Zero lies outside an interval of twice the width: 1 in 1500 by chance with 16 replicates, where 1 in 20 would cry
/// wolf in every study of eight factors.
fn differs_clearly(gap: Estimate) -> bool {
    gap.interval.is_some_and(|interval| gap.estimate.abs() > interval.high - interval.low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::Interval;

    fn estimate(low: f64, high: f64) -> Estimate {
        Estimate { estimate: (low + high) / 2.0, interval: Some(Interval { low, high }) }
    }

    #[test]
    fn only_clear_contradictions_count() {
        assert!(!clearly_above(estimate(0.9, 1.2), Some(1.0)));
        assert!(clearly_above(estimate(1.1, 1.2), Some(1.0)));
        assert!(!clearly_above(Estimate { estimate: 2.0, interval: None }, Some(1.0)));
        assert!(!differs_clearly(estimate(0.001, 0.021)));
        assert!(differs_clearly(estimate(0.02, 0.04)));
        assert!(!differs_clearly(estimate(0.0, 0.0)));
    }
}
