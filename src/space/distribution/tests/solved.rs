//! Distributions by a mean and a standard deviation, or by two quantiles.

use super::*;

/// Keys with their numbers.
type Stated = Vec<(&'static str, f64)>;

fn stated(family: &str, stated: &[(&'static str, f64)]) -> Result<Distribution, Error> {
    let parameters: Vec<_> = stated.iter().map(|(key, value)| (*key, Parameter::Number(*value))).collect();
    Kind::from_name(family).expect("a family").make(&parameters)
}

#[track_caller]
fn close(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value:e}, not {expected:e}");
}

#[test]
fn closed_forms_are_met() {
    let made = |family, keys: &[(&'static str, f64)]| made(stated(family, keys));
    // The 95 % quantile of the standard normal distribution, from tables.
    let z = 1.644_853_626_951_472_7;
    let normal = made("normal", &[("p05", 10.0 - 2.0 * z), ("p95", 10.0 + 2.0 * z)]);
    close(normal.mean(), 10.0, 1e-14);
    close(normal.sd(), 2.0, 1e-14);
    let uniform = made("uniform", &[("mean", 1.0), ("sd", 3f64.sqrt().recip())]);
    close(uniform.support().0, 0.0, 1e-15);
    close(uniform.support().1, 2.0, 1e-15);
    let log_normal = made("log-normal", &[("p05", 1.0), ("p95", 4.0)]);
    close(log_normal.median(), 2.0, 1e-13);
    close(log_normal.quantile(0.95), 4.0, 1e-12);
    // Exponential: standard deviation and mean are equal.
    let weibull = made("weibull", &[("mean", 3.0), ("sd", 3.0)]);
    close(weibull.median(), 3.0 * libm::log(2f64), 1e-11);
    close(made("exponential", &[("mean", 3.0)]).median(), 3.0 * libm::log(2f64), 1e-14);
    let triangle = made("triangular", &[("mode", 3.0), ("p05", 1.0), ("p95", 5.0)]);
    close(triangle.mean(), 3.0, 1e-9);
}

/// One of each family that is solved for, and what has to be given with mean and standard deviation or quantiles.
fn samples() -> Vec<(Distribution, Stated)> {
    let cases: [(Result<Distribution, Error>, Stated); 15] = [
        (Distribution::uniform(-1.0, 2.5), vec![]),
        (Distribution::log_uniform(0.5, 40.0), vec![]),
        (Distribution::normal(1e6, 0.5), vec![]),
        (Distribution::log_normal_of_logs(1.0, 0.25), vec![]),
        (Distribution::gumbel(1.0, 2.0), vec![]),
        (Distribution::weibull(1.7, 2.0, 0.0), vec![]),
        (Distribution::weibull(1.7, 2.0, 3.0), vec![("location", 3.0)]),
        (Distribution::gamma(2.5, 2.0, 0.0), vec![]),
        (Distribution::gamma(2.5, 2.0, -3.0), vec![("location", -3.0)]),
        (Distribution::exponential(2.0, 0.0), vec![]),
        (Distribution::exponential(2.0, 1.0), vec![]),
        (Distribution::logistic(1.0, 2.0), vec![]),
        (Distribution::student_t(5.0, 1.0, 2.0), vec![("df", 5.0)]),
        (Distribution::pareto(3.5, 2.0), vec![]),
        (Distribution::triangular(1.0, 2.0, 4.0), vec![("mode", 2.0)]),
    ];
    cases.into_iter().map(|(distribution, beside)| (made(distribution), beside)).collect()
}

#[test]
fn every_way_leads_back() {
    for (distribution, beside) in samples() {
        let quantile = |key: &'static str, probability| (key, distribution.quantile(probability));
        let mut ways = vec![
            vec![quantile("p05", 0.05), quantile("p90", 0.9)],
            vec![quantile("p50", 0.5), quantile("p90", 0.9)],
            vec![quantile("p05", 0.05), quantile("p50", 0.5)],
        ];
        if distribution.name() != "triangular" {
            ways.push(vec![("mean", distribution.mean()), ("sd", distribution.sd())]);
        }
        for way in ways {
            let keys: Stated = beside.iter().chain(&way).copied().collect();
            let found = stated(distribution.name(), &keys).unwrap_or_else(|error| panic!("{keys:?}: {error}"));
            for u in [0.02, 0.3, 0.8, 0.99] {
                // Quantiles that are close together say little of a tail: 1e-9 sd there is 1e-6 here.
                close(found.quantile(u), distribution.quantile(u), 1e-6 * distribution.sd());
            }
        }
    }
}

#[test]
fn invalid_settings_are_refused_by_name() {
    type Case<'a> = (&'a str, &'a [(&'static str, f64)], &'a str);
    let cases: [Case<'_>; 12] = [
        ("normal", &[("p05", 3.0), ("p95", 3.0)], "`p05` is 3 and `p95` is 3, but `p05` must be below `p95`"),
        ("normal", &[("p05", 3.0)], "the normal distribution needs two quantiles, such as `p05` and `p95`"),
        (
            "normal",
            &[("p05", 3.0), ("p95", 4.0), ("mean", 3.5)],
            "the normal distribution has no `mean` together with `p05`",
        ),
        ("normal", &[("p05", 3.0), ("p50", 3.5), ("p95", 4.0)], "needs two quantiles"),
        ("normal", &[("mean", 3.5)], "the normal distribution needs `sd`"),
        ("uniform", &[("mode", 3.0), ("p95", 4.0)], "the uniform distribution has no `mode`"),
        ("log-normal", &[("p05", -3.0), ("p95", 4.0)], "`p05` is -3.0, but must be greater than 0"),
        ("weibull", &[("scale", 1.0), ("shape", -1.0)], "`shape` is -1.0, but must be greater than 0"),
        (
            "triangular",
            &[("mode", 9.0), ("p05", 0.0), ("p95", 1.0)],
            "no triangular distribution, or more than one, with",
        ),
        (
            "pareto",
            &[("mean", 1.0), ("sd", 100.0)],
            "no pareto distribution, or more than one, with mean = 1 and sd = 100",
        ),
        ("gumbel", &[("mean", f64::NAN), ("sd", 1.0)], "`mean` is NaN, but must be a finite number"),
        ("seed", &[("mean", 1.0)], "the seed distribution has no `mean`"),
    ];
    for (family, keys, expected) in cases {
        let message = stated(family, keys).expect_err("must be refused").to_string();
        assert!(message.contains(expected), "no {expected:?} in {message:?}");
    }
    let words = |family| Kind::from_name(family).map(Kind::takes);
    assert_eq!(words("beta").as_deref(), Some("alpha and beta and min and max; or mean and sd and min and max"));
    assert_eq!(words("boolean").as_deref(), Some("perhaps probability"));
    assert_eq!(words("seed").as_deref(), Some("no keys"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// Two quantiles in order determine every family of two parameters, and are those found. Weibull distributions are sought
    /// up to a shape of 1e4, where these quantiles are 3.1e-4 apart.
    #[test]
    fn quantiles_come_back(low in 1e-3..1e3f64, ratio in 4e-4..3.0f64) {
        let high = low * (1.0 + ratio);
        for family in ["uniform", "normal", "log-normal", "gumbel", "weibull"] {
            let found = made(stated(family, &[("p10", low), ("p90", high)]));
            close(found.quantile(0.1), low, 1e-9 * (high - low));
            close(found.quantile(0.9), high, 1e-9 * (high - low));
        }
    }

    #[test]
    fn nothing_panics(family in 0..26usize, picks in prop::collection::vec((0..KEYS.len(), -1e3..1e3f64), 0..5)) {
        let keys: Stated = picks.into_iter().map(|(place, value)| (KEYS[place].name, value)).collect();
        let _ = stated(Kind::all().nth(family).map_or("uniform", Kind::name), &keys);
    }
}
