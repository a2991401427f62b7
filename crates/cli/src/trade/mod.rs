//! Comparison of the settings of a study: the time of each, and the distance of its indices from the reference.
//!
//! The reference is the exact result of a function that has one, else the indices by the finest model, as accurate as a
//! part of the time allows; the error of the reference is part of every reported error. Times are measured, so they differ between
//! comparisons; the indices do not. The comparison is written as JSON that other programs can rely on, see `docs/guide/trade.md`.

mod curve;
mod document;

use std::sync::atomic::AtomicBool;

use apportion::result::{StudyResult, StudySetup};
use apportion::run::{RunError, threads_in_force};
use apportion::study::{Study, SurrogateChoice, Target};
use apportion_base::clock::Instant;
pub use curve::Axis;
use curve::{Curve, SURROGATES, indices_only, rungs};
pub use document::settings_document;
use serde::{Deserialize, Serialize};

/// Base samples at the start of a curve, and their growth factor.
const FIRST_BASE_SAMPLES: u64 = 16;
const STEP: u64 = 4;

/// Maximum number of base samples of a curve.
const MAX_BASE_SAMPLES: u64 = 1 << 22;

/// Part of the time for the reference.
const SHARE_OF_TRUTH: f64 = 0.25;

/// Seconds that the runs of a setting last together at least, so that their times mean something.
const MIN_SECONDS: f64 = 0.05;

/// Number of seeds that a setting has even if they take more than its part of the time.
const MIN_SEEDS: usize = 3;

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
    pub stop: &'a AtomicBool,
    /// Receives the next measurement, and the completed part of the comparison.
    pub on_progress: &'a dyn Fn(&str, f64),
}

impl SettingsJob<'_> {
    /// Runs a variant of the study.
    fn run(&self, study: &Study) -> Result<StudyResult, RunError> {
        study.runner().threads(self.threads).stop(self.stop).run()
    }
}

/// A comparison, in the format `apportion-trade`, version 1. Later versions of the program only add keys. A number that
/// does not exist is `null`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Always `apportion-trade`.
    pub format: String,
    /// Version of the format.
    pub version: u32,
    /// The study.
    pub study: StudySetup,
    /// Version of the program.
    pub apportion_version: String,
    /// Number of threads of the runs.
    pub threads: usize,
    /// The reference for the errors.
    pub truth: TruthRecord,
    /// The curve of the study's model and sampler, without surrogates.
    pub own: String,
    /// All measured settings.
    pub settings: Vec<Measured>,
    /// The cheapest setting for each accuracy.
    pub advice: Vec<Advice>,
}

/// The cheapest setting for an accuracy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Advice {
    /// The accuracy.
    pub accuracy: f64,
    /// Number of the setting, from 0; `null` if none reaches it.
    pub setting: Option<usize>,
}

/// The reference for the errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TruthRecord {
    /// Its description.
    pub words: String,
    /// Its error: the largest half width of its intervals, 0 if it is exact; `None` if it has no intervals.
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
    /// Seconds, fits and estimates included: the minimum over all seeds, which are run again until they last 50 ms.
    pub seconds: f64,
    /// The median of these seconds.
    pub usual_seconds: f64,
    /// Number of seeds.
    pub seeds: usize,
    /// Largest error of a first-order or total index of any output, over all seeds; `None` without indices.
    pub error: Option<f64>,
    /// The smaller of the largest errors of every other seed and of the rest: how small it may be by chance.
    pub least_error: Option<f64>,
    /// Whether no other setting is both quicker and more accurate.
    pub is_on_front: bool,
    /// The lines of a study with this setting.
    pub lines: String,
}

impl Measured {
    /// Returns whether it is on the curve of this name, with or without surrogates.
    fn is_on(&self, curve: &str) -> bool {
        self.curve.trim_end_matches(SURROGATES) == curve
    }
}

/// Returns the Pareto-optimal settings in time and error, by number, the quickest first. Errors below that of the
/// reference are equal.
fn front(settings: &[Measured], truth_error: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..settings.len()).collect();
    order.sort_by(|&a, &b| settings[a].seconds.total_cmp(&settings[b].seconds));
    let mut best = f64::INFINITY;
    order.retain(|&k| {
        let error = settings[k].error.map_or(f64::INFINITY, |error| error.max(truth_error));
        let is_better = error < best;
        best = best.min(error);
        is_better
    });
    order
}

/// Returns the cheapest setting with an error of at most `accuracy`, including the error of the reference; the study's
/// curve `study_curve` instead, if that differs from that by no more than the noise of time and error.
fn cheapest(settings: &[Measured], truth_error: f64, study_curve: &str, accuracy: f64) -> Option<usize> {
    let mut front = front(settings, truth_error).into_iter();
    let quickest = front.find(|&k| settings[k].error.is_some_and(|error| error + truth_error <= accuracy))?;
    let best = &settings[quickest];
    if best.is_on(study_curve) {
        return Some(quickest);
    }
    let alike = settings.iter().position(|of| {
        let reaches = of.least_error.is_some_and(|error| error + truth_error <= accuracy);
        of.is_on(study_curve) && of.seconds <= best.usual_seconds && reaches
    });
    alike.or(Some(quickest))
}

/// Target half width of a reference.
const FINEST: f64 = 1e-6;

/// First-order and total index of every factor, of every output that has them.
type Indices = Vec<[f64; 2]>;

struct Truth {
    outputs: Vec<Option<Indices>>,
    record: TruthRecord,
}

