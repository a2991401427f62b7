//! The critical force, as a ladder of fidelities: every rung computes the same quantities, a higher
//! rung drops assumptions.

mod auto;
mod bristles;
mod carried;
mod closed_form;
mod closed_forms;
mod dynamic;
mod fixed_step;
mod motion;
mod presliding;
mod quasi_static;
mod slip;
mod statics;
mod substrate;
mod swing;
#[cfg(test)]
mod tests;

use apportion_base::names::named;
use apportion_base::quantity::Domain;
pub use closed_forms::{AT_ONCE, ClosedForms, Column, Slips};
pub(super) use presliding::Presliding;
pub(super) use statics::Statics;
pub(super) use substrate::Substrate;

use super::friction::LuGreParameters;
use super::{ContactTheory, Failure, Flags, FrictionLaw, Scene, Torsion};

named! {
    /// How much of the mechanics is kept.
    pub enum Fidelity {
        /// Small twist, no inertia: closed formulas.
        ClosedForm = "closed-form",
        /// Exact geometry, no inertia; the massless ramp of LuGre friction.
        QuasiStatic = "quasi-static",
        /// The equations of motion, integrated by an adaptive stiff method, the slip located as an event; LuGre
        /// friction by its bristles under a particle with mass.
        Dynamic = "dynamic",
        /// The equations of motion, integrated in steps of [`Options::step`], the forces read at the first step past
        /// the slip. It overshoots by up to k_lat V step, and exists to show the effect of such steps.
        FixedStep = "fixed-step",
        /// The lowest of the first three with an error estimate within [`Options::tolerance`], or with none better
        /// above.
        Auto = "auto",
    }
}

/// The choice of the competing formulas, and the accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Law of friction under the particle.
    pub friction: FrictionLaw,
    /// Theory of the particle's contacts.
    pub contact: ContactTheory,
    /// How much of the mechanics is kept.
    pub fidelity: Fidelity,
    /// Formula for the torsional stiffness.
    pub torsion: Torsion,
    /// Whether friction includes the pull-off force of the contact, so that N = F_Z + F_ad. Hurtado-Kim and
    /// Lemaitre-Carlson friction do not depend on the load, and do not change.
    pub adhesion_in_load: bool,
    /// The source of stiffness and damping of LuGre bristles.
    pub lugre: LuGreParameters,
    /// Relative error of the critical force, > 0: the target of the integrated rungs, and the limit with which `auto`
    /// compares the estimates.
    pub tolerance: f64,
    /// Whether error estimates, and `auto`, include the critical time in addition to the force.
    pub accurate_time: bool,
    /// Step of the `fixed-step` rung (s), > 0.
    pub step: f64,
    /// Maximum number of steps of any one integration.
    pub step_budget: u64,
}

/// As in the papers: Coulomb, JKR, closed form, thin strip, adhesion not in the load, frozen LuGre
/// parameters. Beyond them: tolerance 1e-6, fixed step 10 ms, a million steps.
impl Default for Options {
    fn default() -> Self {
        Self {
            friction: FrictionLaw::Coulomb,
            contact: ContactTheory::Jkr,
            fidelity: Fidelity::ClosedForm,
            torsion: Torsion::ThinStrip,
            adhesion_in_load: false,
            lugre: LuGreParameters::Frozen,
            tolerance: 1e-6,
            accurate_time: false,
            step: 0.01,
            step_budget: 1_000_000,
        }
    }
}

impl Options {
    /// Checks that the numbers among the options are valid.
    ///
    /// # Errors
    /// [`Failure::OutOfDomain`] names the first invalid one.
    #[inline]
    fn check(&self) -> Result<(), Failure> {
        Failure::unless_in(Domain::Positive, "tolerance", self.tolerance)?;
        Failure::unless_in(Domain::Positive, "step", self.step)
    }
}

