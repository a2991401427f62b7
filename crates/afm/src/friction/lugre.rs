//! LuGre friction (Canudas de Wit, Olsson, Astrom & Lischinsky 1995).

use std::f64::consts::PI;

use apportion_base::names::named;

use crate::Scene;

named! {
    /// The source of stiffness and damping of the LuGre bristles.
    pub enum LuGreParameters {
        /// The constants of the scene. As in the Sobol' study of this law, where neither the contact modulus nor the
        /// adhesion therefore has an effect.
        Frozen = "frozen",
        /// The contact: sigma0 = 8 G_eff a with 1/G_eff = (2 - nu1)/G1 + (2 - nu2)/G2 (Mindlin 1949), and critical
        /// damping of the particle, sigma1 = 2 sqrt(sigma0 m_p).
        Contact = "contact",
    }
}

/// z' = v - sigma0 |v| z/Fss(v), F = sigma0 z + sigma1 z' + sigma2 v: bristles of deflection z, which yield towards the
/// Stribeck curve Fss.
///
/// The Sobol' study of this law prints sigma0 |v|/Fss without z, and the Stribeck curve without F_C, two misprints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LuGre {
    /// Stiffness of the bristles sigma0 (N/m), >= 0.
    pub stiffness: f64,
    /// Damping of the bristles sigma1 (N s/m), >= 0.
    pub damping: f64,
    /// Coefficient of static friction mu_s, >= 0.
    pub static_friction: f64,
    /// Coefficient of dynamic friction mu_d, >= 0; may exceed `static_friction`.
    pub dynamic_friction: f64,
    /// Viscous friction sigma2 (N s/m), >= 0.
    pub viscous_friction: f64,
    /// Stribeck velocity v_s (m/s), > 0.
    pub stribeck_velocity: f64,
}

/// Returns the mass of the particle, a sphere (kg).
pub(crate) fn particle_mass(scene: &Scene) -> f64 {
    let r = scene.particle_radius;
    scene.particle_density * (4.0 / 3.0) * PI * (r * r * r)
}

impl LuGre {
    /// Creates the law with the constants of `scene`.
    #[inline(always)]
    pub fn from_scene(scene: &Scene) -> Self {
        Self {
            stiffness: scene.bristle_stiffness,
            damping: scene.bristle_damping,
            static_friction: scene.static_friction,
            dynamic_friction: scene.dynamic_friction,
            viscous_friction: scene.viscous_friction,
            stribeck_velocity: scene.stribeck_velocity,
        }
    }

    /// Creates the law with `parameters` for a contact of radius `radius` (m).
    pub fn with(scene: &Scene, parameters: LuGreParameters, radius: f64) -> Self {
        let law = Self::from_scene(scene);
        match parameters {
            LuGreParameters::Frozen => law,
            LuGreParameters::Contact => {
                let compliance = (2.0 - scene.particle_poisson_ratio) / scene.particle_shear_modulus
                    + (2.0 - scene.substrate_poisson_ratio) / scene.substrate_shear_modulus;
                let stiffness = 8.0 * radius / compliance;
                Self { stiffness, damping: 2.0 * (stiffness * particle_mass(scene)).sqrt(), ..law }
            }
        }
    }

    /// Returns dz/dt (m/s) at the deflection `z` (m) and the velocity `v` (m/s) under `load` (N), > 0.
    pub fn deflection_rate(&self, load: f64, z: f64, v: f64) -> f64 {
        v - self.stiffness * v.abs() * z / self.stribeck(load, v)
    }

    /// Returns the friction force (N) at the deflection `z` (m) and the velocity `v` (m/s) under `load` (N), > 0.
    pub fn force(&self, load: f64, z: f64, v: f64) -> f64 {
        self.stiffness * z + self.damping * self.deflection_rate(load, z, v) + self.viscous_friction * v
    }

    /// Returns dFss/dv (N s/m).
    pub fn stribeck_slope(&self, load: f64, velocity: f64) -> f64 {
        let ratio = velocity / self.stribeck_velocity;
        let drop = load * (self.static_friction - self.dynamic_friction);
        -2.0 * drop * ratio / self.stribeck_velocity * libm::exp(-ratio * ratio)
    }

    /// Returns the Stribeck curve Fss(v) = F_C + (F_S - F_C) exp(-(v/v_s)^2) at the load N (N), with F_S = mu_s N and
    /// F_C = mu_d N (N).
    #[inline]
    pub fn stribeck(&self, load: f64, velocity: f64) -> f64 {
        let ratio = velocity / self.stribeck_velocity;
        // 1 - exp(-x) without cancellation, and weights that make both limits exact.
        let slid = -libm::expm1(-ratio * ratio);
        load * (self.static_friction * (1.0 - slid) + self.dynamic_friction * slid)
    }

