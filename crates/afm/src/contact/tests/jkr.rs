use proptest::prelude::*;

use super::*;

fn pair() -> impl Strategy<Value = Pair> {
    (-9.0..-5.0_f64, 7.0..13.0_f64, -3.0..1.0_f64).prop_map(|(radius, modulus, adhesion)| Pair {
        radius: libm::pow(10.0, radius),
        modulus: libm::pow(10.0, modulus),
        adhesion: libm::pow(10.0, adhesion),
        separation: 0.2e-9,
    })
}

/// Returns the load that holds a contact of radius a: F = K a^3/R - sqrt(6 pi w K a^3).
fn load_at(pair: &Pair, a: f64) -> f64 {
    pair.modulus * a.powi(3) / pair.radius - (6.0 * PI * pair.adhesion * pair.modulus * a.powi(3)).sqrt()
}

/// Solves the load equation for a by bisection on its stable branch, which starts at the
/// pull-off radius a^3 = 3 pi w R^2/(2 K).
fn radius_by_bisection(pair: &Pair, load: f64) -> f64 {
    let mut low = libm::cbrt(1.5 * PI * pair.adhesion * pair.radius.powi(2) / pair.modulus);
    let mut high = 2.0 * low;
    while load_at(pair, high) < load {
        high *= 2.0;
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if load_at(pair, middle) < load { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn nominal_contact() {
    let pair = Pair { radius: 50e-9, modulus: 60e9, adhesion: 0.2, separation: 0.2e-9 };
    let contact = contact(&pair, 489.4e-9).unwrap();
    assert!((contact.radius - 9.09e-9).abs() < 0.005e-9, "{}", contact.radius);
    // By hand, at a = 9.09121 nm: a^2/R - (2/3) sqrt(6 pi w a/K) = 1.65300 - 0.50386 nm.
    assert!((contact.indentation - 1.14914e-9).abs() < 1e-14, "{}", contact.indentation);
}

/// Known exact points: a^3 = 6 pi w R^2/K without load, and 3 pi w R^2/(2 K) at pull-off.
#[test]
fn exact_points() {
    let pair = Pair { radius: 50e-9, modulus: 60e9, adhesion: 0.2, separation: 0.2e-9 };
    let unit = PI * pair.adhesion * pair.radius.powi(2) / pair.modulus;
    let at_rest = contact(&pair, 0.0).unwrap().radius;
    assert!((at_rest / libm::cbrt(6.0 * unit) - 1.0).abs() < 1e-15);
    let at_pull_off = contact(&pair, -pull_off(&pair)).unwrap().radius;
    assert!((at_pull_off / libm::cbrt(1.5 * unit) - 1.0).abs() < 1e-15);
}

proptest! {
    /// Loads from 0.9 of pull-off upwards; nearer, the square root makes the radius itself ill-conditioned.
    /// 1e-13: some hundred roundings through a condition number of at most 5.
    #[test]
    fn solves_the_load_equation(pair in pair(), multiple in prop_oneof![-0.9..10.0_f64, 10.0..1e4_f64]) {
        let load = multiple * pull_off(&pair);
        let radius = contact(&pair, load).unwrap().radius;
        let expected = radius_by_bisection(&pair, load);
        prop_assert!((radius / expected - 1.0).abs() < 1e-13, "{radius} {expected}");
    }
}
