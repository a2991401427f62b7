//! Tests of the properties of distributions except their numbers, which `tests/distributions.rs` checks.

use crate::space::Distribution;
use DistributionError as Error;
use proptest::prelude::*;
use student_t::StudentT;

use super::*;

mod refused;
mod solved;

fn made(result: Result<Distribution, Error>) -> Distribution {
    result.unwrap_or_else(|error| panic!("{error}"))
}

/// One of each family.
fn samples() -> Vec<Distribution> {
    [
        Distribution::uniform(-1.0, 2.5),
        Distribution::log_uniform(0.5, 40.0),
        Distribution::normal(3.0, 0.5),
        Distribution::truncated_normal(3.0, 0.5, 2.0, 5.0),
        Distribution::log_normal(5.0, 1.0),
        Distribution::log_normal_of_logs(1.0, 0.25),
        Distribution::triangular(1.0, 2.0, 4.0),
        Distribution::beta(2.0, 0.5, 1.0, 3.0),
        Distribution::pert(1.0, 2.0, 4.0),
        Distribution::weibull(1.5, 2.0, 0.25),
        Distribution::gumbel(1.0, 2.0),
        Distribution::truncated_gumbel(1.0, 2.0, 0.5, 6.0),
        Distribution::gamma(2.5, 2.0, 0.25),
        Distribution::exponential(2.0, 1.0),
        Distribution::poisson(4.5),
        Distribution::binomial(10.0, 0.25),
        Distribution::negative_binomial(2.5, 0.25),
        Distribution::geometric(0.25),
        Distribution::student_t(5.0, 1.0, 2.0),
        Distribution::logistic(1.0, 0.5),
        Distribution::pareto(3.0, 2.0),
        Distribution::histogram(&[-1.0, 0.5, 1.0, 4.0], &[1.0, 0.0, 3.0]),
        made(Distribution::gamma(2.5, 2.0, 0.25)).truncated(1.0, f64::INFINITY),
        Distribution::discrete(&[3.0, 1.0, 2.0], Some(&[1.0, 0.0, 3.0])),
        Distribution::discrete(&[3.0, 1.0], None),
        Distribution::integer(-2.0, 5.0),
        Distribution::categorical(&["a", "b c"], Some(&[3.0, 1.5]), Some(&[1.0, 4.0])),
        Distribution::boolean(0.25),
        Distribution::empirical(&[3.0, 1.0, 3.0], None),
        Distribution::constant(225.0),
    ]
    .into_iter()
    .map(made)
    .collect()
}

