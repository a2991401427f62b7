use super::*;

fn curve(range: (f64, f64), f: impl Fn(f64) -> f64) -> Curve {
    let x = grid(range, 21);
    Curve { y: x.iter().map(|&x| f(x)).collect(), x }
}

#[test]
fn shapes_are_distinguishable() {
    let line = curve((1.0, 3.0), |x| 2.0 * x + 1.0);
    assert!(line.rises() && !line.falls());
    // Rounding alone bends a straight line.
    assert!(line.bend().0 < 1e-14 && line.bend().1 > 1.0 - 1e-14 && line.steepens() < 1e-12);
    let inverse = curve((1.0, 3.0), |x| 1.0 / (x * x));
    assert!(inverse.falls() && inverse.steepens() == 0.0 && inverse.bend().0 > 0.05);
    // x^3 has the elasticity 3 between any ends.
    let cubic = curve((1.0, 3.0), |x| x * x * x);
    assert!((cubic.elasticity() - 3.0).abs() < 1e-14 && cubic.steepens() > 0.1);
    let flat = curve((0.0, 1.0), |x| 1.0 + 1e-6 * x);
    assert!((flat.spread() - 1e-6).abs() < 1e-11);
    let wave = curve((0.0, 6.0), libm::sin);
    assert!(!wave.rises() && !wave.falls());
    assert_eq!(grid((0.0, 1.0), 3), [0.0, 0.5, 1.0]);
}
