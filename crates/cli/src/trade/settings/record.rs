//! The file of a comparison: JSON that other programs can rely on.
//!
//! Format `apportion-trade`, version 1, described in `docs/trade.md`. Later versions of the program only add keys. A
//! number that does not exist is `null`.

use std::ops::Deref;

use apportion::analysis::study_setup;
use apportion::result::StudySetup;
use apportion::study::Study;
use serde::{Deserialize, Serialize};

use super::{ACCURACIES, Comparison};

/// A comparison of settings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SettingsFile {
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
    /// The comparison.
    #[serde(flatten)]
    pub comparison: Comparison,
    /// The cheapest setting for each accuracy.
    pub advice: Vec<AdviceRecord>,
}

impl Deref for SettingsFile {
    type Target = Comparison;

    fn deref(&self) -> &Comparison {
        &self.comparison
    }
}

/// The cheapest setting for an accuracy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AdviceRecord {
    /// The accuracy.
    pub accuracy: f64,
    /// Number of the setting, from 0; `null` if none reaches it.
    pub setting: Option<usize>,
}

/// Builds the file of `comparison`, made on so many threads.
pub fn build_settings(study: &Study, threads: usize, comparison: Comparison) -> SettingsFile {
    let cheapest = |accuracy| AdviceRecord { accuracy, setting: comparison.cheapest(accuracy) };
    let advice = ACCURACIES.map(cheapest).to_vec();
    SettingsFile {
        format: "apportion-trade".to_owned(),
        version: 1,
        study: study_setup(study),
        apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
        threads,
        comparison,
        advice,
    }
}
