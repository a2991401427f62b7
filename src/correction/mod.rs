//! Correction of plain indices by surrogates, with the errors of what the surrogates leave.

mod contributions;
mod error;
mod estimates;
mod influenced;
mod mean;
mod replace;
mod surrogate_use;

pub(crate) use contributions::{
    Contributions, Effects, interaction, is_interaction, mean_power, touches, values_and_rest, within,
};
pub use error::{CorrectionError, in_parts};
pub use estimates::{ErrorShares, SurrogateEstimates};
pub use influenced::EstimateWithInfluences;
pub(crate) use replace::{correct, hull};
pub use surrogate_use::{ChosenTerms, Knot, LowFidelityUse, NamedTerm, Refusal, SurrogateTerm, SurrogateUse};
