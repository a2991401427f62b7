//! Quantile functions against frozen references, independent distribution functions, symmetries and
//! numerical integration. `tests/oracle/distributions.py` made the references.

use apportion::space::distribution::{Distribution, DistributionError};
use proptest::prelude::*;
use serde_json::Value;
use statrs::function::beta::beta_reg;

fn made(result: Result<Distribution, DistributionError>) -> Distribution {
    result.unwrap_or_else(|error| panic!("{error}"))
}

fn from_json(case: &Value) -> Distribution {
    let p = |name: &str| case["parameters"][name].as_f64().unwrap_or(f64::NAN);
    let whole = made(match case["distribution"].as_str().expect("a name") {
        "uniform" => Distribution::uniform(p("min"), p("max")),
        "log-uniform" => Distribution::log_uniform(p("min"), p("max")),
        "normal" => Distribution::normal(p("mean"), p("sd")),
        "truncated-normal" => Distribution::truncated_normal(p("mean"), p("sd"), p("min"), p("max")),
        "log-normal" if p("mean").is_nan() => Distribution::log_normal_of_logs(p("log_mean"), p("log_sd")),
        "log-normal" => Distribution::log_normal(p("mean"), p("sd")),
        "triangular" => Distribution::triangular(p("min"), p("mode"), p("max")),
        "pert" => Distribution::pert(p("min"), p("mode"), p("max")),
        "beta" => Distribution::beta(p("alpha"), p("beta"), p("min"), p("max")),
        "weibull" => Distribution::weibull(p("shape"), p("scale"), p("location")),
        "gumbel" => Distribution::gumbel(p("location"), p("scale")),
        "truncated-gumbel" => Distribution::truncated_gumbel(p("location"), p("scale"), p("min"), p("max")),
        "gamma" => Distribution::gamma(p("shape"), p("scale"), p("location")),
        "exponential" => Distribution::exponential(p("scale"), p("location")),
        "poisson" => Distribution::poisson(p("mean")),
        "binomial" => Distribution::binomial(p("n"), p("p")),
        "negative-binomial" => Distribution::negative_binomial(p("n"), p("p")),
        "geometric" => Distribution::geometric(p("p")),
        // With 1 degree of freedom there is no variance without truncation.
        "student-t" if p("df") == 1.0 => return truncated_cauchy(case),
        "student-t" => Distribution::student_t(p("df"), p("location"), p("scale")),
        "logistic" => Distribution::logistic(p("location"), p("scale")),
        "pareto" if p("shape") <= 2.0 => return truncated_pareto(case),
        "pareto" => Distribution::pareto(p("shape"), p("min")),
        "histogram" => {
            let [edges, weights] = ["edges", "weights"].map(|key| numbers(&case["parameters"][key]));
            Distribution::histogram(&edges, &weights)
        }
        other => panic!("{other}"),
    });
    match &case["parameters"]["truncate"] {
        Value::Null => whole,
        bounds => {
            let [min, max] = [0, 1].map(|place| match &bounds[place] {
                Value::String(text) => text.parse().expect("infinite"),
                number => number.as_f64().expect("a number"),
            });
            made(whole.truncated(min, max))
        }
    }
}

/// Families without a variance are truncated only in study files.
fn by_study(keys: &str) -> Distribution {
    let text = format!("model = 'expression'\n[outputs]\ny = 'x'\n[factors.x]\n{keys}");
    let study = apportion_files::parse_study(&text, std::path::Path::new("s.toml"), &[]);
    study.unwrap_or_else(|error| panic!("{error}")).space().factors()[0].distribution().clone()
}

fn truncated_cauchy(case: &Value) -> Distribution {
    let truncate = &case["parameters"]["truncate"];
    by_study(&format!("distribution = 'student-t'\ndf = 1\nlocation = 0\nscale = 1\ntruncate = {truncate}"))
}

