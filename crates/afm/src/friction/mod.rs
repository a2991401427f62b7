//! The largest lateral force the substrate contact can hold before the particle slips, F_Y*.
//!
//! One law a file. Laws with a state (LuGre, Dahl, Armstrong, Lemaitre-Carlson) answer with the peak of the force when
//! a spring pulls ever harder, the break-away force.

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

use apportion::names::named;
pub use armstrong::{Armstrong, Loading};
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

/// The substrate contact as friction feels it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pressed {
    /// Normal load N, with the adhesive part where the options ask for it (N), >= 0; below 0 for laws that live on
    /// the contact area too.
    pub load: f64,
    /// Contact radius a (m), >= 0.
    pub radius: f64,
}

/// How the break-away force of LuGre friction is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LuGreForm {
    /// As the force of steady sliding, Fss(V) + sigma2 V: good for V far below v_s.
    Fast,
    /// As the peak of the ramp dF/dt = k_lat (V - v) of a massless particle.
    Ramp,
}

/// How the particle is pulled.
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
    /// Most steps of an integration.
    pub step_budget: u64,
}

/// The largest force that friction holds, and what it cost to find.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// F_Y* (N).
    pub force: f64,
    /// Evaluations of rates of change.
    pub evaluations: u64,
}

impl Held {
    /// This force, if it lies in `range`.
    ///
    /// # Errors
    /// [`Failure::StepTooSmall`] for a march that has missed what would have limited it.
    fn within(self, range: std::ops::RangeInclusive<f64>) -> Result<Self, Failure> {
        if range.contains(&self.force) { Ok(self) } else { Err(Failure::StepTooSmall) }
    }
}

impl Drive {
    /// Pulled at the velocity of `scene` through a spring of `stiffness` (N/m): frozen LuGre parameters, fast form, a
    /// tolerance of 1e-8 and a million steps.
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

    /// How near to the peak of a LuGre ramp the force of steady sliding may stand for it, relatively. What an integration
    /// gains over a bound this near is lost in the tolerance of a run, of which `tolerance` is the hundredth part.
    pub(crate) fn near_steady(&self) -> f64 {
        10.0 * self.tolerance
    }
}

impl FrictionLaw {
    /// F_Y*: the largest lateral force (N) that the contact holds, with the constants of `scene`.
    ///
    /// # Errors
    /// [`Failure::StepBudget`] and [`Failure::StepTooSmall`] of the laws that are integrated;
    /// [`Failure::VelocityZero`] for Lemaitre-Carlson at rest, whose layer grows stronger for ever.
    #[inline]
    pub fn capacity(self, scene: &Scene, pressed: Pressed, drive: &Drive) -> Result<Held, Failure> {
        let load = pressed.load;
        let force = match self {
            Self::Coulomb => Coulomb::from_scene(scene).capacity(pressed),
            Self::HurtadoKim => HurtadoKim::from_scene(scene).capacity(pressed.radius),
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
                Armstrong(scene).break_away(load, Loading { rate: stiffness * drive.velocity, rest: scene.rest_time })
            }
            Self::LemaitreCarlson => return LemaitreCarlson(scene).capacity(pressed, drive),
        };
        Ok(Held { force, evaluations: 0 })
    }

    /// Whether friction still holds under a load below zero, by the area that adhesion keeps together.
    #[inline]
    pub fn lives_on_area(self) -> bool {
        matches!(self, Self::Coulomb | Self::HurtadoKim | Self::LemaitreCarlson)
    }
}
