//! Runs and files that must not be lost: what a command keeps, or refuses before it changes any file.

use std::path::Path;

use crate::common::{Folder, apportion, files, stderr, succeed, text};
use crate::messages::messages;

const SLOW: &str = "model = \"command\"\noutputs = [\"y\"]\ncommand = [\"python3\", \"model.py\"]\n[factors.a]\nmin = 0\nmax = 1\n\
                    [factors.b]\nmin = 0\nmax = 2\n";

const SUM: &str = "model = \"expression\"\n[outputs]\ny = { formula = \"a + b^2\", unit = \"mm\" }\n\
                   [design]\nbase_samples = 8\n[factors.a]\nmin = 0\nmax = 1\nunit = \"mm\"\nnominal = 0.25\n\
                   [factors.b]\nmin = 0\nmax = 2\n";

#[test]
fn a_run_that_chose_its_design_is_made_more_accurate() {
    let folder = Folder::new();
    let (study, out) = (folder.with("s.toml", SUM), folder.path("out"));
    let [study, out] = [text(&study), text(&out)];
    let said = succeed(&["run", study, "--accuracy", "0.05", "--out", out, "--charts", "none"]);
    assert!(said.contains("\n    [design]\n    base_samples = "), "{said}");
    let before = files(Path::new(out));
    succeed(&["run", study, "--accuracy", "0.025", "--out", out, "--charts", "none"]);
    assert_eq!(files(Path::new(out)), before);
}

#[test]
fn rows_behind_the_last_one_are_not_passed_over() {
    let folder = Folder::new();
    let study = folder.with("s.toml", SUM);
    let (design, outputs, out) = (folder.path("d.csv"), folder.path("y.csv"), folder.path("out"));
    succeed(&["sample", text(&study), "-o", text(&design)]);
    succeed(&["evaluate", text(&study), text(&design), "-o", text(&outputs)]);
    let (outputs, out, design) = (std::fs::read_to_string(outputs).unwrap(), text(&out), text(&design));
    let mut messages = messages!();
    for (case, rest) in [("the same again", outputs.as_str()), ("a word", "abc\n"), ("two numbers", "1\n2\n")] {
        let data = folder.with("z.csv", format!("{outputs}{rest}"));
        messages.refused_as(case, &["analyze", text(&data), "--design", design, "--out", out]);
    }
    assert!(!folder.path("out").exists());
}

#[test]
fn a_file_that_is_read_is_not_written() {
    let folder = Folder::new();
    let (study, points) = (folder.with("s.toml", SUM), folder.with("p.csv", "a,b\n0.5,1\n"));
    std::fs::create_dir(folder.path("sub")).unwrap();
    let same = folder.path("sub/../p.csv");
    let mut messages = messages!();
    for output in [&points, &same, &study] {
        messages.refused(&["evaluate", text(&study), text(&points), "-o", text(output)]);
    }
    assert_eq!(std::fs::read_to_string(points).unwrap(), "a,b\n0.5,1\n");
    assert_eq!(std::fs::read_to_string(study).unwrap(), SUM);
}

#[test]
fn sample_overwrites_only_its_own_designs() {
    let folder = Folder::new();
    let (study, table) = (folder.with("s.toml", SUM), folder.with("t.csv", "a,b\n0.5,1\n"));
    let sample = |more: &[&str]| apportion(&[&["sample", text(&study), "-o", text(&table)], more].concat());
    let mut messages = messages!();
    for more in [&[][..], &["--runs", "32"]] {
        messages.ended(&more.join(" "), 2, &sample(more));
        assert_eq!(std::fs::read_to_string(&table).unwrap(), "a,b\n0.5,1\n");
    }
    for more in [&["--force"][..], &[], &["--seed", "3"]] {
        let output = sample(more);
        assert_eq!(output.status.code(), Some(0), "{more:?}: {}", stderr(&output));
    }
    // A file with outputs is not a file of points.
    std::fs::write(&table, std::fs::read_to_string(&table).unwrap().replace('\n', ",1\n")).unwrap();
    assert_eq!(sample(&[]).status.code(), Some(2));
}

