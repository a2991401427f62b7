//! Studies built in code.

use std::path::Path;

use apportion::design::{DesignError, Sampler};
use apportion::estimate::Estimator;
use apportion::model::{FunctionModel, Output, function_model};
use apportion::result::parse_result;
use apportion::space::{Distribution, Factor};
use apportion::study::{AnalysisOptions, BuildError, Study, StudyBuilder, Target};
use apportion::uncertainty::IntervalMethod;
use apportion::{Resume, RunError, Shard};
use apportion_base::quantity::Unit;

fn unit() -> Distribution {
    Distribution::uniform(0.0, 1.0).unwrap()
}

fn sum() -> StudyBuilder {
    Study::builder("sum", function_model("y", |x| x.iter().sum()))
}

/// The same function, points and options, once in code and once by its name in a file: the same bits.
#[test]
fn a_built_study_gives_the_bits_of_the_file() {
    let angle = || Distribution::uniform(-std::f64::consts::PI, std::f64::consts::PI).unwrap();
    let known = apportion::model::KnownAnswer::from_name("ishigami").unwrap().default_function();
    let study = Study::builder("ishigami", function_model("y", move |x| known.value(x)));
    let study = ["x1", "x2", "x3"].into_iter().fold(study, |study, name| study.factor(name, angle()));
    let study = study.base_samples(1024).seed(3).build().unwrap();
    let built = study.runner().threads(2).run().unwrap();
    let path = std::path::Path::new("ishigami.toml");
    let typed =
        apportion_files::parse_study("model = \"ishigami\"\n[design]\nbase_samples = 1024\nseed = 3", path, &[])
            .unwrap();
    let typed = typed.runner().threads(1).run().unwrap();
    assert_eq!(built.outputs[0].indices, typed.outputs[0].indices);
    assert_eq!((built.study.model.as_str(), built.provenance.study_sha256.len()), ("custom", 64));
    // Its files can be read like any result.
    let json = built.json();
    assert_eq!(parse_result(json.as_bytes()).unwrap(), built);
}

#[test]
fn factors_reach_the_function_in_si_and_in_order() {
    let model =
        FunctionModel::new(vec![Output::new("way", Unit::parse("um").unwrap(), "")], |x: &[f64], y: &mut [f64]| {
            assert_eq!(x.len(), 2);
            assert!((2e-6..=4e-6).contains(&x[0]) && (0.0..=1.0).contains(&x[1]), "{x:?}");
            y[0] = x[0];
            Ok(())
        });
    let um = Unit::parse("um").unwrap();
    let mut share = Factor::new("share", Unit::dimensionless(), unit()).unwrap();
    share.group = Some("rest".to_owned());
    let study =
        Study::builder("units", model).title("Units").factor_in("a", um, Distribution::uniform(2.0, 4.0).unwrap());
    let study = study.with_factor(share).base_samples(256).build().unwrap();
    let result = study.runner().threads(1).run().unwrap();
    let output = &result.outputs[0];
    // Evenly spread points: the mean of 256 has an error of 1e-3 of the range.
    assert!((output.mean.unwrap() - 3.0).abs() < 2e-3 && output.unit == "um");
    assert_eq!(output.groups.as_ref().unwrap()[0].factors, ["share"]);
}

#[test]
fn rows_that_the_function_leaves_out_fail() {
    let outputs = || ["set", "unset"].map(|name| Output::new(name, Unit::dimensionless(), "")).to_vec();
    let model = FunctionModel::new(outputs(), |x: &[f64], y: &mut [f64]| {
        y[0] = x[0];
        Ok(())
    });
    let study = Study::builder("half", model).factor("x", unit()).base_samples(64).build().unwrap();
    let result = study.runner().threads(1).run().unwrap();
    assert_eq!((result.outputs[0].runs_failed, result.outputs[1].runs_ok), (0, 0));
    assert_eq!(result.outputs[1].failures[0].runs, result.outputs[1].runs_failed);
}

#[test]
fn options_ask_for_more() {
    let options = AnalysisOptions {
        second_order: true,
        estimators: vec![Estimator::Default],
        subsets: vec![vec![1, 0, 1]],
        ..AnalysisOptions::for_sampler(Sampler::Sobol)
    };
    let study = sum().factor("a", unit()).factor("b", unit()).base_samples(256).analysis(options).build().unwrap();
    let output = &study.runner().threads(1).run().unwrap().outputs[0];
    assert_eq!(output.second_order.as_ref().unwrap().len(), 1);
    assert_eq!(output.subsets.as_ref().unwrap()[0].factors, ["a", "b"]);
    assert!(output.estimators.is_empty());
}

#[test]
fn a_number_of_runs_makes_the_design_of_the_file() {
    let study = sum().factor("a", unit()).factor("b", unit()).runs(100).build().unwrap();
    let text = "model = \"expression\"\noutputs.y = \"a + b\"\n[design]\nruns = 100\n\
        [[factor]]\nname = \"a\"\nmin = 0\nmax = 1\n[[factor]]\nname = \"b\"\nmin = 0\nmax = 1\n";
    let file = apportion_files::parse_study(text, Path::new("mine.toml"), &[]).unwrap();
    assert_eq!(study.design(), file.design());
    assert!(study.design().is_plain() && study.design().rows() == 96);
}

