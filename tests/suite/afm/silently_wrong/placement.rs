//! The points of the map: at the bounds of the factors and past them.

use apportion::model::{FunctionModel, Output, RowFailure};
use apportion::space::Distribution;
use apportion::study::Study;
use apportion_base::quantity::Unit;

use super::map::{Extremes, Kind, Reason};
use super::map_of;

/// The map of a model that fails at every point with the place of the point: a reason for each.
fn map(bounds: &[(f64, f64)], points: u64, seed: u64) -> Extremes {
    let output = Output::new("y", Unit::dimensionless(), "");
    let model =
        FunctionModel::new(vec![output], |x: &[f64], _: &mut [f64]| Err(RowFailure::new(&format!("fails at {x:?}"))));
    let mut study = Study::builder("points", model);
    for (number, (min, max)) in bounds.iter().enumerate() {
        let unit = Unit::parse("um").unwrap();
        study = study.factor_in(&format!("x{number}"), unit, Distribution::uniform(*min, *max).unwrap());
    }
    map_of(&study.base_samples(64).build().unwrap(), points, seed)
}

/// The SI values of the factors.
fn si(reason: &Reason) -> Vec<f64> {
    let values = reason.reason.trim_start_matches("fails at [").trim_end_matches(']').split(", ");
    values.map(|value| value.parse().unwrap()).collect()
}

#[test]
fn bounds_and_values_past_them_are_in_the_units_of_the_factors() {
    let map = map(&[(1.0, 2.0), (0.0, 5.0), (-1.0, 1.0)], 500, 0);
    let corners = map.reasons.iter().filter(|reason| reason.kind == Kind::Corners);
    assert_eq!(corners.map(|reason| reason.count).sum::<u64>(), 8);
    let at = |row: usize, place: &str| {
        let found = map.reasons.iter().find(|reason| reason.place == format!("x{row} {place}"));
        found.map(|reason| si(reason)[row])
    };
    assert_eq!(at(0, "10^0 above its upper bound"), Some(2e-6));
    assert!((at(0, "10^6 above its upper bound").unwrap() / 2.0 - 1.0).abs() < 1e-12);
    assert!((at(0, "10^6 below its lower bound").unwrap() / 1e-12 - 1.0).abs() < 1e-12);
    for (place, value) in [("5e-324", f64::from_bits(1)), ("0e0", 0.0), ("-2e-6", -2e-6)] {
        assert_eq!(at(0, &format!("at {place} in SI units")), Some(value));
    }
    // Below 0 there are negative numbers, and below a negative bound there is no further sign to try.
    assert!(at(1, "10^1 below its lower bound").unwrap() < 0.0);
    assert!(at(2, "10^1 below its lower bound").unwrap() < -9e-6);
    assert!(at(0, "at -2e-6 in SI units").is_some());
    assert!(!map.reasons.iter().any(|reason| reason.place.starts_with("x2 at -")));
    assert!(map.reasons.iter().all(|reason| si(reason).iter().all(|x| x.is_finite())));
    // Inputs are in the units of the factors; the smallest number of all has no digits to compare.
    for (reason, x) in map.reasons.iter().map(|reason| (reason, si(reason)[0])).filter(|(_, x)| !x.is_subnormal()) {
        assert!((reason.inputs["x0"].as_f64().unwrap() - 1e6 * x).abs() <= 1e-9 * (1e6 * x).abs(), "{reason:?}");
    }
}

#[test]
fn many_corners_are_chosen_by_the_seed() {
    let corners = |seed| -> Vec<Vec<f64>> {
        let reasons = map(&[(0.0, 1.0); 70], 100, seed).reasons.into_iter();
        let mut corners: Vec<Vec<f64>> =
            reasons.filter(|reason| reason.kind == Kind::Corners).map(|reason| si(&reason)).collect();
        corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
        corners
    };
    let (one, other) = (corners(1), corners(2));
    assert_eq!((one.len(), one == corners(1), one == other), (25, true, false));
    assert_eq!((&one[0], &one[24]), (&vec![0.0; 70], &vec![1e-6; 70]));
}