#[test]
fn an_evaluation_that_ended_early_is_resumed() {
    const TWICE: &str = "import csv, os, sys\nfor row in csv.DictReader(sys.stdin):\n    number, a = row['id'], float(row['a'])\n    \
                         open('calls', 'a').write(f'{a}\\n')\n    again = a == 0.75 and not os.path.exists('go')\n    for _ in \
                         range(1 + again):\n        print(number, 2 * a, sep=',', flush=True)\n";
    let folder = Folder::new();
    folder.with("model.py", TWICE);
    let study = folder.with(
        "s.toml",
        SLOW.replace(
            "command = [\"python3\", \"model.py\"]",
            "[command]\nprogram = [\"python3\", \"model.py\"]\nworkers = 1",
        ),
    );
    let values: Vec<f64> = (0..80).map(|k| f64::from(k) / 80.0).collect();
    let lines: String = values.iter().map(|a| format!("{a},1\n")).collect();
    let (points, out) = (folder.with("p.csv", format!("a,b\n{lines}")), folder.path("o.csv"));
    let evaluate =
        |more: &[&str]| apportion(&[&["evaluate", text(&study), text(&points), "-o", text(&out)], more].concat());
    assert_eq!(evaluate(&["--resume"]).status.code(), Some(2));
    assert_ne!(evaluate(&[]).status.code(), Some(0));
    assert!(!out.exists() && folder.path("o.csv.journal").exists());
    let calls = || std::fs::read_to_string(folder.path("calls")).unwrap().lines().count();
    let before = calls();
    folder.with("go", "");
    let output = evaluate(&["--resume"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    // Only the rows that had no answer are evaluated again.
    assert!(before > 50 && calls() < 90, "{before} {}", calls());
    let outputs: Vec<f64> =
        std::fs::read_to_string(&out).unwrap().lines().skip(1).map(|line| line.parse().unwrap()).collect();
    assert_eq!(outputs, values.iter().map(|a| 2.0 * a).collect::<Vec<f64>>());
    // Other points are another table.
    folder.with("p.csv", format!("a,b\n{lines}0.5,0.5\n"));
    assert_eq!(evaluate(&["--force", "--resume"]).status.code(), Some(2));
    assert_eq!(evaluate(&["--force"]).status.code(), Some(0));
}

#[test]
fn a_screening_and_a_sweep_that_ended_early_are_resumed() {
    const MODEL: &str = "import csv, os, sys\nfor row in csv.DictReader(sys.stdin):\n    number, a, b = row['id'], float(row['a']), \
                         float(row['b'])\n    open('calls', 'a').write(f'{a}\\n')\n    again = len(open('calls').readlines()) == 40 and \
                         not os.path.exists('go')\n    for _ in range(1 + again):\n        print(number, a * b + a, sep=',', flush=True)\n";
    let mut messages = messages!();
    for (command, more, rows) in [("screen", ["--trajectories", "32"], 96), ("sweep", ["--points", "40"], 81)] {
        let folder = Folder::new();
        folder.with("model.py", MODEL);
        let program = "[command]\nprogram = [\"python3\", \"model.py\"]\nworkers = 1";
        let study = folder.with("s.toml", SLOW.replace("command = [\"python3\", \"model.py\"]", program));
        let [out, whole] = ["out", "whole"].map(|name| folder.path(name));
        let call = |out: &Path, more: &[&str]| {
            apportion(&[&[command, text(&study), "--out", text(out), "--charts", "none"], more].concat())
        };
        assert_eq!(call(&out, &[&more[..], &["--resume"]].concat()).status.code(), Some(2));
        messages.ended(command, 1, &call(&out, &more));
        let calls = || std::fs::read_to_string(folder.path("calls")).unwrap().lines().count();
        let before = calls();
        folder.with("go", "");
        let resumed = call(&out, &[&more[..], &["--resume"]].concat());
        assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
        assert!(calls() < before + rows - 20, "{before} {}", calls());
        assert_eq!(call(&whole, &more).status.code(), Some(0));
        let table = |out: &Path| std::fs::read(out.join(format!("s-{command}.csv"))).unwrap();
        assert_eq!(table(&out), table(&whole));
        // Other points, another nominal value and another program are not mixed in.
        let [points, nominal] = [[more[0], "8"], ["--set", "factor.b.nominal=0.5"]];
        assert_eq!(call(&out, &[&points[..], &["--resume"]].concat()).status.code(), Some(2));
        assert_eq!(call(&out, &[&more[..], &nominal, &["--resume"]].concat()).status.code(), Some(2));
        folder.with("model.py", MODEL.replace("a * b", "a - b"));
        assert_eq!(call(&out, &more).status.code(), Some(2));
    }
}

#[test]
fn factors_without_a_column_are_listed_with_their_values() {
    let folder = Folder::new();
    let (study, points, out) = (folder.with("s.toml", SUM), folder.with("p.csv", "b\n1\n"), folder.path("o.csv"));
    let output = apportion(&["evaluate", text(&study), text(&points), "-o", text(&out)]);
    messages!().ended("no column a", 0, &output);
}

#[test]
fn outputs_keep_the_kind_of_unit_that_the_study_says() {
    let folder = Folder::new();
    let study = folder.with("s.toml", SUM);
    let (design, outputs, out) = (folder.path("d.csv"), folder.path("y.csv"), folder.path("out"));
    succeed(&["sample", text(&study), "-o", text(&design)]);
    succeed(&["evaluate", text(&study), text(&design), "-o", text(&outputs)]);
    let analyze =
        ["analyze", text(&outputs), "--design", text(&design), "--out", text(&out), "--charts", "none", "--units"];
    let mut messages = messages!();
    for unit in ["y=kg", "y=mmm"] {
        messages.refused(&[&analyze[..], &[unit]].concat());
    }
    succeed(&[&analyze[..], &["y=um"]].concat());
}

#[test]
fn a_file_in_place_of_a_folder_and_a_missing_folder_are_named() {
    let folder = Folder::new();
    let (study, file) = (folder.with("s.toml", SUM), folder.with("afile", ""));
    let [table, new] = ["nodir/x.csv", "nodir/x.toml"].map(|name| folder.path(name));
    let (study, mut messages) = (text(&study), messages!());
    for arguments in [
        &["run", study, "--out", text(&file)][..],
        &["run", study, "--out", text(&file.join("deeper"))],
        &["run", study, "--out", text(&folder.path("out")), "--save-outputs", text(&table)],
        &["new", text(&new)],
        &["sample", study, "-o", text(&table)],
    ] {
        messages.refused(arguments);
    }
}

#[test]
fn a_run_without_saved_rows_does_not_offer_to_resume() {
    let folder = Folder::new();
    let study = folder.with("s.toml", SLOW.replace("python3", "no-such-program"));
    messages!().ended("no such program", 1, &apportion(&["run", text(&study), "--out", text(&folder.path("out"))]));
}

#[test]
fn invalid_numbers_and_paths_of_options_are_refused() {
    let folder = Folder::new();
    let (study, mut messages) = (folder.with("s.toml", SUM), messages!());
    messages.refused(&["run", text(&study), "--seed", "-1"]);
    messages.refused(&["screen", text(&study), "--trajectories", "0"]);
    if Path::new("/dev/full").exists() {
        let program = assert_cmd::cargo::cargo_bin("apportion");
        let full = std::fs::File::create("/dev/full").unwrap();
        let output = std::process::Command::new(program).arg("models").stdout(full).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    }
}

#[test]
fn text_that_is_not_utf_8_is_reported_with_its_line() {
    let folder = Folder::new();
    let latin = folder.with("latin.toml", b"model = \"ishigami\"\n# caf\xe9\n");
    let (study, points) = (folder.with("s.toml", SUM), folder.with("p.csv", b"a,b\n0.5,\xe9\n"));
    let mut messages = messages!();
    messages.refused(&["check", text(&latin)]);
    messages.refused(&["evaluate", text(&study), text(&points), "-o", text(&folder.path("o.csv"))]);
}
