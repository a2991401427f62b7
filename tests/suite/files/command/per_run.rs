//! Programs that run once for each row, in separate directories.

use apportion_files::{InputTemplate, TemplateError};

#[cfg(target_os = "linux")]
use super::processes::within;
use super::{Case, only_reason, rows_where};
use crate::common::{files, text};
use crate::messages::messages;

/// A simulator that starts faster than Python: it reads `model.in` and writes according to `more`.
fn simulator(command: &str, outputs: &str, more: &str) -> Case {
    let keys = format!("template = \"model.in\"\nfiles = [\"model.awk\"]\n{command}\n{outputs}");
    let case = Case::new(&keys, "");
    let study = std::fs::read_to_string(case.path("study.toml")).unwrap();
    let program = "program = [\"awk\", \"-f\", \"model.awk\", \"model.in\"]";
    let study = study.replace("program = [\"python3\", \"model.py\"]", program).replace("outputs = [\"y\"]\n", "");
    case.write("study.toml", &study);
    case.write("model.in", "x1 = {{x1}}\nx2 = {{ x2 }}   # {{{{not one}}\nx3 = {{x3}}\n");
    let sum = "v[\"x1\"] + 2*v[\"x2\"]";
    case.write(
        "model.awk",
        &format!("$2 == \"=\" {{ v[$1] = $3 }}\nEND {{\n  y = {sum}; x1 = v[\"x1\"]\n{more}\n}}\n"),
    );
    case
}

const REPORT: &str = "outputs.y = { file = \"out.txt\", regex = 'y = (\\S+)' }";

#[test]
fn outputs_are_picked_from_files() {
    let outputs = "outputs.report = { regex = 'y = (\\S+)', unit = \"nN\" }\noutputs.first = { regex = 'y = (\\S+)', match = \"first\" }\n\
                   outputs.table = { file = \"out.csv\", column = \"y\" }\noutputs.json = { file = \"out.json\", pointer = \"/a/1\" }";
    let writes = "  printf \"y = 1.5D+00\\ny = %.17g\\n\", y\n  printf \"t,y\\n0,1\\n1,%.17g\\n\", y > \"out.csv\"\n  \
                  printf \"{\\\"a\\\": [0, %.17g]}\", y > \"out.json\"";
    let case = simulator("", outputs, writes);
    let (result, _) = case.result();
    let mean = |name: &str| result.outputs.iter().find(|output| output.name == name).unwrap().mean.unwrap();
    // The mean of x1 + 2 x2 by 32 Sobol' points.
    assert!((mean("table") - 1.5).abs() < 0.05, "{}", mean("table"));
    assert!((mean("report") - mean("table")).abs() < 1e-12 && (mean("json") - mean("table")).abs() < 1e-12);
    assert_eq!(mean("first"), 1.5);
    assert_eq!(result.outputs[0].unit, "nN");
}

#[test]
fn missing_output_of_a_run_is_named() {
    let bad = rows_where(|x| x > 0.9);
    let mut messages = messages!();
    for more in [
        "if (x1 <= 0.9) print \"y = \" y > \"out.txt\"",
        "print (x1 > 0.9 ? \"nothing\" : \"y = \" y) > \"out.txt\"",
        "print \"y = \" (x1 > 0.9 ? \"*****\" : y) > \"out.txt\"",
        "print \"y = \" (x1 > 0.9 ? \"nan\" : y) > \"out.txt\"",
        "print \"y = \" y > \"out.txt\"; if (x1 > 0.9) { print \"diverged at \" x1 > \"/dev/stderr\"; exit 4 }",
    ] {
        let (result, _) = simulator("", REPORT, more).result();
        messages.add(more, only_reason(&result.outputs[0], bad));
        assert!(result.outputs[0].indices.is_some());
    }
}

/// A copied result of an earlier run of the simulator is not used as that of a row.
#[test]
fn a_file_from_before_the_run_is_not_an_output() {
    let more = "if (x1 <= 0.9) print \"y = \" y > \"out.txt\"";
    let case = simulator("", REPORT, more).replace("[\"model.awk\"]", "[\"model.awk\", \"out.txt\"]");
    case.write("out.txt", "y = 7\n");
    let (result, _) = case.result();
    messages!().add("a file of before", only_reason(&result.outputs[0], rows_where(|x| x > 0.9)));
}

/// Programs may set any time: what they write is theirs.
#[test]
fn an_output_with_an_old_time_is_read() {
    let more = "print \"y = \" y > \"out.txt\"; close(\"out.txt\"); system(\"touch -d @0 out.txt\")";
    let (result, _) = simulator("", REPORT, more).result();
    assert_eq!(result.outputs[0].runs_failed, 0);
}

