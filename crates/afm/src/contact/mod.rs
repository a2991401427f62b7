//! Contact of a sphere with a flat, or of two spheres, under a normal load.
//!
//! [`ContactTheory`] chooses the theory, one per file; [`Pair`] is the two bodies, [`Contact`] the result. The units of
//! adhesion are the load pi w R and the radius (pi w R^2/K)^(1/3). The Tabor parameter says whether surface forces act
//! inside or outside the contact, where a theory depends on it.

mod cos;
mod dmt;
mod dugdale;
mod hertz;
mod jkr;
mod maugis_dugdale;
#[cfg(test)]
mod tests;

use std::f64::consts::PI;

use apportion_base::names::named;

use super::{Failure, Scene};

named! {
    /// Theory of adhesive elastic contact. Without adhesion all are Hertz, to the last bit.
    pub enum ContactTheory {
        /// Hertz 1881: no adhesion, for any work of adhesion.
        Hertz = "hertz",
        /// Johnson, Kendall & Roberts 1971: soft, sticky, large; Tabor parameter above 5.
        Jkr = "jkr",
        /// Derjaguin, Muller & Toporov 1975: stiff, weakly adhesive, small; Tabor parameter below 0.1.
        Dmt = "dmt",
        /// Maugis 1992, with Dugdale's constant cohesive stress: every Tabor parameter.
        MaugisDugdale = "maugis-dugdale",
        /// Carpick, Ogletree & Salmeron 1999, a closed form close to Maugis-Dugdale: every Tabor parameter.
        Cos = "cos",
        /// By the Tabor parameter: JKR from 5, DMT up to 0.1, Maugis-Dugdale between.
        Auto = "auto",
    }
}

/// Two elastic bodies that may touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Equivalent radius R: that of the sphere on a flat, R1 R2/(R1 + R2) of two spheres (m), > 0.
    pub radius: f64,
    /// Equivalent modulus K = (4/3) E* (Pa), > 0.
    pub modulus: f64,
    /// Work of adhesion omega (J/m2), >= 0.
    pub adhesion: f64,
    /// Equilibrium separation z0 (m), > 0.
    pub separation: f64,
}

impl Pair {
    /// Creates the pair of the particle and the substrate: R = R_p.
    #[inline(always)]
    pub fn substrate(scene: &Scene) -> Self {
        Self {
            radius: scene.particle_radius,
            modulus: scene.equivalent_modulus,
            adhesion: scene.adhesion,
            separation: scene.equilibrium_separation,
        }
    }

    /// Creates the pair of the tip and the particle: R = R_p R_t/(R_p + R_t).
    #[inline]
    pub fn tip(scene: &Scene) -> Self {
        let (particle, tip) = (scene.particle_radius, scene.tip_radius);
        Self { radius: particle * (tip / (particle + tip)), ..Self::substrate(scene) }
    }

    /// Returns the Tabor parameter mu_T = [16 R omega^2/(9 K^2 z0^3)]^(1/3): the elastic deformation at pull-off in
    /// units of the reach of the surface forces (Tabor 1977).
    #[inline]
    pub fn tabor(&self) -> f64 {
        libm::cbrt(self.tabor_cubed())
    }

    /// Returns the cube of [`tabor`](Self::tabor), which is enough for comparisons.
    #[inline(always)]
    fn tabor_cubed(&self) -> f64 {
        let strain = self.adhesion / (self.modulus * self.separation);
        16.0 / 9.0 * (self.radius / self.separation) * strain * strain
    }

    /// Returns Maugis' parameter lambda = 1.157 mu_T: small for DMT, large for JKR (Maugis 1992).
    #[inline]
    pub fn transition(&self) -> f64 {
        1.157 * self.tabor()
    }

    /// Returns pi w R (N).
    #[inline]
    fn unit_load(&self) -> f64 {
        PI * self.adhesion * self.radius
    }

    /// Returns (pi w R^2/K)^(1/3) (m).
    #[inline]
    fn unit_radius(&self) -> f64 {
        self.radius * libm::cbrt(PI * self.adhesion / (self.modulus * self.radius))
    }
}

/// A contact under load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Contact radius a (m).
    pub radius: f64,
    /// Indentation d (m); negative where adhesion stretches the bodies.
    pub indentation: f64,
}

