//! First attempts of users: studies in the forms that they expect, and the messages where those are invalid.

use std::path::Path;

use apportion::design::DesignError;
use apportion::study::{BuildError, Study};
use apportion_files::{Problem, StudyError};

use crate::common::{Folder, succeed, text};
use crate::messages::messages;

fn parsed(study: &str) -> Study {
    apportion_files::parse_study(study, Path::new("s.toml"), &[]).unwrap_or_else(|error| panic!("{study}\n{error}"))
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
    let mut messages = messages!();
    for (form, place) in [
        (&format!("{list}[factors.b]\nmin = 0\nmax = 1\n")[..], "7:10"),
        ("[factor]\nname = \"a\"\nmin = 0\nmax = 1\n", "3:2"),
        ("[factor.a]\nmin = 0\nmax = 1\n", "3:2"),
        ("factors = [{ name = \"a\", min = 0, max = 1 }]\n", "3:11"),
        ("[factors.a]\nname = \"b\"\nmin = 0\n", "4:8"),
        ("[factors.a]\nmin = 0\n", "3:10"),
    ] {
        messages.unparsed(form, &format!("{head}{form}"), place);
    }
    let outputs = "[expression]\noutputs.z = \"a\"\n";
    messages.unparsed(outputs, &format!("model = \"expression\"\n{outputs}{list}"), "3:1");
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
    let mut messages = messages!();
    // A place in a formula is that in the file.
    for (outputs, place) in [
        ("outputs.y = \"x1\"\n", "2:10"),
        ("model = \"command\"\noutputs.y = \"nN\"\n", "1:1"),
        ("model = \"expression\"\n[outputs]\ny = \"x1 + x3\"\n", "3:11"),
    ] {
        messages.unparsed(outputs, &format!("{outputs}{factor}"), place);
    }
}

#[test]
fn keys_in_the_wrong_table_are_reported_with_the_right_one() {
    let factor = "[[factor]]\nname = \"x1\"\nmin = 0\nmax = 1\n";
    let mut messages = messages!();
    for (lines, place) in [
        ("model = \"expression\"\noutputs.y = \"x1\"\n[expression]\na = 7\n", "4:1"),
        ("[expression]\nconstants.a = 1\n", "1:1"),
        ("seed = 3\n", "1:1"),
        ("N = 1024\n", "1:1"),
        ("model = \"my_model.py\"\n", "1:9"),
        ("model = \"ishigam\"\n", "1:9"),
    ] {
        messages.unparsed(lines, &format!("{lines}{factor}"), place);
    }
    messages.unparsed("outputs behind a factor", &format!("{factor}outputs = [\"y\"]\n"), "5:1");
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
    let mut messages = messages!();
    for line in ["dist = \"normal\"", "bounds = [0, 1]", "sigma = 1", "std = 1", "mu = 1", "lower = 1", "N = 1"] {
        messages.unparsed(line, &factor(line), "5:1");
    }
    for name in ["norm", "gaussian", "lognorm", "cauchy"] {
        messages.unparsed(name, &factor(&format!("distribution = \"{name}\"")), "5:16");
    }
    for key in ["N", "samples", "n_samples", "method"] {
        let study = factor("min = 0\nmax = 1").replace("seed = 1", &format!("{key} = 1"));
        messages.unparsed(key, &study, "8:1");
    }
    let study = factor("min = 0\nmax = 1").replace("seed = 1", "sampler = \"lhs\"");
    messages.unparsed("lhs", &study, "8:11");
}

#[test]
fn functions_of_python_are_refused_with_those_that_there_are() {
    let study = "model = \"expression\"\noutputs.y = \"np.sin(x1)\"\n[factors.x1]\nmin = 1\nmax = 2\n";
    messages!().unparsed("np.sin(x1)", study, "2:14");
}

#[test]
fn mistyped_keys_and_values_are_reported_at_their_place() {
    let rest = "outputs.y = \"x1\"\n[factors.x1]\nmin = 0\nmax = 1\n";
    let mut messages = messages!();
    for typed in ["modle", "Model", "models"] {
        let study = format!("{typed} = \"expression\"\n{rest}");
        messages.unparsed(typed, &study, "1:1");
    }
    messages.unparsed("N", "[design]\nN = 3\n", "2:1");
    for (line, place) in [("a = [0, 1.5]", "4:5"), ("größe = { min = 0, max = 1 }", "4:3")] {
        messages.unparsed(line, &format!("model = \"expression\"\noutputs.y = \"a\"\n[factors]\n{line}\n"), place);
    }
}

#[test]
fn a_place_is_shown_with_its_line_and_a_caret() {
    let study = "model = \"ishigami\"\nfactors.'µ' = { min = 'x' }\n";
    let error = apportion_files::parse_study(study, Path::new("s.toml"), &[]).unwrap_err().to_string();
    let lines: Vec<&str> = error.lines().take(4).collect();
    assert!(lines[0].starts_with("s.toml:2:23: "), "{error}");
    assert_eq!(lines[1..], ["  |", "2 | factors.'µ' = { min = 'x' }", "  |                       ^^^"]);
}
