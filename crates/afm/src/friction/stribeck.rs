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
mod tests {
    use super::*;

    /// Constants under which friction falls far, and rises again.
    fn scene() -> Scene {
        Scene { dynamic_friction: 0.5, viscous_friction: 1e-6, ..Scene::default() }
    }

    /// From F_S at rest down through the dip and up again along F_C + F_v v.
    #[test]
    fn dips_and_rises() {
        let (load, scene) = (1e-7, scene());
        let law = Stribeck(&scene);
        assert_eq!(law.force(load, 0.0), 0.8 * load);
        let by_hand = load * (0.5 + 0.3 * libm::exp(-4.0_f64)) + 2e-9;
        assert!((law.force(load, 2e-3) / by_hand - 1.0).abs() < 1e-15);
        assert!(law.force(load, 2e-3) < law.force(load, 1e-3) && law.force(load, 2e-3) < law.force(load, 1e-1));
        assert_eq!(law.force(load, 1.0), 0.5 * load + 1e-6);
    }

    /// The first peak by stepping along the curve, 1e-6 for the step.
    #[test]
    fn capacity_is_the_first_peak() {
        for exponent in [0.5, 1.0, 1.5, 2.0, 4.0] {
            for viscous_friction in [0.0, 1e-7, 1e-6, 1e-5, 1e-3] {
                for velocity in [0.0, 1e-7, 3e-4, 1e-3, 5e-3] {
                    let scene = Scene { viscous_friction, stribeck_exponent: exponent, ..scene() };
                    let law = Stribeck(&scene);
                    let mut peak = law.force(1e-7, 0.0);
                    for i in 1..=20_000 {
                        let next = law.force(1e-7, velocity * f64::from(i) / 2e4);
                        if next < peak {
                            break;
                        }
                        peak = next;
                    }
                    let capacity = law.capacity(1e-7, velocity).unwrap();
                    assert!(
                        (capacity / peak - 1.0).abs() < 1e-6,
                        "{exponent} {viscous_friction} {velocity} {capacity} {peak}"
                    );
                }
            }
        }
    }

    #[test]
    fn friction_that_only_rises_holds_to_the_end() {
        let scene = Scene { static_friction: 0.3, ..scene() };
        let law = Stribeck(&scene);
        assert_eq!(law.capacity(1e-7, 2e-3).unwrap(), law.force(1e-7, 2e-3));
    }
}
