use super::*;

#[test]
fn solves_with_row_exchanges_and_rows_of_all_sizes() {
    let matrix = [[0.0, 2e-20, 1e-20], [1e15, 0.0, 3e15], [4.0, 1.0, 0.0]];
    let x = [1.0, -2.0, 3.0];
    let b = std::array::from_fn(|i| (0..3).map(|k| matrix[i][k] * x[k]).sum());
    let solved = Factors::new(matrix).solve(&b);
    for i in 0..3 {
        assert!((solved[i] - x[i]).abs() < 1e-14, "{solved:?}");
    }
}

#[test]
fn a_singular_matrix_is_noticed() {
    let solved = Factors::new([[1.0, 2.0], [2.0, 4.0]]).solve(&[1.0, 1.0]);
    assert!(solved.iter().any(|value| !value.is_finite()));
}
