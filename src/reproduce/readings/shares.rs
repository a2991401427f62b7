//! Percentages of the indices of a result.

use super::{Effect, Share};
use crate::reproduce::published;
use apportion::report::{EffectRecord, EstimateRecord, OutputRecord};

/// The printed percentage of `factor` in the study `group`.
pub(super) fn printed(group: &str, factor: &str) -> Option<f64> {
    published(group, "lugre").shares.iter().find(|(name, _)| *name == factor).map(|(_, share)| *share)
}

/// The percentages of all factors of an output by an effect that is read from indices; or why there are none.
pub(super) fn of_record(record: &OutputRecord, group: &str, effect: Effect) -> Result<Vec<Share>, String> {
    let Some(indices) = &record.indices else {
        return Err(record.reason.clone().unwrap_or_else(|| "there are no indices".to_owned()));
    };
    let share = |factor: &str, indices: &EffectRecord| {
        let (share, interval) = match effect {
            Effect::FirstOrder => {
                (indices.share_first_order?, indices.share_first_order_interval.map(|i| (i.low, i.high)))
            }
            Effect::Total => (indices.share_total?, indices.share_total_interval.map(|i| (i.low, i.high))),
            Effect::PlainFirstOrder => in_percent(indices.first_order),
            Effect::PlainTotal => in_percent(indices.total),
            Effect::VarianceAlone | Effect::RangeAlone => return None,
        };
        Some(Share { factor: factor.to_owned(), share, interval, published: printed(group, factor) })
    };
    indices
        .iter()
        .map(|index| share(&index.factor, &index.effect))
        .collect::<Option<_>>()
        .ok_or_else(|| "the indices do not sum to a positive number".to_owned())
}

fn in_percent(index: EstimateRecord) -> (f64, Option<(f64, f64)>) {
    let interval = index.low.zip(index.high).map(|(low, high)| (100.0 * low, 100.0 * high));
    (100.0 * index.estimate, interval)
}
