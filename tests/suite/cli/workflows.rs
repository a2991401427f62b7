//! What a user does, through the program: run, evaluate, check, models.

use std::path::Path;

use apportion::result::StudyResult;

use crate::common::{Folder, all_files, apportion, stderr, stdout, study_path, succeed, text};
use crate::messages::messages;

#[test]
fn check_writes_nothing_and_run_writes_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let (study, out) = (study_path("soft-cantilever"), folder.path().join("out"));
    succeed(&["check", text(&study), "--out", text(&out)]);
    assert!(!out.exists(), "check writes nothing");
    let table = succeed(&["run", text(&study), "--out", text(&out), "--base-samples", "1024"]);
    // Page, result, indices and convergence; four charts of two outputs, each as SVG and PNG.
    assert_eq!(all_files(&out).len(), 4 + 2 * 4 * 2);
    messages!().add_printed("run", &table);
}

#[test]
fn check_announces_no_journal_that_a_run_would_not_keep() {
    let study = study_path("ishigami");
    let disk = |base_samples: u64| {
        let setting = format!("design.base_samples={base_samples}");
        let printed = succeed(&["check", text(&study), "--set", &setting]);
        printed.lines().find(|line| line.starts_with("disk: ")).unwrap().to_owned()
    };
    // Five runs for each base sample, of one output of eight bytes.
    let largest = (8 << 30) / 40 / 256 * 256;
    assert!(disk(largest).contains("ishigami.journal"));
    let none = disk(largest + 256);
    assert!(!none.contains("ishigami.journal"));
    messages!().add("disk", &none);
}

#[test]
fn a_result_reads_back_as_it_was_and_carries_its_study() {
    let folder = tempfile::tempdir().unwrap();
    let study = study_path("coulomb-general");
    let arguments =
        ["run", text(&study), "--out", text(folder.path()), "--base-samples", "512", "--set", "afm.friction=hk"];
    succeed(&arguments);
    let json = std::fs::read_to_string(folder.path().join("coulomb-general.json")).unwrap();
    let result: StudyResult = serde_json::from_str(&json).unwrap();
    assert_eq!(result.json(), json);
    assert_eq!((result.format.as_str(), result.version), ("apportion-result", 1));
    assert_eq!(result.study.source, std::fs::read_to_string(&study).unwrap());
    assert_eq!(result.study.settings["friction"], "hk");
    assert_eq!(result.study.overrides, ["afm.friction=hk", "design.base_samples=512"]);
    assert_eq!(result.provenance.model_runs, 512 * 12);
    assert_eq!(result.provenance.study_sha256.len(), 64);
    let output = &result.outputs[0];
    assert_eq!((output.name.as_str(), output.unit.as_str()), ("critical_force", "nN"));
    assert_eq!((output.runs_ok, output.runs_failed), (512 * 12, 0));
    assert_eq!(output.groups.as_ref().unwrap()[0].factors, ["length", "width", "thickness", "height"]);
    let tabor = result.validity.iter().find(|flag| flag.flag == "tabor-out-of-range").unwrap();
    assert!(tabor.runs > 0 && tabor.share <= 1.0);
}

#[test]
fn the_format_of_a_result_is_what_it_was() {
    let overrides = ["design.base_samples=256", "outputs=['critical_force', 'critical_time']", "afm.velocity=0 nm/s"];
    let mut result = crate::common::analysed("lugre-dimensional", &overrides);
    result.provenance.apportion_version = "VERSION".to_owned();
    result.provenance.threads = 0;
    result.provenance.wall_seconds = 0.0;
    result.provenance.study_sha256 = "SHA-256".to_owned();
    result.study.source = "SOURCE".to_owned();
    result.study.constants.truncate(2);
    for output in &mut result.outputs {
        output.convergence.truncate(1);
        if let Some(scatter) = &mut output.scatter {
            scatter.points.truncate(1);
            scatter.conditional_means.truncate(1);
            for means in &mut scatter.conditional_means {
                means.x.truncate(2);
                for list in [&mut means.mean, &mut means.low, &mut means.high] {
                    list.truncate(2);
                }
            }
        }
        let Some(distribution) = output.distribution.as_mut() else { continue };
        distribution.quantiles.truncate(2);
        if let Some(histogram) = &mut distribution.histogram {
            histogram.edges.truncate(2);
            histogram.counts.truncate(2);
        }
    }
    // Four digits: this tests the format, not the last bits of another processor's logarithm.
    let text = result.json();
    let mut value: serde_json::Value = serde_json::from_str(&text).unwrap();
    round(&mut value);
    insta::assert_snapshot!(serde_json::to_string_pretty(&value).unwrap());
}

