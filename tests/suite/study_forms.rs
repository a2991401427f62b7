//! First attempts of users: studies in the forms that they expect, and the messages where those are invalid.

use std::path::Path;

use apportion::design::DesignError;
use apportion::study::{BuildError, Study};
use apportion_files::{Problem, StudyError};

use crate::common::{Folder, apportion, stderr, succeed, text};

fn parsed(study: &str) -> Study {
    apportion_files::parse_study(study, Path::new("s.toml"), &[]).unwrap_or_else(|error| panic!("{study}\n{error}"))
}

/// The study is refused, with all of `expected` in the message.
#[track_caller]
fn refused(study: &str, expected: &[&str]) {
    let error = match apportion_files::parse_study(study, Path::new("s.toml"), &[]) {
        Ok(_) => panic!("not refused:\n{study}"),
        Err(error) => error.to_string(),
    };
    for part in expected {
        assert!(error.contains(part), "no {part:?} in:\n{error}");
    }
}

const LISTED: &str = "model = \"expression\"\noutputs.z = \"b + 2*a\"\noutputs.y = \"a\"\n\
                      [[factor]]\nname = \"b\"\nmin = 0\nmax = 1\n[[factor]]\nname = \"a\"\nmin = -1\nmax = 2\nunit = \"mm\"\n";

/// Their order decides which dimension of the sequence each gets, and so the numbers.
#[test]
fn factors_are_the_same_study_in_both_forms_in_the_order_of_the_file() {
    let listed = parsed(LISTED);
    let head = "model = \"expression\"\noutputs.z = \"b + 2*a\"\noutputs.y = \"a\"\n";
    for form in [
        "[factors]\nb = { min = 0, max = 1 }\na = { min = -1, max = 2, unit = \"mm\" }\n",
        "[factors.b]\nmin = 0\nmax = 1\n[factors.a]\nmin = -1\nmax = 2\nunit = \"mm\"\n",
    ] {
        let study = parsed(&format!("{head}{form}"));
        assert_eq!(study.space(), listed.space(), "{form}");
        assert_eq!(study.identity(), listed.identity(), "{form}");
    }
    // The same numbers, through the binary, and a change of a factor by its name.
    let folder = Folder::new();
    let table = folder.with(
        "table.toml",
        format!("{head}[factors.b]\nmin = 0\nmax = 1\n[factors.a]\nmin = -1\nmax = 2\nunit = \"mm\"\n"),
    );
    let list = folder.with("list.toml", LISTED);
    let csv = |study: &Path, name: &str| {
        let out = folder.path(name);
        let set = ["--set", "factor.a.max=3", "--base-samples", "64"];
        succeed(&[&["run", text(study), "--out", text(&out)][..], &set].concat());
        std::fs::read_to_string(out.join(format!("{}.csv", study.file_stem().unwrap().to_str().unwrap()))).unwrap()
    };
    assert_eq!(csv(&table, "a"), csv(&list, "b"));
}

#[test]
fn other_forms_are_refused_with_todays_lines() {
    let head = "model = \"expression\"\noutputs.y = \"a\"\n";
    let list = "[[factor]]\nname = \"a\"\nmin = 0\nmax = 1\n";
    refused(&format!("{head}{list}[factors.b]\nmin = 0\nmax = 1\n"), &["s.toml:7:10:", "keep one of the two"]);
    for old in [
        "[factor]\nname = \"a\"\nmin = 0\nmax = 1\n",
        "[factor.a]\nmin = 0\nmax = 1\n",
        "factors = [{ name = \"a\", min = 0, max = 1 }]\n",
    ] {
        refused(&format!("{head}{old}"), &["s.toml:3:", "no longer read", "[factors]\nx1 = { min = 0, max = 1 }"]);
    }
    let outputs = "[expression]\noutputs.z = \"a\"\n";
    refused(
        &format!("model = \"expression\"\n{outputs}{list}"),
        &["s.toml:3:1:", "no longer read", "outputs.y = ...\nabove the first table"],
    );
    refused(&format!("{head}[factors.a]\nname = \"b\"\nmin = 0\n"), &["the key before its table"]);
    refused(&format!("{head}[factors.a]\nmin = 0\n"), &["s.toml:3:10:", "factor `a`", "needs `max`"]);
}

#[test]
fn outputs_are_written_above_the_tables_of_models() {
    let factor = "[factors.x1]\nmin = 0\nmax = 1\n";
    let outputs = |study: &str| -> Vec<String> {
        parsed(study).model().outputs().iter().map(|output| format!("{} [{}]", output.name, output.unit)).collect()
    };
    for study in [
        format!("model = \"expression\"\noutputs.y = \"x1^2\"\n{factor}"),
        format!("model = \"expression\"\n[outputs]\ny = \"x1^2\"\n{factor}"),
        format!("model = \"expression\"\noutputs.y = \"a*x1^2\"\n[expression]\nconstants.a = 2\n{factor}"),
        format!("model = \"expression\"\n[outputs]\ny = {{ formula = \"x1\", unit = \"\" }}\n{factor}")
            .replace("\"\"", "\"1\""),
    ] {
        assert_eq!(outputs(&study), ["y [1]"], "{study}");
    }
    assert_eq!(
        outputs(&format!("model = \"external\"\n[outputs]\ny = \"nN\"\nz = \"\"\n{factor}")),
        ["y [nN]", "z []"]
    );
    let program = format!("model = \"command\"\ncommand = [\"python3\", \"m.py\"]\n[outputs]\ny = \"nN\"\n{factor}");
    assert_eq!(outputs(&program), ["y [nN]"]);
    let table = format!("model = \"command\"\noutputs.y = \"nN\"\ncommand.program = [\"python3\", \"m.py\"]\n{factor}");
    assert_eq!(outputs(&table), ["y [nN]"]);
    refused(&format!("outputs.y = \"x1\"\n{factor}"), &["unknown factor `x1`"]);
    refused(&format!("model = \"command\"\noutputs.y = \"nN\"\n{factor}"), &["the study has no program"]);
    // A place in a formula is that in the file.
    refused(&format!("model = \"expression\"\n[outputs]\ny = \"x1 + x3\"\n{factor}"), &["s.toml:3:11:", "no `x3`"]);
}

