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