    /// Returns the force of steady sliding, Fss(v) + sigma2 v (N), at the load (N) and the velocity (m/s),
    /// >= 0.
    #[inline]
    pub fn steady_force(&self, load: f64, velocity: f64) -> f64 {
        self.stribeck(load, velocity) + self.viscous_friction * velocity
    }

    /// Returns whether `velocity` (m/s) is so far below the Stribeck velocity (1 %) that the steady force can replace
    /// the peak of the ramp.
    #[inline(always)]
    pub fn is_slow(&self, velocity: f64) -> bool {
        velocity <= 0.01 * self.stribeck_velocity
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const LAW: LuGre = LuGre {
        stiffness: 625.0,
        damping: 1.6e-7,
        static_friction: 0.8,
        dynamic_friction: 0.7,
        viscous_friction: 0.3,
        stribeck_velocity: 1e-3,
    };

    #[test]
    fn at_rest_it_is_static_friction_exactly() {
        assert_eq!(LAW.steady_force(5e-7, 0.0), 0.8 * 5e-7);
    }

    #[test]
    fn far_above_the_stribeck_velocity_it_is_dynamic_and_viscous_exactly() {
        assert_eq!(LAW.steady_force(5e-7, 0.1), 0.7 * 5e-7 + 0.3 * 0.1);
    }

    /// At v = v_s the curve is down to 1/e; 1e-15 is a few roundings.
    #[test]
    fn at_the_stribeck_velocity() {
        let expected = 0.7 + 0.1 * libm::exp(-1.0_f64);
        assert!((LAW.stribeck(1.0, 1e-3) - expected).abs() < 1e-15);
    }

    /// By hand: G_eff = 1/(1.58/27 + 1.83/31.2) GPa = 8.5354 GPa, sigma0 = 8 G_eff 9.09 nm = 620.7 N/m; m_p =
    /// 1.01054e-17 kg; sigma1 = 2 sqrt(620.7 * 1.01054e-17). The study's constants 625 and 1.6e-7 are these, rounded.
    #[test]
    fn the_parameters_of_the_contact_explain_the_frozen_ones() {
        let law = LuGre::with(&Scene::default(), LuGreParameters::Contact, 9.09e-9);
        assert!((law.stiffness / 620.7 - 1.0).abs() < 1e-3, "{}", law.stiffness);
        assert!((law.damping / 1.584e-7 - 1.0).abs() < 1e-3, "{}", law.damping);
        assert_eq!(LuGre::with(&Scene::default(), LuGreParameters::Frozen, 1.0), LuGre::from_scene(&Scene::default()));
    }

    /// Steady sliding: z' = 0 leaves z = Fss/sigma0 and F = Fss + sigma2 v.
    #[test]
    fn steady_state() {
        for velocity in [1e-7, 1e-3, 1.0] {
            let z = LAW.stribeck(5e-7, velocity) / LAW.stiffness;
            assert!(LAW.deflection_rate(5e-7, z, velocity).abs() < 1e-15 * velocity);
            assert!((LAW.force(5e-7, z, velocity) / LAW.steady_force(5e-7, velocity) - 1.0).abs() < 1e-14);
        }
    }

    /// Central differences, 1e-6 for their curvature.
    #[test]
    fn slope_of_the_stribeck_curve() {
        for velocity in [1e-5, 3e-4, 1e-3, 2e-3] {
            let step = 1e-4 * velocity;
            let difference = (LAW.stribeck(1.0, velocity + step) - LAW.stribeck(1.0, velocity - step)) / (2.0 * step);
            assert!((LAW.stribeck_slope(1.0, velocity) / difference - 1.0).abs() < 1e-6);
        }
    }

    proptest! {
        /// Between the two coefficients, whichever is larger, and as published: 4e-16 for roundings of numbers <= 2.
        #[test]
        fn lies_between_the_coefficients(mu_s in 0.0..2.0_f64, mu_d in 0.0..2.0_f64, velocity in 0.0..5e-3_f64) {
            let law = LuGre { static_friction: mu_s, dynamic_friction: mu_d, ..LAW };
            let force = law.stribeck(1.0, velocity);
            prop_assert!(force >= mu_s.min(mu_d) - 4e-16 && force <= mu_s.max(mu_d) + 4e-16);
            let published = mu_d + (mu_s - mu_d) * libm::exp(-(velocity / 1e-3).powi(2));
            prop_assert!((force - published).abs() < 1e-15);
        }
    }
}
