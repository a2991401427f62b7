use super::*;

#[test]
fn kernels_are_those_of_the_exponential() {
    for (place, width) in [(0.0, 3.0), (17.4, 0.4), (98.9, 25.0), (50.5, 0.02)] {
        let mut density = [0.0; GRID];
        add_kernel(&mut density, place, width, 2.0);
        for (k, got) in density.iter().enumerate() {
            let expected = 2.0 * libm::exp(-((k as f64 - place) / width).powi(2) / 2.0);
            // The error of a ratio is multiplied by the number of steps.
            assert!((got - expected).abs() <= 1e-11 * expected.max(1e-30), "{place} {width} {k}: {got} {expected}");
        }
    }
}

#[test]
fn classes_that_are_points_are_as_far_as_can_be() {
    let values: Vec<f64> = (0..800).map(f64::from).collect();
    let classes = Partition { labels: (0..800).collect(), count: 800 };
    assert_eq!(OutputDistribution::new(&values).delta(&classes, &[1.0; 800], 1.0), 1.0);
}

#[test]
fn unusual_values_are_counted() {
    let atoms = |values: &[f64]| OutputDistribution::new(values).atoms;
    let rows = |of: fn(u32) -> f64| (0..1000u32).map(of).collect::<Vec<f64>>();
    assert_eq!(atoms(&rows(f64::from)), 0);
    assert_eq!(atoms(&rows(|k| f64::from(k % 50))), 50);
    // Two thirds 0, or 1 in 100 rows; finely rounded values have no atoms.
    assert_eq!(atoms(&rows(|k| if k % 3 > 0 { 0.0 } else { f64::from(k) })), 1);
    assert_eq!(atoms(&rows(|k| if k % 100 > 0 { f64::from(k) } else { 0.5 })), 1);
    assert_eq!(atoms(&rows(|k| f64::from(k % 200))), 0);
    // Digits that are rounding create no separate values, not even next to a huge one.
    assert_eq!(atoms(&rows(|k| if k == 7 { 1e20 } else { f64::from(1 + k % 2) + f64::from(k % 3) * 2.3e-16 })), 3);
}