fn truncated_pareto(case: &Value) -> Distribution {
    let p = &case["parameters"];
    let max = &p["truncate"][1];
    by_study(&format!("distribution = 'pareto'\nshape = {}\nmin = {}\ntruncate = [-inf, {max}]", p["shape"], p["min"]))
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().expect("a list").iter().map(|number| number.as_f64().expect("a number")).collect()
}

#[test]
fn quantiles_and_moments_are_those_of_scipy_and_mpmath() {
    let cases: Value = serde_json::from_str(include_str!("../../oracle/distributions.json")).expect("json");
    let cases = cases.as_array().expect("a list");
    assert!(cases.len() > 50, "{}", cases.len());
    for case in cases {
        let distribution = from_json(case);
        let expected_sd = case["sd"].as_f64().expect("a number");
        for (u, expected) in numbers(&case["u"]).into_iter().zip(numbers(&case["quantile"])) {
            let value = distribution.quantile(u);
            // A few ulp; far out in the tail of a beta of tiny shape a few hundred, and near 0 those of the sd and of the mean,
            // from which it is measured.
            let from_mean = 5e-16 * case["mean"].as_f64().expect("a number").abs();
            let tolerance = 2e-13 * expected.abs() + 2e-15 * expected_sd + from_mean;
            assert!((value - expected).abs() <= tolerance, "{distribution:?} at {u:e}: {value:e}, not {expected:e}");
        }
        let mean = case["mean"].as_f64().expect("a number");
        // A few ulp.
        assert!((distribution.mean() - mean).abs() <= 2e-15 * mean.abs() + 2e-14 * expected_sd, "{distribution:?}");
        // By quadrature of values that are rounded, where they are far from 0 and close together.
        let rounding =
            if case["parameters"]["truncate"].is_null() { 0.0 } else { f64::EPSILON * mean.abs() / expected_sd };
        let error = (distribution.sd() / expected_sd - 1.0).abs();
        assert!(error < 5e-15 + rounding, "{distribution:?} {} {error:e}", distribution.sd());
    }
}

/// Every family of study files has a reference.
#[test]
fn every_family_has_its_reference() {
    let schema: Value = serde_json::from_str(&crate::common::succeed(&["schema", "study"])).expect("json");
    let names = &schema["definitions"]["FactorSection"]["properties"]["distribution"]["enum"];
    let names: Vec<&str> = names.as_array().expect("names").iter().filter_map(Value::as_str).collect();
    assert!(names.len() >= 24, "{names:?}");
    let [families, kinds] =
        [include_str!("../../oracle/distributions.json"), include_str!("../../oracle/factor_kinds.json")];
    for name in names {
        let case = format!("{{\"distribution\": \"{name}\", \"parameters\"");
        // The seeds of a stochastic model cannot be compared.
        assert!(name == "seed" || families.contains(&case) || kinds.contains(&case), "{name}");
    }
}

/// P(X <= x) and P(X > x), each in a form that keeps its digits where it is small.
type Tails = fn(f64) -> (f64, f64);

fn normal_tails(z: f64) -> (f64, f64) {
    (0.5 * libm::erfc(-z / 2f64.sqrt()), 0.5 * libm::erfc(z / 2f64.sqrt()))
}

