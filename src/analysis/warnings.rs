//! What a careful reader of a result should know.

use thiserror::Error;

use super::finished_run::{FinishedRun, names_of_swaps};
use super::output::{LOST, error_of_rounding};
use crate::estimate::{CentralMoments, Moments};
use crate::model::Model;
use crate::run::Totals;
use crate::study::Study;
use crate::uncertainty::{
    EffectEstimates, Estimate, Interval, IntervalMethod, NoiseIndices, OutputIndices, Refusal, differs_clearly,
};

/// Why numbers of an output may be wrong, or less sure than they look.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Warning {
    /// No run has a value.
    #[error("all {runs} runs failed")]
    AllRunsFailed {
        /// The runs.
        runs: u64,
    },
    /// Some runs have no value.
    #[error(
        "{failed} of {runs} runs failed: every index does without the base points at which one of its own runs failed (at \
         most {left_out} of {base_samples}), and describes the part of the factor space where they succeed"
    )]
    RunsFailed {
        /// Runs without a value.
        failed: u64,
        /// All runs.
        runs: u64,
        /// Base points that an index does without, at most.
        left_out: u64,
        /// All base points.
        base_samples: u64,
    },
    /// Runs fail by several factors together.
    #[error(
        "{points} of {base_samples} base points have a run that failed although it takes each factor from one of two runs that \
         succeeded: several factors together (or chance) decide what fails, so the factors depend on each other where runs succeed, \
         and these indices are not defined there, however many runs there are; narrow the ranges until no run fails, study an output \
         that is 1 where a run fails and 0 elsewhere, or pass the rows that succeed (--save-outputs) to given-data"
    )]
    JointFailures {
        /// Base points whose rows A and B succeeded, and another row did not.
        points: u64,
        /// All base points.
        base_samples: u64,
    },
    /// The points of a replicate are not a power of two.
    #[error(
        "{points} base points in each replicate are not a power of two: Sobol' points lose much of their accuracy; \
         base_samples = {fewer} or {more} would be better"
    )]
    Unbalanced {
        /// Base points of a replicate.
        points: u64,
        /// The next smaller good number of base samples.
        fewer: u64,
        /// The next larger one.
        more: u64,
    },
    /// One replicate, and intervals from the spread of replicates.
    #[error("a single replicate says nothing about its error: no intervals")]
    SingleReplicate,
    /// One net, and intervals from its parts.
    #[error(
        "a single net gives no independent estimate of its error: intervals rest on how its parts differ (4 replicates are \
         safer)"
    )]
    SingleNet,
    /// The model raised a flag that warns.
    #[error("{flag} ({}): {description}", if *runs == 1 { "1 run".to_owned() } else { format!("{runs} runs") })]
    ModelFlag {
        /// The flag.
        flag: String,
        /// What it means.
        description: String,
        /// Runs that raised it.
        runs: u64,
    },
    /// The variance rests on few rows.
    #[error(
        "the variance rests on few rows, as if on {rows:.0} of the {values} of A and B (excess kurtosis {kurtosis:.0}): rows \
         as large may be missing from the sample, so that intervals are longer above the estimates than below, and may still \
         be too short; more base samples help, or the logarithm of the output"
    )]
    FewRows {
        /// Rows that would have this variance if all others did nothing.
        rows: f64,
        /// Rows A and B.
        values: u64,
        /// Excess kurtosis of the values.
        kurtosis: f64,
    },
    /// The output is large beside its variation.
    #[error(
        "the output is so much larger than what varies in it that doubles keep few digits of that: indices may be off by some \
         {error:.1e}; subtract a constant from it before it is rounded"
    )]
    FewDigits {
        /// Error of the indices.
        error: f64,
    },
    /// Intervals do not exist.
    #[error(
        "no intervals: without the rows of one part of the sample the output does not vary (or too few rows are left), so that \
         nothing tells the error of the indices: more base samples are needed"
    )]
    NoIntervals,
    /// A few runs carry what the surrogate leaves.
    #[error(
        "a few runs carry what the surrogate leaves unexplained, and others like them may be missing: the intervals of the \
         corrected indices hold those of the plain ones too"
    )]
    HeavyTailedSurrogate,
    /// Corrected and plain indices are apart, within what the intervals hold.
    #[error(
        "the indices corrected by surrogates and the plain ones of the same rows are apart by more than their errors make \
         likely: the intervals hold both"
    )]
    DoubtedSurrogate,
    /// Corrected indices contradict plain ones, which are the result.
    #[error(
        "the indices corrected by surrogates contradict the plain ones of the same rows by {times:.1} times what their errors \
         allow: the rows do not represent a factor, and the plain ones are the result"
    )]
    ContradictedSurrogate {
        /// The distance over what both errors allow.
        times: f64,
    },
    /// Surrogates claim more variance than the rows show; the plain indices are the result.
    #[error(
        "the surrogates claim {times:.1} times the variance that the rows show of a factor: the rows do not represent it, and \
         the plain indices are the result"
    )]
    InflatedSurrogate {
        /// The variance claimed over that of the rows.
        times: f64,
    },
    /// A level of a factor that hardly any row has.
    #[error("{0}")]
    RareLevel(RareLevel),
    /// Rows for surrogates, which explain little.
    #[error(
        "the surrogates explain {:.0} % of the variance of runs that they were not fitted to, so that plain rows, which only \
         they learn from, are of little use: all runs as base samples are better for this output, and errors and intervals may \
         be too small here",
        (100.0 * explained).max(0.0)
    )]
    PoorSurrogate {
        /// Share of the variance that they explain.
        explained: f64,
    },
    /// Factors of single values depend on others.
    #[error(
        "{}: single values that depend on other factors: to fix the factor here is to fix the normal score behind its value, \
         which says more of the others than the value does; its own indices are too large by that, and those of its partners \
         too small",
        factors.join(", ")
    )]
    DependentSteps {
        /// The factors.
        factors: Vec<String>,
    },
    /// The noise does nothing.
    #[error(
        "{factor}: no run changed with its seed: the model is not stochastic, or draws its random numbers without it"
    )]
    NoNoise {
        /// The seed.
        factor: String,
    },
    /// The noise may be all.
    #[error(
        "{factor}: all variance may be noise, so that the indices of the mean over it may be anything: more base samples are \
         needed, or several runs of each row (repetitions in [noise])"
    )]
    AllNoise {
        /// The seed.
        factor: String,
    },
    /// A first-order index above its total index.
    #[error(
        "{name}: the first-order index {} exceeds the total index {} beyond the error of their difference: too few samples",
        decimals(*first_order),
        decimals(*total)
    )]
    AboveTotal {
        /// Factor, group or subset.
        name: String,
        /// Its first-order index.
        first_order: f64,
        /// Its total index.
        total: f64,
    },
    /// The same by the intervals of both.
    #[error(
        "{name}: the interval of the first-order index {} lay above that of the total index {}, and both were lengthened until \
         they met: too few samples",
        decimals(*first_order),
        decimals(*total)
    )]
    Contradictory {
        /// Factor, group or subset.
        name: String,
        /// Its first-order index.
        first_order: f64,
        /// Its total index.
        total: f64,
    },
    /// Two formulas disagree.
    #[error(
        "{name}: two formulas for the first-order index differ by {gap:.2e}, beyond the error of their difference: too few \
         samples, or a heavy-tailed output (its logarithm may serve better)"
    )]
    FormulasDiffer {
        /// Factor, group or subset.
        name: String,
        /// By how much.
        gap: f64,
    },
    /// An estimator that was asked for disagrees with the default one.
    #[error(
        "{name}: the {index} index by `{estimator}` differs from the default one by {gap:.2e}, beyond the error of their \
         difference: one of the two is not to be trusted on this output"
    )]
    EstimatorsDiffer {
        /// Factor, group or subset.
        name: String,
        /// `first-order` or `total`.
        index: &'static str,
        /// The estimator.
        estimator: &'static str,
        /// By how much.
        gap: f64,
    },
    /// First-order indices that may sum to nothing.
    #[error(
        "the sum of the first-order indices may be 0: the output comes from interactions, or the samples are too few; shares \
         of the first-order indices mean nothing"
    )]
    NoFirstOrder,
    /// First-order indices beyond 1.
    #[error("the first-order indices sum to {sum:.4}, beyond 1 by more than their error: too few samples")]
    FirstOrderAboveOne {
        /// Their sum.
        sum: f64,
    },
    /// Total indices below 1.
    #[error("the total indices sum to {sum:.4}, below 1 by more than their error: too few samples")]
    TotalsBelowOne {
        /// Their sum.
        sum: f64,
    },
    /// A total index above 1.
    #[error(
        "{name}: the total index {total:.4} is above 1 by more than its error: too few samples, or rows that do not belong \
         together"
    )]
    TotalAboveOne {
        /// Factor, group or subset.
        name: String,
        /// Its total index.
        total: f64,
    },
    /// Rows of a table that look as if they were in another order.
    #[error(
        "every total index is near 1 and every first-order index near 0, as rows in another order than that of the design \
         give; if the order is right, the output is all interaction"
    )]
    Shuffled,
    /// A value that may stand for a missing one.
    #[error("{text}")]
    Unlikely {
        /// Which, and where.
        text: String,
    },
    /// Rows that were run again had another answer.
    #[error("{text}")]
    Irreproducible {
        /// How many, and why.
        text: String,
    },
}