/// Truncation of any family: unchanged distributions, the two families with their own form to the bit, empty ones.
#[test]
fn continuous_families_are_truncated_by_one_rule() {
    let (none, two) = (f64::NEG_INFINITY, [2.0, 5.0]);
    let cut = |uncut: Result<Distribution, Error>, [min, max]: [f64; 2]| made(uncut).truncated(min, max);
    let pairs = [
        (cut(Distribution::uniform(0.0, 3.0), two), Distribution::uniform(2.0, 3.0)),
        (cut(Distribution::log_uniform(1.0, 8.0), two), Distribution::log_uniform(2.0, 5.0)),
        (cut(Distribution::normal(3.0, 0.5), two), Distribution::truncated_normal(3.0, 0.5, 2.0, 5.0)),
        (
            cut(Distribution::truncated_normal(3.0, 0.5, 2.5, 9.0), two),
            Distribution::truncated_normal(3.0, 0.5, 2.5, 5.0),
        ),
        (cut(Distribution::gumbel(3.0, 0.5), two), Distribution::truncated_gumbel(3.0, 0.5, 2.0, 5.0)),
        (cut(Distribution::pareto(3.0, 1.0), [2.0, f64::INFINITY]), Distribution::pareto(3.0, 2.0)),
        (cut(Distribution::constant(3.0), two), Distribution::constant(3.0)),
        (cut(Distribution::logistic(0.0, 1.0), [none, f64::INFINITY]), Distribution::logistic(0.0, 1.0)),
    ];
    for (left, expected) in pairs {
        assert_eq!(left, expected);
    }
    // Nothing is cut off twice.
    let gamma = made(Distribution::gamma(2.0, 1.0, 0.0));
    assert_eq!(made(gamma.truncated(1.0, 9.0)).truncated(2.0, 5.0), gamma.truncated(2.0, 5.0));
    for (uncut, [min, max]) in [
        (Distribution::gamma(2.0, 1.0, 0.0), [-5.0, -1.0]),
        (Distribution::normal(0.0, 1.0), [40.0, 50.0]),
        (Distribution::student_t(1e5, 0.0, 1.0), [60.0, 70.0]),
        (Distribution::uniform(0.0, 1.0), [1.0, 2.0]),
        (Distribution::constant(3.0), [4.0, 5.0]),
    ] {
        let uncut = made(uncut);
        let error = uncut.truncated(min, max);
        assert!(matches!(error, Err(Error { key: Some("truncate"), .. })), "{uncut:?} {error:?}");
    }
    let bounds = gamma.truncated(3.0, 2.0);
    assert_eq!(bounds.map_err(|error| error.key), Err(Some("truncate")));
    let mut messages = Vec::new();
    for single in [
        Distribution::integer(0.0, 9.0),
        Distribution::discrete(&[1.0, 2.0, 5.0, 6.0], None),
        Distribution::empirical(&[1.0, 2.0, 5.0], None),
        Distribution::histogram(&[0.0, 4.0, 8.0], &[1.0, 1.0]),
        Distribution::poisson(2.0),
        Distribution::binomial(9.0, 0.5),
    ] {
        messages.push(cut(single, two).expect_err("no parameters to truncate by").to_string());
    }
    messages.push(cut(Distribution::boolean(0.5), [0.0, 0.5]).expect_err("labels").to_string());
    // Between two bounds every variance is finite, but not with one bound.
    let cauchy = Distribution::StudentT(StudentT::new(1.0, 0.0, 1.0).expect("a law"));
    assert!((made(cauchy.truncated(-1.0, 1.0)).quantile(0.75) - libm::tan(std::f64::consts::PI / 8.0)).abs() < 1e-15);
    messages.push(cauchy.truncated(0.0, f64::INFINITY).expect_err("a long tail").to_string());
    insta::assert_snapshot!(messages.join("\n"));
}

#[test]
fn counts_have_their_exact_shares() {
    let coins = made(Distribution::binomial(2.0, 0.5));
    let at = [0.0, 0.2499, 0.2501, 0.7499, 0.7501, 1.0].map(|u| coins.quantile(u));
    assert_eq!((at, coins.mean(), coins.sd()), ([0.0, 0.0, 1.0, 1.0, 2.0, 2.0], 1.0, 0.5f64.sqrt()));
    assert_eq!(coins.levels().map(|levels| levels.len()), Some(3));
    let trials = made(Distribution::geometric(0.5));
    assert_eq!([0.4999, 0.5001, 0.7501].map(|u| trials.quantile(u)), [1.0, 2.0, 3.0]);
    assert_eq!((trials.mean(), trials.support()), (2.0, (1.0, f64::INFINITY)));
    // One success: failures before it, one less than the trials.
    let failures = made(Distribution::negative_binomial(1.0, 0.5));
    assert_eq!([0.4999, 0.5001, 0.7501].map(|u| failures.quantile(u)), [0.0, 1.0, 2.0]);
    let events = made(Distribution::poisson(2.0));
    let at = [0.1353, 0.1354, 0.4060, 0.4061, 0.6766, 0.6767].map(|u| events.quantile(u));
    assert_eq!(at, [0.0, 1.0, 1.0, 2.0, 2.0, 3.0]);
    assert_eq!((events.mean(), events.sd(), events.support()), (2.0, 2f64.sqrt(), (0.0, f64::INFINITY)));
    for (value, u) in events.levels().expect("a few") {
        assert_eq!(events.quantile(u), value);
    }
    assert_eq!(made(Distribution::poisson(1e6)).levels(), None);
}

