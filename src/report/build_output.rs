//! From the analysis of one output to its part of the result file.

use super::distribution::OutputDistribution;
use super::result::{
    DistributionRecord, EstimatorRecord, GroupRecord, IndexRecord, NoiseRecord, OtherIndexRecord, OutputRecord,
    PairRecord, PlainIndexRecord, PlayerRecord, StageRecord, SubsetRecord, SurrogateRecord,
};
use super::scatter::{rows_of_scatter, scatter_record};
use crate::analysis::{Analysis, FirstRows, OutputAnalysis, names_of_swaps, row_inputs};
use crate::estimate::{FirstOrder, ShapleyPlayers, Total};
use crate::run::Place;
use crate::study::Study;
use crate::uncertainty::{
    EffectChecks, EffectEstimates, Estimate, MeanEstimates, NoiseIndices, OtherEstimates, OutputIndices, Stage,
    SurrogateUse,
};

/// What the records of all outputs are made from.
pub(super) struct OutputRecords<'a> {
    study: &'a Study,
    runs_per_point: u64,
    rows: FirstRows,
}

impl<'a> OutputRecords<'a> {
    pub fn new(study: &'a Study, analysis: &Analysis) -> Self {
        let design = &analysis.design;
        Self { study, runs_per_point: design.rows_per_point(), rows: rows_of_scatter(design) }
    }

    /// The record of `output`, which may be a value of a series: a series has pictures as a whole.
    pub fn record(&self, output: &OutputAnalysis, is_item: bool) -> OutputRecord {
        let (study, unit) = (self.study, &output.unit);
        let squared = |x: f64| unit.span_from_si(unit.span_from_si(x));
        let in_unit = |x: f64| unit.from_si(x);
        let (mean, variance) = (output.mean, output.variance);
        let stage = |stage: &Stage| stage_record(study, stage, self.runs_per_point);
        let mut record = OutputRecord {
            name: output.name.clone(),
            unit: unit.to_string(),
            mean: mean.map(|mean| in_unit(mean.estimate)).filter(|mean| mean.is_finite()),
            variance: variance.map(|variance| squared(variance.estimate)).filter(|variance| variance.is_finite()),
            mean_interval: mean.and_then(|mean| mean.interval?.map(in_unit)),
            variance_interval: variance.and_then(|variance| variance.interval?.map(squared)),
            runs_ok: output.runs_ok,
            runs_failed: output.runs_failed,
            base_points_used: output.base_points_used,
            failures: output.failures.clone(),
            measures: output.measures.clone(),
            surrogate_trial: output.trial,
            convergence: output.convergence.iter().map(stage).collect(),
            distribution: distribution_record(output, is_item),
            reason: output.indices.as_ref().err().map(ToString::to_string),
            warnings: output.warnings.iter().map(ToString::to_string).collect(),
            warning_codes: output.warnings.iter().map(|warning| warning.code().to_owned()).collect(),
            ..OutputRecord::default()
        };
        if let Ok(indices) = &output.indices {
            add_indices(&mut record, study, indices);
        }
        // At points of SALib nothing is known of the inputs.
        let indices = record.indices.as_deref().filter(|_| !study.analysis.salib && !is_item);
        record.scatter = indices.and_then(|indices| scatter_record(&self.rows, &study.space, output, indices));
        record
    }
}

fn add_indices(record: &mut OutputRecord, study: &Study, indices: &OutputIndices) {
    let factors = study.space.factors();
    let names = |numbers: &[usize]| numbers.iter().map(|&number| factors[number].name.clone()).collect::<Vec<_>>();
    if study.space.copula().is_none() {
        record.sum_first_order = Some(indices.sum_first_order);
        record.sum_total = Some(indices.sum_total);
    }
    let known = factors.iter().zip(&indices.factors).filter(|(factor, _)| !factor.distribution().is_noise());
    record.indices = Some(known.map(|(factor, &effect)| IndexRecord { factor: factor.name.clone(), effect }).collect());
    record.noise = indices.noise.as_ref().map(|noise| noise_record(study, indices, noise));
    let groups = study.space.groups().into_iter().zip(&indices.groups);
    let of_group =
        groups.map(|(group, &effect)| GroupRecord { factors: names(&group.factors), group: group.name, effect });
    record.groups = Some(of_group.collect());
    let subsets = study.analysis.subsets.iter().zip(&indices.subsets);
    record.subsets = Some(subsets.map(|(numbers, &effect)| SubsetRecord { factors: names(numbers), effect }).collect());
    record.dummy = indices.dummy;
    if study.analysis.shapley_players == Some(ShapleyPlayers::Groups) {
        add_players(record, indices);
    }
    if study.analysis.second_order {
        let of_pair = |((j, k), index): ((usize, usize), &Estimate)| PairRecord {
            factors: [j, k].map(|number| factors[number].name.clone()),
            index: *index,
        };
        let pairs = study.layout().pair_list();
        record.second_order = Some(pairs.into_iter().zip(&indices.second_order).map(of_pair).collect());
    }
    record.estimators = estimator_records(study, indices);
    record.surrogate = indices.surrogate.as_ref().map(|used| surrogate_record(study, used));
}

