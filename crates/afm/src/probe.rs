//! The cantilever and its tip: stiffnesses and preload.

use apportion_base::names::named;

use super::Scene;

named! {
    /// Formula for the torsional stiffness of the rectangular cantilever.
    pub enum Torsion {
        /// K_theta = G w t^3/(3 L), as in the papers; exact for t << w.
        ThinStrip = "thin-strip",
        /// 1/3 becomes 1/3 - 0.21 (t/w) (1 - t^4/(12 w^4)) (Young & Budynas, *Roark's Formulas*), with w and t
        /// exchanged if t > w. Within 0.5 % of the exact series at every ratio.
        Rectangle = "rectangle",
    }
}

/// Stiffnesses and preload of the probe (Tafazzoli & Sitti 2004).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// Normal bending stiffness K_z = E w t^3/(4 L^3) (N/m).
    pub normal: f64,
    /// Lateral bending stiffness K_y = E t w^3/(4 L^3) (N/m).
    pub lateral: f64,
    /// Torsional stiffness K_theta (N m/rad).
    pub torsional: f64,
    /// Lateral stiffness at the apex, k_lat = 1/(1/K_y + H^2/K_theta) (N/m): bending and twist in
    /// series.
    pub apex: f64,
    /// Normal deflection of the preload, z_P0 = L sin(phi0) (m).
    pub preload_deflection: f64,
    /// Normal force of the preload, F_Z0 = K_z z_P0 (N).
    pub preload_force: f64,
}

impl Probe {
    /// Creates the probe of a scene that has been [checked](Scene::check).
    #[inline]
    pub fn new(scene: &Scene, torsion: Torsion) -> Self {
        Self::with_sine(scene, torsion, libm::sin(scene.preload_angle))
    }

    /// Creates the same from the sine of the preload angle.
    #[inline(always)]
    pub(super) fn with_sine(scene: &Scene, torsion: Torsion, sine: f64) -> Self {
        let &Scene { length, width, thickness, height, elastic_modulus, .. } = scene;
        let bending = elastic_modulus * width * thickness / (4.0 * length * length * length);
        let normal = bending * thickness * thickness;
        let lateral = bending * width * width;
        let torsional = scene.effective_shear_modulus() * torsion_constant(width, thickness, torsion) / length;
        // The angle may be minus zero, whose sign would reverse the force angle of a scene without any force.
        let preload_deflection = length * sine.abs();
        Self {
            normal,
            lateral,
            torsional,
            apex: 1.0 / (1.0 / lateral + height * height / torsional),
            preload_deflection,
            preload_force: normal * preload_deflection,
        }
    }
}

/// Returns J of K_theta = G J/L, for a section of `width` by `thickness` (m^4).
#[inline(always)]
fn torsion_constant(width: f64, thickness: f64, torsion: Torsion) -> f64 {
    match torsion {
        Torsion::ThinStrip => width * (thickness * thickness * thickness) / 3.0,
        Torsion::Rectangle => {
            let (long, short) = if thickness > width { (thickness, width) } else { (width, thickness) };
            let ratio = short / long;
            let factor = 1.0 / 3.0 - 0.21 * ratio * (1.0 - ratio * ratio * ratio * ratio / 12.0);
            long * (short * short * short) * factor
        }
    }
}

#[cfg(test)]
#[path = "tests/probe.rs"]
mod tests;
