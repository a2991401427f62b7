//! Stochastic models: the noise as well as the factors, and the mean over it.

use std::path::Path;
use std::sync::Arc;

use apportion::study::{AnalysisOptions, Study, StudyBuilder, SurrogateChoice};
use apportion::{Distribution, Estimate, RepeatedModel, Sampler, StudyResult, Warning, function_model};
use statrs::distribution::{ContinuousCDF, Normal};

use crate::common::{Folder, apportion, effects, stderr, succeed, text};
use crate::messages::messages;

/// A standard normal number for a seed.
fn normal(seed: f64) -> f64 {
    Normal::standard().inverse_cdf((seed + 0.5) / 2f64.powi(31))
}

/// x1 + x2 + 3 (x1 - 1/2)(x2 - 1) + s x3 e, with x1 and x3 uniform on 0 to 1, x2 on 0 to 2, and e standard normal.
fn noisy(s: f64) -> impl apportion::Model + 'static {
    let mean = |x: &[f64]| x[0] + x[1] + 3.0 * (x[0] - 0.5) * (x[1] - 1.0);
    function_model("y", move |x| mean(x) + s * x[2] * normal(x[3]))
}

fn with_factors(study: StudyBuilder, last: Distribution) -> StudyBuilder {
    let uniform = |max| Distribution::uniform(0.0, max).unwrap();
    study.factor("x1", uniform(1.0)).factor("x2", uniform(2.0)).factor("x3", uniform(1.0)).factor("seed", last)
}

fn options(surrogate: SurrogateChoice) -> AnalysisOptions {
    let subsets = vec![vec![0, 3], vec![1, 3], vec![2, 3]];
    AnalysisOptions { surrogate, subsets, ..AnalysisOptions::for_sampler(Sampler::Sobol) }
}

fn run(s: f64, base_samples: u64, seed: u64, surrogate: SurrogateChoice) -> StudyResult {
    let study = with_factors(Study::builder("noisy", noisy(s)), Distribution::seed());
    let study = study.base_samples(base_samples).seed(seed).analysis(options(surrogate)).build().unwrap();
    study.run().unwrap()
}

/// The indices that are known for s = 1, each with its estimate. The variance is 1/12 + 4/12 + 9 (1/12)(4/12) + 1/3 = 1, of
/// which the noise has 1/4 alone and 1/12 together with x3, and the mean over it 2/3.
fn known(analysis: &StudyResult) -> Vec<(f64, Estimate)> {
    let output = &analysis.outputs[0];
    let noise = output.noise.as_ref().unwrap();
    let first = [1.0 / 12.0, 1.0 / 3.0, 0.0, 0.25];
    let total = [1.0 / 3.0, 7.0 / 12.0, 1.0 / 12.0, 1.0 / 3.0];
    let mut known = vec![(2.0 / 3.0, noise.mean_share)];
    for (factor, (first, total)) in effects(output).into_iter().chain([noise.effect]).zip(first.into_iter().zip(total))
    {
        known.extend([(first, factor.first_order), (total, factor.total)]);
    }
    for (of, (first, total)) in noise.of_mean.iter().zip([(0.125, 0.5), (0.5, 0.875), (0.0, 0.0)]) {
        known.extend([(first, of.effect.first_order.unwrap()), (total, of.effect.total.unwrap())]);
    }
    known
}

#[test]
fn the_indices_of_a_run_and_of_the_mean_are_those_of_the_formula() {
    for surrogate in [SurrogateChoice::Off, SurrogateChoice::On] {
        for (exact, found) in known(&run(1.0, 16384, 1, surrogate)) {
            // The noise is a random number in each row: errors are those of some 2^14 random points.
            assert!((found.estimate - exact).abs() < 0.03, "{surrogate:?} {exact}: {found:?}");
        }
    }
}

#[test]
fn the_intervals_hold() {
    for (surrogate, seeds) in [(SurrogateChoice::Off, 100), (SurrogateChoice::Auto, 12)] {
        let (mut held, mut all, mut of_mean, mut all_of_mean) = (0, 0, 0, 0);
        for seed in 0..seeds {
            for (place, (exact, found)) in known(&run(1.0, 256, seed, surrogate)).into_iter().enumerate() {
                let interval = found.interval.unwrap();
                let holds = usize::from(interval.low <= exact && exact <= interval.high);
                if place == 0 || place > 8 {
                    (of_mean, all_of_mean) = (of_mean + holds, all_of_mean + 1);
                } else {
                    (held, all) = (held + holds, all + 1);
                }
            }
        }
        let (held, of_mean) = (held as f64 / all as f64, of_mean as f64 / all_of_mean as f64);
        println!("{surrogate:?}: {held:.3} of the indices of a run, {of_mean:.3} of those of the mean");
        assert!((0.92..=0.99).contains(&held) && (0.92..=0.99).contains(&of_mean), "{surrogate:?} {held} {of_mean}");
    }
}