/// The Shapley effects of groups, and of factors without one, in a list of their own: those of factors alone are not theirs.
fn add_players(record: &mut OutputRecord, indices: &OutputIndices) {
    let of_factors = record.indices.iter_mut().flatten().zip(&indices.factors);
    let of_factors = of_factors.map(|(index, effect)| {
        index.effect.shapley = None;
        (index.factor.clone(), vec![index.factor.clone()], effect)
    });
    let of_groups = record.groups.iter_mut().flatten().zip(&indices.groups);
    let of_groups = of_groups.map(|(group, effect)| {
        group.effect.shapley = None;
        (group.group.clone(), group.factors.clone(), effect)
    });
    let player = |(player, factors, effect): (String, Vec<String>, &EffectEstimates)| {
        effect.shapley.map(|shapley| PlayerRecord { player, factors, shapley })
    };
    record.shapley_groups = Some(of_factors.chain(of_groups).filter_map(player).collect());
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

/// What is told of all swaps without the noise, which is told of by itself.
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
    let record = |(number, estimator): (usize, &crate::estimate::Estimator)| {
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

fn stage_record(study: &Study, stage: &Stage, runs_per_point: u64) -> StageRecord {
    let of_factor = |(factor, effect): (&crate::space::Factor, &EffectEstimates)| PlainIndexRecord {
        factor: factor.name.clone(),
        first_order: effect.first_order,
        total: effect.total,
    };
    StageRecord {
        base_samples: stage.base_samples,
        model_runs: stage.base_samples * runs_per_point,
        largest_half_width: stage.indices.largest_half_width(),
        indices: without_noise(study, study.space.factors().iter().zip(&stage.indices.factors).map(of_factor)),
    }
}

/// Moments and range from all values of the rows A and B, the rest from those that were kept. `None` without values, and
/// where a number is beyond double precision in the unit. A value of a series has neither histogram nor density.
fn distribution_record(output: &OutputAnalysis, is_item: bool) -> Option<DistributionRecord> {
    let (values, unit) = (&output.values, &output.unit);
    let kept: Vec<f64> = output.samples.iter().flatten().copied().filter(|value| value.is_finite()).collect();
    let mut sample = OutputDistribution::from_values(&kept, unit)?;
    let (min, max) = values.range()?;
    (sample.mean, sample.min, sample.max) = (unit.from_si(values.mean()?), unit.from_si(min), unit.from_si(max));
    let n = values.count();
    let variance = values.variance()?;
    let sd = (variance * (n as f64 / (n as f64 - 1.0))).sqrt();
    // Of values that vary by 1e-160 the variance is beyond double precision; that of the kept ones is scaled.
    if variance.is_normal() || min == max {
        sample.sd = (n > 1).then(|| unit.span_from_si(sd)).filter(|sd| sd.is_finite());
    }
    if is_item {
        sample.histogram = None;
    }
    (sample.skewness, sample.excess_kurtosis) = (values.skewness(), values.excess_kurtosis());
    let quantiles = sample.quantiles.iter().map(|quantile| quantile.value);
    let edges = sample.histogram.iter().flat_map(|histogram| histogram.edges.iter().copied());
    let all = [sample.mean, sample.min, sample.max].into_iter().chain(quantiles).chain(edges);
    let representable = all.into_iter().all(f64::is_finite);
    representable.then_some(DistributionRecord { values: n, sample })
}

/// The inputs of a row of `study` in words, such as `length = 300 um, velocity = 0 nm/s`; `place` may lie beyond the
/// study's own design, where a growing run has gone.
pub fn inputs_in_words(study: &Study, place: Place) -> String {
    let points = place.point.checked_add(1).and_then(u64::checked_next_power_of_two);
    let longer = points.filter(|points| *points > study.design.points_per_replicate());
    let longer = longer.and_then(|points| study.design.with_points(points).ok());
    let values = row_inputs(study, longer.as_ref().unwrap_or(&study.design), place);
    let words = study.space.factors().iter().zip(values).map(|(factor, value)| {
        let unit = factor.unit().to_string();
        if unit == "1" { format!("{} = {value}", factor.name) } else { format!("{} = {value} {unit}", factor.name) }
    });
    words.collect::<Vec<_>>().join(", ")
}
