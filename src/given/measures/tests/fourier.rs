use super::*;

fn without_ties(sorted: &[f64]) -> f64 {
    first_order(sorted, &(0..=sorted.len()).collect::<Vec<usize>>())
}

#[test]
fn a_sine_of_the_input_explains_all_variance_and_noise_none() {
    let rows = 1000;
    // A cosine of one period in the order up and down.
    let sorted: Vec<f64> = (0..rows).map(|k| libm::cos(TAU * (k as f64) / (2.0 * rows as f64))).collect();
    assert!((without_ties(&sorted) - 1.0).abs() < 1e-4);
    let scattered: Vec<f64> = (0..rows).map(|k| ((k * 7919 % rows) as f64 - 499.5) / 500.0).collect();
    assert!(without_ties(&scattered).abs() < 0.05);
}

#[test]
fn ties_are_averaged_over_their_orders() {
    let (z, starts) = ([0.5, -1.5, 2.0, -0.25, 1.0, -1.75], [0, 3, 4, 6]);
    let mut sum = 0.0;
    for first in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        for last in [[4, 5], [5, 4]] {
            let rows = first.into_iter().chain([3]).chain(last);
            sum += without_ties(&rows.map(|row| z[row]).collect::<Vec<f64>>());
        }
    }
    assert!((first_order(&z, &starts) - sum / 12.0).abs() < 1e-14);
}
