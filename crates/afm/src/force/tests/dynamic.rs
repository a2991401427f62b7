//! The integrated rungs against the quasi-static one, and `auto`.

use proptest::prelude::*;

use super::properties::within_ranges;
use super::*;
use crate::force::motion::Motion;
use crate::force::statics::Statics;
use crate::force::substrate::Substrate;
use crate::friction::LuGreForm;
use crate::ode::{Control, DormandPrince, March, Outcome, Problem};
use crate::probe::Probe;

fn at(fidelity: Fidelity, friction: FrictionLaw) -> Options {
    Options { fidelity, ..by(friction) }
}

const STUCK: [FrictionLaw; 6] = [
    FrictionLaw::Coulomb,
    FrictionLaw::HurtadoKim,
    FrictionLaw::Dahl,
    FrictionLaw::Stribeck,
    FrictionLaw::Armstrong,
    FrictionLaw::LemaitreCarlson,
];

/// Fast enough to end: from 10 nm/s.
fn moving() -> impl Strategy<Value = Scene> {
    (within_ranges(), 10e-9..800e-9_f64).prop_map(|(scene, velocity)| Scene { velocity, ..scene })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(50))]

    /// The accuracy of this rung at its default tolerance. Where the twist is large and the probe swings, the
    /// quasi-static estimate bounds the difference.
    #[test]
    fn dynamic_agrees_with_quasi_static(scene in moving(), law in prop::sample::select(&STUCK[..])) {
        let dynamic = critical_force(&scene, &at(Fidelity::Dynamic, law)).unwrap();
        let limit = critical_force(&scene, &at(Fidelity::QuasiStatic, law)).unwrap();
        let error = (dynamic.critical_force / limit.critical_force - 1.0).abs();
        prop_assert!(error < 1e-6 + limit.error_estimate, "{error} {}", limit.error_estimate);
        prop_assert!(dynamic.rung == Fidelity::Dynamic && dynamic.evaluations > limit.evaluations);
    }

    /// Bristles under a particle with mass against the massless ramp, within the estimate of the latter.
    #[test]
    fn bristles_agree_with_the_ramp(scene in moving()) {
        let dynamic = critical_force(&scene, &at(Fidelity::Dynamic, FrictionLaw::LuGre)).unwrap();
        let limit = critical_force(&scene, &at(Fidelity::QuasiStatic, FrictionLaw::LuGre)).unwrap();
        let error = (dynamic.critical_force / limit.critical_force - 1.0).abs();
        prop_assert!(error < 1e-6 + 2.0 * limit.error_estimate, "{error} {}", limit.error_estimate);
    }

    /// On a fast substrate the swing of the tip makes the slip earlier, by up to a fifth of the time and more.
    #[test]
    fn errors_include_the_critical_time_if_requested(
        scene in within_ranges(), velocity in -8.0..-2.7_f64, law in prop::sample::select(&STUCK[..2])
    ) {
        let scene = Scene { velocity: libm::exp10(velocity), ..scene };
        let time = |critical: &Critical| critical.critical_time.unwrap();
        let exact = critical_force(&scene, &Options { tolerance: 1e-9, ..at(Fidelity::Dynamic, law) });
        // Some of the fastest scenes take more steps than allowed.
        prop_assume!(exact.is_ok());
        let exact = time(&exact.unwrap());
        for fidelity in [Fidelity::ClosedForm, Fidelity::QuasiStatic, Fidelity::Auto] {
            let found = critical_force(&scene, &Options { accurate_time: true, ..at(fidelity, law) }).unwrap();
            let late = time(&found) / exact - 1.0;
            // The integration may step over the maximum of a swing that just reaches the slip, and then finds a later one.
            let stepped_over = fidelity == Fidelity::Auto && found.rung == Fidelity::QuasiStatic && late < 0.0;
            let error = if stepped_over && late > -1e-5 { 0.0 } else { late.abs() };
            let claimed = found.error_estimate;
            prop_assert!(claimed >= 1.0 || error <= 1.1 * claimed + 1e-8, "{} {error} {claimed}", fidelity.name());
            prop_assert!(fidelity != Fidelity::Auto || error < 2e-6, "{error}");
        }
    }

    /// The first step past the slip overshoots by less than k_lat V step, and never falls short.
    #[test]
    fn fixed_steps_overshoot_by_less_than_a_step(scene in moving()) {
        let exact = critical_force(&scene, &at(Fidelity::QuasiStatic, FrictionLaw::Coulomb)).unwrap();
        let fixed = critical_force(&scene, &at(Fidelity::FixedStep, FrictionLaw::Coulomb)).unwrap();
        let excess = fixed.lateral_force - exact.lateral_force;
        let step = Probe::new(&scene, Torsion::ThinStrip).apex * scene.velocity * 0.01;
        // Large twists stiffen the probe.
        prop_assert!(excess > -1e-5 * exact.lateral_force && excess < step * (1.01 + 10.0 * fixed.twist.powi(2)));
    }

    /// `auto` meets its tolerance, compared with the rung above the one that it used.
    #[test]
    fn auto_meets_its_tolerance(scene in moving(), decade in -8.0..-2.0_f64, law in prop::sample::select(&STUCK[..3])) {
        let tolerance = 10_f64.powf(decade);
        let options = Options { tolerance, step_budget: 20_000, ..at(Fidelity::Auto, law) };
        let exact = critical_force(&scene, &at(Fidelity::QuasiStatic, law)).unwrap();
        match critical_force(&scene, &options) {
            Ok(found) => {
                let error = (found.critical_force / exact.critical_force - 1.0).abs();
                prop_assert!(error < tolerance + exact.error_estimate, "{:?} {error} {tolerance}", found.rung);
                prop_assert!(found.error_estimate <= tolerance * 1.01 || found.rung == Fidelity::Dynamic);
            }
            // Following every period of the swing takes more steps.
            Err(failure) => prop_assert_eq!(failure, Failure::StepBudget),
        }
    }
}

