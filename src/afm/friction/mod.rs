//! The largest lateral force the substrate contact can hold before the particle slips, F_Y*.

mod coulomb;
mod hurtado_kim;
mod lugre;

pub use coulomb::Coulomb;
pub use hurtado_kim::HurtadoKim;
pub use lugre::LuGre;

use super::Scene;
use super::named::named;

named! {
    /// Law of friction between particle and substrate.
    pub enum FrictionLaw {
        /// Coefficient times load plus shear strength times area: [`Coulomb`].
        Coulomb = "coulomb",
        /// Hurtado & Kim 1999, strength of a single contact by its size: [`HurtadoKim`].
        HurtadoKim = "hk",
        /// Canudas de Wit et al. 1995, bristles with a Stribeck curve, in the steady fast form: [`LuGre`].
        LuGre = "lugre",
    }
}

/// The substrate contact as friction feels it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pressed {
    /// Normal load N, with the adhesive part where the options ask for it (N), >= 0.
    pub load: f64,
    /// Contact radius a (m), >= 0.
    pub radius: f64,
}

impl FrictionLaw {
    /// F_Y*: the largest lateral force (N) that the contact holds, with the constants of `scene`.
    #[inline]
    pub fn capacity(self, scene: &Scene, pressed: Pressed) -> f64 {
        match self {
            Self::Coulomb => Coulomb::of(scene).capacity(pressed),
            Self::HurtadoKim => HurtadoKim::of(scene).capacity(pressed.radius),
            Self::LuGre => LuGre::of(scene).steady_force(pressed.load, scene.velocity),
        }
    }
}
