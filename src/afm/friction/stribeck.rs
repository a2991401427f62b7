//! The classical law: stiction, Coulomb, Stribeck and viscous friction.

use crate::afm::root::{self, Point};
use crate::afm::{Failure, Scene};

/// F(v) = F_C + (F_S - F_C) exp(-(v/v_s)^d_s) + F_v v for v > 0, and any force up to F_S = mu_s N at rest
/// (Armstrong-Helouvry, Dupont & Canudas de Wit 1994, after Stribeck 1902 and Bo & Pavelescu 1982); F_C = mu_d N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stribeck {
    /// Coefficient of static friction mu_s, >= 0.
    pub static_friction: f64,
    /// Coefficient of dynamic friction mu_d, >= 0; may exceed `static_friction`.
    pub dynamic_friction: f64,
    /// Viscous friction F_v (N s/m), >= 0.
    pub viscous_friction: f64,
    /// Stribeck velocity v_s (m/s), > 0.
    pub stribeck_velocity: f64,
    /// Exponent d_s, > 0.
    pub exponent: f64,
}

impl Stribeck {
    /// The law with the constants of `scene`.
    #[inline]
    pub fn of(scene: &Scene) -> Self {
        Self {
            static_friction: scene.static_friction,
            dynamic_friction: scene.dynamic_friction,
            viscous_friction: scene.viscous_friction,
            stribeck_velocity: scene.stribeck_velocity,
            exponent: scene.stribeck_exponent,
        }
    }

    /// Friction of sliding at `velocity` (m/s), >= 0, under `load` (N); at rest the break-away force F_S (N).
    pub fn force(&self, load: f64, velocity: f64) -> f64 {
        let slid = -libm::expm1(-libm::pow(velocity / self.stribeck_velocity, self.exponent));
        load * (self.static_friction * (1.0 - slid) + self.dynamic_friction * slid) + self.viscous_friction * velocity
    }

    /// The first peak of F(v) for v from 0 to `velocity` (m/s) (N): where a particle pulled ever harder breaks away, or
    /// the force at `velocity` if friction holds it all the way.
    ///
    /// # Errors
    /// None of its own; the search for the peak cannot fail.
    pub fn capacity(&self, load: f64, velocity: f64) -> Result<f64, Failure> {
        let drop = load * (self.static_friction - self.dynamic_friction);
        if drop <= 0.0 {
            return Ok(self.force(load, velocity));
        }
        // F'(v) = F_v - drop/v_s steepness(v/v_s): it rises until the steepness reaches this threshold.
        let threshold = self.viscous_friction * self.stribeck_velocity / drop;
        let d = self.exponent;
        let steepness = |u: f64| d * libm::pow(u, d - 1.0) * libm::exp(-libm::pow(u, d));
        let steepest = if d > 1.0 { libm::pow((d - 1.0) / d, 1.0 / d) } else { 0.0 };
        let end = (velocity / self.stribeck_velocity).min(steepest);
        if d <= 1.0 {
            // Steepest at once, and flatter ever after.
            let at_rest = if d < 1.0 { f64::INFINITY } else { 1.0 };
            let falls = at_rest > threshold;
            return Ok(if falls { self.force(load, 0.0) } else { self.force(load, velocity) });
        }
        let margin = |u: f64| Ok(steepness(u) - threshold);
        if margin(end)? <= 0.0 {
            return Ok(self.force(load, velocity));
        }
        let (low, high) = (Point { x: 0.0, y: -threshold }, Point { x: end, y: margin(end)? });
        let peak = if threshold == 0.0 { 0.0 } else { root::between(low, high, margin)? };
        Ok(self.force(load, peak * self.stribeck_velocity))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Stribeck = Stribeck {
        static_friction: 0.8,
        dynamic_friction: 0.5,
        viscous_friction: 1e-6,
        stribeck_velocity: 1e-3,
        exponent: 2.0,
    };

    /// From F_S at rest down through the dip and up again along F_C + F_v v.
    #[test]
    fn dips_and_rises() {
        let load = 1e-7;
        assert_eq!(LAW.force(load, 0.0), 0.8 * load);
        let by_hand = load * (0.5 + 0.3 * libm::exp(-4.0_f64)) + 2e-9;
        assert!((LAW.force(load, 2e-3) / by_hand - 1.0).abs() < 1e-15);
        assert!(LAW.force(load, 2e-3) < LAW.force(load, 1e-3) && LAW.force(load, 2e-3) < LAW.force(load, 1e-1));
        assert_eq!(LAW.force(load, 1.0), 0.5 * load + 1e-6);
    }

    /// The first peak by stepping along the curve, 1e-6 for the step.
    #[test]
    fn capacity_is_the_first_peak() {
        for exponent in [0.5, 1.0, 1.5, 2.0, 4.0] {
            for viscous_friction in [0.0, 1e-7, 1e-6, 1e-5, 1e-3] {
                for velocity in [0.0, 1e-7, 3e-4, 1e-3, 5e-3] {
                    let law = Stribeck { viscous_friction, exponent, ..LAW };
                    let mut peak = law.force(1e-7, 0.0);
                    for i in 1..=20_000 {
                        let next = law.force(1e-7, velocity * f64::from(i) / 2e4);
                        if next < peak {
                            break;
                        }
                        peak = next;
                    }
                    let capacity = law.capacity(1e-7, velocity).unwrap();
                    assert!((capacity / peak - 1.0).abs() < 1e-6, "{law:?} {velocity} {capacity} {peak}");
                }
            }
        }
    }

    #[test]
    fn friction_that_only_rises_holds_to_the_end() {
        let law = Stribeck { static_friction: 0.3, ..LAW };
        assert_eq!(law.capacity(1e-7, 2e-3).unwrap(), law.force(1e-7, 2e-3));
    }
}
