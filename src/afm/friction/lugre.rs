//! LuGre friction (Canudas de Wit, Olsson, Astrom & Lischinsky 1995), steady sliding.

use crate::afm::Scene;

/// The part of the LuGre law that survives at constant velocity: the Stribeck curve and the viscous
/// term. For velocities far below v_s this steady force is also the peak of the whole ramp, up to
/// which the particle sticks.
///
/// The Sobol' study of this law prints the Stribeck curve without F_C, a misprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LuGre {
    /// Coefficient of static friction mu_s, >= 0.
    pub static_friction: f64,
    /// Coefficient of dynamic friction mu_d, >= 0; may exceed `static_friction`.
    pub dynamic_friction: f64,
    /// Viscous friction sigma2 (N s/m), >= 0.
    pub viscous_friction: f64,
    /// Stribeck velocity v_s (m/s), > 0.
    pub stribeck_velocity: f64,
}

impl LuGre {
    /// The law with the constants of `scene`.
    #[inline]
    pub fn of(scene: &Scene) -> Self {
        Self {
            static_friction: scene.static_friction,
            dynamic_friction: scene.dynamic_friction,
            viscous_friction: scene.viscous_friction,
            stribeck_velocity: scene.stribeck_velocity,
        }
    }

    /// The Stribeck curve Fss(v) = F_C + (F_S - F_C) exp(-(v/v_s)^2) at the load N (N), with F_S =
    /// mu_s N and F_C = mu_d N (N).
    #[inline]
    pub fn stribeck(&self, load: f64, velocity: f64) -> f64 {
        let ratio = velocity / self.stribeck_velocity;
        // 1 - exp(-x) without cancellation, and weights that make both limits exact.
        let slid = -(-ratio * ratio).exp_m1();
        load * (self.static_friction * (1.0 - slid) + self.dynamic_friction * slid)
    }

    /// The force of steady sliding, Fss(v) + sigma2 v (N), at the load (N) and the velocity (m/s),
    /// >= 0.
    #[inline]
    pub fn steady_force(&self, load: f64, velocity: f64) -> f64 {
        self.stribeck(load, velocity) + self.viscous_friction * velocity
    }

    /// Whether `velocity` (m/s) is so far below the Stribeck velocity (1 %) that the steady force
    /// stands for the peak of the ramp.
    #[inline]
    pub fn is_slow(&self, velocity: f64) -> bool {
        velocity <= 0.01 * self.stribeck_velocity
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const LAW: LuGre =
        LuGre { static_friction: 0.8, dynamic_friction: 0.7, viscous_friction: 0.3, stribeck_velocity: 1e-3 };

    #[test]
    fn at_rest_it_is_static_friction_exactly() {
        assert_eq!(LAW.steady_force(5e-7, 0.0), 0.8 * 5e-7);
    }

    #[test]
    fn far_above_the_stribeck_velocity_it_is_dynamic_and_viscous_exactly() {
        assert_eq!(LAW.steady_force(5e-7, 0.1), 0.7 * 5e-7 + 0.3 * 0.1);
    }

    /// At v = v_s the curve is down to 1/e of the way; 1e-15 is a few roundings.
    #[test]
    fn at_the_stribeck_velocity() {
        let expected = 0.7 + 0.1 * (-1.0_f64).exp();
        assert!((LAW.stribeck(1.0, 1e-3) - expected).abs() < 1e-15);
    }

    proptest! {
        /// Between the two coefficients whichever is larger, and as published: 4e-16 a few roundings of numbers <= 2.
        #[test]
        fn lies_between_the_coefficients(mu_s in 0.0..2.0_f64, mu_d in 0.0..2.0_f64, velocity in 0.0..5e-3_f64) {
            let law = LuGre { static_friction: mu_s, dynamic_friction: mu_d, ..LAW };
            let force = law.stribeck(1.0, velocity);
            prop_assert!(force >= mu_s.min(mu_d) - 4e-16 && force <= mu_s.max(mu_d) + 4e-16);
            let published = mu_d + (mu_s - mu_d) * (-(velocity / 1e-3).powi(2)).exp();
            prop_assert!((force - published).abs() < 1e-15);
        }
    }
}
