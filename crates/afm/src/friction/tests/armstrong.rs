use proptest::prelude::*;

use super::*;

/// Fresh at the start, halfway after gamma, old in the limit.
#[test]
fn static_friction_rises_with_the_dwell_time() {
    for (dwell, coefficient) in [(0.0, 0.75), (1.0, 0.775), (f64::INFINITY, 0.8)] {
        assert!((Armstrong(&Scene::default()).static_force(1.0, dwell) - coefficient).abs() < 1e-15);
    }
}

#[test]
fn sliding_starts_at_static_friction_and_ends_at_coulomb() {
    let at = |velocity| Armstrong(&Scene::default()).sliding_force(1.0, velocity, velocity, 1.0);
    assert!((at(0.0) - 0.775).abs() < 1e-15);
    assert!((at(1e-3) - (0.7 + 0.0375 + 1e-10)).abs() < 1e-15);
    assert!((at(1e3) - (0.7 + 1e-4)).abs() < 1e-12);
}

proptest! {
    /// The root of the quadratic solves the original equation; 1e-12 because terms of p cancel.
    #[test]
    fn break_away_is_consistent(rate in -12.0..3.0_f64, rest in 0.0..10.0_f64, fresh in 0.0..1.0_f64) {
        let scene = Scene { fresh_friction: fresh, rest_time: rest, ..Scene::default() };
        let law = Armstrong(&scene);
        let rate = libm::pow(10.0, rate);
        let force = law.break_away(4e-7, rate);
        let again = law.static_force(4e-7, rest + force / rate);
        prop_assert!((force / again - 1.0).abs() < 1e-12, "{force} {again}");
    }

}

#[test]
fn the_limits_of_the_loading() {
    let at = |rate| Armstrong(&Scene::default()).break_away(4e-7, rate);
    assert!((at(0.0) / 3.2e-7 - 1.0).abs() < 1e-15);
    assert!((at(1e9) / 3e-7 - 1.0).abs() < 1e-15);
    assert!((at(f64::MAX) / 3e-7 - 1.0).abs() < 1e-15);
    assert_eq!(Armstrong(&Scene::default()).break_away(0.0, 1.0), 0.0);
}

impl Armstrong<'_> {
    /// Returns the friction of sliding at `velocity` (m/s), >= 0, under `load` (N), where `lagged` is the velocity one
    /// lag ago and `dwell` (s) the rest before it slid.
    pub fn sliding_force(&self, load: f64, velocity: f64, lagged: f64, dwell: f64) -> f64 {
        let coulomb = self.0.dynamic_friction * load;
        let ratio = lagged / self.0.stribeck_velocity;
        let excess = self.static_force(load, dwell) - coulomb;
        coulomb + excess / (1.0 + ratio * ratio) + self.0.viscous_friction * velocity
    }
}