fn round(value: &mut serde_json::Value) {
    match value {
        serde_json::Value::Number(number) if number.is_f64() => {
            let rounded: f64 = format!("{:.3e}", number.as_f64().unwrap()).parse().unwrap();
            *value = rounded.into();
        }
        serde_json::Value::Array(values) => values.iter_mut().for_each(round),
        serde_json::Value::Object(map) => map.values_mut().for_each(round),
        _ => (),
    }
}

#[test]
fn evaluate_answers_in_the_units_of_the_study_and_names_what_fails() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let points = folder.path().join("points.csv");
    let out = folder.path().join("out.csv");
    let factors = "[[factor]]\nname='velocity'\nmin=0\nmax=800\nunit='nm/s'\n[[factor]]\nname='length'\nmin=200\nmax=700\nunit='um'\n";
    std::fs::write(&study, format!("outputs=['critical_force','normal_force','critical_time']\n{factors}")).unwrap();
    // A byte-order mark, spaces, a quoted cell and Windows line ends, as spreadsheets write them.
    std::fs::write(&points, "\u{feff} velocity \r\n100\r\n\"0\"\r\n -5 \r\n").unwrap();
    let output = apportion(&["evaluate", text(&study), text(&points), "-o", text(&out)]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let written = std::fs::read_to_string(&out).unwrap();
    let lines: Vec<Vec<&str>> = written.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines[0], ["critical_force", "normal_force", "critical_time"]);
    // The length has no column: it is the nominal 225 um, where the reference gives 631.3 and 489.404 nN.
    let number = |row: usize, column: usize| lines[row][column].parse::<f64>().unwrap();
    assert!((number(1, 0) - 631.3).abs() < 0.05 && (number(1, 1) - 489.404).abs() < 5e-4);
    assert_eq!(lines[2][..2], lines[1][..2]);
    assert_eq!((lines[2][2], &lines[3][..]), ("", &["", "", ""][..]));
    messages!().ended("evaluate", 0, &output);
}

#[test]
fn a_failed_point_of_a_single_output_keeps_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let (points, out) = (folder.path().join("points.csv"), folder.path().join("out.csv"));
    std::fs::write(&points, "length\n225\n-1\n226\n").unwrap();
    succeed(&["evaluate", text(&study_path("coulomb-dimensional")), text(&points), "-o", text(&out)]);
    let written = std::fs::read_to_string(&out).unwrap();
    let rows: Vec<_> = csv::Reader::from_reader(written.as_bytes()).into_records().map(Result::unwrap).collect();
    assert_eq!((rows.len(), &rows[1][0]), (3, ""), "{written}");
}

#[test]
fn evaluate_takes_no_points_as_no_points_and_many_as_many() {
    let folder = tempfile::tempdir().unwrap();
    let (points, out) = (folder.path().join("points.csv"), folder.path().join("out.csv"));
    let study = study_path("ishigami");
    std::fs::write(&points, "x1,x2,x3\n").unwrap();
    succeed(&["evaluate", text(&study), text(&points), "-o", text(&out)]);
    assert_eq!(std::fs::read_to_string(&out).unwrap(), "y\n");
    // More than two blocks, each value with all of its digits.
    let rows: Vec<String> = (0..2500).map(|i| format!("{}", f64::from(i) / 1000.0)).collect();
    std::fs::write(&points, format!("x3\n{}\n", rows.join("\n"))).unwrap();
    succeed(&[
        "evaluate",
        text(&study),
        text(&points),
        "--force",
        "-o",
        text(&out),
        "--set",
        "factor.x1.nominal=1.5",
        "--set",
        "factor.x2.nominal=0",
    ]);
    let written = std::fs::read_to_string(&out).unwrap();
    for (i, line) in written.lines().skip(1).enumerate() {
        let x3 = i as f64 / 1000.0;
        let expected = 1.5f64.sin() + 0.1 * x3.powi(4) * 1.5f64.sin();
        let got: f64 = line.parse().unwrap();
        assert!((got - expected).abs() <= 1e-15 * expected.abs(), "row {i}");
    }
    assert_eq!(written.lines().count(), 2501);
}

