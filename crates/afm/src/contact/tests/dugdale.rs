use proptest::prelude::*;

use super::*;

/// The two functions that switch to a series are continuous there: 1e-13, a few hundred roundings of terms that
/// cancel to a hundredth.
#[test]
fn the_series_meet_the_closed_forms() {
    for lambda in [1e-3, 1.0, 1e3] {
        let (below, above) = (Zone::new(lambda, 0.1_f64.next_down()), Zone::new(lambda, 0.1));
        assert!((below.f / above.f - 1.0).abs() < 1e-13);
        assert!((below.excess() / above.excess() - 1.0).abs() < 1e-13);
    }
}

/// Limits of the least load and of the radius there, for small and for large lambda, by expansion about s =
/// infinity and s = 0: lift (16/3) (pi/2 - 1) pi^(-1/2) lambda^(3/2), abar 2 pi lambda/3; and 1/2, (3/2)^(1/3). The
/// next terms are of relative order lambda^(3/2) and 1/lambda^2.
#[test]
fn pull_off_tends_to_dmt_and_jkr() {
    for lambda in [1e-30, 1e-12, 1e-8] {
        let zone = Zone::at_pull_off(lambda);
        let lift = 16.0 / 3.0 * (PI / 2.0 - 1.0) / PI.sqrt() * libm::pow(lambda, 1.5);
        assert!((zone.lift() / lift - 1.0).abs() < 1e-7, "{lambda}");
        assert!((zone.radius / (2.0 * PI / 3.0 * lambda) - 1.0).abs() < 1e-7, "{lambda}");
    }
    for lambda in [1e4, 1e6, 1e8] {
        let zone = Zone::at_pull_off(lambda);
        assert!((zone.lift() - 0.5).abs() < 1.0 / lambda.powi(2) + 1e-14, "{lambda}");
        assert!((zone.radius - libm::cbrt(1.5)).abs() < 1.0 / lambda.powi(2) + 1e-14, "{lambda}");
    }
}

/// A root that a Newton step overshoots into the region past the minimum, and one far from the start.
#[test]
fn descend_arrives_from_anywhere() {
    for start in [1e-200, 1e-3, 0.5, 1.9, 3.0, 1e200] {
        // (ln s)^2 - 1 falls through zero at 1/e and has its minimum at 1.
        let root = descend(start, f64::INFINITY, |s| (libm::log(s).powi(2) - 1.0, 2.0 * libm::log(s)));
        assert!((root * libm::exp(1.0) - 1.0).abs() < 1e-14, "{start}: {root}");
    }
}

proptest! {
    /// The slope is the derivative of the lift: central differences of step 1e-4, to 1e-8 plus its rounding.
    #[test]
    fn slope_is_the_derivative(log_lambda in -3.0..3.0_f64, log_s in -4.0..4.0_f64) {
        let (lambda, s) = (libm::pow(10.0, log_lambda), libm::pow(10.0, log_s));
        let at = |x: f64| Zone::new(lambda, s * libm::exp(x));
        let (up, here, down) = (at(1e-4), at(0.0), at(-1e-4));
        let slope = (up.lift() - down.lift()) / 2e-4;
        let scale = here.radius.powi(3) + lambda * here.radius.powi(2) * (1.0 + here.angle) + 1e-5 * here.lift().abs();
        prop_assert!((slope - here.slope() * here.radius.powi(2)).abs() < 1e-6 * scale);
        let excess = -1.0 - libm::log(up.radius / down.radius) / 2e-4;
        prop_assert!((excess - here.excess()).abs() < 1e-6);
        prop_assert!((0.0..=1.0).contains(&here.excess()));
    }

    /// Roots reproduce the given values, to a few roundings; the lift is above pull-off by a share that may be
    /// tiny.
    #[test]
    fn roots_are_roots(log_lambda in -36.0..9.0_f64, log_share in -14.0..34.0_f64) {
        let lambda = libm::pow(10.0, log_lambda);
        let last = Zone::at_pull_off(lambda);
        let lift = last.lift() * (1.0 + libm::pow(10.0, log_share));
        let zone = Zone::at_lift(lambda, lift, Some(last));
        prop_assert!((zone.lift() / lift - 1.0).abs() < 1e-13, "{} {lift}", zone.lift());
        prop_assert!(zone.radius >= last.radius * (1.0 - 1e-14));
        let again = Zone::at_radius(lambda, zone.radius);
        prop_assert!((again.extent / zone.extent - 1.0).abs() < 1e-13);
    }

    /// Past pull-off the load rises again, before it falls: the minimum is the only one.
    #[test]
    fn one_minimum(log_lambda in -6.0..6.0_f64, log_ratio in -3.0..3.0_f64) {
        prop_assume!(log_ratio.abs() > 1e-6);
        let lambda = libm::pow(10.0, log_lambda);
        let last = Zone::at_pull_off(lambda);
        let zone = Zone::new(lambda, last.extent * libm::pow(10.0, log_ratio));
        prop_assert_eq!(zone.slope() > 0.0, log_ratio > 0.0);
    }
}
