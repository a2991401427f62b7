//! Warnings about the runs and the results of an output.

use super::finished_run::FinishedRun;
use super::output_indices::{EffectIndices, OutputIndices};
use crate::correction::Refusal;
use crate::effect::Effect;
use crate::estimate::{CentralMoments, Moments};
use crate::model::Model;
use crate::result::{IndexKind, Warning};
use crate::run::Totals;
use crate::study::{Study, StudyEffect};
use crate::uncertainty::{EffectChecks, Estimate, IntervalMethod, differs_clearly};

/// Returns warnings about the runs of an output.
///
/// If failures depended on each factor by itself, the rows AB_j of two rows that succeed would succeed too: `used` counts both.
pub(super) fn of_runs(run: &FinishedRun<'_>, failed: u64, used: &Moments) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let (design, settings) = (run.design, run.design.settings());
    let (runs, base_samples) = (design.rows(), settings.base_samples);
    if failed > 0 && failed == runs {
        warnings.push(Warning::AllRunsFailed { runs });
    } else if failed > 0 {
        let left_out = base_samples - used.fewest();
        warnings.push(Warning::RunsFailed { failed, runs, left_out, base_samples });
        let points = used.count() - used.fewest();
        warnings.extend((points > 0).then_some(Warning::JointFailures { points, base_samples }));
    }
    warnings.extend(run.study.analysis.design_warnings(design));
    warnings
}

/// Removes the advice to take more samples if indices contradict each other because of joint failures.
pub(super) fn without_consequences(warnings: &mut Vec<Warning>) {
    use Warning::{AboveTotal, Contradictory, FirstOrderAboveOne, FormulasDiffer, TotalAboveOne, TotalsBelowOne};
    if warnings.iter().any(fails_jointly) {
        warnings.retain(|warning| {
            !matches!(
                warning,
                AboveTotal { .. }
                    | Contradictory { .. }
                    | FormulasDiffer { .. }
                    | FirstOrderAboveOne { .. }
                    | TotalsBelowOne { .. }
                    | TotalAboveOne { .. }
            )
        });
    }
}

/// Returns whether it says that runs fail jointly at a thousandth of the base points or more.
fn fails_jointly(warning: &Warning) -> bool {
    matches!(warning, Warning::JointFailures { points, base_samples } if 1000 * points >= *base_samples)
}

/// Returns warnings raised by the model.
pub(super) fn of_flags(model: &dyn Model, totals: &Totals) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for (flag, &runs) in model.flags().iter().zip(&totals.flags) {
        if flag.warns && runs > 0 {
            let (flag, description) = (flag.name.to_string(), flag.description.to_string());
            warnings.push(Warning::ModelFlag { flag, description, runs });
        }
    }
    warnings
}

/// Share of the variance that surrogates should explain for a split design to gain (`docs/accuracy/surrogate.md`).
const MIN_EXPLAINED: f64 = 0.9;

/// Returns a warning if few of its values dominate the variance of an output.
pub(super) fn of_values(moments: &CentralMoments) -> Option<Warning> {
    let (values, kurtosis) = (moments.count(), moments.excess_kurtosis()?);
    Warning::few_rows(values, kurtosis)
}

/// Effective number of rows of a variance, as above, below which a region that the rows show has too few of them.
const MIN_ROWS_OF_REGION: f64 = 10.0;

/// Returns whether indices of an output with these `values` may be wrong by more than their intervals say: they
/// contradict each other, leave a part of the variance to no factor, or depend on a few rows.
pub(crate) fn is_doubted(study: &Study, indices: &OutputIndices, values: &CentralMoments) -> bool {
    use Warning::{
        AboveTotal, Contradictory, DoubtedSurrogate, FirstOrderAboveOne, FormulasDiffer, HeavyTailedSurrogate,
        TotalAboveOne,
    };
    let highest = indices.inputs().map(|of| of.estimates.total.interval.map_or(1.0, |interval| interval.high));
    let rows = values.excess_kurtosis().map_or(0.0, |kurtosis| values.count() as f64 / (kurtosis + 3.0));
    study.space.copula().is_none() && highest.sum::<f64>() < 1.0
        || rows < MIN_ROWS_OF_REGION
        || of_indices(study, indices).iter().any(|warning| {
            matches!(
                warning,
                AboveTotal { .. }
                    | Contradictory { .. }
                    | DoubtedSurrogate
                    | FirstOrderAboveOne { .. }
                    | FormulasDiffer { .. }
                    | HeavyTailedSurrogate
                    | TotalAboveOne { .. }
            )
        })
}

/// Returns a warning for outputs so large that few digits are left for their variation.
pub(super) fn of_digits(values: &CentralMoments) -> Option<Warning> {
    let error = error_of_rounding(values);
    (error > LOST && error.is_finite()).then_some(Warning::FewDigits { error })
}

/// Returns a warning of discrete factors that depend on others: what is fixed is the normal score behind a value.
fn of_dependent_steps(study: &Study) -> Option<Warning> {
    let space = study.space();
    let mut factors = Vec::new();
    for factor in space.factors() {
        let depends = space.dependences().iter().any(|dependence| dependence.factors().contains(&factor.name));
        if depends && (factor.distribution().levels().is_some() || factor.distribution().is_whole()) {
            factors.push(factor.name.clone());
        }
    }
    (!factors.is_empty()).then_some(Warning::DependentSteps { factors })
}

/// Indices below this get no individual warnings.
const MIN_INDEX: f64 = 1e-6;

