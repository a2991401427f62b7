//! Coulomb friction with an interfacial shear strength.

use std::f64::consts::PI;

use super::Pressed;
use crate::Scene;

/// F_Y* = mu_s N + tau pi a^2 (Tafazzoli & Sitti 2004).
#[derive(Clone, Copy, Debug)]
pub struct Coulomb<'a>(pub &'a Scene);

impl Coulomb<'_> {
    /// Returns the largest lateral force (N).
    #[inline(always)]
    pub fn capacity(&self, pressed: Pressed) -> f64 {
        self.0.static_friction * pressed.load + self.0.shear_strength * (PI * pressed.radius * pressed.radius)
    }
}

#[cfg(test)]
#[path = "tests/coulomb.rs"]
mod tests;
