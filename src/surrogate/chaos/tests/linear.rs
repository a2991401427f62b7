use super::*;

#[test]
fn the_factor_solves_and_inverts() {
    let size = 19;
    let columns: Vec<Vec<f64>> =
        (0..size).map(|j| (0..30).map(|i| libm::sin((1 + i * (j + 2)) as f64)).collect()).collect();
    let columns = Panels::from_columns(30, columns.iter().map(Vec::as_slice));
    let mut matrix = Symmetric::products(&columns, &columns);
    matrix.add_to_diagonal(0.1);
    let x: Vec<f64> = (0..size).map(|j| j as f64 - 7.0).collect();
    let y = matrix.times(&x);
    let factor = Cholesky::new(matrix.clone()).unwrap();
    assert!(factor.solve(&y).iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-10));
    for (j, value) in factor.inverse_diagonal().into_iter().enumerate() {
        let unit: Vec<f64> = (0..size).map(|i| f64::from(u8::from(i == j))).collect();
        assert!((factor.solve(&unit)[j] - value).abs() < 1e-12);
    }
    matrix.add_to_diagonal(-100.0);
    assert!(Cholesky::new(matrix).is_none());
}
