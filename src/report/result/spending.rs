//! What a run spent and chose by itself, why it ended, and the cheaper models beside it, in the result file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a run that was asked for an accuracy chose, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct SpendingRecord {
    /// The half width that was asked for.
    pub accuracy: f64,
    /// Runs of the model in all, those of trials included.
    pub runs: u64,
    /// Runs that the same half width would take at least without surrogates and cheaper models, by the intervals of the plain
    /// indices of this run; `null` if they are unknown.
    pub plain_runs: Option<u64>,
    /// Why it was chosen, in sentences.
    pub reasons: Vec<String>,
    /// Lines of a study that make the same run again, to the bit, in the place of `accuracy`.
    pub lines: String,
}

/// Why a growing run ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct StoppingRecord {
    /// In words.
    pub reason: String,
    /// Whether every index met the target; `null` if there was none.
    pub target_met: Option<bool>,
    /// The half width that was asked for.
    pub target_half_width: Option<f64>,
    /// The time that it might take, in seconds.
    pub budget_seconds: Option<f64>,
    /// The model runs that it might take.
    pub max_runs: Option<u64>,
}

/// What a model with a ladder of fidelities spent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct EffortRecord {
    /// The rungs that answered, and how many runs each.
    pub rungs: Vec<RungRecord>,
    /// Evaluations of the right-hand side (of the closed form, on the rung that has one), in all.
    pub evaluations: u64,
    /// Largest relative error of any run, as its rung estimates it from what it leaves out.
    pub largest_error_estimate: f64,
}

/// How many runs a rung answered.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct RungRecord {
    /// The rung.
    pub rung: String,
    /// Number of runs.
    pub runs: u64,
}
