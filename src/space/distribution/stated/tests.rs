use super::*;

fn made(law: Law, stated: &[(Statistic, f64)]) -> Distribution {
    Distribution::stated(law, stated).unwrap_or_else(|error| panic!("{law:?} {stated:?}: {error}"))
}

#[track_caller]
fn close(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value:e}, not {expected:e}");
}

#[test]
fn closed_forms_are_met() {
    use Statistic::{LogSd, Max, Mean, Min, Mode, P05, P95, Scale, Sd};
    // The 95 % quantile of the standard normal distribution, from tables.
    let z = 1.644_853_626_951_472_7;
    let normal = made(Law::Normal, &[(P05, 10.0 - 2.0 * z), (P95, 10.0 + 2.0 * z)]);
    close(normal.mean(), 10.0, 1e-14);
    close(normal.sd(), 2.0, 1e-14);
    let uniform = made(Law::Uniform, &[(Mean, 1.0), (Sd, 3f64.sqrt().recip())]);
    close(uniform.support().0, 0.0, 1e-15);
    close(uniform.support().1, 2.0, 1e-15);
    let uniform = made(Law::Uniform, &[(Min, 0.1), (P95, 2.0)]);
    assert_eq!(uniform.support().0, 0.1);
    let log_normal = made(Law::LogNormal, &[(P05, 1.0), (P95, 4.0)]);
    close(log_normal.median(), 2.0, 1e-13);
    close(log_normal.quantile(0.95), 4.0, 1e-12);
    let mode = made(Law::LogNormal, &[(Mode, libm::exp(1.0f64 - 0.25)), (LogSd, 0.5)]);
    close(mode.median(), libm::exp(1f64), 1e-13);
    // A triangle of mean 2 on [1, 4] has its mode at 3 * 2 - 1 - 4.
    let triangle = made(Law::Triangular, &[(Min, 1.0), (Max, 4.0), (Mean, 2.0)]);
    assert_eq!(triangle.support(), (1.0, 4.0));
    close(triangle.mean(), 2.0, 1e-12);
    // Exponential: standard deviation and mean are one.
    let weibull = made(Law::Weibull, &[(Mean, 3.0), (Sd, 3.0)]);
    close(weibull.median(), 3.0 * libm::log(2f64), 1e-11);
    let gumbel = made(Law::Gumbel, &[(Mode, 5.0), (Scale, 2.0)]);
    assert_eq!(gumbel, Distribution::gumbel(5.0, 2.0).expect("a Gumbel distribution"));
}

/// One of each family, its statistics, and by how many it is determined.
fn samples() -> Vec<(Law, Distribution, Vec<Statement>, usize)> {
    use Statistic::{Df, Location, LogMean, LogSd, Max, Mean, Min, Mode, P05, P50, P90, Scale, Sd, Shape};
    let sample = |law, made: Result<Distribution, DistributionError>, parameters: &[Statement], count| {
        let made = made.unwrap_or_else(|error| panic!("{error}"));
        let mut statements = parameters.to_vec();
        for statistic in [P05, P50, P90] {
            statements.push((statistic, made.quantile(statistic.probability().expect("a quantile"))));
        }
        statements.extend([(Mean, made.mean()), (Sd, made.sd())]);
        (law, made, statements, count)
    };
    vec![
        sample(Law::Uniform, Distribution::uniform(-1.0, 2.5), &[(Min, -1.0), (Max, 2.5)], 2),
        sample(Law::LogUniform, Distribution::log_uniform(0.5, 40.0), &[(Min, 0.5), (Max, 40.0)], 2),
        sample(Law::Normal, Distribution::normal(1e6, 0.5), &[], 2),
        sample(
            Law::LogNormal,
            Distribution::log_normal_of_logs(1.0, 0.25),
            &[(LogMean, 1.0), (LogSd, 0.25), (Mode, libm::exp(1.0f64 - 0.0625))],
            2,
        ),
        sample(Law::Gumbel, Distribution::gumbel(1.0, 2.0), &[(Location, 1.0), (Scale, 2.0)], 2),
        sample(Law::Weibull, Distribution::weibull(1.7, 2.0, 0.0), &[(Shape, 1.7), (Scale, 2.0)], 2),
        sample(Law::Weibull, Distribution::weibull(1.7, 2.0, 3.0), &[(Shape, 1.7), (Location, 3.0)], 3),
        sample(Law::Gamma, Distribution::gamma(2.5, 2.0, 0.0), &[(Shape, 2.5), (Scale, 2.0), (Mode, 3.0)], 2),
        sample(Law::Gamma, Distribution::gamma(2.5, 2.0, -3.0), &[(Shape, 2.5), (Location, -3.0)], 3),
        sample(Law::Exponential, Distribution::exponential(2.0, 0.0), &[(Scale, 2.0)], 1),
        sample(Law::Exponential, Distribution::exponential(2.0, 1.0), &[(Scale, 2.0), (Location, 1.0)], 2),
        sample(Law::Logistic, Distribution::logistic(1.0, 2.0), &[(Location, 1.0), (Scale, 2.0)], 2),
        sample(Law::StudentT, Distribution::student_t(5.0, 1.0, 2.0), &[(Df, 5.0), (Location, 1.0), (Scale, 2.0)], 3),
        sample(Law::Pareto, Distribution::pareto(3.5, 2.0), &[(Shape, 3.5), (Min, 2.0)], 2),
        sample(
            Law::InverseGaussian,
            Distribution::inverse_gaussian(2.0, 6.0),
            &[(Scale, 6.0), (Mode, 2.0 / (1.25f64.sqrt() + 0.5))],
            2,
        ),
        sample(Law::Triangular, Distribution::triangular(1.0, 2.0, 4.0), &[(Min, 1.0), (Mode, 2.0), (Max, 4.0)], 3),
    ]
}