#[test]
fn errors_of_the_builder_state_the_reason() {
    let two = || sum().factor("a", unit()).factor("b", unit());
    let error = |builder: StudyBuilder| builder.build().unwrap_err();
    assert_eq!(error(sum()), BuildError::Design(DesignError::NoFactors));
    assert!(matches!(error(two().factor("a", unit())), BuildError::Repeated { name, .. } if name == "a"));
    let too_few = DesignError::TooFewSamples { base_samples: 2, replicates: 4 };
    assert_eq!(error(two().base_samples(2)), BuildError::Design(too_few));
    assert_eq!(error(two().replicates(0)), BuildError::Design(DesignError::NoReplicates));
    let key = |builder: StudyBuilder| match builder.build() {
        Err(BuildError::Wrong { key, .. }) => key,
        other => panic!("{other:?}"),
    };
    assert_eq!(key(two().runs(23)), "runs");
    assert_eq!(key(two().runs(100).base_samples(16)), "base_samples");
    assert_eq!(key(two().runs(100).until(Target::accuracy(0.1))), "runs");
    assert_eq!(key(two().runs(100).until(Target::default().max_time(1.0))), "max_time");
    assert_eq!(key(two().until(Target::accuracy(f64::NAN))), "accuracy");
    assert_eq!(key(two().until(Target::accuracy(0.1)).sampler(Sampler::LatinHypercube)), "sampler");
    assert_eq!(key(Study::builder("a/b", function_model("y", |x| x[0])).factor("x", unit())), "name");
    let none = FunctionModel::new(Vec::new(), |_: &[f64], _: &mut [f64]| Ok(()));
    assert_eq!(key(Study::builder("none", none).factor("x", unit())), "outputs");
    let with = |change: fn(&mut AnalysisOptions)| {
        let mut options = AnalysisOptions::for_sampler(Sampler::Sobol);
        change(&mut options);
        key(two().analysis(options))
    };
    assert_eq!(with(|o| o.intervals = IntervalMethod::Percentile), "intervals");
    assert_eq!(with(|o| o.resamples = 0), "resamples");
    assert_eq!(with(|o| o.subsets = vec![vec![2]]), "subsets");
    assert_eq!(with(|o| o.subsets = vec![vec![]]), "subsets");
    assert_eq!(with(|o| o.threshold = f64::NAN), "threshold");
    let changed = |change: fn(&mut Factor)| {
        let mut factor = Factor::new("c", Unit::dimensionless(), unit()).unwrap();
        change(&mut factor);
        two().with_factor(factor)
    };
    assert_eq!(key(changed(|factor| factor.nominal = f64::NAN)), "nominal");
    let group = error(changed(|factor| factor.group = Some("x\ny".to_owned())));
    assert!(matches!(group, BuildError::Name { what: "group", .. }), "{group:?}");
}

#[test]
fn options_that_need_a_journal_or_a_size_are_refused_without_one() {
    let study = sum().factor("a", unit()).factor("b", unit()).base_samples(64).build().unwrap();
    let shard = || "1/2".parse::<Shard>().unwrap();
    let none = |error: RunError| matches!(error, RunError::NoJournal { .. });
    assert!(none(study.runner().run_shard(shard()).unwrap_err()));
    assert!(none(study.runner().merge(&[]).unwrap_err()));
    assert!(none(study.runner().recorded_runs().unwrap_err()));
    assert!(none(study.runner().resume(Resume::Require).run().unwrap_err()));
    assert!(matches!(study.runner().threads(100_000).run(), Err(RunError::Threads { threads: 100_000, .. })));
    let growing = sum().factor("a", unit()).until(Target::accuracy(0.1)).build().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("j");
    assert!(matches!(growing.runner().journal(&journal).run_shard(shard()), Err(RunError::NoSize)));
}

#[test]
fn pilot_runs_of_many_factors_take_little_memory() {
    let factors = 2000;
    let study = (0..factors).fold(sum(), |study, k| study.factor(&format!("x{k}"), unit()));
    let study = study.base_samples(1 << 16).sampler(Sampler::Random).build().unwrap();
    let pilot = apportion::run::Pilot::new(&study, &apportion::RunContext::default()).unwrap();
    assert!(pilot.runs * factors <= 1 << 24, "{} runs", pilot.runs);
}

#[test]
fn a_journal_distinguishes_functions_by_version() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("j");
    let mean = |slope: f64, version: &str| {
        let model = function_model("y", move |x| slope * x[0]);
        let study =
            Study::builder("line", model).version(version).factor("a", unit()).base_samples(64).build().unwrap();
        study.runner().journal(&journal).run().unwrap().outputs[0].mean.unwrap()
    };
    assert!((mean(1.0, "1") - 0.5).abs() < 1e-9);
    assert!((mean(2.0, "2") - 1.0).abs() < 1e-9);
}

/// Runs on the threads of a caller's pool are not nested, which would exhaust the stack.
#[test]
fn many_runs_go_side_by_side_on_the_threads_of_another_pool() {
    use rayon::prelude::*;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).stack_size(1 << 20).build().unwrap();
    let text = "model = \"ishigami\"\n[design]\nbase_samples = 64\n";
    let run = |seed: u64| {
        let seed = format!("design.seed={seed}");
        let study = apportion_files::parse_study(text, std::path::Path::new("many.toml"), &[seed]).unwrap();
        study.runner().threads(1).run().unwrap().outputs[0].mean.unwrap()
    };
    let means: Vec<f64> = pool.install(|| (0..12).into_par_iter().map(run).collect());
    assert_eq!(means[..3], (0..3).map(run).collect::<Vec<f64>>());
}
