//! Comparison of the settings of a study: the time of each, and the distance of its indices from the reference.
//!
//! The reference is the exact result of a function that has one, else the indices by the finest model, as accurate as a
//! part of the time allows; its own error is part of every reported error. Times are measured, so they differ between
//! comparisons; the indices do not.

mod curve;
mod document;
mod record;
mod truth;

use std::sync::atomic::AtomicBool;

use apportion::clock::Instant;
use apportion::estimate::Estimator;
use apportion::result::StudyResult;
use apportion::run::RunError;
use apportion::study::Study;
pub use curve::Axis;
use curve::Curve;
pub use document::settings_document;
pub use record::{SettingsFile, build_settings};
use serde::{Deserialize, Serialize};
use truth::Truth;

/// Base samples at the start of a curve, and their growth factor.
const FIRST_BASE_SAMPLES: u64 = 16;
const STEP: u64 = 4;

/// Maximum number of base samples of a curve.
const MAX_BASE_SAMPLES: u64 = 1 << 22;

/// Part of the time for the reference.
const SHARE_OF_TRUTH: f64 = 0.25;

/// Half widths for which the cheapest setting is reported.
pub const ACCURACIES: [f64; 5] = [0.1, 0.03, 0.01, 0.003, 0.001];

/// A request for a comparison.
#[derive(Clone, Copy)]
pub struct SettingsJob<'a> {
    /// The study.
    pub study: &'a Study,
    /// Approximate time limit in seconds.
    pub seconds: f64,
    /// Number of seeds of every setting; the largest of their errors is used.
    pub seeds: u64,
    /// Threads; 0 for one per core.
    pub threads: usize,
    /// Stops it soon after it is set.
    pub stop: Option<&'a AtomicBool>,
    /// Receives the next measurement, and the completed part of the whole.
    pub on_progress: &'a dyn Fn(&str, f64),
}

impl SettingsJob<'_> {
    /// Runs a variant of the study.
    fn run(&self, study: &Study) -> Result<StudyResult, RunError> {
        let runner = study.runner().threads(self.threads);
        self.stop.into_iter().fold(runner, |runner, stop| runner.stop(stop)).run()
    }
}

/// The result of a comparison.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// The reference for the errors.
    pub truth: TruthFound,
    /// All measured settings.
    pub settings: Vec<Measured>,
}

/// The reference for the errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TruthFound {
    /// Its description.
    pub words: String,
    /// Its own error: the largest half width of its intervals, 0 if it is exact; `None` if it has no intervals.
    pub error: Option<f64>,
    /// Number of model runs for it.
    pub runs: u64,
    /// Seconds for it.
    pub seconds: f64,
}

/// A setting with its cost and error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The name of its curve.
    pub curve: String,
    /// The axis of the curve.
    pub axis: Axis,
    /// Whether surrogates are fitted.
    #[serde(rename = "surrogate")]
    pub has_surrogate: bool,
    /// Base samples.
    pub base_samples: u64,
    /// Model runs.
    pub runs: u64,
    /// Seconds, fits and estimates included: the minimum over all seeds.
    pub seconds: f64,
    /// Largest error of a first-order or total index of any output, over all seeds; `None` without indices.
    pub error: Option<f64>,
    /// Whether no other setting is both quicker and more accurate.
    pub is_on_front: bool,
    /// The lines of a study with this setting.
    pub lines: String,
}

impl Comparison {
    fn new(truth: TruthFound, settings: Vec<Measured>) -> Self {
        let mut comparison = Self { truth, settings };
        for place in comparison.front() {
            comparison.settings[place].is_on_front = true;
        }
        comparison
    }

    /// Returns the Pareto-optimal settings in time and error, by number, the quickest first. Errors below that of the
    /// reference are equal.
    pub fn front(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.settings.len()).filter(|&k| self.settings[k].error.is_some()).collect();
        order.sort_by(|&a, &b| self.settings[a].seconds.total_cmp(&self.settings[b].seconds));
        let mut best = f64::INFINITY;
        order.retain(|&k| {
            let error = self.settings[k].error.unwrap_or(f64::INFINITY).max(self.truth_error());
            let is_better = error < best;
            best = best.min(error);
            is_better
        });
        order
    }

    fn truth_error(&self) -> f64 {
        self.truth.error.unwrap_or(f64::INFINITY)
    }

    /// Returns the cheapest setting with an error of at most `accuracy`, including the error of the reference.
    pub fn cheapest(&self, accuracy: f64) -> Option<usize> {
        self.front().into_iter().find(|&k| self.settings[k].error.is_some_and(|e| e + self.truth_error() <= accuracy))
    }
}

/// Measures the settings of a study.
///
/// # Errors
/// [`RunError`] if the finest model fails, or the comparison is stopped. Settings that cannot be run are omitted.
pub fn compare_settings(job: &SettingsJob<'_>) -> Result<Comparison, RunError> {
    let start = Instant::now();
    (job.on_progress)("the reference", 0.0);
    let truth = Truth::new(job, SHARE_OF_TRUTH * job.seconds)?;
    let curves = Curve::all(job.study);
    let mut settings = Vec::new();
    for (number, curve) in curves.iter().enumerate() {
        let done = start.elapsed().as_secs_f64();
        (job.on_progress)(&curve.name(), (done / job.seconds).min(1.0));
        let share = (job.seconds - done).max(0.0) / (curves.len() - number) as f64;
        settings.extend(measured(job, curve, &truth, share)?);
    }
    Ok(Comparison::new(truth.found, settings))
}