#[test]
fn keys_in_the_wrong_table_are_reported_with_the_right_one() {
    let factor = "[[factor]]\nname = \"x1\"\nmin = 0\nmax = 1\n";
    refused(
        &format!("model = \"expression\"\noutputs.y = \"x1\"\n[expression]\na = 7\n{factor}"),
        &["s.toml:4:1:", "unknown key `a`", "constants"],
    );
    refused(&format!("[expression]\nconstants.a = 1\n{factor}"), &["belongs to model = \"expression\"", "by default"]);
    refused(
        &format!("seed = 3\n{factor}"),
        &["s.toml:1:1:", "unknown key `seed` here: it stands in the table [design]"],
    );
    refused(&format!("{factor}outputs = [\"y\"]\n"), &["s.toml:5:1:", "above the first table"]);
    refused(&format!("N = 1024\n{factor}"), &["did you mean `base_samples`, which belongs in the table [design]?"]);
    refused(
        &format!("model = \"my_model.py\"\n{factor}"),
        &["s.toml:1:9:", "a program of your own is a `command`", "command = [\"python3\", \"my_model.py\"]"],
    );
    refused(&format!("model = \"ishigam\"\n{factor}"), &["did you mean `ishigami`?"]);
}

/// Before any of them is processed.
#[test]
fn more_factors_than_any_study_can_have_are_refused_while_they_are_read() {
    let lines = |count: usize| (0..count).map(|number| format!("x{number} = {{}}\n")).collect::<String>();
    let tables = |count: usize| (0..count).map(|number| format!("[[factor]]\nname = \"x{number}\"\n")).collect();
    let head = "model = \"expression\"\noutputs.y = \"x0\"\n";
    let forms: [String; 2] = [format!("[factors]\n{}", lines(10_001)), tables(10_001)];
    for form in forms {
        let error = apportion_files::parse_study(&format!("{head}{form}"), Path::new("s.toml"), &[]).unwrap_err();
        let StudyError::Invalid(diagnostic) = error else { panic!("{error}") };
        let too_many = DesignError::FarTooManyFactors { factors: 10_001 };
        assert_eq!(diagnostic.problem, Problem::Build(BuildError::Design(too_many)));
    }
}

#[test]
fn words_of_other_programs_are_answered_with_the_keywords_of_this_one() {
    let factor = |line: &str| {
        format!("model = \"expression\"\noutputs.y = \"x1\"\n[[factor]]\nname = \"x1\"\n{line}\n[design]\nseed = 1\n")
    };
    for (line, meant) in [
        ("dist = \"normal\"", "`dist`: did you mean `distribution`?"),
        ("bounds = [0, 1]", "`bounds`: did you mean `min` and `max`?"),
        ("sigma = 1", "`sigma`: did you mean `sd`?"),
        ("std = 1", "`std`: did you mean `sd`?"),
        ("mu = 1", "`mu`: did you mean `mean`?"),
        ("lower = 1", "`lower`: did you mean `min`?"),
        ("distribution = \"norm\"", "unknown distribution `norm`: did you mean `normal`?"),
        ("distribution = \"gaussian\"", "unknown distribution `gaussian`: did you mean `normal`?"),
        ("distribution = \"lognorm\"", "did you mean `log-normal`?"),
        ("distribution = \"cauchy\"", "known: uniform, log-uniform, normal"),
    ] {
        refused(&factor(line), &["s.toml:5:", meant]);
    }
    for (key, ours) in
        [("N", "base_samples"), ("samples", "base_samples"), ("n_samples", "base_samples"), ("method", "sampler")]
    {
        let study = factor("min = 0\nmax = 1").replace("seed = 1", &format!("{key} = 1"));
        refused(&study, &["s.toml:8:1:", &format!("unknown key `{key}`: did you mean `{ours}`?")]);
    }
}

#[test]
fn functions_of_python_are_refused_with_those_that_there_are() {
    let study = "model = \"expression\"\noutputs.y = \"np.sin(x1)\"\n[factors.x1]\nmin = 1\nmax = 2\n";
    refused(study, &["s.toml:2:14:", "no function `np.sin`", "functions: sin, cos"]);
}

#[test]
fn mistyped_keys_and_values_are_reported_at_their_place() {
    let rest = "outputs.y = \"x1\"\n[factors.x1]\nmin = 0\nmax = 1\n";
    for typed in ["modle", "Model", "models"] {
        let study = format!("{typed} = \"expression\"\n{rest}");
        refused(&study, &["s.toml:1:1:", &format!("unknown key `{typed}`: did you mean `model`?")]);
    }
    let factors = |line: &str| format!("model = \"expression\"\noutputs.y = \"a\"\n[factors]\n{line}\n");
    refused(&factors("a = [0, 1.5]"), &["s.toml:4:5:", "expected a table, as in { min = 0, max = 1 }"]);
    refused(&factors("größe = { min = 0, max = 1 }"), &["s.toml:4:", "in quotes, as in \"größe\" = 2"]);
}

#[test]
fn a_short_name_of_a_key_has_a_hint() {
    let folder = Folder::new();
    let path = folder.with("bad.toml", "[design]\nN = 3\n");
    let output = apportion(&["check", text(&path)]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("did you mean `base_samples`?"), "{}", stderr(&output));
}
