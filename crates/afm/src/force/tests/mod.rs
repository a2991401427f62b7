//! Exact results, limits and named failures.

mod closed_forms;
mod dynamic;
mod extended;
mod extremes;
mod presliding;
mod properties;
mod quasi_static;

use std::f64::consts::PI;

use super::*;
use crate::{Flag, Parameter};

fn by(friction: FrictionLaw) -> Options {
    Options { friction, ..Options::default() }
}

fn force(scene: &Scene, options: &Options) -> f64 {
    critical_force(scene, options).unwrap().critical_force
}

/// `scene` with one parameter multiplied by `factor`.
fn scaled(scene: &Scene, name: &str, factor: f64) -> Scene {
    let parameter = Parameter::from_name(name).unwrap();
    let mut scaled = *scene;
    (parameter.set)(&mut scaled, (parameter.get)(scene) * factor);
    scaled
}

/// Laws whose capacity depends neither on the spring nor on the time at rest nor on age.
const RIGID: [FrictionLaw; 5] =
    [FrictionLaw::Coulomb, FrictionLaw::HurtadoKim, FrictionLaw::LuGre, FrictionLaw::Dahl, FrictionLaw::Stribeck];

/// Every combination of these laws, and of the formulas, in closed form.
fn closed_form_options(laws: &[FrictionLaw]) -> Vec<Options> {
    let mut all = Vec::new();
    for &friction in laws {
        for contact in ContactTheory::ALL {
            for torsion in Torsion::ALL {
                for adhesion_in_load in [false, true] {
                    all.push(Options { friction, contact, torsion, adhesion_in_load, ..Options::default() });
                }
            }
        }
    }
    all
}

/// The printed values of the nominal scene, to the printed digits.
#[test]
fn nominal_values() {
    let scene = Scene::default();
    let coulomb = critical_force(&scene, &Options::default()).unwrap();
    assert_eq!(format!("{:.1}", coulomb.normal_force * 1e9), "489.4");
    assert_eq!(format!("{:.2}", coulomb.contact_radius * 1e9), "9.09");
    let with_adhesion = Options { adhesion_in_load: true, ..Options::default() };
    let cases = [
        (Options::default(), "631"),
        (with_adhesion, "656"),
        (by(FrictionLaw::HurtadoKim), "517"),
        (by(FrictionLaw::LuGre), "627"),
    ];
    for (options, printed) in cases {
        assert_eq!(format!("{:.0}", force(&scene, &options) * 1e9), printed, "{options:?}");
    }
}

/// By hand, with a from Newton's method on the load equation: F_Y = 0.8 * 489.4040 nN + 28 MPa * pi
/// (9.091206 nm)^2 = 391.5232 + 7.2703 nN, k_lat = 30.42037 N/m, H/K_theta = 2536.243 1/N.
#[test]
fn nominal_state_at_the_slip() {
    let critical = critical_force(&Scene::default(), &Options::default()).unwrap();
    let close = |actual: f64, expected: f64| {
        assert!((actual / expected - 1.0).abs() < 1e-6, "{actual} {expected}");
    };
    close(critical.lateral_force, 398.7935e-9);
    close(critical.travel, 398.7935e-9 / 30.42037);
    close(critical.critical_time.unwrap(), 0.1310942);
    close(critical.twist, 398.7935e-9 * 2536.243);
    close(critical.force_angle(), libm::atan(398.7935_f64 / 489.4040));
    close(critical.indentation, 1.149141e-9);
    assert_eq!(critical.flags.iter().collect::<Vec<_>>(), [Flag::TaborOutOfRange]);
}

#[test]
fn a_substrate_at_rest_leaves_the_force_and_fails_only_the_time() {
    for options in closed_form_options(&RIGID) {
        let moving = critical_force(&Scene { velocity: 1e-12, ..Scene::default() }, &options).unwrap();
        let resting = critical_force(&Scene { velocity: 0.0, ..Scene::default() }, &options).unwrap();
        assert_eq!(resting.critical_time, Err(Failure::VelocityZero));
        // sigma2 V and the Stribeck curve move LuGre by 1e-19 N of 4e-7 N at 1e-12 m/s.
        assert!((resting.critical_force / moving.critical_force - 1.0).abs() < 1e-11);
    }
}

#[test]
fn a_time_too_long_for_a_number_is_named() {
    let crawling = Scene { velocity: f64::from_bits(1), ..Scene::default() };
    let critical = critical_force(&crawling, &Options::default()).unwrap();
    assert_eq!(critical.critical_time, Err(Failure::NotFinite { quantity: "critical_time" }));
}

/// w = 0: Hertz, so F_cr of Coulomb follows in one line.
#[test]
fn without_adhesion_the_contact_is_hertz() {
    let scene = Scene { adhesion: 0.0, ..Scene::default() };
    let critical = critical_force(&scene, &Options { adhesion_in_load: true, ..Options::default() }).unwrap();
    let normal = critical.normal_force;
    let area = PI * libm::pow(50e-9 * normal / 60e9, 2.0 / 3.0);
    assert!((critical.critical_force / libm::hypot(normal, 0.8 * normal + 28e6 * area) - 1.0).abs() < 1e-14);
    assert_eq!(critical.flags, Flags::NONE, "without adhesion the Tabor parameter does not matter");
}

