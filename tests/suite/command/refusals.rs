//! Invalid studies of programs, and programs that cannot be started.

use super::{Case, contains};
use crate::common::{apportion, stderr, stdout, succeed, text};

/// A study with these keys of `[command]` is refused with all of `expected` in the message.
#[track_caller]
fn refused(keys: &str, expected: &[&str]) {
    let case = Case::new(keys, "");
    let output = apportion(&["run", text(&case.path("study.toml"))]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    contains(&stderr(&output), expected);
}

#[test]
fn keys_are_checked_with_their_places() {
    refused("protocl = \"csv\"", &["study.toml:6:1:", "unknown key `protocl`: did you mean `protocol`?"]);
    refused("protocol = \"xml\"", &["study.toml:6:12:", "unknown protocol `xml`", "known: csv, json-lines"]);
    refused("row_numbers = true", &["study.toml:6:1:", "unknown key `row_numbers`"]);
    let named = |protocol: &str| Case::new(&format!("protocol = \"{protocol}\""), "");
    let case = named("csv").replace("name = \"x1\"", "name = \"id\"");
    let message = stderr(&apportion(&["check", text(&case.path("study.toml"))]));
    contains(&message, &["`name of the factor` must be another than `id`"]);
    let case = named("json-lines").replace("outputs = [\"y\"]", "outputs = [\"id\"]");
    let message = stderr(&apportion(&["check", text(&case.path("study.toml"))]));
    contains(&message, &["`name of the output` must be another than `id`"]);
    refused("timeout = \"60\"", &["study.toml:6:11:", "`timeout` must be a time above 0"]);
    refused("timeout = 60", &["study.toml:6:11:"]);
    refused("retries = 101", &["study.toml:6:11:", "a whole number from 0 to 100"]);
    refused("directory = \"nowhere\"", &["study.toml:6:13:", "no such directory"]);
    refused("keep = \"runs\"", &["study.toml:6:8:", "only with `template`"]);
    refused("outputs.y = { regex = \"1\" }", &["study.toml:2:13:", "only with `template`"]);
    refused("outputs.y = 3", &["study.toml:2:13:", "`outputs.y` must be a unit"]);
    refused("outputs.y = \"a\\u0007b\"", &["study.toml:2:13:", "without control characters"]);
    refused("outputs.y = { units = \"N\" }", &["unknown key `units`: did you mean `unit`?"]);
    refused("template = \"no.in\"", &["study.toml:6:12:", "no.in: cannot read the template"]);
    refused("template = \"model.py\"", &["`outputs.y` must be a table that locates the number"]);
    refused("template = \"model.py\"\nprotocol = \"csv\"", &["study.toml:7:12:", "without `template`"]);
    refused("template = \"model.py\"\ninput = \"../x\"", &["study.toml:7:9:", "the name of a file, without a folder"]);
    refused("template = \"model.py\"\nfiles = [\"no.dat\"]", &["study.toml:7:10:", "there is no such file"]);
    let pick = "template = \"model.py\"\noutputs.y = ";
    refused(
        &format!("{pick}{{ regex = \"(\" }}"),
        &["study.toml:2:13:", "a regular expression", "must be a regular expression"],
    );
    refused(&format!("{pick}{{ pointer = \"a\" }}"), &["which begins with a slash"]);
    refused(&format!("{pick}{{ pointer = \"/a\", column = \"b\" }}"), &["one of `regex`, `column`, `pointer`"]);
    refused(&format!("{pick}{{ column = \"b\", match = \"all\" }}"), &["\"first\" or \"last\""]);
    refused(&format!("{pick}{{ file = \"b\" }}"), &["only with `regex`, `column` or `pointer`"]);
}

#[test]
fn a_study_without_program_or_outputs_is_refused() {
    let refused = |text: &str, expected: &[&str]| {
        let text = format!("{text}\n[[factor]]\nname = \"x\"\nmin = 0\nmax = 1\n");
        let error = apportion_files::parse_study(&text, "s.toml".as_ref(), &[]).unwrap_err().to_string();
        contains(&error, expected);
    };
    refused("model = \"command\"", &["the study has no program", "command = [\"python3\", \"my_model.py\"]"]);
    refused("model = \"command\"\ncommand = []", &["s.toml:2:11:", "the study has no program"]);
    refused("model = \"command\"\n[command]\nworkers = 2", &["the study has no program"]);
    refused("model = \"command\"\ncommand = [\"x\"]", &["the study has no outputs"]);
    refused("model = \"command\"\ncommand = \"x y\"", &["s.toml:2:11:", "a list in square brackets"]);
    refused("command = [\"x\"]", &["unknown key `command`"]);
    refused("model = \"command\"\ncommand = [\"x\"]\noutputs = [\"y\", \"y\"]", &["`y` is listed twice"]);
}

#[test]
fn programs_that_cannot_be_started_are_named_with_what_to_do() {
    let with = |program: &str| {
        let case = Case::new("", "print(1)\n");
        let study = std::fs::read_to_string(case.path("study.toml")).unwrap();
        case.write("study.toml", &study.replace("[\"python3\", \"model.py\"]", program));
        case
    };
    with("[\"no-such-program\"]")
        .gives_up(&["cannot start the program `no-such-program`", "is it installed, and in PATH?"]);
    with("[\"./no-such\"]").gives_up(&["cannot start the program `./no-such`", "is relative to"]);
    with("[\"./model.py\"]").gives_up(&["cannot start the program `./model.py`", "make it executable"]);
}

#[test]
fn a_new_study_comes_with_its_program() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("mine.toml");
    succeed(&["new", text(&study), "--model", "command", "--factors", "a,the \"b\"", "--outputs", "y,z"]);
    let program = std::fs::read_to_string(folder.path().join("my_model.py")).unwrap();
    let out = folder.path().join("out");
    let shown = succeed(&["run", text(&study), "--base-samples", "64", "--out", text(&out)]);
    contains(&shown, &["the \"b\"", "\ny\n", "\nz\n"]);
    assert!(program.contains("row.pop(\"id\")"), "{program}");
    std::fs::write(folder.path().join("my_model.py"), "mine").unwrap();
    let again = apportion(&["new", text(&study), "--model", "command", "--force"]);
    contains(&stderr(&again), &["my_model.py exists already and is not changed"]);
    assert_eq!(std::fs::read_to_string(folder.path().join("my_model.py")).unwrap(), "mine");
    contains(&stdout(&apportion(&["models", "command"])), &["flush=True", "{{name}}", "worker-protocol.md"]);
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
