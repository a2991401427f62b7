//! Invariants over the papers' ranges, and far beyond them.

use proptest::prelude::*;

use super::*;

/// A point of the papers' ranges of the eight factors.
pub(super) fn within_ranges() -> impl Strategy<Value = Scene> {
    (
        (200e-6..700e-6_f64, 5e-6..80e-6_f64, 0.25e-6..2.5e-6_f64, 5e-6..20e-6_f64),
        (0.0..800e-9_f64, 120e9..200e9_f64, 10e9..100e9_f64, 0.0..3.0_f64),
    )
        .prop_map(
            |((length, width, thickness, height), (velocity, elastic_modulus, equivalent_modulus, adhesion))| Scene {
                length,
                width,
                thickness,
                height,
                velocity,
                elastic_modulus,
                equivalent_modulus,
                adhesion,
                ..Scene::default()
            },
        )
}

fn rigid_options() -> impl Strategy<Value = Options> {
    prop::sample::select(closed_form_options(&RIGID))
}

proptest! {
    /// F_cr rises with w, t and E, and falls with L, by every law.
    #[test]
    fn is_monotonic_in_the_probe(scene in within_ranges(), options in rigid_options(), factor in 1.001..2.0_f64) {
        let before = force(&scene, &options);
        for name in ["width", "thickness", "elastic_modulus"] {
            prop_assert!(force(&scaled(&scene, name, factor), &options) > before, "{}", name);
        }
        prop_assert!(force(&scaled(&scene, "length", factor), &options) < before);
        prop_assert_eq!(force(&scaled(&scene, "height", factor), &options), before);
    }

    #[test]
    fn rises_with_static_friction(scene in within_ranges(), mu_s in 0.01..2.0_f64, factor in 1.001..2.0_f64) {
        for friction in [FrictionLaw::Coulomb, FrictionLaw::LuGre] {
            let at = |static_friction| force(&Scene { static_friction, ..scene }, &by(friction));
            prop_assert!(at(mu_s * factor) > at(mu_s));
        }
    }

    /// Without an area term F_cr is E w t^3 sin(phi0)/(4 L^2) hypot(1, mu_s); 1e-14 is a few roundings.
    #[test]
    fn without_shear_strength_coulomb_is_a_product(scene in within_ranges(), factor in 1e-3..1e3_f64) {
        let scene = Scene { shear_strength: 0.0, ..scene };
        let before = force(&scene, &Options::default());
        let preload = scene.elastic_modulus * scene.width * scene.thickness.powi(3) * scene.preload_angle.sin()
            / (4.0 * scene.length.powi(2));
        prop_assert!((before / (preload * 1.0_f64.hypot(0.8)) - 1.0).abs() < 1e-14);
        let scaled = Scene { elastic_modulus: scene.elastic_modulus * factor, ..scene };
        prop_assert!((force(&scaled, &Options::default()) / (before * factor) - 1.0).abs() < 1e-14);
    }

    /// t_cr V = s = F_Y/k_lat = F_Y/K_y + H theta: bending and twist share the travel.
    #[test]
    fn travel_is_bending_and_twist(scene in within_ranges(), options in rigid_options()) {
        if matches!(options.friction, FrictionLaw::LuGre | FrictionLaw::Dahl) {
            return Ok(());
        }
        let critical = critical_force(&scene, &options).unwrap();
        let lateral = scene.elastic_modulus * scene.thickness * (scene.width / scene.length).powi(3) / 4.0;
        let travel = critical.lateral_force / lateral + scene.height * critical.twist;
        prop_assert!((critical.travel / travel - 1.0).abs() < 1e-13);
        if scene.velocity > 0.0 {
            prop_assert!((critical.critical_time.unwrap() * scene.velocity / travel - 1.0).abs() < 1e-13);
        }
    }

    /// Every parameter at extreme values, all at once: still a result.
    #[test]
    fn three_decades_each_way_have_an_answer(
        decades in prop::collection::vec(-3.0..3.0_f64, Parameter::ALL.len()),
        options in rigid_options(),
    ) {
        let mut scene = Scene::default();
        for (parameter, decade) in Parameter::ALL.iter().zip(&decades) {
            let value = (parameter.get)(&scene) * 10_f64.powf(*decade);
            if parameter.domain.contains(value) {
                (parameter.set)(&mut scene, value);
            }
        }
        let critical = critical_force(&scene, &options);
        prop_assert!(critical.is_ok(), "{critical:?}");
        // The time of Dahl's law with a large exponent overflows.
        prop_assert!(critical.unwrap().critical_time.is_ok() || options.friction == FrictionLaw::Dahl);
    }
}
