//! The file of a comparison: JSON that other programs can rely on.
//!
//! Format `apportion-trade`, version 1, described key by key in `docs/trade.md`. Later versions of the program only add keys.
//! A number that does not exist is `null`.

use serde::{Deserialize, Serialize};

use super::{ACCURACIES, Axis, Comparison, Measured};
use crate::report::{StudySetup, study_setup};
use crate::study::Study;

/// A comparison of settings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SettingsFile {
    /// Always `apportion-trade`.
    pub format: String,
    /// Version of the format.
    pub version: u32,
    /// What was asked.
    pub study: StudySetup,
    /// Version of the program.
    pub apportion_version: String,
    /// Threads that the runs had.
    pub threads: usize,
    /// What the errors are distances from.
    pub truth: TruthRecord,
    /// Every setting that was measured.
    pub settings: Vec<SettingRecord>,
    /// For each accuracy the cheapest setting.
    pub advice: Vec<AdviceRecord>,
}

/// What the errors are distances from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TruthRecord {
    /// What it is, in words.
    pub words: String,
    /// Its own error, 0 if it is exact.
    pub error: Option<f64>,
    /// Model runs that it took.
    pub runs: u64,
    /// Seconds that it took.
    pub seconds: f64,
}

/// A setting with what it costs and how far it errs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SettingRecord {
    /// The name of its curve.
    pub curve: String,
    /// What the curve stands for: `fidelity`, `sampler` or `estimator`.
    pub axis: String,
    /// Whether surrogates are fitted.
    pub surrogate: bool,
    /// Base samples.
    pub base_samples: u64,
    /// Model runs.
    pub runs: u64,
    /// Seconds, fits and estimates included.
    pub seconds: f64,
    /// Largest error of an index over all seeds; `null` if there were none.
    pub error: Option<f64>,
    /// Whether no other setting is both quicker and more accurate.
    pub is_on_front: bool,
    /// The lines of a study that ask for it.
    pub lines: String,
}

/// The cheapest setting for an accuracy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AdviceRecord {
    /// The accuracy.
    pub accuracy: f64,
    /// Which setting, by number from 0; `null` if none reaches it.
    pub setting: Option<usize>,
}

/// The file of `comparison`, made on so many threads.
pub fn build_settings(study: &Study, threads: usize, comparison: &Comparison) -> SettingsFile {
    let front = comparison.front();
    let finite = |number: f64| Some(number).filter(|number| number.is_finite());
    let record = |(place, of): (usize, &Measured)| SettingRecord {
        curve: of.curve.clone(),
        axis: match of.axis {
            Axis::Fidelity => "fidelity",
            Axis::Sampler => "sampler",
            Axis::Estimator => "estimator",
        }
        .to_owned(),
        surrogate: of.has_surrogate,
        base_samples: of.base_samples,
        runs: of.runs,
        seconds: of.seconds,
        error: finite(of.error),
        is_on_front: front.contains(&place),
        lines: of.lines.clone(),
    };
    let truth = &comparison.truth;
    SettingsFile {
        format: "apportion-trade".to_owned(),
        version: 1,
        study: study_setup(study),
        apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
        threads,
        truth: TruthRecord {
            words: truth.words.clone(),
            error: finite(truth.error),
            runs: truth.runs,
            seconds: truth.seconds,
        },
        settings: comparison.settings.iter().enumerate().map(record).collect(),
        advice: ACCURACIES
            .iter()
            .map(|&accuracy| AdviceRecord { accuracy, setting: comparison.cheapest(accuracy) })
            .collect(),
    }
}
