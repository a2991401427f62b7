//! Invalid studies of programs, and programs that cannot be started.

use super::Case;
use crate::common::{apportion, succeed, text};
use crate::messages::messages;

#[test]
fn keys_are_checked_with_their_places() {
    let mut messages = messages!();
    for (keys, place) in [
        ("protocl = \"csv\"", "6:1"),
        ("protocol = \"xml\"", "6:12"),
        ("row_numbers = true", "6:1"),
        ("timeout = \"60\"", "6:11"),
        ("timeout = 60", "6:11"),
        ("retries = 101", "6:11"),
        ("directory = \"nowhere\"", "6:13"),
        ("keep = \"runs\"", "6:8"),
        ("outputs.y = { regex = \"1\" }", "2:13"),
        ("outputs.y = 3", "2:13"),
        ("outputs.y = \"a\\u0007b\"", "2:13"),
        ("outputs.y = { units = \"N\" }", "2:13"),
        ("template = \"no.in\"", "6:12"),
        ("template = \"model.py\"", "3:1"),
        ("template = \"model.py\"\nprotocol = \"csv\"", "7:12"),
        ("template = \"model.py\"\ninput = \"../x\"", "7:9"),
        ("template = \"model.py\"\nfiles = [\"no.dat\"]", "7:10"),
        ("template = \"model.py\"\noutputs.y = { regex = \"(\" }", "2:13"),
        ("template = \"model.py\"\noutputs.y = { pointer = \"a\" }", "2:13"),
        ("template = \"model.py\"\noutputs.y = { pointer = \"/a\", column = \"b\" }", "2:13"),
        ("template = \"model.py\"\noutputs.y = { column = \"b\", match = \"all\" }", "2:13"),
        ("template = \"model.py\"\noutputs.y = { file = \"b\" }", "2:13"),
    ] {
        let case = Case::new(keys, "");
        let message = messages.refused_as(keys, &["run", text(&case.path("study.toml"))]);
        assert!(message.contains(&format!("study.toml:{place}: ")), "{keys}: not at {place}: {message}");
    }
    let named = |protocol: &str| Case::new(&format!("protocol = \"{protocol}\""), "");
    for (case, study) in [
        ("a factor id", named("csv").replace("name = \"x1\"", "name = \"id\"")),
        ("an output id", named("json-lines").replace("outputs = [\"y\"]", "outputs = [\"id\"]")),
    ] {
        messages.refused_as(case, &["check", text(&study.path("study.toml"))]);
    }
}

#[test]
fn a_study_without_program_or_outputs_is_refused() {
    let mut messages = messages!();
    for (lines, place) in [
        ("model = \"command\"", "1:1"),
        ("model = \"command\"\ncommand = []", "2:11"),
        ("model = \"command\"\n[command]\nworkers = 2", "2:1"),
        ("model = \"command\"\ncommand = [\"x\"]", "1:1"),
        ("model = \"command\"\ncommand = \"x y\"", "2:11"),
        ("command = [\"x\"]", "1:11"),
        ("model = \"command\"\ncommand = [\"x\"]\noutputs = [\"y\", \"y\"]", "3:11"),
    ] {
        messages.unparsed(lines, &format!("{lines}\n[[factor]]\nname = \"x\"\nmin = 0\nmax = 1\n"), place);
    }
}

#[test]
fn programs_that_cannot_be_started_are_named_with_what_to_do() {
    let with = |program: &str| {
        let case = Case::new("", "print(1)\n");
        let study = std::fs::read_to_string(case.path("study.toml")).unwrap();
        case.write("study.toml", &study.replace("[\"python3\", \"model.py\"]", program));
        case
    };
    let mut messages = messages!();
    for program in ["no-such-program", "./no-such", "./model.py"] {
        messages.ended(program, 1, &with(&format!("[\"{program}\"]")).run());
    }
}

#[test]
fn a_new_study_comes_with_its_program() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("mine.toml");
    succeed(&["new", text(&study), "--model", "command", "--factors", "a,the \"b\"", "--outputs", "y,z"]);
    let program = std::fs::read_to_string(folder.path().join("my_model.py")).unwrap();
    let out = folder.path().join("out");
    let shown = succeed(&["run", text(&study), "--base-samples", "64", "--out", text(&out)]);
    assert!(shown.contains("the \"b\"") && shown.contains("\ny\n") && shown.contains("\nz\n"), "{shown}");
    assert!(program.contains("row.pop(\"id\")"), "{program}");
    std::fs::write(folder.path().join("my_model.py"), "mine").unwrap();
    let again = apportion(&["new", text(&study), "--model", "command", "--force"]);
    let mut messages = messages!();
    messages.ended("new --force", 0, &again);
    assert_eq!(std::fs::read_to_string(folder.path().join("my_model.py")).unwrap(), "mine");
    messages.add("models command", &succeed(&["models", "command"]));
}

#[test]
fn labels_integers_and_units_reach_the_program() {
    let case = Case::new(
        "outputs.y = \"mm\"",
        "import csv, json, sys\nfor row in csv.DictReader(sys.stdin):\n    \
        with open('seen', 'a') as seen:\n        print(json.dumps(row), file=seen)\n    \
        print(row['id'], row['x1'], sep=',', flush=True)\n",
    );
    let study = std::fs::read_to_string(case.path("study.toml")).unwrap();
    let start = study.find("[[factor]]").unwrap();
    let factors = "[[factor]]\nname = \"x1\"\nmin = 1\nmax = 2\nunit = \"um\"\n[[factor]]\nname = \"n\"\ndistribution = \"integer\"\nmin = 1\nmax = 3\n\
                   [[factor]]\nname = \"made of\"\ndistribution = \"categorical\"\nlabels = [\"steel\", \"glass, thin\"]\n\
                   [[factor]]\nname = \"wet\"\ndistribution = \"boolean\"\n";
    case.write("study.toml", &format!("{}{factors}", study[..start].replace("workers = 2", "workers = 1")));
    let (result, _) = case.result();
    let mean = result.outputs[0].mean.unwrap();
    assert!((mean - 1.5).abs() < 0.05, "{mean} mm");
    // By any of the processes that were started in turn, how many depends on the load of the machine.
    let seen = std::fs::read_to_string(case.path("seen")).unwrap();
    let seen: Vec<serde_json::Value> = seen.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    for row in &seen {
        let x1: f64 = row["x1"].as_str().unwrap().parse().unwrap();
        assert!((1.0..2.0).contains(&x1), "{row}");
        assert!(["1", "2", "3"].contains(&row["n"].as_str().unwrap()), "{row}");
        assert!(["steel", "glass, thin"].contains(&row["made of"].as_str().unwrap()), "{row}");
        assert!(["true", "false"].contains(&row["wet"].as_str().unwrap()), "{row}");
    }
    assert!(seen.len() as u64 >= result.provenance.model_runs, "{} rows", seen.len());
}