#[test]
fn distribution_function_of_quantile_is_the_probability() {
    let cases: [(Result<Distribution, _>, Tails); 17] = [
        (Distribution::uniform(0.0, 1.0), |x| (x, 1.0 - x)),
        (Distribution::log_uniform(1.0, 1e6), |x| (x.log10() / 6.0, 1.0 - x.log10() / 6.0)),
        (Distribution::normal(0.0, 2.0), |x| normal_tails(x / 2.0)),
        (Distribution::log_normal_of_logs(1.0, 0.5), |x| normal_tails((x.ln() - 1.0) / 0.5)),
        (Distribution::truncated_normal(0.0, 1.0, 8.0, 9.0), |x| {
            let above = |x| normal_tails(x).1;
            let mass = above(8.0) - above(9.0);
            ((above(8.0) - above(x)) / mass, (above(x) - above(9.0)) / mass)
        }),
        (Distribution::truncated_normal(1.0, 2.0, -3.0, 2.0), |x| {
            let erf = |x: f64| 0.5 * libm::erf((x - 1.0) / 8f64.sqrt());
            let mass = erf(2.0) - erf(-3.0);
            ((erf(x) - erf(-3.0)) / mass, (erf(2.0) - erf(x)) / mass)
        }),
        (Distribution::triangular(0.0, 1.0, 4.0), |x| {
            let below = if x < 1.0 { x * x / 4.0 } else { 1.0 - (4.0 - x) * (4.0 - x) / 12.0 };
            (below, if x < 1.0 { 1.0 - below } else { (4.0 - x) * (4.0 - x) / 12.0 })
        }),
        (Distribution::weibull(1.7, 3.0, 0.0), |x| {
            let hazard = (x / 3.0).powf(1.7);
            (-(-hazard).exp_m1(), (-hazard).exp())
        }),
        (Distribution::gumbel(0.0, 1.0), |x| ((-(-x).exp()).exp(), -(-(-x).exp()).exp_m1())),
        // An Erlang distribution, and Student's t of 4 degrees of freedom, by their closed forms.
        (Distribution::gamma(3.0, 2.0, 0.0), |x| {
            let z = x / 2.0;
            let above = (-z).exp() * (1.0 + z + 0.5 * z * z);
            // The series of the difference, without cancellation.
            let term = |n: i32| (0..n).fold((-z).exp(), |term, k| term * z / f64::from(k + 1));
            (if z < 2.0 { (3..60).map(term).sum() } else { 1.0 - above }, above)
        }),
        (Distribution::pareto(2.5, 3.0), |x| {
            let log = -2.5 * (x / 3.0).ln();
            (-log.exp_m1(), log.exp())
        }),
        (Distribution::logistic(1.0, 2.0), |x| {
            let z = (x - 1.0) / 2.0;
            (1.0 / (1.0 + (-z).exp()), 1.0 / (1.0 + z.exp()))
        }),
        (Distribution::beta(2.0, 5.0, 0.0, 1.0), |x| (beta_reg(2.0, 5.0, x), beta_reg(5.0, 2.0, 1.0 - x))),
        (Distribution::beta(0.5, 0.8, 0.0, 1.0), |x| (beta_reg(0.5, 0.8, x), beta_reg(0.8, 0.5, 1.0 - x))),
        (Distribution::beta(30.0, 7.0, 0.0, 1.0), |x| (beta_reg(30.0, 7.0, x), beta_reg(7.0, 30.0, 1.0 - x))),
        // The arcsine distribution and a power, by their closed forms.
        (Distribution::beta(0.5, 0.5, 0.0, 1.0), |x| {
            let angle = x.sqrt().asin() * std::f64::consts::FRAC_2_PI;
            (angle, 1.0 - angle)
        }),
        (Distribution::beta(0.2, 1.0, 0.0, 1.0), |x| (x.powf(0.2), 1.0 - x.powf(0.2))),
    ];
    let u = (1..200).map(|step| f64::from(step) / 200.0).chain([
        Distribution::SMALLEST_U,
        1e-15,
        1e-6,
        1.0 - 1e-6,
        1.0 - 1e-9,
    ]);
    let u: Vec<f64> = u.collect();
    for (distribution, tails) in cases {
        let distribution = made(distribution);
        for &u in &u {
            // The true quantile lies within a few ulp of the value, according to the distribution function (accurate to
            // 1e-12 by beta_reg): both tails are looked at, each keeps the digits of its own side.
            let value = distribution.quantile(u);
            let slack = 4.0 * f64::EPSILON * (value.abs() + 0.1 * distribution.sd());
            let (low, high) = distribution.support();
            let (below, above) = tails((value - slack).max(low));
            let (below_more, above_less) = tails((value + slack).min(high));
            let accuracy = 1e-12;
            assert!(below * (1.0 - accuracy) <= u, "{distribution:?} at {u:e}: {value:e}, {below:e}");
            assert!(below_more * (1.0 + accuracy) >= u, "{distribution:?} at {u:e}: {value:e}, {below_more:e}");
            assert!(above * (1.0 + accuracy) >= 1.0 - u, "{distribution:?} at {u:e}: {value:e}, {above:e}");
            assert!(above_less * (1.0 - accuracy) <= 1.0 - u, "{distribution:?} at {u:e}: {value:e}, {above_less:e}");
        }
    }
}

