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
mod tests {
    use std::f64::consts::PI;

    use proptest::prelude::*;

    use super::*;

    fn close(actual: f64, expected: f64, tolerance: f64) {
        assert!((actual / expected - 1.0).abs() < tolerance, "{actual} is not {expected}");
    }

    /// By hand: 4 L^3 = 4.55625e-11 m^3, w t^3 = 4.8e-23 m^4, t w^3 = 1.10592e-19 m^4, G =
    /// 66.5354330709 GPa.
    #[test]
    fn nominal_stiffnesses() {
        let probe = Probe::new(&Scene::default(), Torsion::ThinStrip);
        close(probe.normal, 8.112e-12 / 4.55625e-11, 1e-14);
        close(probe.lateral, 1.869_004_8e-8 / 4.55625e-11, 1e-14);
        close(probe.torsional, 4.731_408_574e-9, 1e-9);
        close(probe.preload_deflection, 2.748_825_2e-6, 1e-7);
        close(probe.preload_force, 489.4040e-9, 1e-7);
        // 1/410.2067 + 1.44e-10/4.731409e-9 = 0.00243779 + 0.03043491 m/N
        close(probe.apex, 1.0 / 0.032_872_70, 1e-6);
    }

    /// K_theta of the exact Saint-Venant series: J = long short^3/3 [1 - (192/pi^5) (short/long)
    /// sum tanh(...)/n^5].
    fn exact_torsion_constant(width: f64, thickness: f64) -> f64 {
        let (long, short) = (width.max(thickness), width.min(thickness));
        let sum: f64 =
            (0..200).map(|k| f64::from(2 * k + 1)).map(|n| libm::tanh(n * PI * long / (2.0 * short)) / n.powi(5)).sum();
        long * short.powi(3) / 3.0 * (1.0 - 192.0 / PI.powi(5) * (short / long) * sum)
    }

    #[test]
    fn printed_deviations_of_the_thin_strip() {
        let deviation = |width: f64, thickness: f64| {
            torsion_constant(width, thickness, Torsion::Rectangle)
                / torsion_constant(width, thickness, Torsion::ThinStrip)
                - 1.0
        };
        assert!((deviation(48e-6, 1e-6) + 0.013).abs() < 5e-4);
        assert!((deviation(5e-6, 2.5e-6) + 0.31).abs() < 5e-3);
    }

    #[test]
    fn a_preload_of_minus_zero_is_zero() {
        let scene = Scene { preload_angle: -0.0, ..Scene::default() };
        assert!(Probe::new(&scene, Torsion::ThinStrip).preload_force.is_sign_positive());
    }

    proptest! {
        /// The closed formula compared with the series: 0.5 % is its published accuracy.
        #[test]
        fn rectangle_agrees_with_the_series(width in 1e-6..1e-4_f64, log_ratio in -2.0..2.0_f64) {
            let thickness = width * libm::pow(10.0, log_ratio);
            let ratio = torsion_constant(width, thickness, Torsion::Rectangle) / exact_torsion_constant(width, thickness);
            prop_assert!((ratio - 1.0).abs() < 5e-3, "{ratio}");
        }
    }
}
