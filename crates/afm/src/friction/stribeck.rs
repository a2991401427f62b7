//! The classical law: stiction, Coulomb, Stribeck and viscous friction.

use crate::root::{self, Point};
use crate::{Failure, Scene};

/// F(v) = F_C + (F_S - F_C) exp(-(v/v_s)^d_s) + F_v v for v > 0, and any force up to F_S = mu_s N at rest
/// (Armstrong-Helouvry, Dupont & Canudas de Wit 1994, after Stribeck 1902 and Bo & Pavelescu 1982); F_C = mu_d N.
#[derive(Clone, Copy, Debug)]
pub struct Stribeck<'a>(pub &'a Scene);

impl Stribeck<'_> {
    /// Returns the friction of sliding at `velocity` (m/s), >= 0, under `load` (N); at rest the break-away force F_S.
    pub fn force(&self, load: f64, velocity: f64) -> f64 {
        let slid = -libm::expm1(-libm::pow(velocity / self.0.stribeck_velocity, self.0.stribeck_exponent));
        load * (self.0.static_friction * (1.0 - slid) + self.0.dynamic_friction * slid)
            + self.0.viscous_friction * velocity
    }

    /// Returns the first peak of F(v) for v from 0 to `velocity` (m/s) (N): where a particle pulled harder and harder
    /// breaks away, or the force at `velocity` if friction holds it all the way.
    ///
    /// # Errors
    /// None of its own; the search for the peak cannot fail.
    pub fn capacity(&self, load: f64, velocity: f64) -> Result<f64, Failure> {
        let drop = load * (self.0.static_friction - self.0.dynamic_friction);
        if drop <= 0.0 {
            return Ok(self.force(load, velocity));
        }
        // F'(v) = F_v - drop/v_s steepness(v/v_s): it rises until the steepness reaches this threshold.
        let threshold = self.0.viscous_friction * self.0.stribeck_velocity / drop;
        let d = self.0.stribeck_exponent;
        let steepest = if d > 1.0 { libm::pow((d - 1.0) / d, 1.0 / d) } else { 0.0 };
        let end = (velocity / self.0.stribeck_velocity).min(steepest);
        if d <= 1.0 {
            // Steepest at the start, and flatter afterwards.
            let at_rest = if d < 1.0 { f64::INFINITY } else { 1.0 };
            let falls = at_rest > threshold;
            return Ok(if falls { self.force(load, 0.0) } else { self.force(load, velocity) });
        }
        let margin = |u: f64| Ok(d * libm::pow(u, d - 1.0) * libm::exp(-libm::pow(u, d)) - threshold);
        if margin(end)? <= 0.0 {
            return Ok(self.force(load, velocity));
        }
        let (low, high) = (Point { x: 0.0, y: -threshold }, Point { x: end, y: margin(end)? });
        let peak = if threshold == 0.0 { 0.0 } else { root::between(low, high, margin)? };
        Ok(self.force(load, peak * self.0.stribeck_velocity))
    }
}

#[cfg(test)]
#[path = "tests/stribeck.rs"]
mod tests;
