//! Shapley effects along random permutations of the factors, against closed forms and through the program.

use ::apportion::estimate::{ShapleyMethod, proper_subsets, shapley_effects};
use ::apportion::{
    AnalysisOptions, BuildError, Distribution, Estimate, Sampler, Study, SurrogateChoice, function_model,
};

use crate::common::{Folder, run_in_parts, study_path, succeed, text};
use crate::dependent::{Linear, cases, correlations, portfolio_costs};
use crate::messages::messages;

fn permutations(sampler: Sampler) -> AnalysisOptions {
    let shapley_method = Some(ShapleyMethod::Permutations);
    AnalysisOptions { shapley_method, surrogate: SurrogateChoice::Off, ..AnalysisOptions::for_sampler(sampler) }
}

fn effects(study: &Study, output: &str) -> Vec<Estimate> {
    let analysis = study.run().unwrap();
    crate::common::effects(analysis.output(output).unwrap()).iter().map(|factor| factor.shapley.unwrap()).collect()
}

/// Ten factors of which some are correlated in a chain and some are not.
fn ten() -> Linear {
    let d = 10;
    let mut r = correlations(d, &[0.0; 45]);
    for (i, j, value) in [(0, 1, 0.7), (1, 2, -0.5), (2, 3, 0.3), (5, 6, 0.9), (5, 8, -0.4), (6, 8, -0.2)] {
        (r[i][j], r[j][i]) = (value, value);
    }
    let b = vec![1.0, -2.0, 0.5, 1.5, 0.0, 1.0, 1.0, -0.3, 2.0, 0.7];
    Linear { b, sd: vec![1.0, 1.0, 3.0, 1.0, 0.5, 2.0, 1.0, 1.0, 0.5, 1.0], r }
}

/// By c(u) of all subsets, without any permutation.
fn exact(case: &Linear) -> Vec<f64> {
    let single: Vec<f64> = case.all().into_iter().map(|i| case.total(&[i])).collect();
    let proper: Vec<f64> = proper_subsets(single.len()).iter().map(|u| case.total(u)).collect();
    shapley_effects(&single, &proper)
}

#[test]
fn linear_outputs_of_normal_factors_have_closed_forms() {
    let independent = [2, 3, 5, 10].map(|d| Linear {
        b: (1..=d).map(|k| k as f64).collect(),
        sd: vec![1.0; d],
        r: correlations(d, &vec![0.0; d * (d - 1) / 2]),
    });
    for case in cases().into_iter().chain([ten()]).chain(independent) {
        let found = effects(&case.study_with(1 << 13, 1, permutations(Sampler::Sobol)), "y");
        for (i, (found, exact)) in found.iter().zip(exact(&case)).enumerate() {
            assert!((found.estimate - exact).abs() < 0.025, "x{}: {found:?}, {exact}", i + 1);
            let interval = found.interval.unwrap();
            assert!(interval.high - interval.low < 0.08, "x{}: {found:?}", i + 1);
        }
        let sum: f64 = found.iter().map(|effect| effect.estimate).sum();
        assert!((sum - 1.0).abs() < 1e-12, "Shapley effects share out all of the variance: {sum}");
    }
    // b^2 sd^2 over their sum where factors are independent: for exactly linear outputs the orders add no error.
    let case = Linear { b: vec![1.0, 2.0, 2.0], sd: vec![1.0; 3], r: correlations(3, &[0.0; 3]) };
    assert!(exact(&case).iter().zip([1.0, 4.0, 4.0]).all(|(found, part)| (found - part / 9.0).abs() < 1e-14));
}