/// All choices of `count` of the statements.
fn choices(statements: &[Statement], count: usize) -> Vec<Vec<Statement>> {
    let all = (0u32..1 << statements.len()).filter(|set| set.count_ones() as usize == count);
    all.map(|set| statements.iter().enumerate().filter(|(i, _)| set >> i & 1 == 1).map(|(_, s)| *s).collect()).collect()
}

#[test]
fn every_determination_leads_back() {
    let mut tried = 0;
    for (law, distribution, statements, count) in samples() {
        for stated in choices(&statements, count).iter().filter(|stated| law.is_enough(stated)) {
            let names: Vec<&str> = stated.iter().map(|(statistic, _)| statistic.name()).collect();
            let found = match Distribution::stated(law, stated) {
                Ok(found) => found,
                // What says the same of these families twice.
                Err(DistributionError::NoSuchDistribution { .. })
                    if [
                        ["mean", "p50"],
                        ["scale", "sd"],
                        ["log_mean", "p50"],
                        ["location", "p50"],
                        ["location", "mean"],
                    ]
                    .iter()
                    .any(|same| same.iter().all(|name| names.contains(name))) =>
                {
                    continue;
                }
                Err(error) => panic!("{names:?}: {error}"),
            };
            tried += 1;
            // Where two distributions fit, the narrowest is found.
            assert!(found.sd() <= distribution.sd() * (1.0 + 1e-6), "{names:?}: {found:?}");
            // Two of one standard deviation, such as log-uniform ones of one largest value, differ in the mean.
            let is_same = |a: f64, b: f64| (a - b).abs() <= 1e-6 * distribution.sd();
            // Two of these families may even have one mean, one standard deviation and one quantile.
            let is_other = matches!(law, Law::StudentT | Law::Gamma)
                && !is_same(found.quantile(0.25), distribution.quantile(0.25));
            if is_same(found.sd(), distribution.sd()) && is_same(found.mean(), distribution.mean()) && !is_other {
                for u in [0.02, 0.3, 0.8, 0.99] {
                    // Quantiles that are close together say little of a tail: 1e-9 sd there is 1e-6 here.
                    close(found.quantile(u), distribution.quantile(u), 1e-6 * distribution.sd());
                }
            }
        }
    }
    assert!(tried > 200, "{tried}");
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    use Statistic::{Max, Mean, Min, Mode, P05, P50, P95, Sd, Shape};
    let cases: [(Law, &[Statement], &str); 10] = [
        (Law::Normal, &[(P05, 3.0), (P95, 3.0)], "`p05` is 3 and `p95` is 3, but `p05` must be below `p95`"),
        (Law::Normal, &[(P05, 3.0)], "a normal distribution is determined by two of mean, sd"),
        (Law::Normal, &[(P05, 3.0), (P95, 4.0), (Mean, 3.5)], "p99, but 3 of these are given"),
        (Law::Normal, &[(Mean, 3.0), (P50, 4.0)], "there is no normal distribution, or more than one, with mean = 3"),
        (Law::Normal, &[(P05, 3.0), (P05, 4.0)], "`p05` is stated twice"),
        (Law::Uniform, &[(Mode, 3.0), (P95, 4.0)], "a uniform distribution cannot be given by `mode`"),
        (Law::LogNormal, &[(P05, -3.0), (P95, 4.0)], "`p05` is -3.0, but must be greater than 0"),
        (Law::Weibull, &[(Mean, 1.0), (Shape, -1.0)], "`shape` is -1.0, but must be greater than 0"),
        (Law::Triangular, &[(Min, 0.0), (Max, 1.0), (Mean, 0.9)], "no triangular distribution"),
        (Law::Gumbel, &[(Mean, f64::NAN), (Sd, 1.0)], "`mean` is NaN, but must be a finite number"),
    ];
    for (law, stated, expected) in cases {
        let message = Distribution::stated(law, stated).expect_err("must be refused").to_string();
        assert!(message.contains(expected), "no {expected:?} in {message:?}");
    }
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(64))]
    /// Two quantiles in order determine every family of two parameters, and are those found. Weibull distributions are sought
    /// up to a shape of 1e4, where these quantiles are 3.1e-4 apart.
    #[test]
    fn quantiles_come_back(low in 1e-3..1e3f64, ratio in 4e-4..3.0f64) {
        let high = low * (1.0 + ratio);
        for law in [Law::Uniform, Law::Normal, Law::LogNormal, Law::Gumbel, Law::Weibull] {
            let found = made(law, &[(Statistic::P10, low), (Statistic::P90, high)]);
            close(found.quantile(0.1), low, 1e-9 * (high - low));
            close(found.quantile(0.9), high, 1e-9 * (high - low));
        }
    }

    #[test]
    fn nothing_panics(law in 0..Law::ALL.len(), picks in proptest::collection::vec((0..Statistic::ALL.len(), -1e3..1e3f64), 0..5)) {
        let stated: Vec<Statement> = picks.into_iter().map(|(place, value)| (Statistic::ALL[place], value)).collect();
        let _ = Distribution::stated(Law::ALL[law], &stated);
    }
}
