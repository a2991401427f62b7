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
}

#[test]
fn the_rarest_counts_are_those_of_the_outermost_level() {
    let counts = OrthogonalPolynomials::new(&Distribution::poisson(0.5).unwrap(), 8).unwrap();
    // P(x > 3) = 0.0018, of which more than a thousandth on this side is a level.
    assert_eq!(counts.degree(), 4);
    let n = 100_000;
    let u: Vec<f64> = (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n)).collect();
    for column in counts.columns(&u, 8) {
        assert!((product(&column, &column) / f64::from(n) - 1.0).abs() < 0.02, "{}", product(&column, &column));
    }
    assert_eq!(counts.columns(&[1.0 - 1e-12], 8), counts.columns(&[0.9995], 8));
}

#[test]
fn as_many_levels_as_degrees() {
    let three = Distribution::discrete(&[1.0, 2.0, 7.0], Some(&[0.2, 0.5, 0.3])).unwrap();
    let family = OrthogonalPolynomials::new(&three, 10).unwrap();
    assert_eq!(family.degree(), 2);
    let columns = family.columns(&[0.1, 0.5, 0.9], 8);
    let mean = |a: &[f64], b: &[f64]| 0.2 * a[0] * b[0] + 0.5 * a[1] * b[1] + 0.3 * a[2] * b[2];
    assert!((mean(&columns[0], &columns[0]) - 1.0).abs() < 1e-12 && mean(&columns[0], &columns[1]).abs() < 1e-12);
    assert_eq!(OrthogonalPolynomials::new(&Distribution::constant(1.0).unwrap(), 5), None);
}

#[test]
fn polynomials_without_bounds_are_those_of_laguerre_and_hermite() {
    // Of x in standard deviations from the mean: x p_k = b_(k+1) p_(k+1) + a_k p_k + b_k p_(k-1).
    let gamma = |s: f64| move |k: f64| (2.0 * k / s.sqrt(), ((k + 1.0) * (k + s) / s).sqrt());
    let check = |law: Distribution, exact: &dyn Fn(f64) -> (f64, f64)| {
        let family = OrthogonalPolynomials::new(&law, 14).unwrap();
        assert!(family.is_unbounded() && family.degree() == 14, "{law:?}");
        for (k, (a, b)) in family.recurrence.coefficients.iter().enumerate() {
            let (right_a, right_b) = exact(k as f64);
            assert!((a - right_a).abs() < 1e-9 && (b - right_b).abs() < 1e-9, "{law:?} {k} {a} {b}");
        }
    };
    check(Distribution::exponential(2.0, 5.0).unwrap(), &gamma(1.0));
    check(Distribution::gamma(2.5, 3.0, 0.0).unwrap(), &gamma(2.5));
    check(Distribution::normal(1.0, 2.0).unwrap(), &|k| (0.0, (k + 1.0).sqrt()));
    let z = Distribution::exponential(1.0, 0.0).unwrap();
    let family = OrthogonalPolynomials::new(&z, 2).unwrap();
    // (x^2 - 4 x + 2)/2 at x = 50, where 1 - u has no digits.
    let second = family.upper_columns(&[libm::exp(-50.0)])[1][0];
    assert!((second - 1151.0).abs() < 1e-8, "{second}");
}

#[test]
fn degrees_are_at_most_half_the_finite_moments() {
    let degree = |law: Result<Distribution, _>| OrthogonalPolynomials::new(&law.unwrap(), 14).unwrap().degree();
    assert_eq!([2.01, 3.0, 4.0, 4.5, 9.0].map(|shape| degree(Distribution::pareto(shape, 1.0))), [0, 1, 1, 2, 4]);
    assert_eq!([3.0, 5.0, 10.0].map(|df| degree(Distribution::student_t(df, 0.0, 1.0))), [1, 2, 4]);
    let infinity = f64::INFINITY;
    for law in [
        Distribution::gumbel(1.0, 2.0),
        Distribution::logistic(1.0, 2.0),
        Distribution::weibull(0.5, 1.0, 0.0),
        Distribution::log_normal(1.0, 0.5),
        Distribution::normal(0.0, 1.0).unwrap().truncated(0.0, infinity),
        Distribution::gumbel(0.0, 1.0).unwrap().truncated(1.0, infinity),
        Distribution::exponential(1.0, 0.0).unwrap().truncated(2.0, infinity),
    ] {
        assert_eq!(degree(law.clone()), 14, "{law:?}");
    }
}
