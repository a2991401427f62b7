use super::*;

/// Values that all differ, with `value` in every 20th place.
fn with(value: f64) -> Vec<f64> {
    (0..200).map(|k| if k % 20 == 3 { value } else { (f64::from(k) * 0.618).fract() }).collect()
}

#[test]
fn codes_and_slips_are_found() {
    for code in [-999.0, -9999.0, 1e20, 9.96921e36, 99999.0, 123_456.0] {
        let found = Unlikely::find(&with(code)).unwrap();
        assert_eq!((found.value, found.count, found.first, found.of), (code, 10, 3, 200));
    }
    let mut one = with(0.5);
    one[77] = 2e4;
    assert_eq!(Unlikely::find(&one).map(|found| (found.count, found.first)), Some((1, 77)));
    // Any value that recurs where all others differ.
    assert_eq!(Unlikely::find_in_rows(&with(0.5)).map(|found| found.count), Some(10));
    // A repeated code within the range of the other values is also found.
    let wide: Vec<f64> = with(0.5).iter().map(|y| if *y == 0.5 { -999.0 } else { 1998.0 * y - 998.0 }).collect();
    assert_eq!(Unlikely::find(&wide).map(|found| found.count), Some(10));
}

#[test]
fn values_of_models_are_not() {
    let switch: Vec<f64> = (0..200).map(|k| f64::from(u8::from(k % 50 == 0))).collect();
    let counts: Vec<f64> = (0..10_000).map(f64::from).collect();
    let tail: Vec<f64> = (1..500).map(|k| (1000.0 / f64::from(k)).powi(2)).collect();
    let cut: Vec<f64> = with(0.5).iter().map(|y| y.max(0.2)).collect();
    for values in [switch, counts, tail, cut, vec![-999.0; 40], Vec::new()] {
        assert_eq!(Unlikely::find(&values), None);
        assert_eq!(Unlikely::find_in_rows(&values), None);
    }
}
