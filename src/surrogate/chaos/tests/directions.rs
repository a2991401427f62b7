use super::*;

#[test]
fn outputs_are_sums_of_the_directions() {
    // Rank 2 about their means.
    let outputs: Vec<Vec<f64>> =
        (0..5).map(|k| (0..50).map(|i| 3.0 + f64::from(k * i) + f64::from((i * i) % 7)).collect()).collect();
    let directions = Directions::new(outputs.clone());
    assert_eq!(directions.values.len(), 2);
    assert!(product(&directions.values[0], &directions.values[1]).abs() < 1e-9);
    for (output, y) in directions.outputs.iter().zip(&outputs) {
        let mut sum = vec![output.mean; y.len()];
        output.weights.iter().zip(&directions.values).for_each(|(w, d)| add_scaled(&mut sum, *w, d));
        assert!(sum.iter().zip(y).all(|(a, b)| (a - b).abs() < 1e-9));
    }
}
