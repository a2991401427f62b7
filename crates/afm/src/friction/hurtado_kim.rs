//! Hurtado & Kim 1999, "Scale effects in friction of single-asperity contacts".

use std::f64::consts::PI;

use crate::Scene;

/// Strength t1, in units of G*, of contacts so small that they slip all at once.
const SMALL_STRENGTH: f64 = 1.0 / 43.0;
/// Strength t2 of contacts so large that many dislocations slip together.
const LARGE_STRENGTH: f64 = 1.0 / 1290.0;
/// Radius a1, in Burgers vectors, up to which a contact is small.
const SMALL_RADIUS: f64 = 28.0;
/// Radius a2 from which a contact is large.
const LARGE_RADIUS: f64 = 8e4;
/// Slope M = -log(t1/t2)/log(a2/a1) of the straight line between, on double logarithmic axes.
const SLOPE: f64 = -0.427_416_185_757_036_94;

/// F_Y* = pi a^2 G* tbar(a/b): friction of a single contact, by its size in Burgers vectors. The
/// load acts through the contact radius alone.
///
/// The Sobol' study of this law drops pi and prints log(a2/a2) in the slope, two misprints.
#[derive(Clone, Copy, Debug)]
pub struct HurtadoKim<'a>(pub &'a Scene);

impl HurtadoKim<'_> {
    /// Returns the effective shear modulus G* = 2 G1 G2/(G1 + G2) (Pa).
    #[inline]
    fn shear_modulus(&self) -> f64 {
        let &Scene { particle_shear_modulus: g1, substrate_shear_modulus: g2, .. } = self.0;
        2.0 * g1 * g2 / (g1 + g2)
    }

    /// Returns the largest lateral force (N) of a contact of radius `radius` (m).
    #[inline]
    pub fn capacity(&self, radius: f64) -> f64 {
        PI * radius * radius * self.shear_modulus() * strength(radius / self.0.burgers_vector)
    }
}

/// Returns tbar: shear strength over G*, at the contact radius in Burgers vectors.
#[inline]
fn strength(radius: f64) -> f64 {
    if radius <= SMALL_RADIUS {
        SMALL_STRENGTH
    } else if radius < LARGE_RADIUS {
        SMALL_STRENGTH * libm::pow(radius / SMALL_RADIUS, SLOPE)
    } else {
        LARGE_STRENGTH
    }
}

#[cfg(test)]
#[path = "tests/hurtado_kim.rs"]
mod tests;
