use super::*;
use crate::Scene;
use crate::ode::{DormandPrince, assert_jacobian};

fn drive(velocity: f64, tolerance: f64) -> Drive {
    Drive { velocity, stiffness: 30.0, tolerance, ..Drive::from_scene(&Scene::default(), 30.0) }
}

fn law() -> LuGre {
    LuGre::from_scene(&Scene::default())
}

/// The same ramp in plain units, F and z, with v from the balance by bisection.
struct Plain {
    law: LuGre,
    velocity: f64,
}

impl Plain {
    fn particle_velocity(&self, force: f64, z: f64) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..100 {
            let v = 0.5 * (low + high);
            if self.law.force(4e-7, z, v) < force { low = v } else { high = v }
        }
        low
    }
}

impl Problem<2> for Plain {
    fn rate(&self, _: f64, y: &[f64; 2]) -> [f64; 2] {
        let v = self.particle_velocity(y[0] * 1e-7, y[1] * 1e-10);
        [30.0 * (self.velocity - v) * 1e7, self.law.deflection_rate(4e-7, y[1] * 1e-10, v) * 1e10]
    }

    fn jacobian(&self, _: f64, _: &[f64; 2]) -> [[f64; 2]; 2] {
        [[0.0; 2]; 2]
    }
}

/// Fast and heavily damped enough for the explicit method: the peak of F over its steps. 1e-6 for the steps.
#[test]
fn agrees_with_an_explicit_march() {
    for (velocity, damping) in [(3e-4, 1e-4), (1e-3, 1e-4), (1e-3, 3e-5)] {
        let law = LuGre { damping, viscous_friction: 1e-4, ..law() };
        let control =
            Control { tolerance: 1e-9, scale: [1.0; 2], first_step: 1e-9, longest_step: 1e-7, step_budget: 1_000_000 };
        let plain = Plain { law, velocity };
        let mut march = March::<DormandPrince, _, 2>::new(&plain, (0.0, [0.0; 2]), control);
        let mut largest = 0.0_f64;
        while march.state().t < 3.0 * 4e-7 / (30.0 * velocity) {
            march.advance(1.0).unwrap();
            largest = largest.max(march.state().y[0]);
        }
        let peak = peak(&law, 4e-7, &drive(velocity, 1e-8)).unwrap();
        assert!((peak.force * 1e7 / largest - 1.0).abs() < 1e-6, "{velocity} {peak:?} {largest}");
    }
}

/// Far below v_s the peak is the steady force; at 100 nm/s they differ by 1e-9 of the Stribeck curve.
#[test]
fn slow_ramps_peak_at_the_fast_form() {
    for velocity in [0.0, 1e-9, 1e-7, 8e-7] {
        for tolerance in [1e-6, 1e-11] {
            let force = peak(&law(), 4e-7, &drive(velocity, tolerance)).unwrap().force;
            assert!((force / law().steady_force(4e-7, velocity) - 1.0).abs() < 2e-7, "{velocity} {force}");
        }
    }
}

/// Near v_s friction weakens so fast that the particle breaks loose above the steady force, and below static
/// friction plus dashpots.
#[test]
fn fast_ramps_overshoot() {
    let velocity = 1e-3;
    let force = peak(&law(), 4e-7, &drive(velocity, 1e-8)).unwrap().force;
    let steady = law().steady_force(4e-7, velocity);
    assert!(force > 1.001 * steady && force < law().stribeck(4e-7, 0.0) + 2.6e-7 * velocity, "{force} {steady}");
}

#[test]
fn no_damping_no_strength_and_no_load_have_answers() {
    let undamped = LuGre { damping: 0.0, viscous_friction: 0.0, ..law() };
    let force = peak(&undamped, 4e-7, &drive(1e-7, 1e-10)).unwrap().force;
    assert!((force / 3.2e-7 - 1.0).abs() < 1e-6, "{force}");
    let smooth = LuGre { static_friction: 0.0, dynamic_friction: 0.0, ..law() };
    assert_eq!(peak(&smooth, 4e-7, &drive(1e-7, 1e-10)).unwrap().force, 1e-7 * 1e-7);
    assert_eq!(peak(&law(), 0.0, &drive(1e-7, 1e-10)).unwrap().force, 1e-7 * 1e-7);
}

#[test]
fn the_jacobian_is_the_derivative() {
    let ramp = Ramp::new(&law(), 4e-7, &drive(1e-3, 1e-8));
    assert_jacobian(&ramp, [0.4, 0.3, 0.7], 1e-5);
}
