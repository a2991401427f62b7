use super::*;

#[test]
fn a_sparse_sum_is_found_with_a_dependent_column() {
    let rows = 40;
    let mut columns: Vec<Vec<f64>> =
        (0..60).map(|j| (0..rows).map(|i| libm::sin(((i + 1) * (3 * j + 2)) as f64)).collect()).collect();
    columns[9] = columns[4].iter().map(|x| 2.0 * x).collect();
    let y: Vec<f64> = (0..rows).map(|i| 5.0 + columns[2][i] - 3.0 * columns[17][i]).collect();
    let columns = Panels::from_columns(rows, columns.iter().map(Vec::as_slice));
    let mut sizes = vec![1e-3; 60];
    (sizes[17], sizes[2]) = (2.0, 0.5);
    let fit = Squares::new(&columns, &y, &sizes, &[1.0; 60]);
    assert!((fit.mean - 5.0).abs() < 1e-12 && fit.left < 1e-24, "{} {:e}", fit.mean, fit.left);
    for (j, c) in fit.coefficients.iter().enumerate() {
        let exact = if j == 2 {
            1.0
        } else if j == 17 {
            -3.0
        } else {
            0.0
        };
        assert!((c - exact).abs() < 1e-12, "{j}: {c}");
    }
}