/// Without load and adhesion all forces are zero, and none is undefined.
#[test]
fn no_load_and_no_adhesion_is_no_force() {
    let scene = Scene { adhesion: 0.0, preload_angle: 0.0, viscous_friction: 0.0, ..Scene::default() };
    for options in closed_form_options(&RIGID) {
        let critical = critical_force(&scene, &options).unwrap();
        assert_eq!((critical.critical_force, critical.force_angle(), critical.twist), (0.0, 0.0, 0.0));
        assert_eq!(critical.critical_time, Ok(0.0));
    }
}

/// One parameter moved across the threshold of each flag, which the nominal scene otherwise fixes;
/// thresholds by hand: K = 13.358 GPa (a = 15 nm), hardness = 1.8848 GPa, mu_s = 80.549 (F_Y =
/// 39.43 uN), K = 60/sqrt(1012.5) GPa, v_s/100.
#[test]
fn each_flag_has_its_threshold() {
    let coulomb = FrictionLaw::Coulomb;
    let cases = [
        (Flag::LargeContact, coulomb, "equivalent_modulus", 13.359e9, 13.357e9),
        (Flag::AboveHardness, coulomb, "hardness", 1.885e9, 1.8845e9),
        (Flag::LargeTwist, coulomb, "static_friction", 80.5, 80.6),
        (Flag::TaborOutOfRange, coulomb, "equivalent_modulus", 1.885e9, 1.886e9),
        (Flag::FastLuGreForm, FrictionLaw::LuGre, "velocity", 1e-5, 1.001e-5),
    ];
    assert_eq!(cases.len(), Flag::ALL.len());
    for (flag, friction, name, quiet, raising) in cases {
        let flags = |value| {
            let mut scene = Scene::default();
            (Parameter::from_name(name).unwrap().set)(&mut scene, value);
            critical_force(&scene, &by(friction)).unwrap().flags
        };
        assert!(!flags(quiet).contains(flag), "{flag:?}");
        assert_eq!(flags(raising), flags(quiet).with(flag, true));
    }
}

/// Only LuGre has a fast form.
#[test]
fn other_laws_may_be_as_fast_as_they_like() {
    let fast = Scene { velocity: 1.0, ..Scene::default() };
    for friction in [FrictionLaw::Coulomb, FrictionLaw::HurtadoKim] {
        assert!(!critical_force(&fast, &by(friction)).unwrap().flags.contains(Flag::FastLuGreForm));
    }
}

/// For each law the default parameters that must not affect it; the height affects no law.
#[test]
fn parameters_of_other_friction_laws_have_no_effect() {
    let independent: [(FrictionLaw, &[&str]); 3] = [
        (FrictionLaw::Coulomb, &["height", "velocity", "dynamic_friction", "burgers_vector", "poisson_ratio"]),
        (FrictionLaw::HurtadoKim, &["height", "velocity", "static_friction", "shear_strength", "poisson_ratio"]),
        (FrictionLaw::LuGre, &["height", "equivalent_modulus", "adhesion", "shear_strength", "particle_radius"]),
    ];
    for (friction, names) in independent {
        let nominal = force(&Scene::default(), &by(friction));
        for name in names {
            let scene = scaled(&Scene::default(), name, 1.3);
            assert_eq!(force(&scene, &by(friction)), nominal, "{friction:?} {name}");
        }
    }
}

/// Numbers among the options are checked too.
#[test]
fn an_unusable_option_is_named() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let domain = apportion_base::quantity::Domain::Positive;
        let tolerance = Options { tolerance: value, ..Options::default() };
        let named = |parameter| Err(Failure::OutOfDomain { parameter, domain });
        assert_eq!(critical_force(&Scene::default(), &tolerance), named("tolerance"));
        let step = Options { step: value, ..Options::default() };
        assert_eq!(critical_force(&Scene::default(), &step), named("step"));
    }
}

#[test]
fn an_unphysical_parameter_is_named() {
    let scene = Scene { length: -1.0, ..Scene::default() };
    let failure = critical_force(&scene, &Options::default()).unwrap_err();
    assert_eq!(failure.to_string(), "length is outside its physical domain: it must be a finite number > 0");
}

#[test]
fn overflow_is_named() {
    let huge = Scene { elastic_modulus: 1e300, width: 1e60, ..Scene::default() };
    assert_eq!(critical_force(&huge, &Options::default()), Err(Failure::NotFinite { quantity: "normal_force" }));
    let thin = Scene { thickness: 1e-120, ..Scene::default() };
    assert_eq!(critical_force(&thin, &Options::default()), Err(Failure::NotFinite { quantity: "travel" }));
}