#[test]
fn models_lists_every_model_and_shows_each_in_full() {
    let listed = succeed(&["models"]);
    let place = |name: &str| listed.find(&format!("\n  {name} ")).unwrap_or_else(|| panic!("{name}"));
    let functions = |kind: &apportion_files::ModelKind| kind.known.is_some();
    for kind in apportion_files::ModelKind::all().into_iter().filter(functions) {
        assert!(place("afm") < place(kind.name), "the flagship comes first");
        let shown = succeed(&["models", kind.name]);
        for input in kind.inputs() {
            assert!(shown.contains(&format!("\n  {} ", input.name)), "{}: {}", kind.name, input.name);
        }
        assert!(shown.contains("source: ") && shown.contains("mean "), "{}", kind.name);
    }
    assert!(listed.lines().count() < 40);
    let shown = succeed(&["models", "afm"]);
    let inputs = apportion_afm::Parameter::ALL.iter().map(|parameter| parameter.name);
    let outputs = apportion_afm::AfmOutput::ALL.iter().map(|output| output.name());
    let keys = ["adhesion_in_load", "tolerance", "step", "maugis-dugdale", "quasi-static"];
    for name in inputs.chain(outputs).chain(keys) {
        assert!(shown.contains(name), "{name}");
    }
    let shown = succeed(&["models", "sobol-g"]);
    assert!(shown.contains("0.787144") && shown.contains("prod_i (|4 x_i - 2|"), "{shown}");
}

#[test]
fn a_closed_output_pipe_is_not_a_failure() {
    let binary = assert_cmd::cargo::cargo_bin!("apportion");
    let mut child = std::process::Command::new(binary)
        .arg("models")
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn round_sample_sizes_are_made_whole_and_said_so() {
    let folder = tempfile::tempdir().unwrap();
    let study = study_path("ishigami");
    let output = apportion(&["run", text(&study), "--base-samples", "1001", "--out", text(folder.path())]);
    let mut messages = messages!();
    messages.ended("--base-samples 1001", 0, &output);
    messages.add_printed("printed", &stdout(&output));
}

/// Runs `study` with settings into a separate folder and returns its result, its output, and the folder.
#[track_caller]
fn run_with(study: &str, settings: &[&str]) -> (StudyResult, String, tempfile::TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let path = study_path(study);
    let set = settings.iter().flat_map(|setting| ["--set", setting]);
    let arguments: Vec<&str> = ["run", text(&path), "--out", text(folder.path())].into_iter().chain(set).collect();
    let printed = succeed(&arguments);
    let json = std::fs::read_to_string(folder.path().join(format!("{study}.json"))).unwrap();
    (serde_json::from_str(&json).unwrap(), printed, folder)
}

fn csv_lines(folder: &Path, name: &str) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(folder.join(name)).unwrap();
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
    reader.records().map(|record| record.unwrap().iter().map(str::to_owned).collect()).collect()
}

#[test]
fn pairs_other_estimators_and_a_dummy_are_in_every_result_that_asks_for_them() {
    let (result, printed, folder) = run_with("ishigami-second-order", &["design.base_samples=4096"]);
    let output = &result.outputs[0];
    let pairs = output.second_order.as_ref().unwrap();
    let pair = pairs.iter().find(|pair| pair.factors == ["x1", "x3"]).unwrap();
    // S13 is exactly 0.2437; at 4096 base samples the error is some 3e-3.
    assert!((pair.index.estimate - 0.2437).abs() < 0.015, "{pair:?}");
    assert_eq!(
        output.estimators.iter().map(|record| &record.estimator[..]).collect::<Vec<_>>(),
        ["janon-monod", "jansen", "martinez"]
    );
    assert_eq!(output.dummy.unwrap().total.estimate, 0.0);
    assert_eq!(result.provenance.model_runs, 4096 * (2 + 2 * 4));
    messages!().add_printed("run", &printed);
    let csv = csv_lines(folder.path(), "ishigami-second-order.csv");
    let old = "output,kind,name,first_order,first_order_low,first_order_high,total,total_low,total_high,\
               share_first_order,share_first_order_low,share_first_order_high,share_total,share_total_low,share_total_high";
    assert_eq!(csv[0][..15].join(","), old, "the columns of readers that know the first ones");
    assert_eq!((csv.len(), &csv[4][1][..]), (5, "dummy"));
    let second = csv_lines(folder.path(), "ishigami-second-order-second-order.csv");
    assert_eq!(second.len(), 1 + 3);
    assert_eq!(second[2][3].parse::<f64>().unwrap(), pair.index.estimate, "{second:?}");
    assert_eq!(csv_lines(folder.path(), "ishigami-second-order-estimators.csv").len(), 1 + 3 * 4);
    let convergence = csv_lines(folder.path(), "ishigami-second-order-convergence.csv");
    assert_eq!(convergence.len(), 1 + 3 * output.convergence.len());
    assert_eq!(convergence.last().unwrap()[1], "4096");
}

