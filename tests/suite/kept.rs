//! Runs and files that must not be lost: what a command keeps, or refuses before it changes any file.

use std::path::Path;

use apportion::result::read_result;

use crate::common::{Folder, apportion, files, stderr, succeed, text};

const SLOW: &str = "model = \"command\"\noutputs = [\"y\"]\ncommand = [\"python3\", \"model.py\"]\n[factors.a]\nmin = 0\nmax = 1\n\
                    [factors.b]\nmin = 0\nmax = 2\n";

const MODEL: &str = "import sys\nfor line in sys.stdin:\n    cells = line.split(',')\n    try:\n        \
                     print(cells[0], float(cells[-2]) + float(cells[-1]) ** 2, sep=',', flush=True)\n    except ValueError:\n        pass\n";

const SUM: &str = "model = \"expression\"\n[outputs]\ny = { formula = \"a + b^2\", unit = \"mm\" }\n\
                   [design]\nbase_samples = 8\n[factors.a]\nmin = 0\nmax = 1\nunit = \"mm\"\nnominal = 0.25\n\
                   [factors.b]\nmin = 0\nmax = 2\n";

/// The command is refused with exit code 2, which says `expected`.
#[track_caller]
fn refused(arguments: &[&str], expected: &str) {
    let output = apportion(arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
    assert!(stderr(&output).contains(expected), "no {expected:?} in {}", stderr(&output));
}

#[test]
fn a_split_design_is_doubled_as_it_is() {
    let folder = Folder::new();
    folder.with("model.py", MODEL);
    let (study, out) = (folder.with("s.toml", SLOW), folder.path("out"));
    let [study, out] = [text(&study), text(&out)];
    let design = || read_result(&Path::new(out).join("s.json")).map(|result| result.provenance).unwrap();
    succeed(&["run", study, "--runs", "100", "--out", out, "--charts", "none"]);
    let first = design();
    assert!(first.plain_rows > 0);
    for _ in 0..2 {
        let before = design();
        let doubled =
            apportion(&["run", study, "--set", "design.runs=100", "--double", "--out", out, "--charts", "none"]);
        assert_eq!(doubled.status.code(), Some(0), "{}", stderr(&doubled));
        let (now, recorded) =
            (design(), format!("note: {} of {} runs are already saved", before.model_runs, 2 * before.model_runs));
        assert!(stderr(&doubled).contains(&recorded), "{}", stderr(&doubled));
        assert_eq!((now.base_samples, now.plain_rows), (2 * before.base_samples, first.plain_rows));
    }
    assert!(!files(Path::new(out)).contains("s.journal.old"));
    // Another design cannot resume, and no file changes.
    let before = std::fs::read(Path::new(out).join("s.journal")).unwrap();
    refused(
        &["run", study, "--set", "design.runs=100", "--double", "--seed", "7", "--out", out],
        "s.journal: the journal is of another study",
    );
    assert_eq!(std::fs::read(Path::new(out).join("s.journal")).unwrap(), before);
}

#[test]
fn a_run_that_chose_its_design_is_not_doubled_but_made_more_accurate() {
    let folder = Folder::new();
    let (study, out) = (folder.with("s.toml", SUM), folder.path("out"));
    let [study, out] = [text(&study), text(&out)];
    let said = succeed(&["run", study, "--accuracy", "0.05", "--out", out, "--charts", "none"]);
    assert!(said.contains("repeat the same run exactly.\n    [design]\n    runs = "), "{said}");
    let before = files(Path::new(out));
    refused(&["run", study, "--double", "--out", out], "use --accuracy 0.025 instead");
    refused(&["run", study, "--retry-failed", "--out", out], "use --accuracy 0.05 instead");
    assert_eq!(files(Path::new(out)), before);
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
    for (rest, expected) in [
        (outputs.as_str(), "row 33: column `y`: expected a number"),
        ("abc\n", "row 33: column `y`: expected a number"),
        ("1\n2\n", "the file has 34 rows, but the design has 32"),
    ] {
        let data = folder.with("z.csv", format!("{outputs}{rest}"));
        refused(&["analyze", text(&data), "--design", design, "--out", out], expected);
    }
    assert!(!folder.path("out").exists());
}

#[test]
fn a_file_that_is_read_is_not_written() {
    let folder = Folder::new();
    let (study, points) = (folder.with("s.toml", SUM), folder.with("p.csv", "a,b\n0.5,1\n"));
    std::fs::create_dir(folder.path("sub")).unwrap();
    let same = folder.path("sub/../p.csv");
    for output in [&points, &same, &study] {
        refused(
            &["evaluate", text(&study), text(&points), "-o", text(output)],
            "this is the input file, and it would be overwritten",
        );
    }
    assert_eq!(std::fs::read_to_string(points).unwrap(), "a,b\n0.5,1\n");
    assert_eq!(std::fs::read_to_string(study).unwrap(), SUM);
}

#[test]
fn sample_overwrites_only_its_own_designs() {
    let folder = Folder::new();
    let (study, table) = (folder.with("s.toml", SUM), folder.with("t.csv", "a,b\n0.5,1\n"));
    let sample = |more: &[&str]| apportion(&[&["sample", text(&study), "-o", text(&table)], more].concat());
    let expected =
        "exists already, and is not a design that `sample` wrote of this study: give another name, or add --force";
    for more in [&[][..], &["--random", "10"]] {
        let output = sample(more);
        assert!(output.status.code() == Some(2) && stderr(&output).contains(expected), "{}", stderr(&output));
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
fn factors_without_a_column_are_listed_with_their_values() {
    let folder = Folder::new();
    let (study, points, out) = (folder.with("s.toml", SUM), folder.with("p.csv", "b\n1\n"), folder.path("o.csv"));
    let output = apportion(&["evaluate", text(&study), text(&points), "-o", text(&out)]);
    let said = stderr(&output);
    let expected = "p.csv: factors without a column are at their nominal values: a = 0.25 mm\n";
    assert!(output.status.code() == Some(0) && said.contains(expected), "{said}");
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
    for (unit, expected) in [
        ("y=kg", "the unit `kg` is given for `y`, and measures a mass: the study says `mm`"),
        ("y=mmm", "and is unknown"),
    ] {
        refused(&[&analyze[..], &[unit]].concat(), expected);
    }
    succeed(&[&analyze[..], &["y=um"]].concat());
}

#[test]
fn a_file_in_place_of_a_folder_and_a_missing_folder_are_named() {
    let folder = Folder::new();
    let (study, file) = (folder.with("s.toml", SUM), folder.with("afile", ""));
    let [table, new] = ["nodir/x.csv", "nodir/x.toml"].map(|name| folder.path(name));
    let study = text(&study);
    refused(&["run", study, "--out", text(&file)], "afile is a file, and a folder is needed");
    refused(&["run", study, "--out", text(&file.join("deeper"))], "afile is a file, and a folder is needed");
    let out = folder.path("out");
    refused(&["run", study, "--out", text(&out), "--save-outputs", text(&table)], "nodir does not exist");
    refused(&["new", text(&new)], "nodir does not exist");
    refused(&["sample", study, "-o", text(&table)], "nodir does not exist");
}

#[test]
fn a_run_without_saved_rows_does_not_offer_to_resume() {
    let folder = Folder::new();
    let study = folder.with("s.toml", SLOW.replace("python3", "no-such-program"));
    let output = apportion(&["run", text(&study), "--out", text(&folder.path("out"))]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(said.contains("cannot start the program `no-such-program`") && !said.contains("are saved"), "{said}");
}

#[test]
fn invalid_numbers_and_paths_of_options_are_refused() {
    let folder = Folder::new();
    let study = folder.with("s.toml", SUM);
    refused(&["run", text(&study), "--seed", "-1"], "expected a whole number from 0 to");
    refused(&["screen", text(&study), "--trajectories", "0"], "expected a whole number, at least 4");
    if Path::new("/dev/full").exists() {
        let program = assert_cmd::cargo::cargo_bin("apportion");
        let full = std::fs::File::create("/dev/full").unwrap();
        let output = std::process::Command::new(program).arg("models").stdout(full).output().unwrap();
        let said = stderr(&output);
        assert!(output.status.code() == Some(1) && said.contains("cannot write to standard output: "), "{said}");
    }
}

#[test]
fn text_that_is_not_utf_8_is_reported_with_its_line() {
    let folder = Folder::new();
    let latin = folder.with("latin.toml", b"model = \"ishigami\"\n# caf\xe9\n");
    refused(&["check", text(&latin)], "cannot read the study file: line 2 is not text in UTF-8: save it as UTF-8");
    let (study, points) = (folder.with("s.toml", SUM), folder.with("p.csv", b"a,b\n0.5,\xe9\n"));
    refused(&["evaluate", text(&study), text(&points), "-o", text(&folder.path("o.csv"))], "line 2: not text in UTF-8");
}
