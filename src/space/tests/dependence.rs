use std::f64::consts::PI;

use super::*;
use apportion_base::quantity::Unit;

fn space(laws: Vec<Distribution>) -> Space {
    let names = ["a", "b", "c", "d"];
    let factor = |(law, name): (Distribution, &str)| Factor::new(name, Unit::dimensionless(), law).unwrap();
    Space::new(laws.into_iter().zip(names).map(factor).collect())
}

fn uniform() -> Distribution {
    Distribution::uniform(-1.0, 3.0).unwrap()
}

fn scores(space: &Space, dependence: Dependence) -> f64 {
    let copula = copula(space, &[dependence]).unwrap().unwrap();
    copula.rows()[0][1]
}

#[test]
fn measures_become_those_of_normal_scores() {
    let normals = space(vec![Distribution::normal(1.0, 2.0).unwrap(); 2]);
    let pair = |r: f64| Dependence::pair("a", "b", r);
    for r in [-0.95, -0.3, 0.0, 0.5, 0.99] {
        assert_eq!(scores(&normals, pair(r)), r);
        assert_eq!(scores(&normals, pair(r).measure(CorrelationMeasure::Normal)), r);
        let spearman = scores(&normals, pair(r).measure(CorrelationMeasure::Spearman));
        assert!((6.0 / PI * libm::asin(spearman / 2.0) - r).abs() < 1e-15);
        let kendall = scores(&normals, pair(r).measure(CorrelationMeasure::Kendall));
        assert!((2.0 / PI * libm::asin(kendall) - r).abs() < 1e-14);
        // Of uniform factors Pearson's correlation is Spearman's.
        let uniforms = space(vec![uniform(), uniform()]);
        assert!((scores(&uniforms, pair(r)) - spearman).abs() < 2e-6, "{r}");
    }
}

/// Of two log-normal factors (Liu and Der Kiureghian 1986, table 6, case of two log-normal variables): rho = (exp(r s1 s2) - 1)
/// / sqrt((exp(s1^2) - 1)(exp(s2^2) - 1)).
#[test]
fn pearson_correlations_of_log_normal_factors_have_a_closed_form() {
    let (s1, s2) = (0.4f64, 0.9f64);
    let laws = [s1, s2].map(|s| Distribution::log_normal_of_logs(0.3, s).unwrap()).to_vec();
    let space = space(laws);
    let size = (libm::expm1(s1 * s1) * libm::expm1(s2 * s2)).sqrt();
    for r in [-0.8, -0.2, 0.1, 0.7, 0.95] {
        let stated = libm::expm1(r * s1 * s2) / size;
        assert!((scores(&space, Dependence::pair("a", "b", stated)) - r).abs() < 1e-7, "{r}");
    }
    let error = copula(&space, &[Dependence::pair("a", "b", -0.9)]).unwrap_err();
    let [low, high] = [-s1, s1].map(|s1| libm::expm1(s1 * s2) / size);
    assert!(error.to_string().ends_with(&format!("{low:.4} to {high:.4}")), "{error}");
}

#[test]
fn equal_pairs_share_an_integral_and_others_do_not() {
    let exponential = Distribution::exponential(2.0, 0.0).unwrap();
    let space = space(vec![exponential.clone(), exponential.clone(), exponential, uniform()]);
    let stated = [[1.0, 0.3, 0.3, 0.3], [0.3, 1.0, 0.2, 0.3], [0.3, 0.2, 1.0, 0.3], [0.3, 0.3, 0.3, 1.0]];
    let names = ["a", "b", "c", "d"];
    let together = copula(&space, &[Dependence::new(&names, stated.map(Vec::from).to_vec())]).unwrap().unwrap();
    for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
        let pair = Dependence::pair(names[i], names[j], stated[i][j]);
        let alone = copula(&space, &[pair]).unwrap().unwrap().rows()[i][j];
        assert_eq!(together.rows()[i][j], alone, "{i} and {j}");
    }
}

#[test]
fn discrete_factors_have_pearson_correlations_too() {
    let laws = vec![Distribution::integer(0.0, 9.0).unwrap(), Distribution::exponential(2.0, 0.0).unwrap()];
    let space = space(laws);
    let r = scores(&space, Dependence::pair("a", "b", 0.5));
    assert!((0.5..0.7).contains(&r), "{r}");
}

#[test]
fn invalid_settings_are_refused_with_advice() {
    let space = space(vec![uniform(), uniform(), uniform(), Distribution::constant(1.0).unwrap()]);
    let pair = |a: &str, b: &str| Dependence::pair(a, b, 0.5);
    let messages = [
        &[pair("a", "x")][..],
        &[pair("a", "a")],
        &[pair("a", "b"), pair("b", "a")],
        &[pair("a", "d")],
        &[Dependence::pair("a", "b", 1.0)],
        &[Dependence::pair("a", "b", f64::NAN)],
        &[Dependence::new(&["a", "b"], vec![vec![1.0]])],
        &[Dependence::new(&["a", "b"], vec![vec![1.0, 0.5], vec![0.4, 1.0]])],
        &[Dependence::pair("a", "b", 0.9), Dependence::pair("b", "c", 0.9), Dependence::pair("a", "c", -0.9)],
    ]
    .map(|dependences| copula(&space, dependences).unwrap_err().to_string());
    insta::assert_snapshot!(messages.join("\n"));
    // The proposal is accepted.
    let nearest = messages[8].split("], are ").nth(1).unwrap();
    let nearest: Vec<Vec<f64>> = serde_json::from_str(nearest).unwrap();
    let proposed = Dependence::new(&["a", "b", "c"], nearest).measure(CorrelationMeasure::Normal);
    assert!(copula(&space, &[proposed]).is_ok());
}

#[test]
fn useless_joint_measurements_are_refused_by_name() {
    let space = space(vec![uniform(), uniform(), Distribution::discrete(&[1.0], None).unwrap()]);
    let rising: Vec<f64> = (0..20).map(f64::from).collect();
    let columns = |other: fn(f64) -> f64| vec![rising.clone(), rising.iter().map(|x| other(*x)).collect()];
    let error = |other| copula(&space, &[Dependence::from_measurements(&["a", "b"], &columns(other))]).unwrap_err();
    let mut errors = vec![error(|_| 3.0), error(|x| x * x), error(|x| -x)];
    for measure in CorrelationMeasure::ALL {
        errors.push(copula(&space, &[Dependence::pair("a", "c", 0.5).measure(measure)]).unwrap_err());
    }
    insta::assert_snapshot!(errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"));
}

#[test]
fn joint_measurements_give_the_correlation_of_their_scores() {
    let space = space(vec![uniform(), uniform()]);
    let copula = GaussianCopula::new(DMatrix::from_row_slice(2, 2, &[1.0, -0.7, -0.7, 1.0])).unwrap();
    let points = crate::design::SobolSequence::scrambled(2, 3, 0);
    let mut columns = vec![vec![0.0; 4096]; 2];
    columns.iter_mut().enumerate().for_each(|(j, column)| points.fill(j, 0, column));
    copula.correlate(&mut columns);
    // For any distributions.
    columns[0].iter_mut().for_each(|x| *x = x.powi(5));
    columns[1].iter_mut().for_each(|x| *x = libm::exp(3.0 * *x));
    let measured = Dependence::from_measurements(&["a", "b"], &columns);
    assert!((scores(&space, measured) + 0.7).abs() < 2e-3);
}
