//! Correction of plain indices by surrogates, with the errors of what the surrogates leave.
//!
//! No net is corrected by an expansion fitted to it: a poor surrogate costs accuracy, but intervals stay valid.

mod contributions;
mod error;
mod estimates;
mod held_out;
mod influenced;
mod judged;
mod kind;
mod low_fidelity;
mod many_outputs;
mod mean;
mod nets;
mod plain;
mod replace;
mod surrogate_use;

pub use error::CorrectionError;
pub use estimates::{ErrorShares, SurrogateEstimates};
pub use influenced::EstimateWithInfluences;
pub(crate) use judged::Judged;
pub(crate) use low_fidelity::{IndependentOutputs, LowFidelityOutputs, low_fidelity_estimates};
pub(crate) use many_outputs::surrogates_together;
pub(crate) use plain::{PlainFit, PlainRows};
pub(crate) use replace::{correct, hull};
pub use surrogate_use::{LowFidelityUse, Refusal, SurrogateUse};
