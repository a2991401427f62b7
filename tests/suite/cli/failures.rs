//! Invalid input through the program: each case has a clear error, its place, and exit code 2.

use crate::common::{Folder, HOLES, apportion, stderr, study_path, text};
use crate::messages::messages;

/// A valid study, to be made invalid line by line.
const GOOD: &str = r#"outputs = ["critical_force"]
[afm]
friction = "coulomb"
[design]
base_samples = 64
[[factor]]
name = "length"
min = 200
max = 700
unit = "um"
[[factor]]
name = "velocity"
min = 0
max = 800
unit = "nm/s"
"#;

/// What makes it wrong: a part, what stands in its place, and the line and column of the fault.
const SPOILT: &[(&str, &str, &str)] = &[
    ("base_samples", "base_sample", "5:1"),
    ("min = 200", "mim = 200", "8:1"),
    ("[afm]\nfriction", "[afm]\nfrictoin", "3:1"),
    ("outputs", "output", "1:1"),
    // Names.
    ("\"length\"", "\"lenght\"", "7:8"),
    ("\"coulomb\"", "\"coulom\"", "3:12"),
    ("\"critical_force\"", "\"critical\"", "1:12"),
    ("outputs", "model = \"abm\"\noutputs", "1:9"),
    ("unit = \"um\"", "unit = \"um\"\ndistribution = \"normel\"", "11:16"),
    (
        "name = \"velocity\"",
        "name = \"length\"\nmin = 1\nmax = 2\nunit = \"um\"\n[[factor]]\nname = \"velocity\"",
        "12:8",
    ),
    ("[\"critical_force\"]", "[\"critical_force\", \"critical_force\"]", "1:30"),
    ("[\"critical_force\"]", "[]", "1:11"),
    ("friction =", "length = \"3 um\"\nfriction =", "3:1"),
    // Units.
    ("\"um\"", "\"GPa\"", "10:8"),
    ("\"um\"", "\"furlong\"", "10:8"),
    ("unit = \"um\"\n", "", "7:8"),
    ("friction =", "preload_angle = \"0.7 um\"\nfriction =", "3:17"),
    ("friction =", "preload_angle = 0.7\nfriction =", "3:17"),
    // Ranges.
    ("min = 200", "min = 700", "8:7"),
    ("min = 200", "min = 900", "8:7"),
    ("min = 200", "min = -5", "8:7"),
    ("min = 200", "min = nan", "8:7"),
    ("max = 700", "max = inf", "9:7"),
    ("max = 700\n", "", "7:8"),
    ("max = 700", "max = 700\nsd = 3", "10:6"),
    // Types.
    ("min = 200", "min = \"200\"", "8:7"),
    ("base_samples = 64", "base_samples = -64", "5:16"),
    ("outputs = [\"critical_force\"]", "outputs = \"critical_force\"", "1:11"),
    ("base_samples = 64", "base_samples = 64.5", "5:16"),
    ("\"coulomb\"", "3", "3:12"),
    ("[[factor]]\nname = \"length\"", "[factor]\nname = \"length\"", "11:3"),
    // Designs.
    ("base_samples = 64", "base_samples = 0", "5:16"),
    ("base_samples = 64", "replicates = 0", "5:14"),
    ("base_samples = 64", "base_samples = 18446744073709551615", "5:16"),
    ("base_samples = 64", "sampler = \"sobel\"", "5:11"),
    ("[design]", "[function]\na = 1\n[design]", "4:1"),
];

