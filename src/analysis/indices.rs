//! Conversion of the estimates of an output, by index, to its indices by name.

use super::finished_run::names_of_swaps;
use crate::estimate::{Estimator, FirstOrder, Total};
use crate::result::{
    EstimatorRecord, GroupRecord, IndexRecord, NoiseRecord, OtherIndexRecord, OutputResult, PairRecord,
    PlainIndexRecord, StageRecord, SubsetRecord, SurrogateRecord,
};
use crate::space::Group;
use crate::study::Study;
use crate::uncertainty::{
    EffectChecks, EffectEstimates, Estimate, MeanEstimates, NoiseIndices, OtherEstimates, OutputIndices, Stage,
    SurrogateUse,
};

/// Adds `indices` to `record`, with the names of their factors, groups and subsets.
pub(super) fn add_indices(record: &mut OutputResult, study: &Study, indices: &OutputIndices) {
    let factors = study.space.factors();
    let names = |numbers: &[usize]| numbers.iter().map(|&number| factors[number].name.clone()).collect::<Vec<_>>();
    if study.space.copula().is_none() {
        record.sum_first_order = Some(indices.sum_first_order);
        record.sum_total = Some(indices.sum_total);
    }
    let members = study.analysis.members(&study.space);
    let of_member = |(member, &effect): (&Group, _)| IndexRecord { factor: member.name.clone(), effect };
    record.indices = Some(without_noise(study, members.iter().zip(&indices.factors).map(of_member)));
    record.noise = indices.noise.as_ref().map(|noise| noise_record(study, indices, noise));
    let groups = study.analysis.further_groups(&study.space).into_iter().zip(&indices.groups);
    let of_group =
        groups.map(|(group, &effect)| GroupRecord { factors: names(&group.factors), group: group.name, effect });
    record.groups = Some(of_group.collect());
    let subsets = study.analysis.subsets.iter().zip(&indices.subsets);
    record.subsets = Some(subsets.map(|(numbers, &effect)| SubsetRecord { factors: names(numbers), effect }).collect());
    record.dummy = indices.dummy;
    if study.analysis.second_order {
        let of_pair = |((j, k), index): ((usize, usize), &Estimate)| PairRecord {
            factors: [j, k].map(|number| members[number].name.clone()),
            index: *index,
        };
        let pairs = study.layout().pair_list();
        record.second_order = Some(pairs.into_iter().zip(&indices.second_order).map(of_pair).collect());
    }
    record.estimators = estimator_records(study, indices);
    record.surrogate = indices.surrogate.as_ref().map(|used| surrogate_record(study, used));
}

fn noise_record(study: &Study, indices: &OutputIndices, noise: &NoiseIndices) -> NoiseRecord {
    let names = names_of_swaps(study).into_iter().zip(&noise.of_mean).take(indices.effects().count());
    let real = names.take(study.layout().swaps() - usize::from(study.analysis.dummy));
    let of_mean = real.filter_map(|(name, of)| {
        let MeanEstimates { first_order, total } = *of.as_ref()?;
        Some(OtherIndexRecord { name, first_order, total })
    });
    NoiseRecord {
        name: study.space.factors()[noise.factor].name.clone(),
        effect: indices.factors[noise.factor],
        mean_share: noise.mean_share,
        of_mean: of_mean.collect(),
    }
}

/// Returns the records of all swaps except the noise, which has its own entry.
fn without_noise<T>(study: &Study, of_swaps: impl Iterator<Item = T>) -> Vec<T> {
    let noise = study.space.noise();
    of_swaps.enumerate().filter(|(swap, _)| Some(*swap) != noise).map(|(_, of)| of).collect()
}

fn surrogate_record(study: &Study, used: &SurrogateUse) -> SurrogateRecord {
    let names: Vec<&str> = study.space.factors().iter().map(|factor| factor.name.as_str()).collect();
    let plain = used.plain_first_order.iter().zip(&used.plain_total);
    let of_swap = |(name, (first_order, total)): (String, (&Estimate, &Estimate))| OtherIndexRecord {
        name,
        first_order: Some(*first_order),
        total: Some(*total),
    };
    SurrogateRecord {
        explained: used.explained,
        terms: used.term_count,
        corrects_first_order: used.corrects_first_order,
        corrects_total: used.corrects_total,
        gain_first_order: used.gain_first_order,
        gain_total: used.gain_total,
        leading_terms: used.terms.iter().map(|term| term.named(&names)).collect(),
        plain: without_noise(study, names_of_swaps(study).into_iter().zip(plain).map(of_swap)),
        low: used.low.clone(),
    }
}

fn estimator_records(study: &Study, indices: &OutputIndices) -> Vec<EstimatorRecord> {
    let names = names_of_swaps(study);
    let estimators = study.analysis.estimators.iter().enumerate();
    let record = |(number, estimator): (usize, &Estimator)| {
        let (first_order, total) = estimator.formulas();
        let of_swap = |(name, checks): (&String, &EffectChecks)| {
            let OtherEstimates { first_order, total, .. } = checks.others[number];
            OtherIndexRecord { name: name.clone(), first_order, total }
        };
        EstimatorRecord {
            estimator: estimator.name().to_owned(),
            first_order_source: first_order.map(FirstOrder::source).map(str::to_owned),
            total_source: total.map(Total::source).map(str::to_owned),
            indices: without_noise(study, names.iter().zip(&indices.checks).map(of_swap)),
        }
    };
    estimators.map(record).collect()
}

/// Returns the indices at a stage of the run.
pub(super) fn stage_record(study: &Study, stage: &Stage, runs_per_point: u64) -> StageRecord {
    let members = study.analysis.members(&study.space);
    let of_member = |(member, effect): (Group, &EffectEstimates)| PlainIndexRecord {
        factor: member.name,
        first_order: effect.first_order,
        total: effect.total,
    };
    StageRecord {
        base_samples: stage.base_samples,
        model_runs: stage.base_samples * runs_per_point,
        largest_half_width: stage.indices.largest_half_width(),
        indices: without_noise(study, members.into_iter().zip(&stage.indices.factors).map(of_member)),
    }
}
