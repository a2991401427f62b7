//! What a careful reader of a result should know, in sentences.

use super::finished_run::{FinishedRun, names_of_swaps};
use super::output::{LOST, error_of_rounding};
use crate::estimate::CentralMoments;
use crate::model::Model;
use crate::run::Totals;
use crate::study::Study;
use crate::uncertainty::{
    EffectEstimates, Estimate, Interval, IntervalMethod, NoiseIndices, OutputIndices, differs_clearly,
};

/// Warnings about the runs behind an output.
pub(super) fn of_runs(run: &FinishedRun<'_>, runs_failed: u64, base_points_used: u64) -> Vec<String> {
    let mut warnings = Vec::new();
    let design = run.design;
    let settings = design.settings();
    if runs_failed > 0 && runs_failed == design.rows() {
        warnings.push(format!("all {runs_failed} runs failed"));
    } else if runs_failed > 0 {
        let left_out = settings.base_samples - base_points_used;
        warnings.push(format!(
            "{} of {} runs failed: every index does without the base points at which one of its own runs failed (at most \
             {left_out} of {}), and describes the part of the factor space where they succeed",
            runs_failed,
            design.rows(),
            settings.base_samples
        ));
    }
    if !design.balanced() {
        let points = design.points_per_replicate();
        warnings.push(format!(
            "{points} base points in each replicate are not a power of two: Sobol' points lose much of their accuracy; \
             base_samples = {} or {} would be better",
            points.next_power_of_two() / 2 * settings.replicates,
            points.next_power_of_two() * settings.replicates
        ));
    }
    if settings.replicates == 1 {
        match run.study.analysis.intervals {
            IntervalMethod::Replicates => {
                warnings.push("a single replicate says nothing about its error: no intervals".to_owned());
            }
            IntervalMethod::Nets => warnings.push(
                "a single net cannot tell whether it is a lucky one: intervals rest on how its parts differ (4 replicates \
                 are safer)"
                    .to_owned(),
            ),
            _ => (),
        }
    }
    warnings
}

/// Warnings that the model has raised.
pub(super) fn of_flags(model: &dyn Model, whole: &Totals) -> Vec<String> {
    let raised = model.flags().iter().zip(&whole.flags).filter(|(flag, runs)| flag.warns && **runs > 0);
    let runs = |runs: u64| if runs == 1 { "1 run".to_owned() } else { format!("{runs} runs") };
    raised.map(|(flag, count)| format!("{} ({}): {}", flag.name, runs(*count), flag.description)).collect()
}

/// Effective number of rows behind a variance below which it counts as that of few.
const FEW_ROWS: f64 = 40.0;

/// Share of the variance that surrogates should explain for a split design to gain (`docs/accuracy/surrogate.md`).
pub(crate) const LITTLE: f64 = 0.9;

/// Excess kurtosis (that of an exponential distribution) up to which few rows are just a small sample.
const HEAVY: f64 = 6.0;

/// A warning if the variance of an output rests on few of its `values`: n/(g2 + 3) of n rows with the excess kurtosis g2
/// is their number if all others did nothing.
pub(super) fn of_values(values: &CentralMoments) -> Option<String> {
    let (n, kurtosis) = (values.count(), values.excess_kurtosis()?);
    let rows = n as f64 / (kurtosis + 3.0);
    (kurtosis > HEAVY && rows < FEW_ROWS).then(|| {
        format!(
            "the variance rests on few rows, as if on {rows:.0} of the {n} of A and B (excess kurtosis {kurtosis:.0}): rows as \
             large may be missing from the sample, so that intervals are longer above the estimates than below, and may still be \
             too short; more base samples help, or the logarithm of the output"
        )
    })
}

/// A warning of outputs whose size leaves few digits to what varies in them.
pub(super) fn of_digits(values: &CentralMoments) -> Option<String> {
    let error = error_of_rounding(values);
    (error > LOST && error.is_finite()).then(|| {
        format!(
            "the output is so much larger than what varies in it that doubles keep few digits of that: indices may be off by \
             some {error:.1e}; subtract a constant from it before it is rounded"
        )
    })
}

