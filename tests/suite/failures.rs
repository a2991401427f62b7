//! Invalid input through the program: each case has a clear error, its place, and exit code 2.

use crate::common::{Folder, HOLES, apportion, stderr, study_path, text};

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

/// Runs `check` on an invalid study and expects exit code 2 with every one of `expected` in the message.
#[track_caller]
fn assert_refused(study: &str, expected: &[&str]) {
    let folder = Folder::new();
    let path = folder.with("study.toml", study);
    for command in ["check", "run"] {
        let out = folder.path("out");
        let mut arguments = vec![command, text(&path)];
        if command == "run" {
            arguments.extend(["--out", text(&out)]);
        }
        let output = apportion(&arguments);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{command}: {message}");
        for part in expected {
            assert!(message.contains(part), "{command}: no {part:?} in:\n{message}");
        }
        assert!(!out.exists(), "a refused study leaves nothing behind");
    }
}

#[track_caller]
fn assert_spoilt(from: &str, to: &str, expected: &[&str]) {
    assert!(GOOD.contains(from));
    assert_refused(&GOOD.replacen(from, to, 1), expected);
}

#[test]
fn the_good_study_is_good() {
    let folder = Folder::new();
    let output = apportion(&["check", text(&folder.with("study.toml", GOOD))]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn a_missing_file() {
    let output = apportion(&["run", "no-such-study.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("no-such-study.toml: cannot read the study file"));
}

#[test]
fn a_folder_and_bytes_that_are_not_text_are_refused() {
    let folder = Folder::new();
    for path in [folder.path("."), folder.with("binary.toml", [0xff, 0xfe, 0x00, 0x9f])] {
        let output = apportion(&["check", text(&path)]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    }
}

#[test]
fn not_toml_and_empty_files() {
    assert_refused("this is no study", &["study.toml:1:", "^"]);
    assert_refused("", &["study.toml:1:1:", "no factor", "[factors]"]);
    assert_refused("\u{0}\u{1b}[31m", &["study.toml:1:", "\u{fffd}"]);
}

#[test]
fn unknown_keys_suggest_the_nearest() {
    assert_spoilt("base_samples", "base_sample", &["study.toml:5:1:", "unknown key `base_sample`", "`base_samples`?"]);
    assert_spoilt("min = 200", "mim = 200", &["study.toml:8:1:", "unknown key `mim`", "did you mean `min`?"]);
    assert_spoilt("[afm]\nfriction", "[afm]\nfrictoin", &["study.toml:3:1:", "did you mean `friction`?"]);
    assert_spoilt("outputs", "output", &["study.toml:1:1:", "did you mean `outputs`?"]);
}

#[test]
fn unknown_names_suggest_the_nearest() {
    assert_spoilt("\"length\"", "\"lenght\"", &["study.toml:7:8:", "unknown factor `lenght`: did you mean `length`?"]);
    assert_spoilt("\"coulomb\"", "\"coulom\"", &["study.toml:3:12:", "friction law", "did you mean `coulomb`?"]);
    assert_spoilt(
        "\"critical_force\"",
        "\"critical\"",
        &["study.toml:1:12:", "unknown output `critical`", "lateral_force"],
    );
    assert_spoilt("outputs", "model = \"abm\"\noutputs", &["study.toml:1:9:", "unknown model `abm`", "afm"]);
    assert_spoilt("unit = \"um\"", "unit = \"um\"\ndistribution = \"normel\"", &["study.toml:11:16:", "`normal`?"]);
}

#[test]
fn units_of_the_wrong_kind_and_no_unit() {
    assert_spoilt(
        "\"um\"",
        "\"GPa\"",
        &["study.toml:10:8:", "`length` is a length", "`GPa` measures a pressure", "unit = \"um\""],
    );
    assert_spoilt("\"um\"", "\"furlong\"", &["study.toml:10:8:", "furlong"]);
    assert_spoilt("unit = \"um\"\n", "", &["study.toml:7:8:", "needs a unit", "unit = \"um\""]);
    assert_spoilt("friction =", "preload_angle = \"0.7 um\"\nfriction =", &["study.toml:3:17:", "an angle"]);
    assert_spoilt("friction =", "preload_angle = 0.7\nfriction =", &["study.toml:3:17:", "needs a unit", "deg"]);
}

#[test]
fn invalid_ranges_are_refused() {
    assert_spoilt(
        "min = 200",
        "min = 700",
        &["study.toml:8:7:", "`length`", "distribution = \"constant\", value = 700"],
    );
    assert_spoilt("min = 200", "min = 900", &["study.toml:8:7:", "`length`"]);
    assert_spoilt("min = 200", "min = -5", &["study.toml:8:7:", "must be > 0", "-5 um"]);
    assert_spoilt("min = 200", "min = nan", &["study.toml:8:7:"]);
    assert_spoilt("max = 700", "max = inf", &["study.toml:9:7:"]);
    assert_spoilt("max = 700\n", "", &["study.toml:7:8:", "needs `max`", "min and max"]);
    assert_spoilt("max = 700", "max = 700\nsd = 3", &["study.toml:10:6:", "has no `sd` together with `min`"]);
}

#[test]
fn values_of_the_wrong_type() {
    assert_spoilt("min = 200", "min = \"200\"", &["study.toml:8:7:", "expected a number"]);
    assert_spoilt("base_samples = 64", "base_samples = -64", &["study.toml:5:16:", "whole number"]);
    let words = ["study.toml:1:11:", "expected a list in square brackets"];
    assert_spoilt("outputs = [\"critical_force\"]", "outputs = \"critical_force\"", &words);
    assert_spoilt("base_samples = 64", "base_samples = 64.5", &["study.toml:5:16:", "whole number"]);
    assert_spoilt("\"coulomb\"", "3", &["study.toml:3:12:", "\"coulomb\""]);
    assert_spoilt(
        "[[factor]]\nname = \"length\"",
        "[factor]\nname = \"length\"",
        &["study.toml:11:3:", "duplicate key"],
    );
    assert_spoilt("outputs = [\"critical_force\"]", "outputs = \"critical_force\"", &["study.toml:1:11:"]);
}

#[test]
fn numbers_of_the_ladder() {
    let with = |line: &str, expected: &[&str]| assert_spoilt("friction =", &format!("{line}\nfriction ="), expected);
    with("fidelity = \"quasistatic\"", &["study.toml:3:12:", "did you mean `quasi-static`?"]);
    with("contact = \"jkrs\"", &["study.toml:3:11:", "did you mean `jkr`?"]);
    with("tolerance = 0", &["study.toml:3:13:", "greater than 0", "tolerance = 1e-6"]);
    with("tolerance = \"1e-6\"", &["study.toml:3:13:", "tolerance = 1e-6"]);
    with("step = 0.01", &["study.toml:3:8:", "step = \"10 ms\""]);
    with("step = \"10 nm\"", &["study.toml:3:8:", "step = \"10 ms\""]);
    with("step_budget = 0", &["study.toml:3:15:", "whole number from 1"]);
    with("lugre_parameters = \"freezed\"", &["study.toml:3:20:", "frozen, contact"]);
}

#[test]
fn parameters_of_functions() {
    let refused = |table: &str, expected: &[&str]| {
        assert_refused(&format!("model = \"sobol-g\"\n[function]\n{table}\n"), expected)
    };
    refused("b = 3", &["study.toml:3:1:", "unknown key `b`", "keys allowed here: a, dimension"]);
    refused("dimensions = 3", &["study.toml:3:1:", "did you mean `dimension`?"]);
    refused("a = \"1\"", &["study.toml:3:5:", "`a` must be a number or a list of numbers, not string"]);
    refused("a = [1, true]", &["study.toml:3:5:", "a list of numbers"]);
    refused("a = [1, -2]", &["study.toml:3:5:", "`a` must be 0 or greater, not -2"]);
    refused("a = nan", &["study.toml:3:5:", "0 or greater"]);
    refused("dimension = 3\na = [1, 2]", &["study.toml:4:5:", "`a` has 2 entries", "3 inputs"]);
    refused("dimension = 0", &["study.toml:3:13:", "a whole number from 1 to 4096"]);
    refused("a = [1, 2]\n[[factor]]\nname = \"x3\"", &["study.toml:5:8:", "unknown factor `x3`", "known: x1, x2"]);
    refused(
        "a = 1\n[[factor]]\nname = \"x1\"\nunit = \"%\"",
        &["study.toml:6:8:", "own distribution", "remove the unit"],
    );
    refused("a = 1\n[[factor]]\nname = \"x1\"\nmin = 0", &["study.toml:5:8:", "needs `max`"]);
    refused("[[factor]]\nname = \"x1\"\n[afm]", &["study.toml:5:1:", "unknown key `afm`"]);
    assert_refused("model = \"flood\"\n[function]\na = 1", &["study.toml:3:1:", "the function has no parameter `a`"]);
    assert_refused(
        "model = \"flood\"\n[[factor]]\nname = \"B\"\nmin = -1\nmax = 1",
        &["study.toml:4:7:", "must be > 0"],
    );
    assert_refused("model = \"bratley\"\n[function]\ndimension = 4000", &["study.toml:1:1:", "at most 2048 factors"]);
    assert_spoilt("[design]", "[function]\na = 1\n[design]", &["study.toml:4:1:", "unknown key `function`"]);
}

#[test]
fn impossible_designs() {
    assert_spoilt("base_samples = 64", "base_samples = 0", &["study.toml:5:16:", "too few", "at least 8 base samples"]);
    assert_spoilt("base_samples = 64", "replicates = 0", &["study.toml:5:14:", "replicates = 0"]);
    assert_spoilt("base_samples = 64", "base_samples = 18446744073709551615", &["study.toml:5:16:", "2^32"]);
    assert_spoilt("base_samples = 64", "sampler = \"sobel\"", &["study.toml:5:11:", "did you mean `sobol`?"]);
}

#[test]
fn keys_of_the_analysis() {
    let refused = |line: &str, expected: &[&str]| {
        assert_spoilt("[design]", &format!("[analysis]\n{line}\n[design]"), expected);
    };
    refused("estimators = [\"jansenn\"]", &["study.toml:5:15:", "unknown estimator", "did you mean `jansen`?"]);
    refused("estimators = \"jansen\"", &["study.toml:5:14:"]);
    refused("second_order = 1", &["study.toml:5:16:", "expected a boolean"]);
    refused("subsets = [[\"length\", \"lenght\"]]", &["study.toml:5:23:", "did you mean `length`?"]);
    refused("subsets = [[]]", &["study.toml:5:11:", "lists of factors"]);
    refused("aggregate = \"yes\"", &["study.toml:5:13:", "expected a boolean"]);
    refused("dummy = 0", &["study.toml:5:9:", "expected a boolean"]);
    refused("intervals = \"bootstrap\"", &["study.toml:5:13:", "unknown kind of interval `bootstrap`", "percentile"]);
    refused("intervals = \"percentile\"", &["study.toml:5:13:", "for points of the sampler \"sobol\"", "nets"]);
    refused("resamples = 5", &["study.toml:5:13:", "from 100 to 1000000"]);
    refused("threshold = 2.0", &["study.toml:5:13:", "`threshold` must be a number from 0 to 1, not 2"]);
    refused("threshold = nan", &["study.toml:5:13:", "from 0 to 1"]);
    refused("failures = \"ignore\"", &["study.toml:5:12:", "failure policy `ignore`", "drop-block, fail"]);
    refused("max_failed = -0.1", &["study.toml:5:14:", "`max_failed` must be a number from 0 to 1"]);
    refused("thresold = 0.1", &["study.toml:5:1:", "did you mean `threshold`?"]);
}

#[test]
fn keys_that_end_a_run() {
    let refused = |line: &str, expected: &[&str]| assert_spoilt("base_samples = 64", line, expected);
    let accurate = |value: &str| {
        let study = GOOD.replace("base_samples = 64\n", "").replace("[afm]", &format!("accuracy = {value}\n[afm]"));
        assert_refused(&study, &["study.toml:2:12:", "a finite number above 0"]);
    };
    ["0.0", "nan", "-1"].into_iter().for_each(accurate);
    for (old, new) in [("target = 0.01", "accuracy"), ("budget = \"30 s\"", "max_time"), ("budget_runs = 300", "runs")]
    {
        refused(old, &["study.toml:5:1:", &format!("did you mean `{new}`")]);
    }
    refused("max_time = \"30\"", &["study.toml:5:12:"]);
    refused("max_time = \"30 nm\"", &["study.toml:5:12:", "a time above 0, as in \"30 s\""]);
    refused("max_time = \"-1 s\"", &["study.toml:5:12:", "a time above 0"]);
    refused("max_time = 30", &["study.toml:5:12:"]);
    refused("base_samples = 64\nruns = 300", &["`base_samples` must be alone"]);
    refused(
        "base_samples = 64\nmax_runs = 300",
        &["study.toml:6:12:", "`max_runs` must be used with `accuracy` or alone"],
    );
    refused("max_runs = -1", &["study.toml:5:12:", "whole number"]);
    refused("max_runs = 15", &["study.toml:5:12:", "32 or more"]);
    refused("sampler = \"latin-hypercube\"\nmax_runs = 1000", &["study.toml:5:11:", "`sampler` must be"]);
}

/// A study of a function that fails on a part of its inputs.
fn holes(analysis: &str) -> String {
    format!("{HOLES}[design]\nbase_samples = 256\n[analysis]\n{analysis}\n")
}

#[test]
fn an_output_lost_to_failed_runs_is_a_failed_run() {
    let folder = Folder::new();
    let (study, out) = (folder.with("holes.toml", holes("max_failed = 0")), folder.path("out"));
    let output = apportion(&["run", text(&study), "--out", text(&out)]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("no indices of y: too many runs failed (max_failed = 0 in [analysis]"),
        "{}",
        stderr(&output)
    );
    let json = std::fs::read_to_string(out.join("holes.json")).unwrap();
    let result: apportion::result::StudyResult = serde_json::from_str(&json).unwrap();
    assert!(result.outputs[0].reason.as_ref().unwrap().contains("max_failed = 0"), "{json}");
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
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(out.join("none.json").exists());
    // An output that does not vary has no indices either, but nothing failed.
    let constant =
        folder.with("constant.toml", "model = \"linear\"\n[function]\nc = [0, 0]\n[design]\nbase_samples = 64\n");
    let output = apportion(&["run", text(&constant), "--out", text(&out)]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn the_first_failed_run_stops_a_study_that_stops_at_failures() {
    let folder = Folder::new();
    for size in ["base_samples = 256", "max_runs = 100000"] {
        let text_of = holes("failures = \"fail\"").replace("base_samples = 256", size);
        let (study, out) = (folder.with("holes.toml", text_of), folder.path("out"));
        let output = apportion(&["run", text(&study), "--out", text(&out)]);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{message}");
        assert!(
            message.contains("the study stops at the first failure") && message.contains("the run's inputs: x1 = "),
            "{message}"
        );
        let files = crate::common::files(&out);
        assert!(files.iter().all(|name| name == "holes.journal"), "no result files: {files:?}");
    }
}

#[test]
fn repeated_and_contradicting_names() {
    let again = "name = \"length\"\nmin = 1\nmax = 2\nunit = \"um\"\n[[factor]]\nname = \"velocity\"";
    assert_spoilt("name = \"velocity\"", again, &["study.toml:12:8:", "twice"]);
    assert_spoilt("[\"critical_force\"]", "[\"critical_force\", \"critical_force\"]", &["study.toml:1:30:", "twice"]);
    assert_spoilt("[\"critical_force\"]", "[]", &["study.toml:1:11:", "no names of outputs"]);
    assert_spoilt("friction =", "length = \"3 um\"\nfriction =", &["study.toml:3:1:", "is a factor of this study"]);
}

#[test]
fn overrides_that_make_no_sense() {
    let study = study_path("coulomb-dimensional");
    let refused = |arguments: &[&str], expected: &str| {
        let output = apportion(&[&["check", text(&study)], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
    };
    refused(&["--set", "afm.friction"], "expected KEY=VALUE");
    refused(&["--set", "afm.friction=hkk"], "unknown friction law `hkk`: did you mean `hk`?");
    refused(&["--set", "factor.lenght.max=3"], "did you mean `length`?");
    refused(&["--base-samples", "0"], "too few");
    refused(&["--base-samples", "many"], "invalid value");
    refused(&["--seed", "-1"], "-1");
    refused(&["--seed", "9223372036854775808"], "9223372036854775807");
    let folder = Folder::new();
    let large = folder.with("large.toml", GOOD.replace("base_samples = 64", "seed = 9223372036854775808"));
    let output = apportion(&["check", text(&large), "--base-samples", "64"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("cannot be changed"), "an override must never be dropped: {}", stderr(&output));
    let output = apportion(&["run", text(&study), "--threads", "0"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn results_that_cannot_be_written_are_found_before_the_run() {
    let folder = Folder::new();
    let file = folder.with("file", "");
    let study = study_path("coulomb-dimensional");
    let output = apportion(&["run", text(&study), "--out", text(&file.join("out"))]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("cannot write"));
    assert!(!stderr(&output).contains("model runs"), "the run must not start");
}

/// Evaluates `points` at the good study and expects exit code 2 with every one of `expected` in the message.
#[track_caller]
fn assert_points_refused(points: impl AsRef<[u8]>, expected: &[&str]) {
    let folder = Folder::new();
    let (study, points) = (folder.with("study.toml", GOOD), folder.with("points.csv", points));
    let target = folder.with("out.csv", "old");
    let output = apportion(&["evaluate", text(&study), text(&points), "-o", text(&target)]);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    for part in expected.iter().chain(&["points.csv"]) {
        assert!(message.contains(part), "no {part:?} in: {message}");
    }
    assert_eq!(std::fs::read_to_string(&target).unwrap(), "old", "the target is what it was");
}

#[test]
fn points_that_are_wrong() {
    assert_points_refused("", &["empty", "expected a header"]);
    assert_points_refused("lenght,velocity\n1,2\n", &["column 1: `lenght`", "did you mean `length`?"]);
    assert_points_refused("length,length\n1,2\n", &["column 2: `length` is also the name of column 1"]);
    assert_points_refused(
        "length,velocity\n300,100\n300,fast\n",
        &["line 3: column 2 (`velocity`)", "nm/s", "\"fast\""],
    );
    assert_points_refused("length\n300\nNaN\n", &["line 3: column 1", "finite number"]);
    assert_points_refused("length\n300\n\"\"\n", &["line 3: column 1", "finite number"]);
    assert_points_refused("length,velocity\n300\n", &["line 2", "expected 2 cells", "not 1"]);
    assert_points_refused([b'l', b'e', 0xff, b'\n'], &["UTF-8"]);
    assert_points_refused("length\n300\n1e999\n", &["line 3"]);
    assert_points_refused("length\n\n\nabc\n", &["line 4"]);
    assert_points_refused("length\r\n1\r\n2\r\nabc", &["line 4"]);
    assert_points_refused("length,velocity\n225,48\n\n225,48,3", &["line 4"]);
}

#[test]
fn missing_points_and_a_target_that_is_a_folder() {
    let folder = Folder::new();
    let study = folder.with("study.toml", GOOD);
    let output = apportion(&["evaluate", text(&study), "no-such.csv", "-o", text(&folder.path("out.csv"))]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("no-such.csv: cannot read the file"));
    let points = folder.with("points.csv", "length\n300\n");
    let output = apportion(&["evaluate", text(&study), text(&points), "-o", text(&folder.path("."))]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
}

#[test]
fn usage_errors_exit_with_2() {
    assert_eq!(apportion(&["frobnicate"]).status.code(), Some(2));
    assert_eq!(apportion(&[]).status.code(), Some(2));
    assert_eq!(apportion(&["run"]).status.code(), Some(2));
}
