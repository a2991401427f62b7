//! Contact of a sphere with a flat, or of two spheres, under a normal load.

mod jkr;

use super::Failure;
use super::named::named;

named! {
    /// Theory of adhesive elastic contact.
    pub enum ContactTheory {
        /// Johnson, Kendall & Roberts 1971: soft, sticky, large; Tabor parameter above 5.
        Jkr = "jkr",
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
    /// Tabor parameter mu_T = [16 R omega^2/(9 K^2 z0^3)]^(1/3): the elastic deformation at
    /// pull-off in units of the reach of the surface forces (Tabor 1977).
    #[inline]
    pub fn tabor(&self) -> f64 {
        let strain = self.adhesion / (self.modulus * self.separation);
        (16.0 / 9.0 * (self.radius / self.separation) * strain * strain).cbrt()
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

impl ContactTheory {
    /// The contact of `pair` under the normal load `load` (N), positive when pressing.
    ///
    /// # Errors
    /// [`Failure::BeyondPullOff`] if `load` is below minus the [pull-off force](Self::pull_off).
    #[inline]
    pub fn contact(self, pair: &Pair, load: f64) -> Result<Contact, Failure> {
        match self {
            Self::Jkr => jkr::contact(pair, load),
        }
    }

    /// Size of the force that pulls `pair` apart (N).
    #[inline]
    pub fn pull_off(self, pair: &Pair) -> f64 {
        match self {
            Self::Jkr => jkr::pull_off(pair),
        }
    }

    /// Whether the theory is meant for this Tabor parameter.
    #[inline]
    pub fn suits(self, tabor: f64) -> bool {
        match self {
            Self::Jkr => tabor >= 5.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand at the nominal scene: [16 * 50e-9 * 0.2^2/(9 * (60e9)^2 * (0.2e-9)^3)]^(1/3) =
    /// (10/81)^(1/3).
    #[test]
    fn nominal_tabor_parameter() {
        let pair = Pair { radius: 50e-9, modulus: 60e9, adhesion: 0.2, separation: 0.2e-9 };
        assert!((pair.tabor() - (10.0_f64 / 81.0).cbrt()).abs() < 1e-14);
        assert!(!ContactTheory::Jkr.suits(pair.tabor()));
    }

    #[test]
    fn a_soft_sticky_pair_suits_jkr() {
        let pair = Pair { radius: 1e-3, modulus: 1e6, adhesion: 0.05, separation: 0.2e-9 };
        assert!(ContactTheory::Jkr.suits(pair.tabor()));
    }
}