/// Measures the points of `curve` that fit into so many seconds, at least the first.
fn measured(job: &SettingsJob<'_>, curve: &Curve, truth: &Truth, seconds: f64) -> Result<Vec<Measured>, RunError> {
    let start = Instant::now();
    let mut all = Vec::new();
    let mut base_samples = FIRST_BASE_SAMPLES;
    while base_samples <= MAX_BASE_SAMPLES {
        let began = start.elapsed().as_secs_f64();
        let mut point: Option<Measured> = None;
        for seed in 0..job.seeds.max(1) {
            let own = job.study.design().settings().seed.wrapping_add(seed);
            let Ok(study) = curve.study(job.study, base_samples, own) else { return Ok(all) };
            let began = Instant::now();
            let result = match job.run(&study) {
                Ok(result) => result,
                Err(error @ RunError::Interrupted { .. }) => return Err(error),
                Err(_) => return Ok(all),
            };
            let seconds = began.elapsed().as_secs_f64();
            let error = error(&result, curve.estimator, truth);
            let (runs, settings) = (result.provenance.model_runs, result.provenance.base_samples);
            let point = point.get_or_insert_with(|| Measured {
                curve: curve.name(),
                axis: curve.axis,
                has_surrogate: curve.has_surrogate,
                base_samples: settings,
                runs,
                seconds,
                error,
                is_on_front: false,
                lines: curve.lines(settings),
            });
            point.seconds = point.seconds.min(seconds);
            point.error = point.error.zip(error).map(|(one, other)| one.max(other));
        }
        all.extend(point);
        let spent = start.elapsed().as_secs_f64();
        if spent + STEP as f64 * (spent - began) > seconds {
            break;
        }
        base_samples *= STEP;
    }
    Ok(all)
}

/// Returns the largest error of an index; `None` if one is missing, or all are.
fn error(result: &StudyResult, estimator: Estimator, truth: &Truth) -> Option<f64> {
    let mut largest = 0.0_f64;
    for (output, truth) in result.outputs.iter().zip(&truth.outputs) {
        let (Some(indices), Some(truth)) = (&output.indices, truth) else { continue };
        let others = output.estimators.first().filter(|_| estimator != Estimator::Default);
        for (place, (index, [first, total])) in indices.iter().zip(truth).enumerate() {
            let (found_first, found_total) = match others {
                Some(others) => {
                    let other = &others.indices[place];
                    (other.first_order.map(|e| e.estimate), other.total.map(|e| e.estimate))
                }
                None => (Some(index.effect.first_order.estimate), Some(index.effect.total.estimate)),
            };
            for (found, truth) in [(found_first, first), (found_total, total)] {
                let error = found.map_or(f64::INFINITY, |found| (found - truth).abs());
                largest = if error.is_nan() { f64::INFINITY } else { largest.max(error) };
            }
        }
    }
    let has_any = result.outputs.iter().any(|output| output.indices.is_some());
    Some(largest).filter(|error| has_any && error.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured(seconds: f64, error: Option<f64>) -> Measured {
        Measured {
            curve: String::new(),
            axis: Axis::Fidelity,
            has_surrogate: false,
            base_samples: 16,
            runs: 96,
            seconds,
            error,
            is_on_front: false,
            lines: String::new(),
        }
    }

    fn comparison(error_of_truth: f64, settings: &[(f64, f64)]) -> Comparison {
        let truth = TruthFound { words: String::new(), error: Some(error_of_truth), runs: 0, seconds: 0.0 };
        let known = |error: f64| Some(error).filter(|error| error.is_finite());
        Comparison::new(truth, settings.iter().map(|&(seconds, error)| measured(seconds, known(error))).collect())
    }

    #[test]
    fn the_front_is_not_beaten_in_both_time_and_error() {
        let all = [(3.0, 0.01), (1.0, 0.5), (2.0, 0.6), (2.5, 0.2), (4.0, f64::INFINITY), (5.0, 1e-9), (6.0, 1e-12)];
        assert_eq!(comparison(0.0, &all).front(), [1, 3, 0, 5, 6]);
        // Differences below the error of the reference count as equal.
        assert_eq!(comparison(1e-6, &all).front(), [1, 3, 0, 5]);
    }

    #[test]
    fn the_cheapest_setting_includes_the_error_of_the_reference() {
        let all = [(1.0, 0.09), (2.0, 0.02), (3.0, 0.001)];
        assert_eq!(comparison(0.0, &all).cheapest(0.1), Some(0));
        assert_eq!(comparison(0.02, &all).cheapest(0.1), Some(1));
        assert_eq!(comparison(0.02, &all).cheapest(0.02), None);
    }
}
