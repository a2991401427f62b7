use super::*;
use apportion_base::sum::product;

#[test]
fn polynomials_are_orthonormal_under_their_distribution() {
    let cases = [
        Distribution::truncated_normal(0.1, 0.016, 0.05, 0.15).unwrap(),
        Distribution::triangular(1.0, 2.0, 5.0).unwrap(),
        Distribution::beta(0.5, 0.5, 0.0, 1.0).unwrap(),
        Distribution::uniform(-3.0, 4.0).unwrap(),
    ];
    let n = 40_000;
    let u: Vec<f64> = (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n)).collect();
    for distribution in cases {
        let family = OrthogonalPolynomials::new(&distribution, 8).unwrap();
        assert_eq!(family.degree(), 8);
        let columns = family.columns(&u, 8);
        for (j, a) in columns.iter().enumerate() {
            assert!((a.iter().sum::<f64>() / f64::from(n)).abs() < 1e-3, "{distribution:?} {j}");
            for (k, b) in columns.iter().enumerate() {
                let product = product(a, b) / f64::from(n);
                let exact = f64::from(u8::from(j == k));
                // The midpoint rule itself has this error where quantiles are steep.
                assert!((product - exact).abs() < 1e-2, "{distribution:?} {j} {k} {product}");
            }
        }
    }
}

#[test]
fn polynomials_of_uniform_factors_are_legendres() {
    let family = OrthogonalPolynomials::new(&Distribution::uniform(2.0, 5.0).unwrap(), 14).unwrap();
    for (k, (a, b)) in family.recurrence.coefficients.iter().enumerate() {
        let n = k as f64 + 1.0;
        assert!(a.abs() < 1e-12 && (b - n / (4.0 * n * n - 1.0).sqrt()).abs() < 1e-12, "{k} {a} {b}");
    }
}

#[test]
fn steps_of_quantiles_are_met() {
    let gap = Distribution::histogram(&[0.0, 1.0, 9.0, 10.0], &[0.97, 0.0, 0.03]).unwrap();
    let family = OrthogonalPolynomials::new(&gap, 8).unwrap();
    let n = 100_000;
    let u: Vec<f64> = (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n)).collect();
    for column in family.columns(&u, 8) {
        assert!((product(&column, &column) / f64::from(n) - 1.0).abs() < 1e-4);
    }
    let counts = OrthogonalPolynomials::new(&Distribution::poisson(0.5).unwrap(), 8).unwrap();
    // Those of Charlier: a_0 = mean and b_1 = sd, moved and scaled.
    let Recurrence { middle, half, coefficients } = &counts.recurrence;
    assert!((middle + half * coefficients[0].0 - 0.5).abs() < 1e-11);
    assert!((half * coefficients[0].1 - 0.5f64.sqrt()).abs() < 1e-11);
}

#[test]
fn as_many_levels_as_degrees() {
    let three = Distribution::discrete(&[1.0, 2.0, 7.0], Some(&[0.2, 0.5, 0.3])).unwrap();
    let family = OrthogonalPolynomials::new(&three, 10).unwrap();
    assert_eq!(family.degree(), 2);
    let columns = family.columns(&[0.1, 0.5, 0.9], 8);
    let mean = |a: &[f64], b: &[f64]| 0.2 * a[0] * b[0] + 0.5 * a[1] * b[1] + 0.3 * a[2] * b[2];
    assert!((mean(&columns[0], &columns[0]) - 1.0).abs() < 1e-12 && mean(&columns[0], &columns[1]).abs() < 1e-12);
    assert_eq!(OrthogonalPolynomials::new(&Distribution::normal(0.0, 1.0).unwrap(), 5), None);
}
