use super::*;

fn matrix(n: usize, upper: &[f64]) -> DMatrix<f64> {
    let mut matrix = DMatrix::identity(n, n);
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    for ((i, j), r) in pairs.zip(upper) {
        (matrix[(i, j)], matrix[(j, i)]) = (*r, *r);
    }
    matrix
}

#[test]
fn regressions_are_those_of_the_normal_distribution() {
    let copula = GaussianCopula::new(matrix(3, &[0.5, 0.2, -0.4])).unwrap();
    // By hand: (r02 - r01 r12, r12 - r01 r02) / (1 - r01^2).
    let found = copula.regression(2, &[0, 1]);
    let expected = [(0.2 + 0.5 * 0.4) / 0.75, (-0.4 - 0.5 * 0.2) / 0.75];
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
    assert!(copula.regression(1, &[]).is_empty());
    // 0 is connected with 2 only through 1: it has no coefficient unless 1 is given, and one through it.
    let chain = GaussianCopula::new(matrix(3, &[0.5, 0.0, 0.5])).unwrap();
    assert_eq!(chain.regression(0, &[2]), [0.0]);
    assert!(chain.regression(0, &[1, 2])[1] < -0.1);
}

#[test]
fn an_impossible_correlation_matrix_is_refused_with_the_nearest_possible_one() {
    // Higham's example: the nearest matrix is known to four digits.
    let proposed = GaussianCopula::new(matrix(3, &[1.0, 0.0, 1.0])).unwrap_err();
    assert!((proposed[(0, 1)] - 0.7607).abs() < 5e-3 && (proposed[(0, 2)] - 0.1573).abs() < 5e-3, "{proposed}");
    assert!(GaussianCopula::new(proposed).is_ok());
    for (n, upper) in [(2, vec![1.0]), (3, vec![0.9, -0.9, 0.9]), (4, vec![-0.9; 6])] {
        assert!(GaussianCopula::new(GaussianCopula::new(matrix(n, &upper)).unwrap_err()).is_ok(), "{upper:?}");
    }
}
