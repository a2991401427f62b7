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
mod tests {
    use super::*;

    /// The published form, M log10(abar) + B, in full; 1e-14 because its logarithms cancel.
    #[test]
    fn agrees_with_the_published_line() {
        let (t1, t2, a1, a2) = (SMALL_STRENGTH, LARGE_STRENGTH, SMALL_RADIUS, LARGE_RADIUS);
        let span = libm::log10(a2 / a1);
        let slope = -libm::log10(t1 / t2) / span;
        let intercept = (libm::log10(t1) * libm::log10(a2) - libm::log10(t2) * libm::log10(a1)) / span;
        assert!((SLOPE - slope).abs() < 1e-15);
        for radius in [28.001, 31.57, 100.0, 1e3, 1e4, 7.99e4] {
            let published = libm::pow(10.0, slope * libm::log10(radius) + intercept);
            assert!((strength(radius) / published - 1.0).abs() < 1e-14, "{radius}");
        }
    }

    /// Across a breakpoint the strength may change only by rounding: 1e-15 through a power of about one unit roundoff.
    #[test]
    fn is_continuous_at_both_breakpoints() {
        for edge in [SMALL_RADIUS, LARGE_RADIUS] {
            let (below, above) = (strength(edge.next_down()), strength(edge.next_up()));
            assert!((below / above - 1.0).abs() < 1e-15, "{below} {above}");
        }
    }

    /// By hand: G* = 2 * 27 * 31.2/58.2 GPa.
    #[test]
    fn effective_modulus_of_gold_on_oxide() {
        assert!((HurtadoKim(&Scene::default()).shear_modulus() / (1684.8e9 / 58.2) - 1.0).abs() < 1e-15);
    }
}