/// Returns warnings about indices that cannot all be right. Each compares an estimate with its interval, so that the
/// noise of a small sample does not raise it.
pub(super) fn of_indices(study: &Study, indices: &OutputIndices) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let alone = study.design.settings().replicates == 1 && study.analysis.intervals == IntervalMethod::Replicates;
    if !alone && indices.inputs().all(|of| of.estimates.total.interval.is_none()) {
        warnings.push(Warning::NoIntervals);
    }
    if let Some(used) = &indices.surrogate {
        warnings.extend((used.is_heavy_tailed && used.refusal.is_none()).then_some(Warning::HeavyTailedSurrogate));
        warnings.extend(used.is_doubted.then_some(Warning::DoubtedSurrogate));
        warnings.extend(used.refusal.map(|refusal| match refusal {
            Refusal::Contradiction { times } => Warning::ContradictedSurrogate { times },
            Refusal::Growth { times } => Warning::InflatedSurrogate { times },
        }));
        let is_poor = study.design.is_plain() && used.explained < MIN_EXPLAINED;
        warnings.extend(is_poor.then_some(Warning::PoorSurrogate { explained: used.explained }));
    }
    // Corrected first-order indices do not depend on the formulas.
    let is_corrected = (indices.surrogate.as_ref())
        .is_some_and(|used| used.corrects_first_order && !used.is_doubted && !used.is_heavy_tailed);
    warnings.extend(of_dependent_steps(study));
    let effects = study.effects();
    let noise = effects.iter().zip(&indices.effects).find(|(effect, _)| effect.effect == Effect::Noise);
    warnings.extend(noise.and_then(|(effect, of)| of_noise(&effect.name, of, indices.mean_share)));
    for (StudyEffect { name, .. }, EffectIndices { estimates: effect, checks, .. }) in
        effects.iter().zip(&indices.effects)
    {
        let total = effect.dependent.map_or(effect.total, |dependent| dependent.full_total).estimate;
        let (name, first_order) = (name.clone(), effect.first_order.estimate);
        let is_visible = first_order.abs().max(total.abs()) >= MIN_INDEX;
        if checks.interaction.estimate < 0.0 && differs_clearly(checks.interaction) && is_visible {
            warnings.push(Warning::AboveTotal { name: name.clone(), first_order, total });
        }
        if checks.is_contradictory && is_visible {
            warnings.push(Warning::Contradictory { name: name.clone(), first_order, total });
        }
        if !is_corrected && differs_clearly(checks.gap) {
            warnings.push(Warning::FormulasDiffer { name: name.clone(), gap: checks.gap.estimate.abs() });
        }
        warnings.extend(disagreements(study, &name, checks));
    }
    // Indices of dependent factors have no fixed sum.
    if study.space.copula().is_some() {
        return warnings;
    }
    let (first_order, total) = (indices.sums.first_order, indices.sums.total);
    if first_order.interval.is_some_and(|interval| interval.low <= 0.0) {
        warnings.push(Warning::NoFirstOrder);
    }
    for (StudyEffect { name, .. }, of) in effects.into_iter().zip(&indices.effects) {
        let total = of.estimates.total;
        if total.interval.is_some_and(|interval| interval.low > 1.0) {
            warnings.push(Warning::TotalAboveOne { name, total: total.estimate });
        }
    }
    // If this program runs the model, its rows are in order.
    if study.subject.is_external() && looks_shuffled(indices) {
        warnings.push(Warning::Shuffled);
    }
    if first_order.interval.is_some_and(|interval| interval.low > 1.0) {
        warnings.push(Warning::FirstOrderAboveOne { sum: first_order.estimate });
    }
    if total.interval.is_some_and(|interval| interval.high < 1.0) {
        warnings.push(Warning::TotalsBelowOne { sum: total.estimate });
    }
    warnings
}

/// Returns a warning of a noise that has no effect, or the whole effect.
fn of_noise(name: &str, noise: &EffectIndices, mean_share: Option<Estimate>) -> Option<Warning> {
    let (factor, total) = (name.to_owned(), noise.estimates.total);
    if total.estimate == 0.0 {
        return Some(Warning::NoNoise { factor });
    }
    mean_share?.interval.is_some_and(|share| share.low <= 0.0).then_some(Warning::AllNoise { factor })
}

/// Returns warnings of requested estimators whose indices differ from the default ones by more than chance.
fn disagreements(study: &Study, name: &str, checks: &EffectChecks) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for (estimator, other) in study.analysis.estimators.iter().zip(&checks.others) {
        for (index, gap) in [(IndexKind::FirstOrder, other.first_order_gap), (IndexKind::Total, other.total_gap)] {
            if let Some(gap) = gap.filter(|gap| differs_clearly(*gap)) {
                let (name, estimator) = (name.to_owned(), estimator.name().to_owned());
                warnings.push(Warning::EstimatorsDiffer { name, index, estimator, gap: gap.estimate });
            }
        }
    }
    warnings
}

/// Returns whether the rows A, B and AB of a base point look independent: first-order indices near 0, totals near 1.
fn looks_shuffled(indices: &OutputIndices) -> bool {
    const NEAR: f64 = 0.15;
    indices.inputs().count() > 1
        && indices.inputs().all(|EffectIndices { estimates: of, .. }| {
            (of.total.estimate - 1.0).abs() < NEAR && of.first_order.estimate.abs() < NEAR
        })
}

/// Error of indices by rounding of the outputs above which a result has a warning.
const LOST: f64 = 1e-3;

/// Returns the largest error of an index by the rounding of outputs with these moments; infinity if they do not vary.
fn error_of_rounding(values: &CentralMoments) -> f64 {
    let Some(((low, high), variance)) = values.range().zip(values.variance()) else { return f64::INFINITY };
    let largest = low.abs().max(high.abs());
    4.0 * (largest.next_up() - largest) / variance.sqrt()
}

#[cfg(test)]
#[path = "tests/warnings.rs"]
mod tests;