/// Without noise the seed has no effect, and all else is that of a study with an inert factor instead.
#[test]
fn without_noise_all_is_as_without_it() {
    let of = |last: Distribution| {
        let study = with_factors(Study::builder("noisy", noisy(0.0)), last).base_samples(512);
        study.analysis(options(SurrogateChoice::Off)).build().unwrap().run().unwrap()
    };
    let (silent, without) = (of(Distribution::seed()), of(Distribution::uniform(0.0, 1.0).unwrap()));
    let [silent, without] = [&silent, &without].map(|analysis| analysis.outputs[0].clone());
    assert!(silent.warnings.iter().any(|warning| matches!(warning, Warning::NoNoise { .. })), "{:?}", silent.warnings);
    let [factors, of_others] = [&silent, &without].map(effects);
    for (a, b) in factors.iter().zip(&of_others) {
        assert_eq!((a.first_order, a.total, a.share_total), (b.first_order, b.total, b.share_total));
    }
    let noise = silent.noise.unwrap();
    let of_noise = &noise.effect;
    for index in [of_noise.first_order, of_noise.total] {
        // Rule of three: fewer than 3 in 512 base points, times half of R^2/V.
        let interval = index.interval.unwrap();
        assert!(index.estimate == 0.0 && interval.low == 0.0 && (0.0..0.2).contains(&interval.high), "{interval:?}");
    }
    assert_eq!((of_noise.share_total, of_noise.probability_first), (None, None));
    // The mean over it is the output itself.
    assert_eq!(noise.mean_share.estimate, 1.0);
    for (of_mean, factor) in noise.of_mean.iter().zip(&factors) {
        let first = of_mean.effect.first_order.unwrap();
        // The index of the mean may be missed on both sides alike, that of a run above.
        assert_eq!(first.estimate, factor.first_order.estimate);
        assert_eq!(first.interval.unwrap().high, factor.first_order.interval.unwrap().high);
        assert!((of_mean.effect.total.unwrap().estimate - factor.total.estimate).abs() < 1e-12);
    }
    assert_eq!(noise.of_mean.len(), 3);
}

/// Rows that differ in a factor share the seed: if there is only noise, factors have no effect in any row.
#[test]
fn rows_of_a_factor_share_the_noise_of_their_point() {
    let model = function_model("y", |x| normal(x[3]));
    let study = with_factors(Study::builder("all", model), Distribution::seed()).base_samples(256);
    let analysis = study.analysis(options(SurrogateChoice::Off)).build().unwrap().run().unwrap();
    let output = &analysis.outputs[0];
    assert!(effects(output).iter().all(|factor| factor.total.estimate == 0.0), "{:?}", output.indices);
    assert!((output.noise.as_ref().unwrap().effect.total.estimate - 1.0).abs() < 0.1);
    assert!(output.warnings.iter().any(|warning| matches!(warning, Warning::AllNoise { .. })), "{:?}", output.warnings);
}

/// The variance over the noise is x3^2: of its estimate by 8 runs, (1/5)(9/7) - 1/9 is the variance, of which the variance
/// itself has 4/45, all by x3.
#[test]
fn mean_and_variance_over_repetitions_have_their_indices() {
    let model = RepeatedModel::new(Arc::new(noisy(1.0)), 3, 8);
    let study = with_factors(Study::builder("repeated", model), Distribution::seed()).base_samples(8192);
    let analysis = study.analysis(options(SurrogateChoice::Off)).build().unwrap().run().unwrap();
    let of_mean = |name: &str| analysis.output(name).unwrap().noise.clone().unwrap();
    let of_variance = of_mean("y_variance");
    let all = 0.2 * 9.0 / 7.0 - 1.0 / 9.0;
    assert!((of_variance.mean_share.estimate - 4.0 / 45.0 / all).abs() < 0.05, "{:?}", of_variance.mean_share);
    for (found, exact) in of_variance.of_mean.iter().zip([0.0, 0.0, 1.0]) {
        let found = [found.effect.first_order, found.effect.total].map(|index| index.unwrap().estimate);
        assert!(found.iter().all(|index| (index - exact).abs() < 0.08), "{found:?} {exact}");
    }
    // The mean of 8 runs still has an eighth of the noise, and its mean the same indices as that of one run.
    let of_means = of_mean("y_mean");
    assert!((of_means.mean_share.estimate - 16.0 / 17.0).abs() < 0.02, "{:?}", of_means.mean_share);
    for (found, exact) in of_means.of_mean.iter().zip([0.5, 0.875, 0.0]) {
        assert!((found.effect.total.unwrap().estimate - exact).abs() < 0.03, "{found:?}");
    }
}

