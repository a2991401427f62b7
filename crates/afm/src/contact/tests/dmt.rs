use super::*;

const PAIR: Pair = Pair { radius: 50e-9, modulus: 60e9, adhesion: 0.2, separation: 0.2e-9 };

/// Known exact points: a^3 = 2 pi w R^2/K without load, and a = 0 at pull-off.
#[test]
fn exact_points() {
    let at_rest = contact(&PAIR, 0.0).unwrap();
    let cube = 2.0 * PI * 0.2 * 50e-9_f64.powi(2) / 60e9;
    assert!((at_rest.radius / libm::cbrt(cube) - 1.0).abs() < 1e-15);
    assert!((at_rest.indentation / (libm::cbrt(cube).powi(2) / 50e-9) - 1.0).abs() < 1e-15);
    assert_eq!(contact(&PAIR, -pull_off(&PAIR)), Ok(Contact { radius: 0.0, indentation: 0.0 }));
    assert_eq!(contact(&PAIR, (-pull_off(&PAIR)).next_down()), Err(Failure::BeyondPullOff));
}
