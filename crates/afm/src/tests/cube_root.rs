use proptest::prelude::*;

use super::*;

#[test]
fn cubes_have_exact_roots() {
    for root in [0.0, 1e-100, 0.25, 1.0, 2.0, 3.0, 101.0, 2.0_f64.powi(-340), 2.0_f64.powi(341)] {
        let cube: f64 = root * root * root;
        assert!((cube_root(cube) - root).abs() <= 2.0 * f64::EPSILON * root, "{root}");
    }
    for x in [8.0, 27.0, 1e6, 2.0_f64.powi(-1074), 2.0_f64.powi(1020)] {
        assert_eq!(cube_root(x), libm::cbrt(x), "{x}");
    }
}

#[test]
fn the_ends_of_the_range() {
    assert_eq!(cube_root(0.0), 0.0);
    assert_eq!(cube_root(f64::INFINITY), f64::INFINITY);
    assert!(cube_root(f64::NAN).is_nan());
}

proptest! {
    /// One unit in the last place from the library's root, which is itself rounded.
    #[test]
    fn agrees_with_the_library(x in any::<f64>()) {
        let x = x.abs();
        let (own, library) = (cube_root(x), libm::cbrt(x));
        prop_assert!(own == library || (own - library).abs() <= 2.0 * f64::EPSILON * library || x.is_nan());
    }
}