const FORMULA: &str =
    "model = \"expression\"\nnoise = \"seed\"\noutputs.y = \"x + sin(seed)\"\n[design]\nbase_samples = 256\n";

fn parsed(text: &str) -> Result<Study, apportion_files::StudyError> {
    apportion_files::parse_study(text, Path::new("noise.toml"), &[])
}

#[test]
fn noise_can_be_written_in_three_equivalent_forms() {
    let short = parsed(&format!("{FORMULA}[factors.x]\nmin = 0\nmax = 1")).unwrap();
    let long = FORMULA.replace("noise = \"seed\"\n", "")
        + "[noise]\nname = \"seed\"\n[[factor]]\nname = \"x\"\nmin = 0\nmax = 1";
    let long = parsed(&long).unwrap();
    let as_factor = FORMULA.replace("noise = \"seed\"\n", "")
        + "[[factor]]\nname = \"x\"\nmin = 0\nmax = 1\n[[factor]]\nname = \"seed\"\ndistribution = \"seed\"";
    let as_factor = parsed(&as_factor).unwrap();
    assert_eq!(short.identity(), long.identity());
    assert_eq!(short.identity(), as_factor.identity());
    assert_eq!(short.space().noise(), Some(1));
    // The noise is not one of the factors of a result.
    let result = short.run().unwrap();
    let output = &result.outputs[0];
    assert_eq!((result.factors.len(), output.indices.as_ref().unwrap().len()), (1, 1));
    assert_eq!(output.noise.as_ref().unwrap().name, "seed");
}

#[test]
fn senseless_input_is_refused() {
    let x = "[factors.x]\nmin = 0\nmax = 1\n";
    let mut messages = messages!();
    for text in [
        format!("{FORMULA}{x}[factors.other]\ndistribution = \"seed\""),
        format!("{FORMULA}{x}[factors.seed]\nmin = 0\nmax = 1"),
        FORMULA.to_owned(),
        format!("{}{x}[noise]\nrepetitions = 0", FORMULA.replace("noise = \"seed\"\n", "")),
        format!("{}{x}[noise]\nrepeats = 2", FORMULA.replace("noise = \"seed\"\n", "")),
        format!("{}{x}", FORMULA.replace("\"seed\"", "3")),
        format!("{FORMULA}{x}[factors.s]\ndistribution = \"seed\"\ntruncate = [0, 5]"),
        format!("{FORMULA}{x}[factors.s]\ndistribution = \"seed\"\nunit = \"um\""),
        format!("{FORMULA}{x}[factors.s]\ndistribution = \"seed\"\nmin = 0"),
        "model = \"external\"\noutputs = [\"y\"]\n[noise]\nrepetitions = 4\n".to_owned() + x,
        "model = \"ishigami\"\nnoise = \"seed\"\n".to_owned() + &x.replace(".x]", ".x1]"),
    ] {
        messages.add(&text, &parsed(&text).map(|_| ()).unwrap_err().to_string());
    }
}

/// A program that is random, with a seed or without.
fn program(folder: &Folder, draws: &str) -> std::path::PathBuf {
    let source = format!(
        "import csv, random, sys\nfor row in csv.DictReader(sys.stdin):\n    x = float(row['x'])\n    {draws}\n    \
         print(row['id'], y, sep=',', flush=True)\n"
    );
    folder.with("model.py", source);
    let study = "model = \"command\"\noutputs = [\"y\"]\nnoise = \"seed\"\n[command]\nprogram = [\"python3\", \"model.py\"]\n\
                 [design]\nbase_samples = 64\n[factors.x]\nmin = 0\nmax = 1\n";
    folder.with("study.toml", study)
}

#[test]
fn check_finds_programs_that_draw_without_their_seed() {
    let folder = Folder::new();
    let seeded = program(&folder, "y = x + random.Random(int(row['seed'])).gauss(0, 1)");
    let mut messages = messages!();
    messages.add_printed("with its seed", &succeed(&["check", text(&seeded)]));
    let unseeded = program(&folder, "y = x + random.gauss(0, 1)");
    messages.add_printed("without its seed", &succeed(&["check", text(&unseeded)]));
    let plain = std::fs::read_to_string(&unseeded).unwrap().replace("noise = \"seed\"\n", "");
    let plain = folder.with("plain.toml", plain);
    messages.add_printed("no seed", &succeed(&["check", text(&plain)]));
}