/// The Shapley effects of Ishigami's function are S1 + S13/2, S2 and S13/2 (Owen 2014).
#[test]
fn ishigami_and_the_portfolio_have_their_effects() {
    let pi = std::f64::consts::PI;
    let ishigami = |x: &[f64]| x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin();
    let (s1, s2, s13) = (0.313_905, 0.442_411, 0.243_684);
    for (sampler, offset, tolerance) in [(Sampler::Sobol, 0.0, 0.01), (Sampler::Random, 1e7, 0.02)] {
        let mut builder = Study::builder("ishigami", function_model("y", move |x: &[f64]| ishigami(x) + offset));
        for name in ["x1", "x2", "x3"] {
            builder = builder.factor(name, Distribution::uniform(-pi, pi).unwrap());
        }
        let study = builder.sampler(sampler).base_samples(1 << 14).analysis(permutations(sampler)).build().unwrap();
        assert_eq!(study.design().rows_per_point(), 2 + 3 + 2);
        for (found, exact) in effects(&study, "y").iter().zip([s1 + s13 / 2.0, s2, s13 / 2.0]) {
            assert!((found.estimate - exact).abs() < tolerance, "{sampler:?}: {found:?}, {exact}");
            let interval = found.interval.unwrap();
            assert!(interval.low - 0.01 < exact && exact < interval.high + 0.01, "{sampler:?}: {found:?}, {exact}");
        }
    }
    let asked = ["design.base_samples=65536", "analysis.shapley_method=\"permutations\""].map(str::to_owned);
    let study = apportion_files::load_study(&study_path("portfolio"), &asked).unwrap();
    let (total, proper) = portfolio_costs();
    for (found, exact) in effects(&study, "value").iter().zip(shapley_effects(&total, &proper)) {
        assert!((found.estimate - exact).abs() < 0.015, "{found:?}, {exact}");
    }
}

/// Share of 95 % intervals with the exact value, as for all subsets; more seeds with `SEEDS=200 cargo test --release --test suite --
/// --nocapture intervals_along`.
#[test]
fn intervals_along_permutations_hold_the_truth() {
    let seeds: u64 = std::env::var("SEEDS").map_or(25, |seeds| seeds.parse().unwrap());
    for base_samples in [256, 1024] {
        let (mut held, mut all) = (0, 0);
        for case in cases().into_iter().chain([ten()]) {
            let exact = exact(&case);
            for seed in 0..seeds {
                let found = effects(&case.study_with(base_samples, seed, permutations(Sampler::Sobol)), "y");
                for (found, exact) in found.iter().zip(&exact) {
                    let interval = found.interval.unwrap();
                    held += usize::from(interval.low - 1e-12 <= *exact && *exact <= interval.high + 1e-12);
                    all += 1;
                }
            }
        }
        let share = held as f64 / all as f64;
        println!("N = {base_samples}: {share:.3} of {all}");
        assert!(share > 0.88, "N = {base_samples}: {share:.3}");
    }
}

/// Every interval of random points, and failed runs: a base point without one of its runs is left out of the effects.
#[test]
fn random_points_and_failed_runs_have_their_intervals() {
    use ::apportion::uncertainty::IntervalMethod;
    let linear = |x: &[f64]| if x[0] > 0.98 { f64::NAN } else { x[0] + 2.0 * x[1] + 3.0 * x[2] };
    for intervals in [IntervalMethod::Batches, IntervalMethod::Delta, IntervalMethod::Percentile] {
        let options = AnalysisOptions { intervals, resamples: 200, ..permutations(Sampler::Random) };
        let mut builder = Study::builder("linear", function_model("y", linear));
        for name in ["x1", "x2", "x3"] {
            builder = builder.factor(name, Distribution::uniform(0.0, 1.0).unwrap());
        }
        let study = builder.sampler(Sampler::Random).base_samples(4096).analysis(options).build().unwrap();
        let widths: Vec<f64> = effects(&study, "y")
            .iter()
            .zip([1.0, 4.0, 9.0])
            .map(|(found, part)| {
                let interval = found.interval.unwrap();
                assert!((found.estimate - part / 14.0).abs() < 0.03, "{intervals:?}: {found:?}");
                interval.high - interval.low
            })
            .collect();
        assert!(widths.iter().all(|width| (0.002..0.06).contains(width)), "{intervals:?}: {widths:?}");
    }
}

const TWELVE: &str = "model = \"expression\"\noutputs.y = \"x1 + 2*x2*x3 + x4^2 - x12*x5\"\n[design]\nbase_samples = 512\n\
                      [analysis]\nshapley = true\n";

fn twelve() -> String {
    let factor = |k: usize| format!("[[factor]]\nname = \"x{k}\"\nmin = -1\nmax = 2\n");
    TWELVE.to_owned() + &(1..=12).map(factor).collect::<String>()
}

