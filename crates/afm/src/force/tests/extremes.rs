//! Every law at every rung, at the limits of every range and beyond: a finite result or a named failure, never a NaN, a
//! panic or an endless loop.

use proptest::prelude::*;

use super::*;

/// Every law at every rung, with so few steps that hopeless integrations end soon.
fn every_run() -> Vec<Options> {
    let mut all = Vec::new();
    for friction in FrictionLaw::ALL {
        for fidelity in Fidelity::ALL {
            for lugre in [LuGreParameters::Frozen, LuGreParameters::Contact] {
                if lugre == LuGreParameters::Frozen || friction == FrictionLaw::LuGre {
                    all.push(Options { friction, fidelity, lugre, step_budget: 20_000, ..Options::default() });
                }
            }
        }
    }
    all
}

fn any_options() -> impl Strategy<Value = Options> {
    (prop::sample::select(every_run()), any::<bool>(), prop::sample::select(Torsion::ALL.to_vec()))
        .prop_map(|(options, adhesion_in_load, torsion)| Options { adhesion_in_load, torsion, ..options })
}

/// The 2^8 corners of the papers' ranges.
pub(super) fn corners() -> Vec<Scene> {
    let ranges = [
        ("length", 200e-6, 700e-6),
        ("width", 5e-6, 80e-6),
        ("thickness", 0.25e-6, 2.5e-6),
        ("height", 5e-6, 20e-6),
        ("velocity", 0.0, 800e-9),
        ("elastic_modulus", 120e9, 200e9),
        ("equivalent_modulus", 10e9, 100e9),
        ("adhesion", 0.0, 3.0),
    ];
    let corner = |bits: u32| {
        let mut scene = Scene::default();
        for (i, (name, low, high)) in ranges.iter().enumerate() {
            (Parameter::from_name(name).unwrap().set)(&mut scene, if bits >> i & 1 == 0 { *low } else { *high });
        }
        scene
    };
    (0..256).map(corner).collect()
}

/// In the papers' box there is always a result, except for Lemaitre-Carlson at rest.
#[test]
fn every_corner_has_an_answer() {
    for options in every_run() {
        let options = Options { step_budget: 100_000, ..options };
        for scene in corners() {
            match critical_force(&scene, &options) {
                Err(Failure::VelocityZero) => {
                    assert!(options.friction == FrictionLaw::LemaitreCarlson && scene.velocity == 0.0);
                }
                outcome => {
                    let critical = outcome.unwrap_or_else(|failure| panic!("{failure} {options:?} {scene:?}"));
                    assert!(critical.critical_force > 0.0 && critical.error_estimate <= 1.0, "{critical:?}");
                }
            }
        }
    }
}

/// One at a time and in pairs, the parameters that the issue of extremes names.
#[test]
fn named_extremes_are_finite_or_named() {
    let extremes: [(&str, &[f64]); 7] = [
        ("velocity", &[0.0, 1e-3]),
        ("adhesion", &[0.0, 3.0]),
        ("equivalent_modulus", &[60e6, 60e12]),
        ("elastic_modulus", &[169e6, 169e12]),
        ("thickness", &[10e-9, 2.5e-6]),
        ("length", &[5e-3, 50e-6]),
        ("particle_radius", &[1e-9, 10e-6]),
    ];
    for options in every_run() {
        for (i, (first, values)) in extremes.iter().enumerate() {
            for (second, others) in &extremes[..=i] {
                for (&value, &other) in values.iter().flat_map(|v| others.iter().map(move |o| (v, o))) {
                    let mut scene = Scene::default();
                    (Parameter::from_name(second).unwrap().set)(&mut scene, other);
                    (Parameter::from_name(first).unwrap().set)(&mut scene, value);
                    is_finite_or_named(&scene, &options).unwrap();
                }
            }
        }
    }
}

proptest! {
    /// Any number for one parameter, the others nominal: a finite answer or a named failure.
    #[test]
    fn one_wild_number_is_finite_or_named(
        parameter in prop::sample::select(Parameter::ALL),
        value in any::<f64>(),
        options in any_options(),
    ) {
        let mut scene = Scene::default();
        (parameter.set)(&mut scene, value);
        is_finite_or_named(&scene, &options)?;
    }

    /// Physical numbers of every magnitude for every parameter: a finite answer or a named failure.
    #[test]
    fn any_magnitude_is_finite_or_named(
        exponents in prop::collection::vec(-30.0..30.0_f64, Parameter::ALL.len()),
        options in any_options(),
    ) {
        let mut scene = Scene::default();
        for (parameter, exponent) in Parameter::ALL.iter().zip(&exponents) {
            let value = 10_f64.powf(*exponent);
            let inside = if parameter.domain.contains(value) { value } else { 0.3 };
            (parameter.set)(&mut scene, inside);
        }
        prop_assert_eq!(scene.check(), Ok(()));
        is_finite_or_named(&scene, &options)?;
    }
}