#[test]
fn symmetric_distributions_are_symmetric() {
    // Dyadic, so that 1 - u is exact.
    for u in (1..=50).map(|power| 0.5f64.powi(power)).chain((1..32).map(|step| f64::from(step) / 64.0)) {
        let normal = made(Distribution::normal(0.0, 3.0));
        assert_eq!(normal.quantile(u), -normal.quantile(1.0 - u));
        let triangular = made(Distribution::triangular(-2.0, 0.0, 2.0));
        assert_eq!(triangular.quantile(u), -triangular.quantile(1.0 - u));
        let pairs = [
            (Distribution::truncated_normal(0.0, 1.0, 8.0, 9.0), Distribution::truncated_normal(0.0, 1.0, -9.0, -8.0)),
            (Distribution::truncated_normal(0.5, 1.0, -1.0, 3.0), Distribution::truncated_normal(-0.5, 1.0, -3.0, 1.0)),
            (Distribution::beta(0.3, 4.0, -1.0, 1.0), Distribution::beta(4.0, 0.3, -1.0, 1.0)),
            (Distribution::beta(700.0, 900.0, -1.0, 1.0), Distribution::beta(900.0, 700.0, -1.0, 1.0)),
        ];
        for (one, other) in pairs {
            let (value, mirrored) = (made(one).quantile(u), -made(other).quantile(1.0 - u));
            // The branches may meet on different sides, and differ by the last bits there.
            assert!((value - mirrored).abs() <= 4.0 * f64::EPSILON, "{value:e} {mirrored:e} at {u:e}");
        }
    }
}

/// The integral of `function` over (0, 1) by the tanh-sinh rule (Takahasi and Mori 1974), which endures
/// singularities at the ends.
fn integral(function: impl Fn(f64) -> f64) -> f64 {
    let step = 1.0 / 64.0;
    let term = |index: i32| {
        let t = step * f64::from(index);
        let ratio = (-std::f64::consts::PI * t.sinh()).exp();
        let u = 1.0 / (1.0 + ratio);
        if !(Distribution::SMALLEST_U..=Distribution::LARGEST_U).contains(&u) {
            return 0.0;
        }
        step * std::f64::consts::PI * t.cosh() * u * ratio / (1.0 + ratio) * function(u)
    };
    (-240..=240).map(term).sum()
}