#[test]
fn a_run_distinguishes_random_programs_from_programs_with_state() {
    let folder = Folder::new();
    // The last one draws from one seed at its start.
    let mut messages = messages!();
    for (draws, is_random) in [
        ("y = x", false),
        ("y = x + random.random()", true),
        ("n = globals().get('n') or random.Random(1); y = x + n.random()", true),
    ] {
        let study = program(&folder, draws);
        let study = folder.with("s.toml", std::fs::read_to_string(study).unwrap().replace("noise = \"seed\"\n", ""));
        let out = folder.path("out");
        succeed(&["run", text(&study), "--restart", "--charts", "none", "--out", text(&out)]);
        let result = apportion::result::read_result(&out.join("s.json")).unwrap();
        let warnings =
            result.outputs[0].warnings.iter().filter(|warning| matches!(warning, Warning::Irreproducible { .. }));
        let warnings: Vec<String> = warnings.map(ToString::to_string).collect();
        assert_eq!(warnings.len(), usize::from(is_random), "{draws}: {warnings:?}");
        messages.add(draws, &warnings.concat());
    }
}

/// The seed is a part of the row: a journal gives the same result, and so does a table filled by another program.
#[test]
fn the_example_says_which_question_each_number_answers() {
    let folder = Folder::new();
    for name in ["stochastic.toml", "model.py"] {
        let path = crate::common::root().join("studies/stochastic").join(name);
        folder.with(name, std::fs::read(path).unwrap());
    }
    let study = folder.path("stochastic.toml");
    let runs = ["--set", "design.base_samples=64"];
    let out = |name: &str| folder.path(name).to_str().unwrap().to_owned();
    let printed = succeed(&["run", text(&study), runs[0], runs[1], "--out", &out("one")]);
    messages!().add_printed("run", &printed);
    let result = |name: &str| {
        let path = folder.path(name).join("stochastic.json");
        let text = std::fs::read(&path).unwrap();
        apportion::result::parse_result(&text).unwrap().outputs.remove(0)
    };
    let one = result("one");
    let noise = one.noise.as_ref().unwrap();
    assert_eq!((noise.name.as_str(), noise.of_mean.len()), ("seed", 3));
    assert!(noise.effect.total.estimate > 0.1 && noise.of_mean.iter().all(|of_mean| of_mean.effect.total.is_some()));
    let csv = std::fs::read_to_string(folder.path("one").join("stochastic.csv")).unwrap();
    assert!(csv.lines().any(|line| line.starts_with("wait,noise,seed,")), "{csv}");
    // Sampled, evaluated and analysed in separate steps.
    let (design, answers) = (out("design.csv"), out("answers.csv"));
    succeed(&["sample", text(&study), runs[0], runs[1], "-o", &design]);
    let first = std::fs::read_to_string(&design).unwrap();
    assert!(first.lines().nth(1).unwrap().rsplit(',').next().unwrap().parse::<u32>().is_ok(), "{first:.200}");
    succeed(&["evaluate", text(&study), &design, runs[0], runs[1], "-o", &answers]);
    let output = apportion(&["analyze", &answers, "--design", &design, "--out", &out("two")]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let estimates = |output: &apportion::OutputResult| -> Vec<f64> {
        let of_mean = output.noise.iter().flat_map(|noise| &noise.of_mean);
        of_mean.flat_map(|of| [of.effect.first_order.unwrap().estimate, of.effect.total.unwrap().estimate]).collect()
    };
    // Minutes are rounded on their way through the file, and the choice of terms may be another one.
    let (one, two) = (estimates(&one), estimates(&result("two")));
    assert!(one.len() == 6 && one.iter().zip(&two).all(|(a, b)| (a - b).abs() < 1e-9), "{one:?} {two:?}");
}

/// The noise has a line among the indices over all outputs together: it is not a factor, and the total indices of all sum to 1 with it.
#[test]
fn indices_over_all_outputs_have_a_line_of_the_noise() {
    let folder = Folder::new();
    let study = "model = \"expression\"\nnoise = \"seed\"\n[outputs]\ny = \"x + sin(seed)\"\nz = \"2*x\"\n[design]\n\
                 base_samples = 1024\n[analysis]\naggregate = true\n[[factor]]\nname = \"x\"\nmin = 0\nmax = 1\n";
    let file = folder.with("noisy.toml", study);
    let out = folder.path("out");
    let told = succeed(&["run", text(&file), "--out", text(&out)]);
    let together = told.split("All outputs together").nth(1).unwrap();
    assert!(together.contains("noise (seed)"), "{told}");
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(out.join("noisy.json")).unwrap()).unwrap();
    let aggregate = &json["aggregate"];
    let total = |record: &serde_json::Value| record["total"]["estimate"].as_f64().unwrap();
    assert!(
        aggregate["noise"]["factor"] == "seed" && aggregate["indices"].as_array().unwrap().len() == 1,
        "{aggregate}"
    );
    assert!((total(&aggregate["indices"][0]) + total(&aggregate["noise"]) - 1.0).abs() < 0.05, "{aggregate}");
    let lines = std::fs::read_to_string(out.join("noisy.csv")).unwrap();
    assert!(lines.contains("aggregate,seed,") && lines.contains("aggregate,x,"), "{lines}");
}
