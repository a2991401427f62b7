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
#[path = "tests/lugre.rs"]
mod tests;