/// Directories of a killed run are removed by the next one, and nothing else is.
#[cfg(target_os = "linux")]
#[test]
fn directories_of_a_killed_run_are_removed() {
    let answer = "print \"y = \" y > \"out.txt\"";
    let case = simulator("", REPORT, &format!("{answer}; if (x1 > 0.5) system(\"sleep 1000\")"));
    let temporary = case.path("tmp");
    let mine = [".apportion-notes", ".apportion-aB3dE5gH7jK9mN1p.old"];
    mine.iter().for_each(|name| std::fs::create_dir_all(temporary.join(name)).unwrap());
    let run = |out: &str| {
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("apportion"));
        command.env("TMPDIR", &temporary).args(["run", text(&case.path("study.toml")), "--out", text(&case.path(out))]);
        command.stderr(std::process::Stdio::null()).spawn().unwrap()
    };
    let mut killed = run("out");
    within(60, "two runs hang", || files(&temporary).len() >= 4);
    std::thread::sleep(std::time::Duration::from_millis(1500));
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert_eq!(files(&temporary).len(), 4);
    let program = std::fs::read_to_string(case.path("model.awk")).unwrap();
    case.write("model.awk", &program.replace("sleep 1000", "true"));
    assert!(run("again").wait().unwrap().success());
    assert_eq!(files(&temporary), mine.map(str::to_owned).into());
}

#[test]
fn one_missing_output_leaves_the_others() {
    let outputs = format!("{REPORT}\noutputs.z = {{ file = \"out.txt\", regex = 'z = (\\S+)' }}");
    let (result, _) =
        simulator("", &outputs, "print \"y = \" y > \"out.txt\"; if (x1 <= 0.9) print \"z = 1\" > \"out.txt\"")
            .result();
    assert_eq!(result.outputs[0].runs_failed, 0);
    assert_eq!(result.outputs[1].runs_failed, rows_where(|x| x > 0.9));
}

#[test]
fn a_run_that_takes_too_long_is_ended() {
    let more = "print \"y = \" y > \"out.txt\"; if (x1 > 0.97) system(\"sleep 1000\")";
    let (result, _) = simulator("timeout = \"300 ms\"", REPORT, more).result();
    messages!().add("too long", only_reason(&result.outputs[0], rows_where(|x| x > 0.97)));
}

#[test]
fn directories_are_kept_if_asked_for() {
    let case = simulator("keep = \"runs\"", REPORT, "print \"y = \" y > \"out.txt\"");
    case.result();
    let runs: Vec<_> = files(&case.path("runs")).into_iter().collect();
    // Identical points share their directory.
    assert!(runs.len() > 100 && runs.len() <= 160, "{}", runs.len());
    let one = case.path("runs").join(&runs[0]);
    let expected = ["factors.csv", "model.awk", "model.in", "out.txt", "stderr.txt", "stdout.txt"];
    assert_eq!(files(&one).into_iter().collect::<Vec<_>>(), expected);
    let values = std::fs::read_to_string(one.join("factors.csv")).unwrap();
    let x1 = values.lines().nth(1).unwrap().split(',').next().unwrap();
    let input = std::fs::read_to_string(one.join("model.in")).unwrap();
    assert!(input.contains(&format!("x1 = {x1}\n")) && input.contains("# {{not one}}"), "{input}");
}

#[test]
fn a_simulator_that_never_works_is_given_up() {
    let broken = simulator("", REPORT, "print \"no licence\" > \"/dev/stderr\"; exit 9");
    let mut messages = messages!();
    broken.ends_with(&mut messages, "no licence", 1);
    let elsewhere = simulator("", REPORT, "print \"y = \" y");
    elsewhere.ends_with(&mut messages, "no file", 1);
}

#[test]
fn templates_are_checked_when_the_study_is_read() {
    let case = simulator("", REPORT, "print \"y = \" y > \"out.txt\"");
    case.write("model.in", "x1 = {{x1}}\nx3 = {{x3}}\n");
    let mut messages = messages!();
    messages.ended("x2 is missing", 0, &case.run());
    case.write("model.in", "x1 = {{x1}}\ny = {{x4}}\n");
    messages.ended("an unknown factor", 2, &case.run());
}

fn filled(text: &str) -> Result<String, TemplateError> {
    let number = |name: &str| ["a", "b c"].iter().position(|known| *known == name);
    let template = InputTemplate::parse(text, &number)?;
    Ok(template.fill(|factor, out| out.push_str(["1.5", "steel"][factor])))
}

#[test]
fn placeholders_are_filled_and_braces_stay() {
    for (text, expected) in [
        ("", ""),
        ("{{a}}", "1.5"),
        ("x={{ a }};{{b c}}{{a}}\r\n", "x=1.5;steel1.5\r\n"),
        ("{ \"y\": {\"a\": {{a}}} }", "{ \"y\": {\"a\": 1.5} }"),
        ("{{{{a}} and }}", "{{a}} and }}"),
        ("µ{{a}}µ", "µ1.5µ"),
    ] {
        assert_eq!(filled(text).as_deref(), Ok(expected), "{text}");
    }
}
