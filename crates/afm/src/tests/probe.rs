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
        torsion_constant(width, thickness, Torsion::Rectangle) / torsion_constant(width, thickness, Torsion::ThinStrip)
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