#[test]
fn subsets_and_outputs_together() {
    let (result, printed, folder) = run_with("soft-cantilever-subsets", &["design.base_samples=2048"]);
    let subsets = result.outputs[0].subsets.as_ref().unwrap();
    assert_eq!(subsets[0].factors, ["particle_radius", "adhesion"]);
    // Thickness and friction determine the force, except for adhesion and radius, which add 0.1 %.
    assert!((subsets[1].effect.total.estimate - 0.9987).abs() < 5e-3, "{:?}", subsets[1]);
    let aggregate = result.aggregate.as_ref().unwrap();
    assert_eq!(aggregate.outputs, ["critical_force", "critical_time"]);
    assert_eq!(aggregate.indices.as_ref().unwrap().len(), 5);
    messages!().add_printed("run", &printed);
    let lines = csv_lines(folder.path(), "soft-cantilever-subsets.csv");
    let kinds: Vec<&str> = lines[1..].iter().map(|line| &line[1][..]).collect();
    let expected = [["factor"; 10].as_slice(), &["subset"; 4], &["aggregate"; 5]].concat();
    assert_eq!(kinds, expected);
    assert_eq!(lines.last().unwrap()[0], "critical_force + critical_time");
}

/// Where surrogates correct all outputs they correct the aggregate, too: polynomials have it exactly from few runs.
#[test]
fn the_aggregate_is_corrected_with_its_outputs() {
    let of = |units: &str| {
        let source = format!(
            "model = \"expression\"\n[outputs]\ny = {{ formula = \"2*a + b\"{units} }}\nz = {{ formula = \"3*a*c\" }}\n\
             [design]\nbase_samples = 64\n[analysis]\naggregate = true\n[factors]\na = {{ min = 0, max = 1 }}\n\
             b = {{ min = 0, max = 1 }}\nc = {{ min = 0, max = 1 }}\n"
        );
        let study = apportion_files::parse_study(&source, Path::new("together.toml"), &[]).unwrap();
        study.runner().run().unwrap().aggregate.unwrap().indices.unwrap()
    };
    // Variances 20/48 and 21/48; those of a alone 16/48 and 9/48, of a and c together 3/48.
    let weighted = [(25.0, 28.0), (4.0, 4.0), (9.0, 12.0)].map(|(first, total)| (first / 41.0, total / 41.0));
    let standardised = [(0.8 + 9.0 / 21.0, 0.8 + 12.0 / 21.0), (0.2, 0.2), (9.0 / 21.0, 12.0 / 21.0)];
    for (units, expected) in [("", weighted), (", unit = \"m\"", standardised.map(|(s, t)| (s / 2.0, t / 2.0)))] {
        for (found, (first, total)) in of(units).iter().zip(expected) {
            let found = [found.effect.first_order, found.effect.total];
            for (found, exact) in found.into_iter().zip([first, total]) {
                let width = found.interval.unwrap().width();
                assert!((found.estimate - exact).abs() < 1e-9 && width < 1e-6, "{units}: {found:?} for {exact}");
            }
        }
    }
}

