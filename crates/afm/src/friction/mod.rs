//! The largest lateral force the substrate contact can hold before the particle slips, F_Y*.
//!
//! One law per file. Laws with a state (LuGre, Dahl, Armstrong, Lemaitre-Carlson) return the peak of the force when a
//! spring pulls harder and harder, the break-away force.

mod armstrong;
mod coulomb;
mod dahl;
mod hurtado_kim;
mod lemaitre_carlson;
mod lugre;
mod ramp;
mod stribeck;
#[cfg(test)]
mod tests;

use apportion_base::names::named;
pub use armstrong::Armstrong;
pub use coulomb::Coulomb;
pub use dahl::Dahl;
pub use hurtado_kim::HurtadoKim;
pub use lemaitre_carlson::LemaitreCarlson;
pub(crate) use lugre::particle_mass;
pub use lugre::{LuGre, LuGreParameters};
pub(super) use ramp::travel as ramp_travel;
pub use stribeck::Stribeck;

use super::{Failure, Scene};

named! {
    /// Law of friction between particle and substrate.
    pub enum FrictionLaw {
        /// Coefficient times load plus shear strength times area: [`Coulomb`].
        Coulomb = "coulomb",
        /// Hurtado & Kim 1999, strength of a single contact by its size: [`HurtadoKim`].
        HurtadoKim = "hk",
        /// Canudas de Wit et al. 1995, bristles with a Stribeck curve: [`LuGre`].
        LuGre = "lugre",
        /// Dahl 1968, a spring that yields: [`Dahl`].
        Dahl = "dahl",
        /// Coulomb, Stribeck, viscous friction and stiction: [`Stribeck`].
        Stribeck = "stribeck",
        /// Armstrong's seven parameters, with lag and memory of rest: [`Armstrong`].
        Armstrong = "armstrong",
        /// Lemaitre & Carlson 2004, a glassy layer: [`LemaitreCarlson`].
        LemaitreCarlson = "lemaitre-carlson",
    }
}

/// The load and size of the substrate contact for friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pressed {
    /// Normal load N, with the adhesive part if the options say so (N), >= 0; below 0 for laws that depend on the
    /// contact area too.
    pub load: f64,
    /// Contact radius a (m), >= 0.
    pub radius: f64,
}

/// How the break-away force of LuGre friction is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LuGreForm {
    /// As the force of steady sliding, Fss(V) + sigma2 V: good for V far below v_s.
    Fast,
    /// As the peak of the ramp dF/dt = k_lat (V - v) of a massless particle.
    Ramp,
}

/// The pull on the particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Velocity V of the far end of the spring (m/s), >= 0.
    pub velocity: f64,
    /// Stiffness k_lat of the spring (N/m), > 0.
    pub stiffness: f64,
    /// Mass of the particle (kg), > 0.
    pub mass: f64,
    /// Source of the LuGre parameters.
    pub lugre: LuGreParameters,
    /// Form of the LuGre law.
    pub form: LuGreForm,
    /// Relative tolerance of the laws that are integrated, > 0.
    pub tolerance: f64,
    /// Maximum number of steps of an integration.
    pub step_budget: u64,
}

/// The largest force that friction holds, and the cost of its computation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// F_Y* (N).
    pub force: f64,
    /// Number of evaluations of rates of change.
    pub evaluations: u64,
}

impl Drive {
    /// Creates a drive at the velocity of `scene` through a spring of `stiffness` (N/m): frozen LuGre parameters, fast
    /// form, a tolerance of 1e-8 and a million steps.
    pub fn from_scene(scene: &Scene, stiffness: f64) -> Self {
        Self {
            velocity: scene.velocity,
            stiffness,
            mass: particle_mass(scene),
            lugre: LuGreParameters::Frozen,
            form: LuGreForm::Fast,
            tolerance: 1e-8,
            step_budget: 1_000_000,
        }
    }

    /// Returns the relative distance up to which the force of steady sliding can replace the peak of a LuGre ramp. A
    /// more accurate integration is lost in the tolerance of a run, of which `tolerance` is the hundredth part.
    pub(crate) fn near_steady(&self) -> f64 {
        10.0 * self.tolerance
    }
}

impl FrictionLaw {
    /// Returns F_Y*: the largest lateral force (N) that the contact holds, with the constants of `scene`.
    ///
    /// # Errors
    /// [`Failure::StepBudget`] and [`Failure::StepTooSmall`] of the laws that are integrated; [`Failure::VelocityZero`]
    /// for Lemaitre-Carlson at rest, whose layer grows stronger without limit.
    #[inline(always)]
    pub fn capacity(self, scene: &Scene, pressed: Pressed, drive: &Drive) -> Result<Held, Failure> {
        let load = pressed.load;
        let force = match self {
            Self::Coulomb => Coulomb(scene).capacity(pressed),
            Self::HurtadoKim => HurtadoKim(scene).capacity(pressed.radius),
            Self::LuGre => match drive.form {
                LuGreForm::Fast => LuGre::from_scene(scene).steady_force(load, drive.velocity),
                LuGreForm::Ramp => {
                    return ramp::peak(&LuGre::with(scene, drive.lugre, pressed.radius), load, drive);
                }
            },
            Self::Dahl => Dahl(scene).capacity(load),
            Self::Stribeck => Stribeck(scene).capacity(load, drive.velocity)?,
            Self::Armstrong => {
                let stiffness = 1.0 / (1.0 / drive.stiffness + 1.0 / scene.bristle_stiffness);
                Armstrong(scene).break_away(load, stiffness * drive.velocity)
            }
            Self::LemaitreCarlson => return LemaitreCarlson(scene).capacity(pressed, drive),
        };
        Ok(Held { force, evaluations: 0 })
    }

    /// Returns whether friction still holds under a load below zero, by the area that adhesion keeps together.
    #[inline]
    pub fn lives_on_area(self) -> bool {
        matches!(self, Self::Coulomb | Self::HurtadoKim | Self::LemaitreCarlson)
    }
}
