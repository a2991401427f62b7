//! Every function with known indices through the whole program.

use std::path::Path;

use apportion::model::{Basis, KnownAnswer};
use apportion::result::{OutputResult, StudyResult};

use crate::common::numbers;

fn analysed(text: &str, overrides: &[String]) -> StudyResult {
    let study = apportion_files::parse_study(text, Path::new("known.toml"), overrides)
        .unwrap_or_else(|error| panic!("{error}"));
    study.run().unwrap()
}

const SEEDS: u64 = 32;

/// Mean, variance, first-order and total indices from a study of one function, one list per seed.
fn estimates(name: &str, base_samples: u64) -> Vec<Vec<f64>> {
    let of_seed = |seed| {
        let design = [format!("base_samples={base_samples}"), "replicates=1".to_owned(), format!("seed={seed}")];
        let result = analysed(&format!("model = \"{name}\""), &design.map(|setting| format!("design.{setting}")));
        let output = &result.outputs[0];
        let (first, total) = numbers(output);
        [vec![output.mean.unwrap(), output.variance.unwrap()], first, total].concat()
    };
    (0..SEEDS).map(of_seed).collect()
}

/// Mean and standard deviation over the seeds.
fn spread(column: &[f64]) -> (f64, f64) {
    let mean = column.iter().sum::<f64>() / column.len() as f64;
    let squares: f64 = column.iter().map(|x| (x - mean) * (x - mean)).sum();
    (mean, (squares / (column.len() - 1) as f64).sqrt())
}

#[test]
fn every_function_has_its_indices() {
    let (mut single_estimates, mut far) = (0, 0);
    for answer in KnownAnswer::all() {
        let exact = answer.default_function().exact();
        let indices = exact.indices.unwrap();
        let expected = [vec![exact.mean, exact.variance], indices.first_order, indices.total].concat();
        let known_to = match exact.basis {
            Basis::ClosedForm => 1e-12,
            Basis::Quadrature { error } => error,
        };
        let mut spreads = Vec::new();
        for base_samples in [128, 1024] {
            let all = estimates(answer.name, base_samples);
            for (place, &expected) in expected.iter().enumerate() {
                let column: Vec<f64> = all.iter().map(|estimates| estimates[place]).collect();
                let (mean, sd) = spread(&column);
                spreads.push(sd);
                // Rounding errors, where there is no randomness: inert inputs have the index 0 in every sample.
                let rounding = known_to * expected.abs().max(1.0);
                let gap = |x: f64| ((x - expected).abs() - rounding).max(0.0);
                let what = || format!("{answer:?}, N = {base_samples}, {place}: {mean} +- {sd}, not {expected}");
                // No bias. Of 600 such means one beyond 4 standard errors (of 31 degrees of freedom) is likely, beyond 5
                // is not.
                assert!(gap(mean) <= 5.0 * sd / (SEEDS as f64).sqrt(), "{}", what());
                single_estimates += column.len();
                far += column.iter().filter(|&&x| gap(x) > 4.0 * sd).count();
                assert!(column.iter().all(|&x| gap(x) <= 6.0 * sd), "{}", what());
            }
        }
        // Eight times the points: N^-1/2 would leave 0.35 of the error. The mean of the ratios' logarithms over all
        // quantities that vary is known to some 5 %.
        let (coarse, fine) = spreads.split_at(expected.len());
        let ratios =
            coarse.iter().zip(fine).filter(|(coarse, _)| **coarse > 1e-12).map(|(coarse, fine)| (fine / coarse).ln());
        let (sum, count) = ratios.fold((0.0, 0), |(sum, count), ratio| (sum + ratio, count + 1));
        let ratio = (sum / f64::from(count)).exp();
        assert!(ratio < 0.45, "{answer:?}: the error falls to {ratio} only");
    }
    // Measured at 512 and 4096 base samples: 25 of 18,000 single estimates are beyond 4 true standard errors, since some
    // assignments of columns to dimensions are less even than others; 50 are allowed.
    assert!(far <= 50 && single_estimates > 15_000, "{far} of {single_estimates}");
}

/// The only output of a result.
fn only(result: &StudyResult) -> &OutputResult {
    assert_eq!(result.outputs.len(), 1);
    &result.outputs[0]
}

#[test]
fn a_constant_output_has_a_reason_instead_of_indices() {
    let result = analysed("model = \"linear\"\n[function]\nc = 0\ndimension = 3\n", &[]);
    let output = only(&result);
    assert_eq!((output.mean, output.variance), (Some(0.0), Some(0.0)));
    assert!(output.indices.is_none() && output.reason.is_some());
}

#[test]
fn factors_have_their_own_distributions_and_other_inputs_are_fixed() {
    let some =
        analysed("model = \"flood\"\n[[factor]]\nname = \"Hd\"\n[[factor]]\nname = \"Q\"\ngroup = \"river\"\n", &[]);
    let names: Vec<_> = some.factors.iter().map(|factor| (&*factor.name, &*factor.distribution.name)).collect();
    assert_eq!(names, [("Hd", "uniform"), ("Q", "truncated-gumbel")]);
    let mixed = "model = \"sobol-g\"\n[function]\na = [0, 1, 2]\n[[factor]]\nname = \"x3\"\nmin = 0.25\nmax = 0.5\n[[factor]]\nname = \"x1\"";
    let study = apportion_files::parse_study(mixed, Path::new("mixed.toml"), &[]).unwrap();
    assert_eq!(study.constants(), [("x2".to_owned(), 0.75, "1".to_owned())]);
    assert_eq!(study.space().factors()[0].distribution().support(), (0.25, 0.5));
    let overridden =
        apportion_files::parse_study("model = \"linear\"", Path::new("l.toml"), &["function.c=[1, 2, 3]".to_owned()]);
    assert_eq!(overridden.unwrap().space().factors().len(), 3);
}

#[test]
fn a_thousand_factors() {
    let text =
        "model = \"linear\"\n[function]\nc = 1\ndimension = 1000\n[design]\nbase_samples = 256\nreplicates = 1\n";
    let result = analysed(text, &[]);
    let (_, total) = numbers(only(&result));
    assert_eq!(total.len(), 1000);
    // 3 % for the variance of 256 points. Where A_j and B_j are correlated by r, the total index comes out as 1 - r of what
    // it is: with 2000 dimensions and 256 points that are some 20 factors, by up to 0.75 (tests of the sequence).
    let close = total.iter().filter(|st| (**st - 1e-3).abs() < 1e-4).count();
    assert!(close > 950, "{close}");
    assert!(total.iter().all(|st| (0.2e-3..1.8e-3).contains(st)));
    assert!((total.iter().sum::<f64>() - 1.0).abs() < 0.05);
}

/// The answer of Sobol' G is that of factors from 0 to 1.
#[test]
fn exact_indices_hold_for_the_ranges_of_the_function() {
    let notes = |range: &str| {
        let text = format!("model = 'sobol-g'\n[factors]\nx1 = {{ {range} }}\nx2 = {{}}\n");
        let study = apportion_files::parse_study(&text, Path::new("g.toml"), &[]).unwrap();
        study.notes().to_vec()
    };
    assert!(notes("").is_empty() && notes("min = 0.25, max = 1").is_empty());
    for range in ["min = -1, max = 1", "distribution = 'normal', mean = 0.5, sd = 0.1"] {
        assert!(notes(range)[0].contains("exact indices"), "{range}");
    }
}
