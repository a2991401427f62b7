use super::*;

#[test]
fn t_quantiles_are_those_of_the_tables() {
    // Whole degrees of freedom from tables; 2.5 and 5.7 from scipy.stats.t.ppf, SciPy 1.17.
    let cases = [
        (1.0, 12.7062),
        (2.0, 4.3027),
        (4.0, 2.7764),
        (15.0, 2.1314),
        (100.0, 1.9840),
        (2.5, 3.574_65),
        (5.7, 2.478_47),
    ];
    for (freedom, expected) in cases {
        assert!((t_quantile(freedom).unwrap() - expected).abs() < 6e-5, "{freedom}: {:?}", t_quantile(freedom));
    }
    assert_eq!(t_quantile(0.0), None);
}

#[test]
fn an_interval_needs_an_error() {
    let interval = |error, freedom| t_interval(0.5, StandardError { error, freedom });
    assert_eq!(interval(0.0, 1.0), Some(Interval { low: 0.5, high: 0.5 }));
    assert_eq!(interval(f64::NAN, 0.0), None);
    assert_eq!(t_interval(f64::NAN, StandardError { error: 0.1, freedom: 3.0 }), None);
    let found = interval(0.1, 1e9).unwrap();
    assert!((found.high - 0.695_996).abs() < 1e-6 && (found.low - 0.304_004).abs() < 1e-6);
}