/// A warning of factors that take single values and depend on others: what is held fixed is the normal score behind a value.
fn of_dependent_steps(study: &Study) -> Option<String> {
    let space = study.space();
    let depends =
        |name: &str| space.dependences().iter().any(|dependence| dependence.factors().iter().any(|of| of == name));
    let steps = space.factors().iter().filter(|factor| {
        depends(&factor.name) && (factor.distribution().levels().is_some() || factor.distribution().is_whole())
    });
    let names: Vec<&str> = steps.map(|factor| factor.name.as_str()).collect();
    (!names.is_empty()).then(|| {
        format!(
            "{}: single values that depend on other factors: to fix the factor here is to fix the normal score behind its value, \
             which says more of the others than the value does; its own indices are too large by that, and those of its \
             partners too small",
            names.join(", ")
        )
    })
}

/// Indices below this are not warned of one by one.
const TRACE: f64 = 1e-6;

/// An index in a warning: four decimals, or three digits of what is smaller.
fn told(index: f64) -> String {
    if index == 0.0 || index.abs() >= 0.01 { format!("{index:.4}") } else { format!("{index:.2e}") }
}

/// Warnings about indices that cannot all be right. Each compares an estimate with its interval, so that the noise of
/// a small sample does not raise it.
pub(super) fn of_indices(study: &Study, indices: &OutputIndices) -> Vec<String> {
    let mut warnings = Vec::new();
    let alone = study.design.settings().replicates == 1 && study.analysis.intervals == IntervalMethod::Replicates;
    if !alone && indices.factors.iter().all(|effect| effect.total.interval.is_none()) {
        warnings.push(
            "no intervals: without the rows of one part of the sample the output does not vary (or too few rows are left), so \
             that nothing tells the error of the indices: more base samples are needed"
                .to_owned(),
        );
    }
    if indices.surrogate.as_ref().is_some_and(|used| used.is_heavy_tailed) {
        warnings.push(
            "a few runs carry what the surrogate leaves unexplained, and others like them may be missing: the intervals of the \
             corrected indices hold those of the plain ones too"
                .to_owned(),
        );
    }
    if let Some(used) =
        indices.surrogate.as_ref().filter(|used| study.design.plain_rows() > 0 && used.explained < LITTLE)
    {
        warnings.push(format!(
            "the surrogates explain {:.0} % of the variance of runs that they were not fitted to, so that plain rows, which only \
             they learn from, are of little use: all runs as base samples are better for this output, and errors and intervals \
             may be too small here",
            (100.0 * used.explained).max(0.0)
        ));
    }
    warnings.extend(of_dependent_steps(study));
    warnings.extend(indices.noise.as_ref().and_then(|noise| of_noise(study, indices, noise)));
    for (name, effect) in names_of_swaps(study).iter().zip(indices.effects()) {
        let total = effect.dependent.map_or(effect.total, |dependent| dependent.full_total).estimate;
        // Of less nobody needs to be warned.
        let is_visible = effect.first_order.estimate.abs().max(total.abs()) >= TRACE;
        if effect.interaction.estimate < 0.0 && differs_clearly(effect.interaction) && is_visible {
            warnings.push(format!(
                "{name}: the first-order index {} exceeds the total index {} beyond the error of their difference: too few \
                 samples",
                told(effect.first_order.estimate),
                told(total)
            ));
        }
        if effect.contradictory && is_visible {
            warnings.push(format!(
                "{name}: the interval of the first-order index {} lay above that of the total index {}, and both were \
                 lengthened until they met: too few samples",
                told(effect.first_order.estimate),
                told(total)
            ));
        }
        if differs_clearly(effect.check_gap) {
            warnings.push(format!(
                "{name}: two formulas for the first-order index differ by {:.2e}, beyond the error of their difference: \
                 too few samples, or a heavy-tailed output (its logarithm may serve better)",
                effect.check_gap.estimate.abs()
            ));
        }
        warnings.extend(disagreements(study, name, effect));
    }
    // Indices of factors that depend on each other sum to anything.
    if study.space.copula().is_some() {
        return warnings;
    }
    if indices.sum_first_order.interval.is_some_and(|interval| interval.low <= 0.0) {
        let moving = indices.factors.iter().filter(|effect| effect.total.estimate != 0.0).count();
        // One factor alone interacts with none.
        let why = if moving > 1 {
            "the output comes from interactions, or the samples are too few"
        } else {
            "the samples are too few"
        };
        warnings.push(format!(
            "the sum of the first-order indices may be 0: {why}; shares of the first-order indices mean nothing"
        ));
    }
    for (name, effect) in names_of_swaps(study).iter().zip(indices.effects()) {
        if clearly_above(effect.total, Some(1.0)) {
            warnings.push(format!(
                "{name}: the total index {:.4} is above 1 by more than its error: too few samples, or rows that do not belong \
                 together",
                effect.total.estimate
            ));
        }
    }
    // Where this program runs the model, its rows are in order.
    if study.subject.is_external() && looks_shuffled(indices) {
        warnings.push(
            "every total index is near 1 and every first-order index near 0, as rows in another order than that of the design \
             give; if the order is right, the output is all interaction"
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

/// A noise that does nothing, or all.
fn of_noise(study: &Study, indices: &OutputIndices, noise: &NoiseIndices) -> Option<String> {
    let (name, of_noise) = (&study.space.factors()[noise.factor].name, &indices.factors[noise.factor]);
    let none = |interval: Interval| interval.low == 0.0 && interval.high == 0.0;
    if of_noise.total.estimate == 0.0 && of_noise.total.interval.is_none_or(none) {
        return Some(format!(
            "{name}: no run changed with its seed: the model is not stochastic, or draws its random numbers without it"
        ));
    }
    noise.mean_share.interval.is_some_and(|share| share.low <= 0.0).then(|| {
        format!(
            "{name}: all variance may be noise, so that the indices of the mean over it may be anything: more base samples are \
             needed, or several runs of each row (repetitions in [noise])"
        )
    })
}

/// Estimators asked for whose indices differ from the default ones by more than chance.
fn disagreements(study: &Study, name: &str, effect: &EffectEstimates) -> Vec<String> {
    let mut warnings = Vec::new();
    for (estimator, other) in study.analysis.estimators.iter().zip(&effect.others) {
        for (what, gap) in [("first-order", other.first_order_gap), ("total", other.total_gap)] {
            if let Some(gap) = gap.filter(|gap| differs_clearly(*gap)) {
                warnings.push(format!(
                    "{name}: the {what} index by `{}` differs from the default one by {:.2e}, beyond the error of their \
                     difference: one of the two is not to be trusted on this output",
                    estimator.name(),
                    gap.estimate
                ));
            }
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

fn high(estimate: Estimate) -> Option<f64> {
    estimate.interval.map(|interval| interval.high)
}

fn clearly_above(estimate: Estimate, bound: Option<f64>) -> bool {
    matches!((estimate.interval, bound), (Some(interval), Some(bound)) if interval.low > bound)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(low: f64, high: f64) -> Estimate {
        Estimate { estimate: (low + high) / 2.0, interval: Some(Interval { low, high }) }
    }

    #[test]
    fn heavy_tails_are_warned_of_and_small_samples_are_not() {
        // 3 rows of 1000 have another value: g2 + 3 = 1/p - 3 + 3 p..., n/(g2 + 3) = 3.0.
        let rare: Vec<f64> = (0..1000).map(|i| f64::from(u8::from(i % 400 == 0))).collect();
        let warning = of_values(&CentralMoments::of(&rare)).unwrap();
        assert!(warning.contains("as if on 3 of the 1000 of A and B"), "{warning}");
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
        let warning = of_digits(&CentralMoments::of(&shifted)).unwrap();
        assert!(warning.contains("off by some 1.0e0"), "{warning}");
        let near: Vec<f64> = (0..8).map(|i| 1e11 + f64::from(i % 2)).collect();
        assert_eq!(of_digits(&CentralMoments::of(&near)), None);
        assert_eq!(of_digits(&CentralMoments::of(&[1.0; 8])), None);
    }

    #[test]
    fn small_indices_have_digits_in_warnings() {
        assert_eq!([0.31, 0.01, 3.14e-5, -2e-4, 0.0].map(told), ["0.3100", "0.0100", "3.14e-5", "-2.00e-4", "0.0000"]);
    }

    #[test]
    fn only_clear_contradictions_count() {
        assert!(!clearly_above(estimate(0.9, 1.2), Some(1.0)));
        assert!(clearly_above(estimate(1.1, 1.2), Some(1.0)));
        assert!(!clearly_above(Estimate { estimate: 2.0, interval: None }, Some(1.0)));
        assert!(!differs_clearly(estimate(0.001, 0.021)));
        assert!(differs_clearly(estimate(0.02, 0.03)));
        assert!(!differs_clearly(estimate(0.0, 0.0)));
    }
}
