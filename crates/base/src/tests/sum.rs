use super::*;

#[test]
fn small_cases_by_hand() {
    assert_eq!(mean(&[]), 0.0);
    assert_eq!(mean(&[3.0]), 3.0);
    assert_eq!(mean(&[1.0, 2.0, 6.0]), 3.0);
    let (x, y) = ([1.0, 2.0, 6.0], [0.0, 3.0, 0.0]);
    assert_eq!(centred_product((&x, 3.0), (&y, 1.0)), 2.0 - 2.0 - 3.0);
}

#[test]
fn every_element_counts_once_at_any_length() {
    for n in 0..50 {
        let x: Vec<f64> = (0..n).map(|i| (1u64 << i) as f64).collect();
        assert_eq!(centred_product((&x, 0.0), (&vec![1.0; n], 0.0)), (1u64 << n) as f64 - 1.0);
    }
}

#[test]
fn a_large_offset_costs_no_digits_of_the_spread() {
    // The offset keeps the small integers exact; the error of the mean is up to half of 2^-12, and enters squared.
    let spread: Vec<f64> = (0..1001).map(|i| f64::from(i % 7)).collect();
    let shifted: Vec<f64> = spread.iter().map(|x| x + 2f64.powi(40)).collect();
    let centred = |x: &[f64]| centred_product((x, mean(x)), (x, mean(x)));
    assert!((centred(&shifted) / centred(&spread) - 1.0).abs() < 1e-8);
}

#[test]
fn equal_values_have_no_spread() {
    for value in [0.1, 1e300, -7e-300, 1.0 / 3.0] {
        let x = vec![value; 777];
        assert_eq!(mean(&x), value);
        assert_eq!(centred_product((&x, mean(&x)), (&x, mean(&x))), 0.0);
    }
}