/// The scene at the instant of slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Critical {
    /// Normal force on the tip, F_Z (N).
    pub normal_force: f64,
    /// Lateral force on the tip, F_Y = F_Y* (N).
    pub lateral_force: f64,
    /// Critical force F_cr = hypot(F_Y, F_Z) (N).
    pub critical_force: f64,
    /// Travel of the substrate until the critical time, V t_cr (m).
    pub travel: f64,
    /// Critical time t_cr (s), at which the particle slips; or why there is none, [`Failure::VelocityZero`] if V = 0.
    /// On bristles (LuGre, Dahl, Armstrong, Lemaitre-Carlson) the force only approaches its peak, and t_cr is when it
    /// first reaches 99.9 % of it. Rungs without inertia neglect that the swing of the tip makes the slip earlier: by
    /// about 1/(omega t_cr) of t_cr, more for a tip on a cantilever that is stiff in torsion; `auto` computes it by the
    /// linear response of the tip if it matters for the tolerance.
    pub critical_time: Result<f64, Failure>,
    /// Radius a of the contact between particle and substrate (m).
    pub contact_radius: f64,
    /// Indentation d_s of the contact between particle and substrate (m).
    pub indentation: f64,
    /// Twist of the cantilever, theta (rad).
    pub twist: f64,
    /// Violated assumptions.
    pub flags: Flags,
    /// Estimated relative error of the critical force, from the simplifications and the numerics of the rung; not from
    /// the laws themselves. At most 1, which claims nothing. On LuGre bristles it includes the swing of the tip at
    /// every rung. With [`Options::accurate_time`] it holds for the critical time too.
    pub error_estimate: f64,
    /// Number of evaluations of the contact's friction and of rates of change.
    pub evaluations: u64,
    /// The rung of the result; never `auto`.
    pub rung: Fidelity,
}

/// Computes the critical force of pushing the particle, and the state of the scene at that instant.
///
/// With a substrate at rest, V = 0, everything except the critical time is defined: the limit of ever slower pushing.
///
/// # Errors
/// [`Failure::OutOfDomain`] if a parameter is not physical; [`Failure::NotFinite`] if a result overflows;
/// [`Failure::BeyondPullOff`] if the load pulls the particle off the substrate; [`Failure::ProbeTips`] if the preload
/// twists the cantilever over; [`Failure::StepBudget`] or [`Failure::StepTooSmall`] if an integration fails;
/// [`Failure::VelocityZero`] for Lemaitre-Carlson friction at rest, which has no limit there.
///
/// # Example
/// ```
/// use apportion_afm::{FrictionLaw, Options, Scene, critical_force};
///
/// let scene = Scene::default();
/// let coulomb = critical_force(&scene, &Options::default())?;
/// assert_eq!(format!("{:.0} nN", coulomb.critical_force * 1e9), "631 nN");
///
/// let stiffer = Scene { thickness: 2e-6, ..scene };
/// let options = Options { friction: FrictionLaw::HurtadoKim, ..Options::default() };
/// let hurtado_kim = critical_force(&stiffer, &options)?;
/// assert_eq!(format!("{:.2} uN", hurtado_kim.critical_force * 1e6), "3.94 uN");
/// # Ok::<(), apportion_afm::Failure>(())
/// ```
#[inline]
pub fn critical_force(scene: &Scene, options: &Options) -> Result<Critical, Failure> {
    scene.check()?;
    options.check()?;
    let critical = match options.fidelity {
        Fidelity::ClosedForm => closed_form::critical_force(scene, options)?,
        Fidelity::QuasiStatic => quasi_static::critical_force(scene, options, false)?.0,
        Fidelity::Dynamic => dynamic::critical_force(scene, options)?,
        Fidelity::FixedStep => fixed_step::critical_force(scene, options)?,
        Fidelity::Auto => auto::critical_force(scene, options)?,
    };
    critical.finite()
}

impl Critical {
    /// Returns the angle of the tip force from the vertical, psi = atan2(F_Y, F_Z) (rad).
    pub fn force_angle(&self) -> f64 {
        libm::atan2(self.lateral_force, self.normal_force)
    }

    /// Returns this result, if every quantity is finite. Infinite or undefined ones arise only from overflow or
    /// underflow, since the scene has been checked.
    #[inline]
    fn finite(self) -> Result<Self, Failure> {
        let quantities = [
            ("normal_force", self.normal_force),
            ("lateral_force", self.lateral_force),
            ("critical_force", self.critical_force),
            ("travel", self.travel),
            ("contact_radius", self.contact_radius),
            ("indentation", self.indentation),
            ("twist", self.twist),
        ];
        match quantities.iter().find(|(_, value)| !value.is_finite()) {
            None => Ok(self),
            Some(&(quantity, _)) => Err(Failure::NotFinite { quantity }),
        }
    }
}
