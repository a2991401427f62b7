//! Conversion of the estimates of an output to its indices by name.

use super::output_indices::{EffectIndices, OutputIndices};
use super::stages::Stage;
use crate::correction::SurrogateUse;
use crate::effect::{Effect, IndexPair, OfMean};
use crate::estimate::{FirstOrder, Total};
use crate::result::{EstimatorRecord, Named, NoiseRecord, OutputResult, PairRecord, StageRecord, SurrogateRecord};
use crate::study::{Study, StudyEffect};
use crate::uncertainty::{EffectEstimates, Estimate};

/// Adds `indices` to `record`, with the names of their factors, groups and subsets.
pub(super) fn add_indices(record: &mut OutputResult, study: &Study, indices: &OutputIndices) {
    let effects = study.effects();
    if study.space.copula().is_none() {
        record.sum_first_order = Some(indices.sums.first_order);
        record.sum_total = Some(indices.sums.total);
    }
    let (mut factors, mut groups, mut subsets) = (Vec::new(), Vec::new(), Vec::new());
    for (effect, of) in effects.iter().zip(&indices.effects) {
        match effect.effect {
            Effect::Factor(_) => factors.push(named(study, effect, of.estimates)),
            Effect::Group(_) => groups.push(named(study, effect, of.estimates)),
            Effect::Subset(_) => subsets.push(named(study, effect, of.estimates)),
            Effect::Dummy => record.dummy = Some(of.estimates),
            Effect::Noise => record.noise = noise_record(study, effect, of, &effects, indices),
        }
    }
    (record.indices, record.groups, record.subsets) = (Some(factors), Some(groups), Some(subsets));
    if study.analysis.second_order {
        let name = |position: usize| effects[position].name.clone();
        let pairs = indices.pairs.iter();
        let records =
            pairs.map(|pair| PairRecord { factors: [name(pair.factors.0), name(pair.factors.1)], index: pair.value });
        record.second_order = Some(records.collect());
    }
    record.estimators = estimator_records(study, &effects, indices);
    record.surrogate = indices.surrogate.as_ref().map(|used| surrogate_record(study, &effects, indices, used));
}

/// Returns what belongs to `effect` under its name.
pub(super) fn named<T>(study: &Study, effect: &StudyEffect, of: T) -> Named<T> {
    let factors = match effect.effect {
        Effect::Group(_) | Effect::Subset(_) => &effect.factors[..],
        _ => &[],
    };
    let factors = factors.iter().map(|&number| study.space.factors()[number].name.clone()).collect();
    Named { name: effect.name.clone(), factors, effect: of }
}

fn noise_record(
    study: &Study,
    effect: &StudyEffect,
    noise: &EffectIndices,
    effects: &[StudyEffect],
    indices: &OutputIndices,
) -> Option<NoiseRecord> {
    let real = effects.iter().zip(&indices.effects).filter(|(effect, _)| effect.effect != Effect::Dummy);
    let of_mean = real.filter_map(|(effect, of)| {
        let OfMean { first_order, total } = of.of_mean?;
        Some(named(study, effect, IndexPair { first_order, total: total.flatten() }))
    });
    let (name, of_mean) = (effect.name.clone(), of_mean.collect());
    Some(NoiseRecord { name, effect: noise.estimates, mean_share: indices.mean_share?, of_mean })
}

/// Returns the records of all effects except the noise, which has its own entry.
fn other_records(
    study: &Study,
    effects: &[StudyEffect],
    indices: &OutputIndices,
    read: impl Fn(&EffectIndices) -> IndexPair<Option<Estimate>>,
) -> Vec<Named<IndexPair<Option<Estimate>>>> {
    let effects = effects.iter().zip(&indices.effects).filter(|(effect, _)| effect.effect != Effect::Noise);
    effects.map(|(effect, of)| named(study, effect, read(of))).collect()
}

fn surrogate_record(
    study: &Study,
    effects: &[StudyEffect],
    indices: &OutputIndices,
    used: &SurrogateUse,
) -> SurrogateRecord {
    let names: Vec<&str> = study.space.factors().iter().map(|factor| factor.name.as_str()).collect();
    SurrogateRecord {
        explained: used.explained,
        terms: used.term_count,
        corrects_first_order: used.corrects_first_order,
        corrects_total: used.corrects_total,
        gain_first_order: used.gain_first_order,
        gain_total: used.gain_total,
        leading_terms: used.terms.iter().map(|term| term.named(&names)).collect(),
        plain: match indices.effects.iter().any(|of| of.plain.is_some()) {
            true => other_records(study, effects, indices, |of| of.plain.map(|of| of.map(Some)).unwrap_or_default()),
            false => Vec::new(),
        },
        low: used.low.clone(),
    }
}

fn estimator_records(study: &Study, effects: &[StudyEffect], indices: &OutputIndices) -> Vec<EstimatorRecord> {
    let mut records = Vec::new();
    for (number, estimator) in study.analysis.estimators.iter().enumerate() {
        let (first_order, total) = estimator.formulas();
        records.push(EstimatorRecord {
            estimator: estimator.name().to_owned(),
            first_order_source: first_order.map(FirstOrder::source).map(str::to_owned),
            total_source: total.map(Total::source).map(str::to_owned),
            indices: other_records(study, effects, indices, |of| {
                let other = of.checks.others[number];
                IndexPair { first_order: other.first_order, total: other.total }
            }),
        });
    }
    records
}

/// Returns the indices at a stage of the run.
pub(super) fn stage_record(study: &Study, stage: &Stage, runs_per_point: u64) -> StageRecord {
    let effects = study.effects().into_iter().zip(&stage.indices.effects);
    let factors = effects.filter(|(effect, _)| effect.effect.is_factor());
    let indices = factors.map(|(effect, of)| {
        let EffectEstimates { first_order, total, .. } = of.estimates;
        named(study, &effect, IndexPair { first_order, total })
    });
    StageRecord {
        base_samples: stage.base_samples,
        model_runs: stage.base_samples * runs_per_point,
        largest_half_width: stage.indices.largest_half_width(),
        indices: indices.collect(),
    }
}