/// Halving the step halves the error, on average over where the slip falls within a step.
#[test]
fn fixed_steps_converge_at_first_order() {
    let mean = |step: f64| {
        let errors = (0..40).map(|i| {
            let scene = Scene { velocity: 100e-9 * (1.0 + 0.02 * f64::from(i)), ..Scene::default() };
            let fixed = critical_force(&scene, &Options { step, ..at(Fidelity::FixedStep, FrictionLaw::Coulomb) });
            let exact = critical_force(&scene, &at(Fidelity::QuasiStatic, FrictionLaw::Coulomb)).unwrap();
            fixed.unwrap().critical_force / exact.critical_force - 1.0
        });
        errors.sum::<f64>() / 40.0
    };
    let order = (mean(4e-3) / mean(5e-4)).log2() / 3.0;
    assert!((order - 1.0).abs() < 0.1, "{order}");
}

/// At the defaults: F_cr by each rung, the time of the slip with G = 40.5 GPa, and what a run costs.
#[test]
fn nominal_rungs() {
    for fidelity in [Fidelity::ClosedForm, Fidelity::QuasiStatic, Fidelity::Dynamic, Fidelity::Auto] {
        let critical = critical_force(&Scene::default(), &at(fidelity, FrictionLaw::Coulomb)).unwrap();
        assert_eq!(format!("{:.1}", critical.critical_force * 1e9), "631.3", "{fidelity:?}");
        assert!(critical.evaluations < 200, "{:?}", critical.evaluations);
    }
    let scene = Scene { shear_modulus: Some(40.5e9), ..Scene::default() };
    let time = critical_force(&scene, &at(Fidelity::Dynamic, FrictionLaw::Coulomb)).unwrap().critical_time.unwrap();
    assert!((time - 0.209).abs() < 1e-3, "{time}");
}

#[test]
fn auto_uses_the_lowest_sufficient_rung() {
    let rung = |scene: &Scene, tolerance| {
        let options = Options { tolerance, ..at(Fidelity::Auto, FrictionLaw::Coulomb) };
        critical_force(scene, &options).unwrap().rung
    };
    assert_eq!(rung(&Scene::default(), 1e-3), Fidelity::ClosedForm);
    assert_eq!(rung(&Scene::default(), 1e-6), Fidelity::QuasiStatic);
    let heavy = Scene { tip_mass: Some(1e-9), tip_inertia: Some(1e-20), velocity: 1e-4, ..Scene::default() };
    assert_eq!(rung(&heavy, 1e-7), Fidelity::Dynamic);
}

/// At rest, and without any friction, the integrated rungs agree with the quasi-static limit.
#[test]
fn without_motion_there_is_the_limit() {
    let resting = Scene { velocity: 0.0, ..Scene::default() };
    let smooth = Scene { static_friction: 0.0, shear_strength: 0.0, ..Scene::default() };
    for scene in [resting, smooth] {
        let limit = critical_force(&scene, &at(Fidelity::QuasiStatic, FrictionLaw::Coulomb)).unwrap();
        for fidelity in [Fidelity::Dynamic, Fidelity::FixedStep, Fidelity::Auto] {
            let found = critical_force(&scene, &at(fidelity, FrictionLaw::Coulomb)).unwrap();
            assert_eq!((found.critical_force, found.travel), (limit.critical_force, limit.travel));
        }
    }
}