#[test]
fn runs_that_grow_say_why_they_ended() {
    let stopping = |settings: &[&str]| {
        let (result, printed, _) = run_with("flood", settings);
        let stopping = result.stopping.unwrap();
        assert!(printed.contains(&format!(": {}.", stopping.reason)), "{printed}");
        (stopping, result.provenance.model_runs, result.outputs[0].convergence.last().cloned())
    };
    let (met, _, stage) = stopping(&["accuracy=0.02"]);
    assert_eq!((met.target_met, met.target_half_width), (Some(true), Some(0.02)));
    assert!(stage.unwrap().largest_half_width.unwrap() <= 0.02);
    let (unmet, runs, _) = stopping(&["accuracy=1e-6", "design.max_runs=50000"]);
    assert_eq!((unmet.target_met, unmet.max_runs), (Some(false), Some(50_000)));
    assert!((25_000..=50_000).contains(&runs), "{runs}");
    // Ten runs per base sample: the first stage of 1024 must be smaller.
    let (few, runs, _) = stopping(&["design.max_runs=100"]);
    assert_eq!((few.target_met, runs), (None, 80));
    let (spent, _, _) = stopping(&["design.max_time=0.05 s"]);
    assert_eq!(spent.budget_seconds, Some(0.05));
}

#[test]
fn a_run_continues_while_more_runs_give_intervals() {
    // The output is 1 in a tenth of the square: of nets of four points some do not vary.
    let folder = Folder::new();
    let study = "model = \"expression\"\noutputs.y = \"(a > 0.6837722339831621)*(b > 0.6837722339831621)\"\naccuracy = 0.1\n[design]\nseed = 1\n\
                 [analysis]\nsurrogate = \"off\"\n[factors]\n\
                 a = { min = 0, max = 1 }\nb = { min = 0, max = 1 }\n";
    let out = folder.path("out");
    succeed(&["run", text(&folder.with("rare.toml", study)), "--out", text(&out)]);
    let file: StudyResult = serde_json::from_slice(&std::fs::read(out.join("rare.json")).unwrap()).unwrap();
    assert_eq!(file.stopping.unwrap().target_met, Some(true));
}

#[test]
fn a_run_ends_soon_where_most_runs_fail() {
    let folder = Folder::new();
    let study = "model = \"expression\"\noutputs.y = \"if(a < 0.5, ln(-1), a)\"\naccuracy = 0.001\n\
                 [factors]\na = { min = 0, max = 1 }\nb = { min = 0, max = 1 }\n";
    let out = folder.path("out");
    apportion(&["run", text(&folder.with("half.toml", study)), "--out", text(&out)]);
    let file: StudyResult = serde_json::from_slice(&std::fs::read(out.join("half.json")).unwrap()).unwrap();
    assert!(file.provenance.base_samples <= 2048, "{}", file.provenance.base_samples);
}

#[test]
fn check_shows_the_request_and_its_cost() {
    let check = |study: &str, settings: &[&str]| {
        let path = study_path(study);
        let set: Vec<&str> = settings.iter().flat_map(|setting| ["--set", setting]).collect();
        succeed(&[&["check", text(&path)], &set[..]].concat())
    };
    let mut messages = messages!();
    for (study, settings) in [
        ("ishigami-second-order", &[][..]),
        ("sobol-g-target", &[]),
        ("ishigami", &["design.replicates=1"]),
        ("ishigami", &["design.replicates=1", "analysis.intervals=replicates"]),
        // Of a hundred factors 2^13 points are enough.
        ("sobol-g-hundred", &[]),
        ("sobol-g-hundred", &["design.base_samples=4096"]),
    ] {
        messages.add_printed(&format!("{study} {}", settings.join(" ")), &check(study, settings));
    }
    let bytes = check("flood", &["design.sampler=random", "analysis.intervals=delta", "design.base_samples=1000"]);
    assert!(bytes.contains(" 0.1 MB "), "{bytes}");
}

#[test]
fn models_lists_the_estimators_with_their_costs() {
    let listed = succeed(&["models", "--estimators"]);
    for estimator in apportion::estimate::Estimator::ALL {
        assert!(listed.contains(&format!("\n  {} ", estimator.name())), "{}", estimator.name());
        assert!(listed.contains(&format!("\n{}: ", estimator.name())), "{}: source", estimator.name());
    }
    let line = |name: &str| listed.lines().find(|line| line.starts_with(&format!("  {name} "))).unwrap().to_owned();
    assert!(line("jansen").contains("2 + d ") && line("jansen").contains(" 10 "), "{listed}");
    assert!(line("azzini").contains("2 + 2 d") && line("azzini").contains(" 18 "), "{listed}");
    assert_eq!(apportion(&["models", "flood", "--estimators"]).status.code(), Some(2));
}
