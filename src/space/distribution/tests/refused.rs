//! Invalid parameters of distributions, each with its message.

use super::*;

#[test]
fn invalid_settings_are_refused_by_name() {
    let (nan, infinite) = (f64::NAN, f64::INFINITY);
    let refused = |result: Result<Distribution, Error>| result.expect_err("must be refused");
    let cases = [
        Distribution::uniform(1.0, 1.0),
        Distribution::uniform(2.0, -1.0),
        Distribution::uniform(0.0, infinite),
        Distribution::uniform(-1e308, 1e308),
        Distribution::log_uniform(0.0, 1.0),
        Distribution::log_uniform(3.0, 1.0),
        Distribution::normal(0.0, 0.0),
        Distribution::normal(infinite, 1.0),
        Distribution::normal(0.0, 1e308),
        Distribution::log_normal(-1.0, 1.0),
        Distribution::log_normal(1.0, -1.0),
        Distribution::log_normal_of_logs(0.0, 0.0),
        Distribution::log_normal_of_logs(0.0, 30.0),
        Distribution::triangular(0.0, 1.5, 1.0),
        Distribution::triangular(0.0, 0.0, 0.0),
        Distribution::pert(0.0, 1.5, 1.0),
        Distribution::weibull(0.0, 1.0, 0.0),
        Distribution::weibull(0.005, 1.0, 0.0),
        Distribution::weibull(1.0, 1.0, -infinite),
        Distribution::gumbel(0.0, -2.0),
        Distribution::gumbel(1e308, 1e307),
        Distribution::discrete(&[], None),
        Distribution::discrete(&[1.0, 2.0], Some(&[1.0])),
        Distribution::discrete(&[1.0, 2.0], Some(&[1.0, -2.0])),
        Distribution::discrete(&[1.0, 2.0], Some(&[0.0, 0.0])),
        Distribution::discrete(&[1.0, 2.0], Some(&[1e308, 1e308])),
        Distribution::discrete(&[-1e200, 1e200], None),
        Distribution::integer(0.5, 2.0),
        Distribution::integer(3.0, 2.0),
        Distribution::integer(0.0, 1e16),
        Distribution::boolean(1.5),
        Distribution::categorical::<&str>(&[], None, None),
        Distribution::categorical(&["a", ""], None, None),
        Distribution::categorical(&["a", "a"], None, None),
        Distribution::categorical(&["a"], Some(&[1.0, 2.0]), None),
        Distribution::categorical(&["a", "b"], Some(&[1.0, 1.0]), None),
        Distribution::empirical(&[], None),
        Distribution::gamma(1e6, 1.0, 0.0),
        Distribution::exponential(-1.0, 0.0),
        Distribution::poisson(0.0),
        Distribution::binomial(2.5, 0.5),
        Distribution::binomial(2.0, 1.0),
        Distribution::negative_binomial(0.0, 0.5),
        Distribution::negative_binomial(1e5, 0.01),
        Distribution::geometric(1e-4),
        Distribution::student_t(2.0, 0.0, 1.0),
        Distribution::pareto(1.5, 1.0),
        Distribution::logistic(0.0, 0.0),
        Distribution::histogram(&[1.0, 2.0], &[]),
        Distribution::histogram(&[1.0, 2.0, 2.0], &[1.0, 1.0]),
        Distribution::histogram(&[1.0, 2.0], &[0.0]),
        Distribution::histogram(&[0.0, 1.0, 3.0], &[1e308, 1e308]),
        Distribution::histogram_of_quantiles(&[(0.0, 1.0), (0.5, 2.0)]),
        Distribution::histogram_of_quantiles(&[(0.0, 1.0), (0.5, 0.5), (1.0, 3.0)]),
        Distribution::constant(infinite),
        Distribution::normal(nan, 1.0),
        Distribution::discrete(&[1.0, nan], None),
        Distribution::beta(1e-4, 1.0, 0.0, 1.0),
        Distribution::beta(1.0, 1.0, 3.0, 2.0),
    ];
    insta::assert_snapshot!(cases.map(|result| refused(result).to_string()).join("\n"));
    let swapped = refused(Distribution::beta(1.0, 1.0, 3.0, 2.0));
    assert_eq!((swapped.key, swapped.help), (Some("min"), None));
    let fixed = refused(Distribution::uniform(3.0, 3.0)).help;
    assert_eq!(fixed.as_deref(), Some("for a fixed value, use the constant distribution of 3"));
}

#[test]
fn truncation_without_remaining_values_is_refused() {
    let refused = |min, max| {
        matches!(Distribution::truncated_normal(0.0, 1.0, min, max), Err(Error { key: Some("truncate"), .. }))
    };
    assert!(refused(36.0, 37.0) && refused(-50.0, -36.0) && refused(1e300, 1.5e300));
    assert!(!refused(35.0, 37.0) && !refused(-50.0, -35.0) && !refused(-1e300, 1e-300));
    // Bounds that are equal within the rounding of the mean.
    assert!(matches!(Distribution::truncated_normal(1e20, 1e20, 0.0, 1.0), Err(Error { key: Some("truncate"), .. })));
    let refused = |min, max| {
        matches!(Distribution::truncated_gumbel(0.0, 1.0, min, max), Err(Error { key: Some("truncate"), .. }))
    };
    assert!(refused(650.0, 651.0) && refused(-10.0, -6.5) && refused(-1e300, -1e299));
    assert!(!refused(640.0, 641.0) && !refused(-1e300, -6.4) && !refused(-1e300, 1e300));
}