fn is_finite_or_named(scene: &Scene, options: &Options) -> Result<(), TestCaseError> {
    let Ok(critical) = critical_force(scene, options) else {
        return Ok(());
    };
    for value in [
        critical.lateral_force,
        critical.critical_force,
        critical.travel,
        critical.contact_radius,
        critical.twist,
        critical.error_estimate,
    ] {
        prop_assert!(value.is_finite() && value >= 0.0, "{critical:?}");
    }
    // Adhesion may hold against a tip that pulls.
    prop_assert!(critical.indentation.is_finite() && critical.normal_force.is_finite());
    prop_assert!((0.0..=PI).contains(&critical.force_angle()));
    if let Ok(time) = critical.critical_time {
        prop_assert!(time.is_finite() && time >= 0.0);
    }
    Ok(())
}

/// Numbers that the map of extremes (`apportion trade --extremes`) found silently wrong.
#[test]
fn errors_far_outside_of_any_laboratory_are_stated_or_refused() {
    let lugre = Options { friction: FrictionLaw::LuGre, ..Options::default() };
    let by = |fidelity, options: Options, scene: &Scene| critical_force(scene, &Options { fidelity, ..options });
    // K_y overflows: an error of NaN counts as 100 %.
    let wide = Scene { width: 8e95, ..Scene::default() };
    assert_eq!(critical_force(&wide, &Options::default()).unwrap().error_estimate, 1.0);
    // The ramp stepped over the saturation of the bristles: 21 times the static friction.
    let stiff = Scene {
        bristle_stiffness: 6e15,
        bristle_damping: 1.6e-8,
        viscous_friction: 0.0,
        stribeck_velocity: 1e-37,
        static_friction: 0.85,
        dynamic_friction: 0.6,
        velocity: 1e-37,
        ..Scene::default()
    };
    assert_eq!(by(Fidelity::QuasiStatic, lugre, &stiff), Err(Failure::StepTooSmall));
    // The integration stepped over them by 4 %: its error estimate includes this.
    let stiff = Scene { bristle_stiffness: 1e9, ..Scene::default() };
    let (exact, marched) =
        (by(Fidelity::QuasiStatic, lugre, &stiff).unwrap(), by(Fidelity::Dynamic, lugre, &stiff).unwrap());
    let off = (marched.critical_force / exact.critical_force - 1.0).abs();
    assert!(marched.error_estimate >= 0.9 * off && exact.error_estimate < 1e-4, "{off} {marched:?}");
    // A cantilever so thick that F_Z is 1e33 F_Y, and the integration loses 2.7e-6 of it.
    let hk = Options { friction: FrictionLaw::HurtadoKim, ..Options::default() };
    let mut farthest = 0.0_f64;
    for step in 0..40 {
        let thickness = 1e24 + 5e22 * f64::from(step);
        let [length, width, height] = [700e-6, 80e-3, 20e-3];
        let thick = Scene { length, width, thickness, height, velocity: 1e-13, adhesion: 0.2, ..Scene::default() };
        let exact = by(Fidelity::QuasiStatic, hk, &thick).unwrap();
        // It may also pull the contact apart in its rounding.
        let Ok(marched) = by(Fidelity::Dynamic, hk, &thick) else { continue };
        let off = (marched.critical_force / exact.critical_force - 1.0).abs();
        assert!(exact.error_estimate < 1e-12, "{thickness}: {exact:?}");
        assert!(marched.error_estimate >= 0.9 * off, "{thickness}: {off} {marched:?}");
        farthest = farthest.max(off);
    }
    assert!(farthest > 1e-6, "{farthest}");
    // One step of 14 ms to a slip at 15 us.
    let fast = Scene { velocity: 8e-4, ..Scene::default() };
    let coarse = Options { step: 0.014, ..lugre };
    let (exact, marched) =
        (by(Fidelity::QuasiStatic, coarse, &fast).unwrap(), by(Fidelity::FixedStep, coarse, &fast).unwrap());
    let off = (marched.critical_force - exact.critical_force).abs();
    assert!(1.5 * marched.error_estimate * marched.critical_force >= off, "{off} {marched:?}");
}
