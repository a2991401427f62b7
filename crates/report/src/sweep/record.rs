//! The sweep file: JSON that other programs can rely on.
//!
//! Format `apportion-sweep`, version 2, described key by key in `docs/reference/other-formats.md`. Later versions of the program
//! only add keys. A number that does not exist is `null`.

use apportion::model::Model;
use apportion::result::{StudySetup, ValidityRecord};
use apportion::study::Study;
use apportion::sweep::{NominalOutput, Sweep, Sweeps, SweptOutput};
use apportion_base::quantity::Unlikely;
use serde::{Deserialize, Serialize};

use crate::format::short_with_unit;

/// All sweeps of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepFile {
    /// Always `apportion-sweep`.
    pub format: String,
    /// Version of the format.
    pub version: u32,
    /// The study.
    pub study: StudySetup,
    /// The method.
    pub provenance: SweepProvenance,
    /// Every output with all factors at their nominal values.
    pub nominal: Vec<NominalOutput>,
    /// One entry per factor swept.
    pub sweeps: Vec<Sweep>,
    /// Rows on which the model's assumptions do not hold; these rows are used too.
    pub validity: Vec<ValidityRecord>,
    /// Warnings, in sentences.
    pub warnings: Vec<String>,
}

/// How the sweeps were made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepProvenance {
    /// Version of the program.
    pub apportion_version: String,
    /// Runs of the model.
    pub model_runs: u64,
}

/// Formats the value at `place` of a sweep, or its label, with its unit.
pub(super) fn value_in_words(sweep: &Sweep, place: usize) -> String {
    match (&sweep.labels, sweep.values.get(place)) {
        (Some(labels), Some(_)) => labels[place].clone(),
        (None, Some(value)) => short_with_unit(*value, &sweep.unit),
        (_, None) => String::new(),
    }
}

/// Returns the range of an output; below every width if it has no value.
pub(super) fn width(output: &SweptOutput) -> f64 {
    output.low.zip(output.high).map_or(f64::NEG_INFINITY, |(low, high)| high - low)
}

/// Returns a sentence on the unlikely value of output number `place`, if it has one; runs are counted sweep by sweep.
fn unlikely(sweeps: &Sweeps, place: usize, output: &str) -> Option<String> {
    let values = sweeps.sweeps.iter().flat_map(|sweep| &sweep.outputs[place].values);
    let values: Vec<f64> = values.map(|y| y.unwrap_or(f64::NAN)).collect();
    Unlikely::find(&values).map(|value| format!("{output}: {}", value.in_runs(value.first + 1)))
}

/// Builds the file of the sweeps of `study`, whose model is `model`.
pub fn build_sweep(study: &Study, model: &dyn Model, sweeps: Sweeps) -> SweepFile {
    SweepFile {
        format: "apportion-sweep".to_owned(),
        version: 2,
        study: study.setup(),
        provenance: SweepProvenance {
            apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
            model_runs: sweeps.runs,
        },
        warnings: sweeps
            .nominal
            .iter()
            .enumerate()
            .filter_map(|(place, of)| unlikely(&sweeps, place, &of.output))
            .collect(),
        nominal: sweeps.nominal,
        sweeps: sweeps.sweeps,
        validity: ValidityRecord::of_flags(model.flags().iter().zip(sweeps.flags), sweeps.runs),
    }
}