#[test]
fn names_are_those_of_study_files() {
    let mut names: Vec<_> = samples().iter().map(Distribution::name).collect();
    names.dedup();
    let expected = "uniform log-uniform normal truncated-normal log-normal triangular beta pert weibull gumbel truncated-gumbel gamma exponential poisson binomial negative-binomial geometric student-t logistic pareto histogram gamma discrete integer categorical boolean empirical constant";
    assert_eq!(names.join(" "), expected);
}

#[test]
fn json_holds_the_name_and_the_parameters_as_given() {
    let json = |distribution: &Distribution| serde_json::to_string(distribution).expect("finite numbers");
    let texts: Vec<_> = samples().iter().map(json).collect();
    insta::assert_snapshot!(texts.join("\n"), @r#"
    {"name":"uniform","min":-1.0,"max":2.5}
    {"name":"log-uniform","min":0.5,"max":40.0}
    {"name":"normal","mean":3.0,"sd":0.5}
    {"name":"truncated-normal","mean":3.0,"sd":0.5,"min":2.0,"max":5.0}
    {"name":"log-normal","mean":5.0,"sd":1.0}
    {"name":"log-normal","log_mean":1.0,"log_sd":0.25}
    {"name":"triangular","min":1.0,"mode":2.0,"max":4.0}
    {"name":"beta","alpha":2.0,"beta":0.5,"min":1.0,"max":3.0}
    {"name":"pert","min":1.0,"mode":2.0,"max":4.0}
    {"name":"weibull","shape":1.5,"scale":2.0,"location":0.25}
    {"name":"gumbel","location":1.0,"scale":2.0}
    {"name":"truncated-gumbel","location":1.0,"scale":2.0,"min":0.5,"max":6.0}
    {"name":"gamma","shape":2.5,"scale":2.0,"location":0.25}
    {"name":"exponential","scale":2.0,"location":1.0}
    {"name":"poisson","mean":4.5}
    {"name":"binomial","n":10.0,"p":0.25}
    {"name":"negative-binomial","n":2.5,"p":0.25}
    {"name":"geometric","p":0.25}
    {"name":"student-t","df":5.0,"location":1.0,"scale":2.0}
    {"name":"logistic","location":1.0,"scale":0.5}
    {"name":"pareto","shape":3.0,"min":2.0}
    {"name":"histogram","edges":[-1.0,0.5,1.0,4.0],"weights":[1.0,0.0,3.0]}
    {"name":"gamma","shape":2.5,"scale":2.0,"location":0.25,"truncate":[1.0,"inf"]}
    {"name":"discrete","values":[3.0,1.0,2.0],"weights":[1.0,0.0,3.0]}
    {"name":"discrete","values":[3.0,1.0]}
    {"name":"integer","min":-2.0,"max":5.0}
    {"name":"categorical","labels":["a","b c"],"values":[3.0,1.5],"weights":[1.0,4.0]}
    {"name":"boolean","probability":0.25}
    {"name":"empirical","values":[3.0,1.0,3.0]}
    {"name":"constant","value":225.0}
    "#);
}

#[test]
fn discrete_values_have_their_exact_shares() {
    let grades = made(Distribution::discrete(&[3.0, 1.0, 2.0, 9.0], Some(&[1.0, 2.0, 1.0, 0.0])));
    let below_half = 0.5f64.next_down();
    let at = [Distribution::SMALLEST_U, below_half, 0.5, 0.75f64.next_down(), 0.75, Distribution::LARGEST_U]
        .map(|u| grades.quantile(u));
    assert_eq!(at, [1.0, 1.0, 2.0, 2.0, 3.0, 3.0]);
    assert_eq!((grades.mean(), grades.sd(), grades.support()), (1.75, 0.6875f64.sqrt(), (1.0, 3.0)));
    let even = made(Distribution::discrete(&[5.0; 7], None));
    assert_eq!((even.quantile(Distribution::LARGEST_U), even.sd()), (5.0, 0.0));
}

#[test]
fn whole_numbers_and_categories_have_their_exact_shares() {
    let die = made(Distribution::integer(1.0, 6.0));
    assert_eq!(
        [Distribution::SMALLEST_U, (1.0f64 / 6.0).next_down(), 0.5, Distribution::LARGEST_U].map(|u| die.quantile(u)),
        [1.0, 1.0, 4.0, 6.0]
    );
    assert_eq!((die.mean(), die.sd(), die.support()), (3.5, (35.0f64 / 12.0).sqrt(), (1.0, 6.0)));
    assert_eq!(die.levels().map(|levels| levels.len()), Some(6));
    for (value, u) in die.levels().unwrap_or_default() {
        assert_eq!(die.quantile(u), value);
    }
    let many = made(Distribution::integer(-1e15, 1e15));
    assert_eq!((many.levels(), many.quantile(Distribution::LARGEST_U), many.quantile(0.5)), (None, 1e15, 0.0));
    let probe = made(Distribution::categorical(&["x", "y", "z"], Some(&[5.0, 1.0, 3.0]), Some(&[1.0, 2.0, 0.0])));
    assert_eq!((probe.label(probe.quantile(0.66)), probe.label(probe.quantile(0.67))), (Some("y"), Some("x")));
    assert_eq!(
        (probe.central(), probe.value_of("z"), probe.value_of("w"), probe.label(2.0)),
        (1.0, Some(3.0), None, None)
    );
    assert_eq!(made(Distribution::boolean(1.0)).central(), 1.0);
}

/// Each label was once compared with all others: 60,000 of them took half a minute, 300,000 a quarter of an hour.
#[test]
fn many_labels_are_parsed_quickly() {
    let labels: Vec<String> = (0..300_000).map(|place| place.to_string()).collect();
    let many = made(Distribution::categorical(&labels, None, None));
    assert_eq!((many.central(), many.value_of("299999")), (0.0, Some(299_999.0)));
    let repeated: Vec<f64> =
        (0..300_000).map(|place| if place == 0 { -0.0 } else { f64::from(place % 299_999) }).collect();
    let error = Distribution::categorical(&labels, Some(&repeated), None).expect_err("a number twice").to_string();
    assert!(error.starts_with("`values[299999]`"), "{error}");
}

#[test]
fn quantiles_outside_the_open_interval_do_not_panic() {
    for distribution in samples() {
        for u in [0.0, 1.0, -1.0, 2.0, f64::NAN, f64::INFINITY, f64::MIN_POSITIVE] {
            let _ = distribution.quantile(u);
        }
        let (low, high) = distribution.support();
        assert_eq!((distribution.quantile(0.0), distribution.quantile(1.0)), (low, high), "{}", distribution.name());
    }
}

#[test]
fn numbers_with_units_are_exact_in_si() {
    let unit = |symbol| Unit::parse(symbol).expect("a unit");
    let si = |distribution: Distribution, symbol| made(distribution.to_si(&unit(symbol)));
    let length = si(made(Distribution::uniform(225.0, 230.3)), "um");
    assert_eq!(length, made(Distribution::uniform(225e-6, 230.3e-6)));
    assert_eq!(si(made(Distribution::constant(225.0)), "um").quantile(0.3), 225e-6);
    assert_eq!(
        si(made(Distribution::discrete(&[0.1, 0.7], Some(&[1.0, 2.0]))), "nm"),
        made(Distribution::discrete(&[0.1e-9, 0.7e-9], Some(&[1.0, 2.0])))
    );
    let too_large = made(Distribution::uniform(0.0, 1e300)).to_si(&unit("GPa"));
    let too_large = too_large.expect_err("beyond doubles").to_string();
    assert_eq!(too_large, "`max` is inf, but must be a finite number");
    for distribution in samples() {
        for symbol in ["um", "GPa", "deg"] {
            let scale = unit(symbol).span_to_si(distribution.sd());
            // Each parameter is rounded once or twice, the logarithm of the factor to its last digit.
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-14 * (b.abs() + scale);
            if !distribution.is_converted_by_value() {
                let converted = si(distribution.clone(), symbol);
                assert!(close(converted.mean(), unit(symbol).to_si(distribution.mean())), "{converted:?}");
                assert!(close(converted.sd(), scale), "{converted:?}");
            }
            let factor = crate::space::Factor::new("x", unit(symbol), distribution.clone()).expect("in doubles");
            for u in [1e-9, 0.3, 0.5, 0.97] {
                let mut values = [0.0];
                factor.fill_si(&[u], &mut values);
                assert!(close(values[0], unit(symbol).to_si(distribution.quantile(u))), "{distribution:?} {u}");
            }
        }
    }
    // Whole numbers are converted one by one.
    let mut values = [0.0; 2];
    let degrees = crate::space::Factor::new("x", unit("degC"), made(Distribution::integer(10.0, 30.0)));
    degrees.expect("in doubles").fill_si(&[1e-9, 0.999], &mut values);
    assert_eq!(values, [283.15, 303.15]);
}

#[test]
fn a_column_has_the_bits_of_its_quantiles() {
    let u: Vec<f64> = (0..257)
        .map(|row| (f64::from(row) + 0.5) / 257.0)
        .chain([Distribution::SMALLEST_U, Distribution::LARGEST_U])
        .collect();
    for distribution in samples() {
        let mut column = vec![f64::NAN; u.len()];
        distribution.fill(&u, &mut column);
        for (value, u) in column.iter().zip(&u) {
            assert_eq!(value.to_bits(), distribution.quantile(*u).to_bits());
        }
    }
}

#[test]
fn distributions_travel_between_threads() {
    fn travels<T: Clone + PartialEq + std::fmt::Debug + Send + Sync + 'static>(_: &T) {}
    samples().iter().for_each(travels);
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![any::<f64>(), -1e3..1e3f64, Just(0.0), Just(1e308), Just(5e-324)]
}

proptest! {
    /// Every accepted distribution has these properties.
    #[test]
    fn accepted_distributions_are_finite(p in prop::array::uniform4(any_number()), list in prop::collection::vec(any_number(), 0..4)) {
        let [a, b, c, d] = p;
        let results = [
            Distribution::uniform(a, b),
            Distribution::log_uniform(a.abs(), b.abs()),
            Distribution::normal(a, b.abs()),
            Distribution::truncated_normal(a, b.abs(), c.min(d), c.max(d)),
            Distribution::log_normal(a.abs(), b.abs()),
            Distribution::log_normal_of_logs(a, b.abs()),
            Distribution::triangular(a.min(b).min(c), a.max(b).min(a.min(b).max(c)), a.max(b).max(c)),
            Distribution::beta(a.abs(), b.abs(), c.min(d), c.max(d)),
            Distribution::weibull(a.abs(), b.abs(), c),
            Distribution::gumbel(a, b.abs()),
            Distribution::truncated_gumbel(a, b.abs(), c.min(d), c.max(d)),
            Distribution::gamma(a.abs(), b.abs(), c),
            Distribution::exponential(a.abs(), b),
            Distribution::poisson(a.abs()),
            Distribution::student_t(a.abs(), b, c.abs()),
            Distribution::logistic(a, b.abs()),
            Distribution::pareto(a.abs(), b.abs()),
            Distribution::histogram(&[a, b, c], &[d.abs(), 1.0]),
            Distribution::gamma(a.abs(), b.abs(), 0.0).and_then(|law| law.truncated(c, d)),
            Distribution::student_t(a.abs(), 0.0, 1.0).and_then(|law| law.truncated(c, d)),
            Distribution::discrete(&list, None),
            Distribution::discrete(&p, Some(&list)),
            Distribution::integer(a.round(), b.round()),
            Distribution::boolean(a),
            Distribution::categorical(&["a", "b", "c", "d"], Some(&p), None),
            Distribution::empirical(&list, None),
        ];
        for distribution in results.into_iter().flatten() {
            let (low, high) = distribution.support();
            for u in [Distribution::SMALLEST_U, 1e-9, 0.5, 1.0 - 1e-9, Distribution::LARGEST_U] {
                let value = distribution.quantile(u);
                prop_assert!(value.is_finite() && (low..=high).contains(&value), "{:?} {}", distribution, u);
            }
            prop_assert!(distribution.mean().is_finite() && distribution.sd().is_finite(), "{:?}", distribution);
            prop_assert!(distribution.sd() >= 0.0, "{:?}", distribution);
        }
    }
}