impl Truth {
    /// Returns the exact indices if the function has them, else those of a run of the finest model of so many seconds.
    fn new(job: &SettingsJob<'_>, seconds: f64) -> Result<Self, RunError> {
        let study = job.study;
        if let Some((first, total)) = study.subject().exact_indices(study.space()) {
            let indices = first.into_iter().zip(total).map(|(first, total)| [first, total]).collect();
            let words = "the exact indices of the function".to_owned();
            let record = TruthRecord { words, error: Some(0.0), runs: 0, seconds: 0.0 };
            return Ok(Self { outputs: vec![Some(indices)], record });
        }
        let rung = rungs(study).into_iter().rfind(|rung| rung.is_finest);
        let name = rung.as_ref().map_or_else(String::new, |rung| rung.name.clone());
        let subject = rung.map_or_else(|| study.subject().clone(), |rung| rung.subject);
        let max_time = study.target().max_time.map_or(seconds, |limit| limit.min(seconds));
        let target = Target::accuracy(FINEST).max_time(max_time);
        let analysis = indices_only(study);
        let finest = study.clone().with_subject(subject).with_target(target);
        // A design with fewer swaps always exists.
        let finest = finest.clone().with_design(study.design().settings().clone(), analysis).unwrap_or(finest);
        let start = Instant::now();
        let result = job.run(&finest)?;
        let (mut outputs, mut error) = (Vec::new(), Some(0.0));
        for output in &result.outputs {
            let indices = output.indices.as_ref().map(|indices| {
                indices.iter().map(|i| [i.effect.first_order.estimate, i.effect.total.estimate]).collect()
            });
            if indices.is_some() {
                error = error.zip(output.largest_half_width()).map(|(largest, width)| f64::max(largest, width));
            }
            outputs.push(indices);
        }
        let runs = result.spending.as_ref().map_or(result.provenance.model_runs, |spending| spending.runs);
        let words = format!("a run of {name} with {} base samples", result.provenance.base_samples);
        let record = TruthRecord { words, error, runs, seconds: start.elapsed().as_secs_f64() };
        Ok(Self { outputs, record })
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
    let (truth, own) = (truth.record, job.study.subject().rung_name());
    let truth_error = truth.error.unwrap_or(f64::INFINITY);
    for place in front(&settings, truth_error) {
        settings[place].is_on_front = true;
    }
    let advice = ACCURACIES
        .map(|accuracy| Advice { accuracy, setting: cheapest(&settings, truth_error, &own, accuracy) })
        .to_vec();
    Ok(Comparison {
        format: "apportion-trade".to_owned(),
        version: 1,
        study: job.study.setup(),
        apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
        threads: threads_in_force(job.threads),
        advice,
        truth,
        own,
        settings,
    })
}

/// Measures the points of `curve` that fit into so many seconds, at least the first.
fn measured(job: &SettingsJob<'_>, curve: &Curve, truth: &Truth, seconds: f64) -> Result<Vec<Measured>, RunError> {
    let start = Instant::now();
    let mut all = Vec::new();
    let mut base_samples = FIRST_BASE_SAMPLES;
    while base_samples <= MAX_BASE_SAMPLES {
        let began = start.elapsed().as_secs_f64();
        let (mut errors, mut times, mut last) = (Vec::new(), Vec::new(), None);
        let seeds = job.seeds.max(1) as usize;
        while errors.len() < seeds || times.iter().sum::<f64>() < MIN_SECONDS {
            let seed = job.study.design().settings().seed.wrapping_add((times.len() % seeds) as u64);
            let Ok(study) = curve.study(job.study, base_samples, seed) else { return Ok(all) };
            let began = Instant::now();
            let result = match job.run(&study) {
                Ok(result) => result,
                Err(error @ RunError::Interrupted { .. }) => return Err(error),
                Err(_) => return Ok(all),
            };
            times.push(began.elapsed().as_secs_f64());
            if errors.len() < seeds {
                errors.push(error(&result, truth));
            }
            last = Some(result.provenance);
            if errors.len() >= MIN_SEEDS && start.elapsed().as_secs_f64() > seconds {
                break;
            }
        }
        times.sort_by(f64::total_cmp);
        let [error, even, odd] = [(0, 1), (0, 2), (1, 2)].map(|(first, step)| {
            let mut errors = errors.iter().skip(first % errors.len()).step_by(step);
            errors.try_fold(0.0, |largest: f64, error| Some(largest.max((*error)?)))
        });
        all.extend(last.map(|of| Measured {
            curve: curve.name(),
            axis: curve.axis,
            has_surrogate: curve.surrogate == SurrogateChoice::On,
            base_samples: of.base_samples,
            runs: of.model_runs,
            seconds: times[0],
            usual_seconds: times[times.len() / 2],
            seeds: errors.len(),
            error,
            least_error: even.zip(odd).map(|(one, other)| one.min(other)),
            is_on_front: false,
            lines: curve.lines(of.base_samples),
        }));
        let spent = start.elapsed().as_secs_f64();
        if spent + STEP as f64 * (spent - began) > seconds {
            break;
        }
        base_samples *= STEP;
    }
    Ok(all)
}

/// Returns the largest error of an index; `None` if one is missing, or all are.
fn error(result: &StudyResult, truth: &Truth) -> Option<f64> {
    let mut largest = None;
    for (output, truth) in result.outputs.iter().zip(&truth.outputs) {
        let (Some(indices), Some(truth)) = (&output.indices, truth) else { continue };
        for (index, [first, total]) in indices.iter().zip(truth) {
            for (estimate, truth) in [(index.effect.first_order, first), (index.effect.total, total)] {
                let error = (estimate.estimate - truth).abs();
                largest = Some(if error.is_nan() { f64::INFINITY } else { error.max(largest.unwrap_or(0.0)) });
            }
        }
    }
    largest.filter(|error| error.is_finite())
}