impl Warning {
    /// A name of the kind of warning that stays the same, as it stands in the result file.
    pub fn code(&self) -> &'static str {
        match self {
            Self::AllRunsFailed { .. } => "all-runs-failed",
            Self::RunsFailed { .. } => "runs-failed",
            Self::JointFailures { .. } => "joint-failures",
            Self::Unbalanced { .. } => "unbalanced",
            Self::SingleReplicate => "single-replicate",
            Self::SingleNet => "single-net",
            Self::ModelFlag { .. } => "model-flag",
            Self::FewRows { .. } => "few-rows",
            Self::FewDigits { .. } => "few-digits",
            Self::NoIntervals => "no-intervals",
            Self::HeavyTailedSurrogate => "heavy-tailed-surrogate",
            Self::DoubtedSurrogate => "doubted-surrogate",
            Self::ContradictedSurrogate { .. } => "contradicted-surrogate",
            Self::InflatedSurrogate { .. } => "inflated-surrogate",
            Self::RareLevel(_) => "rare-level",
            Self::PoorSurrogate { .. } => "poor-surrogate",
            Self::DependentSteps { .. } => "dependent-steps",
            Self::NoNoise { .. } => "no-noise",
            Self::AllNoise { .. } => "all-noise",
            Self::AboveTotal { .. } => "above-total",
            Self::Contradictory { .. } => "contradictory",
            Self::FormulasDiffer { .. } => "formulas-differ",
            Self::EstimatorsDiffer { .. } => "estimators-differ",
            Self::NoFirstOrder => "no-first-order",
            Self::FirstOrderAboveOne { .. } => "first-order-above-one",
            Self::TotalsBelowOne { .. } => "totals-below-one",
            Self::TotalAboveOne { .. } => "total-above-one",
            Self::Shuffled => "shuffled",
            Self::Unlikely { .. } => "unlikely-value",
            Self::Irreproducible { .. } => "irreproducible",
        }
    }
}