impl Contact {
    /// Returns the area of contact, pi a^2 (m2).
    #[inline]
    pub fn area(&self) -> f64 {
        PI * self.radius * self.radius
    }
}

impl ContactTheory {
    /// Computes the contact of `pair` under the normal load `load` (N), positive when pressing.
    ///
    /// # Errors
    /// [`Failure::BeyondPullOff`] if `load` is below minus the [pull-off force](Self::pull_off).
    ///
    /// # Example
    /// ```
    /// use apportion_afm::contact::Pair;
    /// use apportion_afm::{ContactTheory, Failure, Scene};
    ///
    /// let pair = Pair::substrate(&Scene::default());
    /// assert_eq!(format!("{:.2}", pair.tabor()), "0.50");
    /// assert_eq!(ContactTheory::Auto.for_tabor(pair.tabor()), ContactTheory::MaugisDugdale);
    ///
    /// let pressed = ContactTheory::Auto.contact(&pair, 489e-9)?;
    /// assert_eq!(format!("{:.2} nm", pressed.radius * 1e9), "8.38 nm");
    /// assert_eq!(ContactTheory::Jkr.contact(&pair, -1e-6), Err(Failure::BeyondPullOff));
    /// # Ok::<(), Failure>(())
    /// ```
    #[inline]
    pub fn contact(self, pair: &Pair, load: f64) -> Result<Contact, Failure> {
        match self {
            Self::Hertz => hertz::contact(pair, load),
            Self::Jkr => jkr::contact(pair, load),
            Self::Dmt => dmt::contact(pair, load),
            Self::MaugisDugdale => maugis_dugdale::contact(pair, load),
            Self::Cos => cos::contact(pair, load),
            Self::Auto => self.for_tabor(pair.tabor()).contact(pair, load),
        }
    }

    /// Returns the magnitude of the force that pulls `pair` apart (N).
    #[inline(always)]
    pub fn pull_off(self, pair: &Pair) -> f64 {
        match self {
            Self::Hertz => 0.0,
            Self::Jkr => jkr::pull_off(pair),
            Self::Dmt => dmt::pull_off(pair),
            Self::MaugisDugdale => maugis_dugdale::pull_off(pair),
            Self::Cos => cos::pull_off(pair),
            Self::Auto => self.for_tabor(pair.tabor()).pull_off(pair),
        }
    }

    /// Returns the theory used at this Tabor parameter: for `Auto` the one it chooses, else `self`.
    #[inline]
    pub fn for_tabor(self, tabor: f64) -> Self {
        match self {
            Self::Auto if Self::Jkr.suits(tabor) => Self::Jkr,
            Self::Auto if Self::Dmt.suits(tabor) => Self::Dmt,
            Self::Auto => Self::MaugisDugdale,
            chosen => chosen,
        }
    }

    /// Returns whether the theory is valid for this Tabor parameter. Hertz requires no adhesion, where it is 0.
    #[inline]
    pub fn suits(self, tabor: f64) -> bool {
        let (least, largest) = self.tabor_range();
        least <= tabor && tabor <= largest
    }

    /// Returns whether the theory is valid for the Tabor parameter of `pair`. Without adhesion all are.
    #[inline(always)]
    pub(crate) fn suits_pair(self, pair: &Pair) -> bool {
        let (least, largest) = self.tabor_range();
        let cubed = pair.tabor_cubed();
        pair.adhesion == 0.0 || least * least * least <= cubed && cubed <= largest * largest * largest
    }

    /// Returns the smallest and the largest Tabor parameter for which the theory is valid.
    #[inline(always)]
    fn tabor_range(self) -> (f64, f64) {
        match self {
            Self::Hertz => (0.0, 0.0),
            Self::Jkr => (5.0, f64::INFINITY),
            Self::Dmt => (0.0, 0.1),
            Self::MaugisDugdale | Self::Cos | Self::Auto => (0.0, f64::INFINITY),
        }
    }

    /// Returns only the contact radius (m) of [`contact`](Self::contact); NaN beyond pull-off.
    #[inline(always)]
    pub(crate) fn radius(self, pair: &Pair, load: f64) -> f64 {
        match self {
            Self::Jkr => jkr::radius(pair, load),
            _ => self.contact(pair, load).map_or(f64::NAN, |contact| contact.radius),
        }
    }
}