#[test]
fn shards_journals_threads_and_files_give_the_bits_of_one_run() {
    let folder = Folder::new();
    for (kind, dependence) in
        [("plain", ""), ("tied", "[[dependence]]\nfactors = [\"x1\", \"x2\", \"x5\"]\ncorrelation = 0.4\n")]
    {
        let path = |name: &str| folder.path(&format!("{kind}-{name}"));
        let file = folder.with(&format!("{kind}.toml"), twelve() + dependence);
        let numbers = |out: &str| -> serde_json::Value {
            let json = std::fs::read_to_string(path(out).join(format!("{kind}.json"))).unwrap();
            serde_json::from_str::<serde_json::Value>(&json).unwrap()["outputs"][0].take()
        };
        succeed(&["run", text(&file), "--out", text(&path("one"))]);
        let one = numbers("one");
        assert!(one["indices"][0]["shapley"]["low"].is_number() && one["indices"][6]["shapley"]["estimate"] == 0.0);
        succeed(&["run", text(&file), "--threads", "1", "--out", text(&path("alone"))]);
        assert_eq!(one, numbers("alone"));
        // Continued from a shorter recorded run.
        let longer = ["run", text(&file), "--out", text(&path("grown")), "--base-samples"].map(str::to_owned);
        for samples in ["256", "512"] {
            let words: Vec<&str> = longer.iter().map(String::as_str).chain([samples]).collect();
            succeed(&words);
        }
        assert_eq!(one, numbers("grown"));
        run_in_parts(&file, &path("merged"));
        assert_eq!(one, numbers("merged"));
        let (points, outputs, out) = (path("points.csv"), path("outputs.csv"), path("analysed"));
        succeed(&["sample", text(&file), "-o", text(&points)]);
        succeed(&["evaluate", text(&file), text(&points), "-o", text(&outputs)]);
        succeed(&["analyze", text(&outputs), "--design", text(&points), "--out", text(&out)]);
        assert_eq!(one["indices"], numbers("analysed")["indices"]);
        let manifest = std::fs::read_to_string(path("points.csv.manifest.json")).unwrap();
        assert!(manifest.contains("\"step\": 10") && !manifest.contains("\"step\": 11"), "{manifest}");
    }
}

#[test]
fn the_program_states_the_method_of_shapley_effects() {
    let folder = Folder::new();
    let file = folder.with("twelve.toml", twelve());
    let (out, mut messages) = (folder.path("out"), messages!());
    messages.add_printed("check", &succeed(&["check", text(&file)]));
    messages.add_printed("run", &succeed(&["run", text(&file), "--out", text(&out)]));
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(out.join("twelve.json")).unwrap()).unwrap();
    assert_eq!(json["provenance"]["shapley_method"], "permutations");
    assert_eq!(json["provenance"]["model_runs"], 512 * (2 + 12 + 11));
    let page = std::fs::read_to_string(out.join("twelve.html")).unwrap();
    let again = folder.path("again");
    succeed(&["report", text(&out.join("twelve.json")), "--out", text(&again)]);
    assert_eq!(page, std::fs::read_to_string(again.join("twelve.html")).unwrap());
}

#[test]
fn invalid_settings_are_refused() {
    let folder = Folder::new();
    let file = folder.with("twelve.toml", twelve());
    let mut messages = messages!();
    for change in [
        "analysis.shapley_method=\"subsets\"",
        "analysis.shapley_method=\"orders\"",
        "analysis={shapley=false, shapley_method=\"permutations\"}",
    ] {
        messages.refused(&["check", text(&file), "--set", change]);
    }
    let build = |factors: usize, options: AnalysisOptions| {
        let mut builder = Study::builder("sum", function_model("y", |x: &[f64]| x.iter().sum()));
        for k in 0..factors {
            builder = builder.factor(&format!("x{k}"), Distribution::uniform(0.0, 1.0).unwrap());
        }
        builder.analysis(options).build().map(|_| ())
    };
    let plain = || AnalysisOptions::for_sampler(Sampler::Sobol);
    let asked = |shapley, shapley_method| AnalysisOptions { shapley: Some(shapley), shapley_method, ..plain() };
    assert!(matches!(build(101, asked(true, None)), Err(BuildError::Wrong { key: "shapley", .. })));
    let subsets = Some(ShapleyMethod::Subsets);
    assert!(matches!(build(9, asked(true, subsets)), Err(BuildError::Wrong { key: "shapley_method", .. })));
    assert!(matches!(build(3, asked(false, subsets)), Err(BuildError::Wrong { key: "shapley", .. })));
    assert!(build(9, asked(true, None)).is_ok() && build(101, plain()).is_ok());
}
