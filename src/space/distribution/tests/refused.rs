//! Invalid parameters of distributions, each with its message.

use super::*;

#[test]
fn invalid_settings_are_refused_by_name() {
    let (nan, infinite) = (f64::NAN, f64::INFINITY);
    let refused = |result: Result<Distribution, Error>| result.expect_err("must be refused");
    let cases = [
        (Distribution::uniform(1.0, 1.0), "`min` is 1 and `max` is 1, but `min` must be below `max`"),
        (Distribution::uniform(2.0, -1.0), "`min` is 2 and `max` is -1, but `min` must be below `max`"),
        (Distribution::uniform(0.0, infinite), "`max` is inf, but must be a finite number"),
        (
            Distribution::uniform(-1e308, 1e308),
            "a uniform distribution with these parameters has values, a mean or a standard deviation beyond",
        ),
        (Distribution::log_uniform(0.0, 1.0), "`min` is 0.0, but must be greater than 0"),
        (Distribution::log_uniform(3.0, 1.0), "`min` is 3 and `max` is 1, but `min` must be below `max`"),
        (Distribution::normal(0.0, 0.0), "`sd` is 0.0, but must be greater than 0"),
        (Distribution::normal(infinite, 1.0), "`mean` is inf, but must be a finite number"),
        (
            Distribution::normal(0.0, 1e308),
            "a normal distribution with these parameters has values, a mean or a standard deviation beyond",
        ),
        (Distribution::log_normal(-1.0, 1.0), "`mean` is -1.0, but must be greater than 0"),
        (Distribution::log_normal(1.0, -1.0), "`sd` is -1.0, but must be greater than 0"),
        (Distribution::log_normal_of_logs(0.0, 0.0), "`log_sd` is 0.0, but must be greater than 0"),
        (
            Distribution::log_normal_of_logs(0.0, 30.0),
            "a log-normal distribution with these parameters has values, a mean or a standard deviation beyond",
        ),
        (Distribution::triangular(0.0, 1.5, 1.0), "`mode` is 1.5, but must lie between `min` (0) and `max` (1)"),
        (Distribution::triangular(0.0, 0.0, 0.0), "`min` is 0 and `max` is 0, but `min` must be below `max`"),
        (Distribution::weibull(0.0, 1.0, 0.0), "`shape` is 0.0, but must be greater than 0"),
        (
            Distribution::weibull(0.005, 1.0, 0.0),
            "a weibull distribution with these parameters has values, a mean or a standard deviation beyond",
        ),
        (Distribution::weibull(1.0, 1.0, -infinite), "`location` is -inf, but must be a finite number"),
        (Distribution::gumbel(0.0, -2.0), "`scale` is -2.0, but must be greater than 0"),
        (
            Distribution::gumbel(1e308, 1e307),
            "a gumbel distribution with these parameters has values, a mean or a standard deviation beyond",
        ),
        (Distribution::discrete(&[], None), "`values` is empty"),
        (Distribution::discrete(&[1.0, 2.0], Some(&[1.0])), "there are 1 `weights` for 2 `values`"),
        (Distribution::discrete(&[1.0, 2.0], Some(&[1.0, -2.0])), "`weights[1]` is -2, but must not be negative"),
        (Distribution::discrete(&[1.0, 2.0], Some(&[0.0, 0.0])), "all `weights` are 0"),
        (Distribution::discrete(&[1.0, 2.0], Some(&[1e308, 1e308])), "`weights` sum to more than 1.8e308"),
        (
            Distribution::discrete(&[-1e200, 1e200], None),
            "a discrete distribution with these parameters has values, a mean or a standard deviation beyond",
        ),
        (Distribution::integer(0.5, 2.0), "`min` is 0.5, but must be a whole number between -2^53 and 2^53"),
        (Distribution::integer(3.0, 2.0), "`min` is 3 and `max` is 2, but `min` must be below `max`"),
        (Distribution::integer(0.0, 1e16), "`max` is 1e16, but must be a whole number between -2^53 and 2^53"),
        (Distribution::boolean(1.5), "`probability` is 1.5, but must lie between 0.0 and 1.0"),
        (Distribution::categorical::<&str>(&[], None, None), "`values` is empty"),
        (Distribution::categorical(&["a", ""], None, None), "`labels[1]` is empty"),
        (Distribution::categorical(&["a", "a"], None, None), "the label \"a\" is listed twice in `labels`"),
        (Distribution::categorical(&["a"], Some(&[1.0, 2.0]), None), "there are 2 `values` for 1 `labels`"),
        (
            Distribution::categorical(&["a", "b"], Some(&[1.0, 1.0]), None),
            "`values[1]` is 1, but must differ from those before it",
        ),
        (Distribution::empirical(&[], None), "`values` is empty"),
        (Distribution::gamma(1e6, 1.0, 0.0), "`shape` is 1000000.0, but must lie between 0.001 and 100000.0"),
        (Distribution::exponential(-1.0, 0.0), "`scale` is -1.0, but must be greater than 0"),
        (Distribution::poisson(0.0), "`mean` is 0.0, but must lie between 1e-300 and 1000000.0"),
        (Distribution::student_t(2.0, 0.0, 1.0), "`df` is 2.0, but must be greater than 2.0, or both tails be cut off"),
        (Distribution::pareto(1.5, 1.0), "`shape` is 1.5, but must be greater than 2.0, or both tails be cut off"),
        (Distribution::logistic(0.0, 0.0), "`scale` is 0.0, but must be greater than 0"),
        (Distribution::histogram(&[1.0, 2.0], &[]), "there are 2 `edges` for 0 `weights`"),
        (
            Distribution::histogram(&[1.0, 2.0, 2.0], &[1.0, 1.0]),
            "`edges[2]` is 2, but must be above the one before it, 2",
        ),
        (Distribution::histogram(&[1.0, 2.0], &[0.0]), "all `weights` are 0"),
        (Distribution::histogram(&[0.0, 1.0, 3.0], &[1e308, 1e308]), "`weights` sum to more than 1.8e308"),
        (
            Distribution::histogram_of_quantiles(&[(0.0, 1.0), (0.5, 2.0)]),
            "`quantiles` has no value for the probability 1, but must have rising values",
        ),
        (
            Distribution::histogram_of_quantiles(&[(0.0, 1.0), (0.5, 0.5), (1.0, 3.0)]),
            "`quantiles` has 1 for the probability 0 and 0.5 for 0.5, but must have rising values",
        ),
        (Distribution::constant(infinite), "`value` is inf, but must be a finite number"),
    ];
    for (result, expected) in cases {
        let message = refused(result).to_string();
        assert!(message.starts_with(expected), "no {expected:?} in {message:?}");
    }
    assert!(refused(Distribution::normal(nan, 1.0)).to_string().contains("`mean` is NaN, but must be a finite number"));
    let entry = refused(Distribution::discrete(&[1.0, nan], None));
    assert_eq!(entry.to_string(), "`values[1]` is NaN, but must be a finite number");
    let shape = refused(Distribution::beta(1e-4, 1.0, 0.0, 1.0));
    assert_eq!(shape.to_string(), "`alpha` is 0.0001, but must lie between 0.001 and 100000.0");
    let swapped = refused(Distribution::beta(1.0, 1.0, 3.0, 2.0));
    assert_eq!(swapped.to_string(), "`min` is 3 and `max` is 2, but `min` must be below `max`");
    assert_eq!((swapped.key(), swapped.help()), (Some("min"), None));
    let fixed = refused(Distribution::uniform(3.0, 3.0)).help();
    assert_eq!(fixed.as_deref(), Some("for a fixed value: distribution = \"constant\", value = 3"));
}

#[test]
fn truncation_without_remaining_values_is_refused() {
    let refused =
        |min, max| matches!(Distribution::truncated_normal(0.0, 1.0, min, max), Err(Error::NothingLeft { .. }));
    assert!(refused(36.0, 37.0) && refused(-50.0, -36.0) && refused(1e300, 1.5e300));
    assert!(!refused(35.0, 37.0) && !refused(-50.0, -35.0) && !refused(-1e300, 1e-300));
    // Bounds that are equal within the rounding of the mean.
    assert!(matches!(Distribution::truncated_normal(1e20, 1e20, 0.0, 1.0), Err(Error::NothingLeft { .. })));
    let refused =
        |min, max| matches!(Distribution::truncated_gumbel(0.0, 1.0, min, max), Err(Error::NothingLeft { .. }));
    assert!(refused(650.0, 651.0) && refused(-10.0, -6.5) && refused(-1e300, -1e299));
    assert!(!refused(640.0, 641.0) && !refused(-1e300, -6.4) && !refused(-1e300, 1e300));
}