/// Warnings about the runs behind an output.
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

/// Drops the advice to take more samples where joint failures are why indices contradict each other.
pub(super) fn without_consequences(warnings: &mut Vec<Warning>) {
    let is_cause = |warning: &Warning| matches!(warning, Warning::JointFailures { points, base_samples } if 1000 * points >= *base_samples);
    if warnings.iter().any(is_cause) {
        let is_consequence = |warning: &Warning| {
            use Warning::{
                AboveTotal, Contradictory, FirstOrderAboveOne, FormulasDiffer, TotalAboveOne, TotalsBelowOne,
            };
            matches!(
                warning,
                AboveTotal { .. }
                    | Contradictory { .. }
                    | FormulasDiffer { .. }
                    | FirstOrderAboveOne { .. }
                    | TotalsBelowOne { .. }
                    | TotalAboveOne { .. }
            )
        };
        warnings.retain(|warning| !is_consequence(warning));
    }
}

/// A level of a factor that rows hardly met.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "{factor}: {level} (probability {probability:.2e}) is in {} of the {values} values drawn, so that its effect on the \
     output is not known, and the indices may be anything: some {:.0} base samples meet it once, and {:.0} ten times",
    if *draws == 0 { "none".to_owned() } else { draws.to_string() },
    self.base_samples(1.0),
    self.base_samples(10.0)
)]
#[non_exhaustive]
pub struct RareLevel {
    /// The number of the factor.
    pub number: usize,
    /// The factor.
    pub factor: String,
    /// The level: a value, a label, or a range.
    pub level: String,
    /// Its probability.
    pub probability: f64,
    /// How many of the values of the factor in A and B are this level.
    pub draws: u64,
    /// How many values there are.
    pub values: u64,
}

impl RareLevel {
    /// Whether so few rows have it, or none, that surrogates cannot know of it.
    pub fn is_missed(&self) -> bool {
        self.draws < 3
    }

    /// Base samples with which the level is drawn that often in the mean.
    pub fn base_samples(&self, draws: f64) -> f64 {
        draws / (2.0 * self.probability)
    }
}

