//! Parameters that make no distribution, each with what is said of them.

use super::*;

#[test]
fn what_cannot_be_is_refused_by_name() {
    let (nan, infinite) = (f64::NAN, f64::INFINITY);
    let refused = |result: Result<Distribution, Error>| result.expect_err("must be refused");
    let cases = [
        (Distribution::uniform(1.0, 1.0), Error::Bounds { min: 1.0, max: 1.0 }),
        (Distribution::uniform(2.0, -1.0), Error::Bounds { min: 2.0, max: -1.0 }),
        (Distribution::uniform(0.0, infinite), Error::NotFinite { parameter: "max", value: infinite }),
        (Distribution::uniform(-1e308, 1e308), Error::Overflow { distribution: "uniform" }),
        (Distribution::log_uniform(0.0, 1.0), Error::NotPositive { parameter: "min", value: 0.0 }),
        (Distribution::log_uniform(3.0, 1.0), Error::Bounds { min: 3.0, max: 1.0 }),
        (Distribution::normal(0.0, 0.0), Error::NotPositive { parameter: "sd", value: 0.0 }),
        (Distribution::normal(infinite, 1.0), Error::NotFinite { parameter: "mean", value: infinite }),
        (Distribution::normal(0.0, 1e308), Error::Overflow { distribution: "normal" }),
        (Distribution::log_normal(-1.0, 1.0), Error::NotPositive { parameter: "mean", value: -1.0 }),
        (Distribution::log_normal(1.0, -1.0), Error::NotPositive { parameter: "sd", value: -1.0 }),
        (Distribution::log_normal_of_logs(0.0, 0.0), Error::NotPositive { parameter: "log_sd", value: 0.0 }),
        (Distribution::log_normal_of_logs(0.0, 30.0), Error::Overflow { distribution: "log-normal" }),
        (Distribution::triangular(0.0, 1.5, 1.0), Error::Mode { mode: 1.5, min: 0.0, max: 1.0 }),
        (Distribution::triangular(0.0, 0.0, 0.0), Error::Bounds { min: 0.0, max: 0.0 }),
        (Distribution::weibull(0.0, 1.0, 0.0), Error::NotPositive { parameter: "shape", value: 0.0 }),
        (Distribution::weibull(0.005, 1.0, 0.0), Error::Overflow { distribution: "weibull" }),
        (Distribution::weibull(1.0, 1.0, -infinite), Error::NotFinite { parameter: "location", value: -infinite }),
        (Distribution::gumbel(0.0, -2.0), Error::NotPositive { parameter: "scale", value: -2.0 }),
        (Distribution::gumbel(1e308, 1e307), Error::Overflow { distribution: "gumbel" }),
        (Distribution::discrete(&[], None), Error::NoValues),
        (Distribution::discrete(&[1.0, 2.0], Some(&[1.0])), Error::Lengths { values: 2, weights: 1 }),
        (Distribution::discrete(&[1.0, 2.0], Some(&[1.0, -2.0])), Error::NegativeWeight { index: 1, value: -2.0 }),
        (Distribution::discrete(&[1.0, 2.0], Some(&[0.0, 0.0])), Error::ZeroWeights),
        (Distribution::discrete(&[1.0, 2.0], Some(&[1e308, 1e308])), Error::WeightSum),
        (Distribution::discrete(&[-1e200, 1e200], None), Error::Overflow { distribution: "discrete" }),
        (Distribution::integer(0.5, 2.0), Error::NotWhole { parameter: "min", value: 0.5 }),
        (Distribution::integer(3.0, 2.0), Error::Bounds { min: 3.0, max: 2.0 }),
        (Distribution::integer(0.0, 1e16), Error::NotWhole { parameter: "max", value: 1e16 }),
        (Distribution::boolean(1.5), Error::OutOfRange { parameter: "probability", value: 1.5, min: 0.0, max: 1.0 }),
        (Distribution::categorical::<&str>(&[], None, None), Error::NoValues),
        (Distribution::categorical(&["a", ""], None, None), Error::EmptyLabel { index: 1 }),
        (Distribution::categorical(&["a", "a"], None, None), Error::RepeatedLabel { label: "a".to_owned() }),
        (Distribution::categorical(&["a"], Some(&[1.0, 2.0]), None), Error::Labels { labels: 1, values: 2 }),
        (
            Distribution::categorical(&["a", "b"], Some(&[1.0, 1.0]), None),
            Error::RepeatedValue { index: 1, value: 1.0 },
        ),
        (Distribution::empirical(&[], None), Error::NoValues),
        (Distribution::gamma(1e6, 1.0, 0.0), Error::OutOfRange { parameter: "shape", value: 1e6, min: 1e-3, max: 1e5 }),
        (Distribution::exponential(-1.0, 0.0), Error::NotPositive { parameter: "scale", value: -1.0 }),
        (Distribution::poisson(0.0), Error::OutOfRange { parameter: "mean", value: 0.0, min: 1e-300, max: 1e6 }),
        (
            Distribution::student_t(2.0, 0.0, 1.0),
            Error::InfiniteVariance { distribution: "student-t", parameter: "df", value: 2.0, least: 2.0 },
        ),
        (
            Distribution::pareto(1.5, 1.0),
            Error::InfiniteVariance { distribution: "pareto", parameter: "shape", value: 1.5, least: 2.0 },
        ),
        (Distribution::logistic(0.0, 0.0), Error::NotPositive { parameter: "scale", value: 0.0 }),
        (Distribution::inverse_gaussian(0.0, 1.0), Error::NotPositive { parameter: "mean", value: 0.0 }),
        (Distribution::histogram(&[1.0, 2.0], &[]), Error::Edges { edges: 2, weights: 0 }),
        (
            Distribution::histogram(&[1.0, 2.0, 2.0], &[1.0, 1.0]),
            Error::NotRising { list: "edges", index: 2, value: 2.0, before: 2.0 },
        ),
        (Distribution::histogram(&[1.0, 2.0], &[0.0]), Error::ZeroWeights),
        (Distribution::histogram(&[0.0, 1.0, 3.0], &[1e308, 1e308]), Error::WeightSum),
        (
            Distribution::mixture(
                &[Distribution::constant(1.0).unwrap(), Distribution::constant(2.0).unwrap()],
                Some(&[1e308, 1e308]),
            ),
            Error::WeightSum,
        ),
        (
            Distribution::histogram_of_quantiles(&[(0.0, 1.0), (0.5, 2.0)]),
            Error::Quantiles { found: "no value for the probability 1".to_owned() },
        ),
        (
            Distribution::histogram_of_quantiles(&[(0.0, 1.0), (0.5, 0.5), (1.0, 3.0)]),
            Error::Quantiles { found: "1 for the probability 0 and 0.5 for 0.5".to_owned() },
        ),
        (Distribution::mixture(&[], None), Error::NoComponents),
        (
            Distribution::mixture(&[made(Distribution::boolean(0.5))], None),
            Error::NoOrder { distribution: "boolean", what: "a part of a mixture" },
        ),
        (Distribution::constant(infinite), Error::NotFinite { parameter: "value", value: infinite }),
    ];
    for (result, expected) in cases {
        assert_eq!(refused(result), expected);
    }
    assert!(refused(Distribution::normal(nan, 1.0)).to_string().contains("`mean` is NaN, but must be a finite number"));
    let entry = refused(Distribution::discrete(&[1.0, nan], None));
    assert_eq!(entry.to_string(), "`values[1]` is NaN, but must be a finite number");
    let shape = refused(Distribution::beta(1e-4, 1.0, 0.0, 1.0));
    assert_eq!(shape.to_string(), "`alpha` is 0.0001, but must lie between 0.001 and 100000.0");
    let swapped = refused(Distribution::beta(1.0, 1.0, 3.0, 2.0));
    assert_eq!(swapped, Error::Bounds { min: 3.0, max: 2.0 });
}

#[test]
fn truncation_where_nothing_is_left_is_refused() {
    let refused =
        |min, max| matches!(Distribution::truncated_normal(0.0, 1.0, min, max), Err(Error::Truncation { .. }));
    assert!(refused(36.0, 37.0) && refused(-50.0, -36.0) && refused(1e300, 1.5e300));
    assert!(!refused(35.0, 37.0) && !refused(-50.0, -35.0) && !refused(-1e300, 1e-300));
    // Bounds that are one number as seen from the mean.
    assert!(matches!(Distribution::truncated_normal(1e20, 1e20, 0.0, 1.0), Err(Error::Truncation { .. })));
    let refused =
        |min, max| matches!(Distribution::truncated_gumbel(0.0, 1.0, min, max), Err(Error::GumbelTruncation { .. }));
    assert!(refused(650.0, 651.0) && refused(-10.0, -6.5) && refused(-1e300, -1e299));
    assert!(!refused(640.0, 641.0) && !refused(-1e300, -6.4) && !refused(-1e300, 1e300));
}