#[test]
fn moments_are_those_of_the_quantile_function() {
    let all = [
        Distribution::uniform(-1.0, 3.0),
        Distribution::log_uniform(1e-3, 10.0),
        Distribution::log_uniform(1.0, 1.5),
        Distribution::normal(1.0, 2.0),
        Distribution::truncated_normal(0.0, 1.0, 8.0, 9.0),
        Distribution::truncated_normal(0.0, 1.0, -1.0, 4.0),
        Distribution::truncated_normal(5.0, 0.1, -4.0, 4.9),
        Distribution::log_normal(3.0, 1.0),
        Distribution::log_normal_of_logs(-2.0, 0.7),
        // A mode inside would be a kink in the integrand.
        Distribution::triangular(0.0, 0.0, 1.0),
        Distribution::triangular(-1.0, 3.0, 3.0),
        Distribution::beta(2.0, 3.0, -1.0, 4.0),
        Distribution::beta(0.5, 0.3, 0.0, 1.0),
        Distribution::beta(400.0, 3.0, 0.0, 1.0),
        Distribution::weibull(0.8, 2.0, 1.0),
        Distribution::weibull(2.5, 2.0, -7.0),
        Distribution::weibull(30.0, 2.0, 0.0),
        Distribution::gumbel(2.0, 0.5),
        Distribution::gamma(0.3, 2.0, 0.0),
        Distribution::gamma(40.0, 2.0, -3.0),
        Distribution::exponential(2.0, 1.0),
        Distribution::logistic(2.0, 0.5),
        Distribution::student_t(30.0, 2.0, 0.5),
        made(Distribution::gamma(2.0, 1.0, 0.0)).truncated(1.0, f64::INFINITY),
        made(Distribution::logistic(0.0, 1.0)).truncated(f64::NEG_INFINITY, 0.5),
    ];
    for distribution in all.map(made) {
        let (mean, sd) = (distribution.mean(), distribution.sd());
        let deviation = integral(|u| distribution.quantile(u) - mean);
        let variance = integral(|u| (distribution.quantile(u) - mean).powi(2));
        // Values beyond 1 - 2^-53 are left out: a share of 1e-16, some 40 (log-normal: 300) sd away.
        assert!(deviation.abs() <= 1e-13 * (mean.abs() + sd), "{distribution:?} {deviation:e}");
        assert!(
            (variance / (sd * sd) - 1.0).abs() <= if distribution.name() == "log-normal" { 2e-11 } else { 1e-12 },
            "{distribution:?} {variance} {}",
            sd * sd
        );
    }
}

#[test]
fn log_uniform_moments_hold_from_narrow_to_widest() {
    // By 60 digits: (max - min) / ln(max / min) and the root of (max^2 - min^2) / (2 ln(max / min)) - mean^2.
    for (min, max, mean, sd) in LOG_UNIFORM_MOMENTS {
        let distribution = made(Distribution::log_uniform(min, max));
        // A few ulp, more where the exponential of +-700 amplifies the rounding of its argument.
        assert!((distribution.mean() / mean - 1.0).abs() < 2e-13, "{min} {max} {}", distribution.mean());
        assert!((distribution.sd() / sd - 1.0).abs() < 2e-13, "{min} {max} {}", distribution.sd());
        assert!((distribution.quantile(Distribution::SMALLEST_U) / min - 1.0).abs() < 2e-13, "{min} {max}");
        assert!((distribution.quantile(Distribution::LARGEST_U) / max - 1.0).abs() < 2e-13, "{min} {max}");
    }
}

const LOG_UNIFORM_MOMENTS: [(f64, f64, f64, f64); 6] = [
    (1.0, 1.0000001, 1.0000000499999993, 2.886751347633608e-08),
    (1.0, 1.01, 1.0049917080713053, 0.002886748964164374),
    (1.0, 3.0, 1.8204784532536749, 0.5716774507941147),
    (1.0, 7.5, 3.2259617131601077, 1.8175555854376395),
    (1e-09, 1000000000.0, 24127471.216847323, 107152231.61980279),
    (1e-300, 1e+300, 7.238241365054197e+296, 1.9010211647220607e+298),
];