/// Warnings that the model has raised.
pub(super) fn of_flags(model: &dyn Model, whole: &Totals) -> Vec<Warning> {
    let raised = model.flags().iter().zip(&whole.flags).filter(|(flag, runs)| flag.warns && **runs > 0);
    let warning = |(flag, runs): (&crate::model::Flag, &u64)| Warning::ModelFlag {
        flag: flag.name.to_string(),
        description: flag.description.to_string(),
        runs: *runs,
    };
    raised.map(warning).collect()
}

/// Effective number of rows behind a variance below which it counts as that of few.
const FEW_ROWS: f64 = 40.0;

/// Share of the variance that surrogates should explain for a split design to gain (`docs/accuracy/surrogate.md`).
const MIN_EXPLAINED: f64 = 0.9;

/// Excess kurtosis (that of an exponential distribution) up to which few rows are just a small sample.
const MAX_KURTOSIS: f64 = 6.0;

/// A warning if the variance of an output rests on few of its `values`: n/(g2 + 3) of n rows with the excess kurtosis g2
/// is their number if all others did nothing.
pub(super) fn of_values(moments: &CentralMoments) -> Option<Warning> {
    let (values, kurtosis) = (moments.count(), moments.excess_kurtosis()?);
    let rows = values as f64 / (kurtosis + 3.0);
    (kurtosis > MAX_KURTOSIS && rows < FEW_ROWS).then_some(Warning::FewRows { rows, values, kurtosis })
}

/// A warning of outputs whose size leaves few digits to what varies in them.
pub(super) fn of_digits(values: &CentralMoments) -> Option<Warning> {
    let error = error_of_rounding(values);
    (error > LOST && error.is_finite()).then_some(Warning::FewDigits { error })
}

/// A warning of factors that take single values and depend on others: what is held fixed is the normal score behind a value.
fn of_dependent_steps(study: &Study) -> Option<Warning> {
    let space = study.space();
    let depends =
        |name: &str| space.dependences().iter().any(|dependence| dependence.factors().iter().any(|of| of == name));
    let steps = space.factors().iter().filter(|factor| {
        depends(&factor.name) && (factor.distribution().levels().is_some() || factor.distribution().is_whole())
    });
    let factors: Vec<String> = steps.map(|factor| factor.name.clone()).collect();
    (!factors.is_empty()).then_some(Warning::DependentSteps { factors })
}

/// Indices below this are not warned of one by one.
const MIN_INDEX: f64 = 1e-6;

/// An index in a warning: four decimals, or three digits of what is smaller.
fn decimals(index: f64) -> String {
    if index == 0.0 || index.abs() >= 0.01 { format!("{index:.4}") } else { format!("{index:.2e}") }
}

/// Warnings about indices that cannot all be right. Each compares an estimate with its interval, so that the noise of
/// a small sample does not raise it.
pub(super) fn of_indices(study: &Study, indices: &OutputIndices) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let alone = study.design.settings().replicates == 1 && study.analysis.intervals == IntervalMethod::Replicates;
    if !alone && indices.factors.iter().all(|effect| effect.total.interval.is_none()) {
        warnings.push(Warning::NoIntervals);
    }
    if let Some(used) = &indices.surrogate {
        warnings.extend(used.is_heavy_tailed.then_some(Warning::HeavyTailedSurrogate));
        warnings.extend(used.is_doubted.then_some(Warning::DoubtedSurrogate));
        warnings.extend(used.refusal.map(|refusal| match refusal {
            Refusal::Contradiction { times } => Warning::ContradictedSurrogate { times },
            Refusal::Growth { times } => Warning::InflatedSurrogate { times },
        }));
        let is_poor = study.design.plain_rows() > 0 && used.explained < MIN_EXPLAINED;
        warnings.extend(is_poor.then_some(Warning::PoorSurrogate { explained: used.explained }));
    }
    warnings.extend(of_dependent_steps(study));
    warnings.extend(indices.noise.as_ref().and_then(|noise| of_noise(study, indices, noise)));
    for (name, effect) in names_of_swaps(study).iter().zip(indices.effects()) {
        let total = effect.dependent.map_or(effect.total, |dependent| dependent.full_total).estimate;
        let (name, first_order) = (name.clone(), effect.first_order.estimate);
        let is_visible = first_order.abs().max(total.abs()) >= MIN_INDEX;
        if effect.interaction.estimate < 0.0 && differs_clearly(effect.interaction) && is_visible {
            warnings.push(Warning::AboveTotal { name: name.clone(), first_order, total });
        }
        if effect.contradictory && is_visible {
            warnings.push(Warning::Contradictory { name: name.clone(), first_order, total });
        }
        if differs_clearly(effect.check_gap) {
            warnings.push(Warning::FormulasDiffer { name: name.clone(), gap: effect.check_gap.estimate.abs() });
        }
        warnings.extend(disagreements(study, &name, effect));
    }
    // Indices of factors that depend on each other sum to anything.
    if study.space.copula().is_some() {
        return warnings;
    }
    let (first_order, total) = (indices.sum_first_order, indices.sum_total);
    if first_order.interval.is_some_and(|interval| interval.low <= 0.0) {
        warnings.push(Warning::NoFirstOrder);
    }
    for (name, effect) in names_of_swaps(study).into_iter().zip(indices.effects()) {
        if effect.total.interval.is_some_and(|interval| interval.low > 1.0) {
            warnings.push(Warning::TotalAboveOne { name, total: effect.total.estimate });
        }
    }
    // Where this program runs the model, its rows are in order.
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