#[test]
fn the_good_study_is_good() {
    let folder = Folder::new();
    let output = apportion(&["check", text(&folder.with("study.toml", GOOD))]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn a_study_that_is_spoilt() {
    messages!().spoilt(&Folder::new(), GOOD, SPOILT);
}

#[test]
fn what_is_no_study_at_all() {
    let mut messages = messages!();
    messages.refused(&["run", "no-such-study.toml"]);
    let folder = Folder::new();
    for path in [folder.path("."), folder.with("binary.toml", [0xff, 0xfe, 0x00, 0x9f])] {
        messages.refused(&["check", text(&path)]);
    }
    messages.refused_study(&folder, "no TOML", "this is no study", "1:6");
    messages.refused_study(&folder, "nothing", "", "1:1");
    messages.refused_study(&folder, "control characters", "\u{0}\u{1b}[31m", "1:3");
}

#[test]
fn numbers_of_the_ladder() {
    let (folder, mut messages) = (Folder::new(), messages!());
    for (line, place) in [
        ("fidelity = \"quasistatic\"", "3:12"),
        ("contact = \"jkrs\"", "3:11"),
        ("tolerance = 0", "3:13"),
        ("tolerance = \"1e-6\"", "3:13"),
        ("step = 0.01", "3:8"),
        ("step = \"10 nm\"", "3:8"),
        ("step_budget = 0", "3:15"),
        ("lugre_parameters = \"freezed\"", "3:20"),
    ] {
        messages.refused_study(&folder, line, &GOOD.replace("friction =", &format!("{line}\nfriction =")), place);
    }
}

#[test]
fn parameters_of_functions() {
    let (folder, mut messages) = (Folder::new(), messages!());
    for (study, place) in [
        ("b = 3", "3:1"),
        ("dimensions = 3", "3:1"),
        ("a = \"1\"", "3:5"),
        ("a = [1, true]", "3:5"),
        ("a = [1, -2]", "3:5"),
        ("a = nan", "3:5"),
        ("dimension = 3\na = [1, 2]", "4:5"),
        ("dimension = 0", "3:13"),
        ("a = [1, 2]\n[[factor]]\nname = \"x3\"", "5:8"),
        ("a = 1\n[[factor]]\nname = \"x1\"\nunit = \"%\"", "6:8"),
        ("a = 1\n[[factor]]\nname = \"x1\"\nmin = 0", "5:8"),
        ("[[factor]]\nname = \"x1\"\n[afm]", "5:1"),
        ("model = \"flood\"\n[function]\na = 1", "3:1"),
        ("model = \"flood\"\n[[factor]]\nname = \"B\"\nmin = -1\nmax = 1", "4:7"),
        ("model = \"bratley\"\n[function]\ndimension = 4000", "1:1"),
    ] {
        let head = if study.starts_with("model") { "" } else { "model = \"sobol-g\"\n[function]\n" };
        messages.refused_study(&folder, study, &format!("{head}{study}\n"), place);
    }
}

#[test]
fn keys_of_the_analysis() {
    let (folder, mut messages) = (Folder::new(), messages!());
    for (line, place) in [
        ("estimators = [\"jansenn\"]", "5:15"),
        ("estimators = \"jansen\"", "5:14"),
        ("second_order = 1", "5:16"),
        ("subsets = [[\"length\", \"lenght\"]]", "5:23"),
        ("subsets = [[]]", "5:11"),
        ("aggregate = \"yes\"", "5:13"),
        ("dummy = 0", "5:9"),
        ("intervals = \"bootstrap\"", "5:13"),
        ("intervals = \"percentile\"", "5:13"),
        ("resamples = 5", "5:13"),
        ("threshold = 2.0", "5:13"),
        ("threshold = nan", "5:13"),
        ("failures = \"ignore\"", "5:12"),
        ("max_failed = -0.1", "5:14"),
        ("thresold = 0.1", "5:1"),
    ] {
        messages.refused_study(
            &folder,
            line,
            &GOOD.replace("[design]", &format!("[analysis]\n{line}\n[design]")),
            place,
        );
    }
}

#[test]
fn keys_that_end_a_run() {
    let (folder, mut messages) = (Folder::new(), messages!());
    for value in ["0.0", "nan", "-1"] {
        let study = GOOD.replace("base_samples = 64\n", "").replace("[afm]", &format!("accuracy = {value}\n[afm]"));
        messages.refused_study(&folder, &format!("accuracy = {value}"), &study, "2:12");
    }
    for (line, place) in [
        ("target = 0.01", "5:1"),
        ("budget = \"30 s\"", "5:1"),
        ("max_time = \"30\"", "5:12"),
        ("max_time = \"30 nm\"", "5:12"),
        ("max_time = \"-1 s\"", "5:12"),
        ("max_time = 30", "5:12"),
        ("base_samples = 64\nruns = 300", "5:16"),
        ("base_samples = 64\nmax_runs = 300", "6:12"),
        ("max_runs = -1", "5:12"),
        ("max_runs = 15", "5:12"),
        ("sampler = \"latin-hypercube\"\nmax_runs = 1000", "5:11"),
    ] {
        messages.refused_study(&folder, line, &GOOD.replace("base_samples = 64", line), place);
    }
}

/// A study of a function that fails on a part of its inputs.
fn holes(analysis: &str) -> String {
    format!("{HOLES}[design]\nbase_samples = 256\n[analysis]\n{analysis}\n")
}

#[test]
fn an_output_lost_to_failed_runs_is_a_failed_run() {
    let mut messages = messages!();
    let folder = Folder::new();
    let (study, out) = (folder.with("holes.toml", holes("max_failed = 0")), folder.path("out"));
    let output = apportion(&["run", text(&study), "--out", text(&out)]);
    messages.ended("no failure is allowed", 1, &output);
    let json = std::fs::read_to_string(out.join("holes.json")).unwrap();
    let result: apportion::result::StudyResult = serde_json::from_str(&json).unwrap();
    messages.add("the reason in the result", &result.outputs[0].reason.unwrap().to_string());
    assert!(result.outputs[0].distribution.is_some(), "the values that there are");
    assert!(out.join("charts/holes-distribution.png").exists());
    // An allowed failure is not an error.
    let study = folder.with("holes.toml", holes("max_failed = 1"));
    let output = apportion(&["run", text(&study), "--out", text(&out)]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    // No run has a value: the time to slip at velocity 0.
    let none = GOOD
        .replace("critical_force", "critical_time")
        .replace("friction =", "velocity = \"0 nm/s\"\nfriction =")
        .split("[[factor]]\nname = \"velocity\"")
        .next()
        .unwrap()
        .to_owned();
    let output = apportion(&["run", text(&folder.with("none.toml", none)), "--out", text(&out)]);
    messages.ended("no run has a value", 1, &output);
    assert!(out.join("none.json").exists());
    // An output that does not vary has no indices either, but nothing failed.
    let constant =
        folder.with("constant.toml", "model = \"linear\"\n[function]\nc = [0, 0]\n[design]\nbase_samples = 64\n");
    let output = apportion(&["run", text(&constant), "--out", text(&out)]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn the_first_failed_run_stops_a_study_that_stops_at_failures() {
    let mut messages = messages!();
    let folder = Folder::new();
    for size in ["base_samples = 256", "max_runs = 100000"] {
        let text_of = holes("failures = \"fail\"").replace("base_samples = 256", size);
        let (study, out) = (folder.with("holes.toml", text_of), folder.path("out"));
        // On one thread the failed run that is named is the first; on more it is that of any of them.
        let output = apportion(&["run", text(&study), "--out", text(&out), "--threads", "1"]);
        messages.ended(size, 1, &output);
        let output = apportion(&["run", text(&study), "--out", text(&out), "--threads", "3"]);
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        let files = crate::common::files(&out);
        assert!(files.iter().all(|name| name == "holes.journal"), "no result files: {files:?}");
    }
}

#[test]
fn overrides_that_make_no_sense() {
    let mut messages = messages!();
    let study = study_path("coulomb-dimensional");
    for arguments in [
        ["--set", "afm.friction"],
        ["--set", "afm.friction=hkk"],
        ["--set", "factor.lenght.max=3"],
        ["--base-samples", "0"],
        ["--base-samples", "many"],
        ["--seed", "-1"],
        ["--seed", "9223372036854775808"],
    ] {
        messages.refused(&[&["check", text(&study)][..], &arguments].concat());
    }
    // An override must never be dropped.
    let folder = Folder::new();
    let large = folder.with("large.toml", GOOD.replace("base_samples = 64", "seed = 9223372036854775808"));
    messages.refused(&["check", text(&large), "--base-samples", "64"]);
    messages.refused(&["run", text(&study), "--threads", "0"]);
}

#[test]
fn results_that_cannot_be_written_are_found_before_the_run() {
    let folder = Folder::new();
    let file = folder.with("file", "");
    messages!().refused(&["run", text(&study_path("coulomb-dimensional")), "--out", text(&file.join("out"))]);
}

/// A system that gives no stack to a second thread, as one that limits their number.
#[cfg(target_os = "linux")]
#[test]
fn without_threads_everything_is_done_by_one() {
    let folder = Folder::new();
    let program = folder.with("model.sh", "while IFS=, read -r id x; do [ $id = id ] || echo $id,$x; done\n");
    let command = format!("model = \"command\"\noutputs = [\"y\"]\ncommand.program = [\"sh\", {program:?}]\n{SMALL}");
    for (study, code) in [(format!("model = \"expression\"\noutputs.y = \"x\"\n{SMALL}"), 0), (command, 1)] {
        let path = folder.with("s.toml", study);
        let run = |stack: &str, out: &str| {
            let (path, out) = (text(&path), folder.path(out));
            let mut run = crate::common::program();
            run.env("RUST_MIN_STACK", stack).args(["run", path, "--no-journal", "--force", "--out", text(&out)]);
            (run.output().unwrap(), std::fs::read(out.join("s.csv")).unwrap_or_default())
        };
        let ((usual, expected), (limited, csv)) = (run("2000000", "usual"), run("1000000000000000000", "limited"));
        assert!(usual.status.success(), "{}", stderr(&usual));
        assert_eq!(limited.status.code(), Some(code), "{}", stderr(&limited));
        assert!(code == 1 || csv == expected);
    }
}

const SMALL: &str = "design.base_samples = 64\n[factors]\nx = { min = 0, max = 1 }\n";

#[test]
fn points_that_are_wrong() {
    let mut messages = messages!();
    let folder = Folder::new();
    let (study, target) = (folder.with("study.toml", GOOD), folder.with("out.csv", "old"));
    for points in [
        "",
        "lenght,velocity\n1,2\n",
        "length,length\n1,2\n",
        "length,velocity\n300,100\n300,fast\n",
        "length\n300\nNaN\n",
        "length\n300\n\"\"\n",
        "length,velocity\n300\n",
        "le\u{ff}\n",
        "length\n300\n1e999\n",
        "length\n\n\nabc\n",
        "length\r\n1\r\n2\r\nabc",
        "length,velocity\n225,48\n\n225,48,3",
    ] {
        // Latin-1: of a letter beyond ASCII, bytes that are no text in UTF-8.
        let path = folder.with("points.csv", points.chars().map(|c| c as u8).collect::<Vec<u8>>());
        let output = apportion(&["evaluate", text(&study), text(&path), "--force", "-o", text(&target)]);
        messages.ended(&format!("{points:?}"), 2, &output);
        assert!(stderr(&output).contains("points.csv"), "{points:?}");
        assert_eq!(std::fs::read_to_string(&target).unwrap(), "old", "the target is what it was");
    }
    messages.refused(&["evaluate", text(&study), "no-such.csv", "-o", text(&target)]);
    let points = folder.with("points.csv", "length\n300\n");
    let output = apportion(&["evaluate", text(&study), text(&points), "-o", text(&folder.path("."))]);
    messages.ended("a folder as target", 1, &output);
}

#[test]
fn usage_errors_exit_with_2() {
    let mut messages = messages!();
    messages.refused(&["frobnicate"]);
    messages.refused(&["run"]);
    assert_eq!(apportion(&[]).status.code(), Some(2));
}