/// A distribution of each continuous family over wide ranges of its parameters.
fn any_distribution() -> impl Strategy<Value = Distribution> {
    let family = 0usize..23;
    let decades = |low: f64, high: f64| (low..high).prop_map(|decade: f64| 10f64.powf(decade));
    (family, -1e3..1e3f64, decades(-3.0, 3.0), decades(-2.0, 4.0), 0.0..1.0f64).prop_filter_map(
        "accepted",
        |(family, location, scale, shape, part)| {
            let (min, max) = (location, location + scale);
            let mode = min + part * (max - min);
            match family {
                0 => Distribution::uniform(min, max),
                1 => Distribution::log_uniform(scale, scale * (1.0 + shape)),
                2 => Distribution::normal(location, scale),
                3 => Distribution::truncated_normal(location + 30.0 * (part - 0.5) * scale, scale, min, max),
                4 => Distribution::log_normal(scale, shape),
                5 => Distribution::log_normal_of_logs(location / 10.0, part + 1e-9),
                6 => Distribution::triangular(min, mode.clamp(min, max), max),
                7 => Distribution::beta(shape, scale * 10.0, min, max),
                8 => Distribution::weibull(shape + 0.02, scale, location),
                9 => Distribution::truncated_gumbel(location + 10.0 * (part - 0.5) * scale, scale, min, max),
                10 => Distribution::gamma(shape, scale, location),
                11 => Distribution::exponential(scale, location),
                12 => Distribution::poisson(shape),
                20 => Distribution::binomial(shape.ceil(), part),
                21 => Distribution::negative_binomial(shape, part),
                22 => Distribution::geometric(part),
                13 => Distribution::student_t(2.0 + shape, location, scale),
                14 => Distribution::logistic(location, scale),
                15 => Distribution::pareto(2.0 + shape, scale),
                16 => Distribution::histogram(&[min, mode, max], &[shape, part]),
                17 => Distribution::gamma(shape, scale, location).and_then(|whole| whole.truncated(mode, max)),
                18 => {
                    Distribution::student_t(2.5, location, scale).and_then(|whole| whole.truncated(mode, f64::INFINITY))
                }
                _ => Distribution::gumbel(location, scale),
            }
            .ok()
        },
    )
}

/// The whole range of `u`, in particular its ends.
fn any_u() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => Distribution::SMALLEST_U..=Distribution::LARGEST_U,
        2 => (-64.0..-1.0f64).prop_map(f64::exp2),
        2 => (-53.0..-1.0f64).prop_map(|power| 1.0 - power.exp2()),
        1 => Just(Distribution::SMALLEST_U),
        1 => Just(0.5f64.powi(33)),
        1 => Just(Distribution::LARGEST_U),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn quantiles_never_fall_nor_leave_the_support(distribution in any_distribution(), u in any_u(), v in any_u()) {
        let (low, high) = distribution.support();
        let exact = matches!(distribution.name(), "uniform" | "triangular");
        for (u, v) in [(u.min(v), u.max(v)), (u, u.next_up().min(Distribution::LARGEST_U))] {
            let (before, after) = (distribution.quantile(u), distribution.quantile(v));
            prop_assert!(before.is_finite() && (low..=high).contains(&before), "{:?} {}", distribution, u);
            // Where rounding decides, a few ulp of the value and of the location that is added, and what a solved F resolves.
            let place = |x: f64| if x.is_finite() { x.abs() } else { 0.0 };
            let slack = 2e-13 * [before, distribution.median(), low, high].map(place).iter().sum::<f64>();
            let least = if exact { before } else { distribution.quantile(u * (1.0 - 1e-12)) - slack };
            prop_assert!(after >= least, "{:?}: {:e} -> {:e}, {:e} -> {:e}", distribution, u, before, v, after);
        }
    }

    #[test]
    fn discrete_quantiles_never_fall(
        pairs in prop::collection::vec((-5.0..5.0f64, 0.0..2.0f64), 1..20),
        u in any_u(),
        v in any_u(),
    ) {
        let (values, weights): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
        for weights in [None, Some(weights.as_slice())] {
            let discrete = made(Distribution::discrete(&values, weights));
            let (before, after) = (discrete.quantile(u.min(v)), discrete.quantile(u.max(v)));
            prop_assert!(before <= after && values.contains(&before));
        }
    }
}
