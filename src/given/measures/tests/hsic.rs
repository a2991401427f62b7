use super::*;

#[test]
fn a_column_does_not_depend_on_other_columns() {
    let x: Vec<f64> = (0..200).map(|k| f64::from(k * 37 % 200)).collect();
    let y: Vec<f64> = (0..200).map(|k| f64::from(k * k % 193)).collect();
    let outputs = Outputs::new(&x, 0).unwrap();
    let itself = outputs.measure(&x).unwrap();
    assert!((itself.estimate.estimate - 1.0).abs() < 1e-12 && itself.p_value.unwrap() < 1e-10);
    // Scale and offset are irrelevant.
    let moved: Vec<f64> = x.iter().map(|x| 3e200 * (x - 7.0)).collect();
    assert!((outputs.measure(&moved).unwrap().estimate.estimate - 1.0).abs() < 1e-12);
    let other = outputs.measure(&y).unwrap();
    assert!(other.estimate.estimate < 0.1 && other.p_value.unwrap() > 0.01, "{other:?}");
}

#[test]
fn sorted_rows_give_the_same_measures_as_random_order() {
    let rows = 3 * MAX_ROWS;
    let a: Vec<f64> = (0..rows).map(|k| k as f64 / rows as f64).collect();
    let b: Vec<f64> = (0..rows).map(|k| (k * 7919 % rows) as f64 / rows as f64).collect();
    let y: Vec<f64> = a.iter().zip(&b).map(|(a, b)| f64::from(u8::from(*a > 0.5)) + 0.2 * b).collect();
    let outputs = Outputs::new(&y, 3).unwrap();
    let [of_a, of_b] = [&a, &b].map(|x| outputs.measure(x).unwrap().estimate.estimate);
    assert!(of_a > 0.5 && of_b < 0.1, "{of_a} {of_b}");
    // The same rows again, and others with another seed.
    assert_eq!(Outputs::new(&y, 3).unwrap().rows, outputs.rows);
    assert_ne!(Outputs::new(&y, 4).unwrap().rows, outputs.rows);
}

#[test]
fn one_value_in_the_sampled_rows_gives_no_number() {
    let rows = 2 * MAX_ROWS;
    let x: Vec<f64> = (0..rows).map(|k| k as f64).collect();
    let mut one = vec![1.0; rows];
    let outputs = Outputs::new(&x, 0).unwrap();
    let left_out = (0..rows).find(|row| outputs.rows.binary_search(row).is_err()).unwrap();
    one[left_out] = 2.0;
    assert!(Outputs::new(&one, 0).is_none() && outputs.measure(&one).is_none());
}
