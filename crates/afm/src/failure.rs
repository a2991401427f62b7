//! Why a scene has no critical force.

use apportion_base::quantity::Domain;

/// The reason a quantity could not be computed. Carries no input values, so that equal reasons
/// compare equal and can be counted over a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, thiserror::Error)]
pub enum Failure {
    /// A parameter is outside its physical domain, or is not a finite number.
    #[error("{parameter} is outside its physical domain: it must be a finite number {domain}")]
    OutOfDomain {
        /// Name of the parameter, as in [`Parameter::ALL`](super::Parameter::ALL).
        parameter: &'static str,
        /// The domain of the parameter.
        domain: Domain,
    },
    /// The substrate is at rest, so it never reaches the critical travel.
    #[error("velocity is zero: the critical force is never reached, so the critical time is infinite; it must be > 0")]
    VelocityZero,
    /// The load pulls harder than adhesion can hold, or pulls where there is no adhesion.
    #[error("the normal load pulls the contact apart: it must be at least minus the pull-off force")]
    BeyondPullOff,
    /// A quantity overflowed the range of floating-point numbers.
    #[error("{quantity} is not a finite number: the parameters are too large or too small to compute with")]
    NotFinite {
        /// Name of the first field of [`Critical`](super::Critical) that overflowed.
        quantity: &'static str,
    },
    /// The preload would twist the cantilever over without any lateral force: F_Z0 H >= K_theta.
    #[error("the preload is too large: normal force times tip height must be below the torsional stiffness")]
    ProbeTips,
    /// An integration needed more steps than allowed.
    #[error("the integration exceeded its step budget: allow more steps or a larger tolerance")]
    StepBudget,
    /// An integration needed steps too small to change the time.
    #[error("the integration cannot meet the tolerance at any step size: choose a larger tolerance")]
    StepTooSmall,
}

impl Failure {
    /// Checks that the `value` of a parameter is in its domain.
    ///
    /// # Errors
    /// [`Failure::OutOfDomain`] if it is not.
    #[inline]
    pub(super) fn unless_in(domain: Domain, parameter: &'static str, value: f64) -> Result<(), Self> {
        if domain.contains(value) { Ok(()) } else { Err(Self::OutOfDomain { parameter, domain }) }
    }
}