#[test]
fn a_budget_too_small_is_named() {
    for fidelity in [Fidelity::Dynamic, Fidelity::FixedStep] {
        let options = Options { step_budget: 3, ..at(fidelity, FrictionLaw::Coulomb) };
        assert_eq!(critical_force(&Scene::default(), &options), Err(Failure::StepBudget));
    }
}

/// A probe with a tip so heavy that an explicit method can follow its swing: both methods find the same slip, which the
/// swing moves visibly. The tolerance of the stiff method is set to follow it too.
#[test]
fn both_methods_follow_a_heavy_tip() {
    // 1e-9 kg for 1e-13: swings of some 1e6 rad/s instead of 1e8; V so high that the ramp is short.
    let scene = Scene { tip_mass: Some(1e-9), tip_inertia: Some(1e-20), velocity: 1e-4, ..Scene::default() };
    let options = Options { tolerance: 1e-8, ..at(Fidelity::Dynamic, FrictionLaw::Coulomb) };
    let found = critical_force(&scene, &options).unwrap();
    let probe = Probe::new(&scene, Torsion::ThinStrip);
    let substrate = Substrate::new(&scene, &options, &probe, LuGreForm::Ramp);
    let statics = Statics::new(&scene, &probe).unwrap();
    let (limit, _) = statics.slip(&substrate).unwrap();
    let motion = Motion::new(&scene, &statics, &limit);
    let control = Control {
        tolerance: 1e-10,
        scale: [1.0, motion.frequency()],
        first_step: 1e-6,
        longest_step: 1.0,
        step_budget: 10_000_000,
    };
    let mut march = March::<DormandPrince, _, 2>::new(&motion, (0.0, [0.0, 1.0]), control);
    let slips = |t: f64, y: &[f64; 2]| {
        let tip = motion.tip(t, y);
        Ok(tip.lateral_force - substrate.hold(tip.normal_force)?.capacity)
    };
    let Ok(Outcome::Event(end)) = march.until(2.0, slips) else { panic!("no slip") };
    assert!((found.travel / (end.t * motion.length) - 1.0).abs() < 1e-6);
    assert!((found.travel / limit.travel - 1.0).abs() > 1e-3, "the swing is visible");
}

/// If friction weakens with velocity, the swing of the tip causes breakaway before the peak of a motion without it:
/// steps so fine that they keep part of the swing gave 6.185056e-7 N here, 1.6e-4 less than any rung finds.
#[test]
fn the_error_estimate_includes_breakaway_by_the_swing() {
    let scene = Scene {
        bristle_stiffness: 294.585_744_801_317_6,
        bristle_damping: 1.6e-6,
        viscous_friction: 3e-10,
        stribeck_velocity: 1.898_296_363_660_551_4e-7,
        static_friction: 0.827_747_605_545_141_9,
        dynamic_friction: 0.6,
        ..Scene::default()
    };
    for fidelity in [Fidelity::Dynamic, Fidelity::QuasiStatic, Fidelity::Auto] {
        for tolerance in [1e-4, 1e-6, 1e-7] {
            let options = Options { tolerance, ..at(fidelity, FrictionLaw::LuGre) };
            let found = critical_force(&scene, &options).unwrap();
            let shaken = (found.critical_force / 6.185_056e-7 - 1.0).abs();
            assert!((1e-4..=found.error_estimate).contains(&shaken), "{fidelity:?} {tolerance}: {found:?}");
        }
    }
}

/// Central differences of the scaled motion; 1e-5 for their curvature and rounding.
#[test]
fn the_jacobian_of_the_motion_is_the_derivative() {
    let scene = Scene { static_friction: 20.0, ..Scene::default() };
    let options = at(Fidelity::Dynamic, FrictionLaw::Coulomb);
    let probe = Probe::new(&scene, Torsion::ThinStrip);
    let substrate = Substrate::new(&scene, &options, &probe, LuGreForm::Ramp);
    let statics = Statics::new(&scene, &probe).unwrap();
    let (limit, _) = statics.slip(&substrate).unwrap();
    let motion = Motion::new(&scene, &statics, &limit);
    let (t, y) = (0.8, [0.7, 0.9]);
    let slopes = motion.slopes(&motion.twist(t, y[0]), &y);
    for j in 0..3 {
        let rate = |step: f64| {
            let shifted = std::array::from_fn(|k| y[k] + if k == j { step } else { 0.0 });
            motion.rate(t + if j == 2 { step } else { 0.0 }, &shifted)
        };
        let (above, below) = (rate(1e-5), rate(-1e-5));
        for (i, row) in slopes.iter().enumerate() {
            let difference = (above[i] - below[i]) / 2e-5;
            let slope = row[j];
            let close = (slope - difference).abs() < 1e-5 * difference.abs().max(motion.stiffness);
            assert!(close, "{i} {j} {} {difference}", slope);
        }
    }
}