/// A noise that does nothing, or all.
fn of_noise(study: &Study, indices: &OutputIndices, noise: &NoiseIndices) -> Option<Warning> {
    let (name, total) = (&study.space.factors()[noise.factor].name, indices.factors[noise.factor].total);
    let factor = name.clone();
    let none = |interval: Interval| interval.low == 0.0 && interval.high == 0.0;
    if total.estimate == 0.0 && total.interval.is_none_or(none) {
        return Some(Warning::NoNoise { factor });
    }
    noise.mean_share.interval.is_some_and(|share| share.low <= 0.0).then_some(Warning::AllNoise { factor })
}

/// Estimators asked for whose indices differ from the default ones by more than chance.
fn disagreements(study: &Study, name: &str, effect: &EffectEstimates) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for (estimator, other) in study.analysis.estimators.iter().zip(&effect.others) {
        for (index, gap) in [("first-order", other.first_order_gap), ("total", other.total_gap)] {
            let gap = gap.filter(|gap| differs_clearly(*gap));
            warnings.extend(gap.map(|Estimate { estimate: gap, .. }| Warning::EstimatorsDiffer {
                name: name.to_owned(),
                index,
                estimator: estimator.name(),
                gap,
            }));
        }
    }
    warnings
}

/// Whether the rows A, B and AB of a base point are as different as any others: no factor acts alone, and each takes part in all.
fn looks_shuffled(indices: &OutputIndices) -> bool {
    const NEAR: f64 = 0.15;
    let all = |near: &dyn Fn(&EffectEstimates) -> bool| indices.factors.iter().all(near);
    indices.factors.len() > 1
        && all(&|effect| (effect.total.estimate - 1.0).abs() < NEAR)
        && all(&|effect| effect.first_order.estimate.abs() < NEAR)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heavy_tails_are_warned_of_and_small_samples_are_not() {
        // 3 rows of 1000 have another value: g2 + 3 = 1/p - 3 + 3 p..., n/(g2 + 3) = 3.0.
        let rare: Vec<f64> = (0..1000).map(|i| f64::from(u8::from(i % 400 == 0))).collect();
        let Some(Warning::FewRows { rows, values: 1000, .. }) = of_values(&CentralMoments::of(&rare)) else {
            panic!("no warning of few rows");
        };
        assert_eq!(rows.round(), 3.0);
        let normal: Vec<f64> = (0..16).map(|i| f64::from(i * i)).collect();
        assert_eq!(of_values(&CentralMoments::of(&normal)), None);
        assert_eq!(of_values(&CentralMoments::of(&[1.0; 8])), None);
        let many: Vec<f64> = rare.iter().cycle().take(20_000).copied().collect();
        assert_eq!(of_values(&CentralMoments::of(&many)), None);
    }

    #[test]
    fn lost_digits_are_warned_of() {
        // Steps of 1/8 about 1e15, for a standard deviation of 0.5: an error of 4/4.
        let shifted: Vec<f64> = (0..8).map(|i| 1e15 + f64::from(i % 2)).collect();
        assert_eq!(of_digits(&CentralMoments::of(&shifted)), Some(Warning::FewDigits { error: 1.0 }));
        let near: Vec<f64> = (0..8).map(|i| 1e11 + f64::from(i % 2)).collect();
        assert_eq!(of_digits(&CentralMoments::of(&near)), None);
        assert_eq!(of_digits(&CentralMoments::of(&[1.0; 8])), None);
    }

    #[test]
    fn small_indices_have_digits_in_warnings() {
        assert_eq!(
            [0.31, 0.01, 3.14e-5, -2e-4, 0.0].map(decimals),
            ["0.3100", "0.0100", "3.14e-5", "-2.00e-4", "0.0000"]
        );
    }
}
