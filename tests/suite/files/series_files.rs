//! Outputs that are series, through the program: studies, answers, tables, pages.

use std::path::Path;

use apportion::result::{StudyResult, read_result};

use crate::common::{Folder, all_files, apportion, stderr, study_path, succeed, text};
use crate::messages::messages;

/// Two factors between 0 and 1.
const FACTORS: &str = "[[factor]]\nname = \"a\"\nmax = 1\nmin = 0\n[[factor]]\nname = \"b\"\nmin = 0\nmax = 1\n";

/// A program that prints, for a * k + b at k = 0, 1, ..., `length` numbers in the place of `{values}`.
fn python(answer: &str) -> String {
    format!(
        "import csv, json, sys\nfor row in csv.DictReader(sys.stdin):\n    \
         i, a, b = row['id'], float(row['a']), float(row['b'])\n    {answer}\n"
    )
}

/// The result of a study of a program of these lines.
#[track_caller]
fn run(folder: &Folder, study: &str, program: &str) -> (StudyResult, String) {
    let out = folder.path("out");
    folder.with("model.py", program);
    let study = format!("model = \"command\"\n{study}\n[design]\nbase_samples = 64\n{FACTORS}");
    let path = folder.with("s.toml", study);
    let printed = succeed(&["run", text(&path), "--out", text(&out), "--no-journal"]);
    (read_result(&out.join("s.json")).unwrap(), printed)
}

const COMMAND: &str = "[command]\nprogram = [\"python3\", \"model.py\"]\n";

fn page(out: &Path) -> String {
    std::fs::read_to_string(out.join("s.html")).unwrap()
}

#[test]
fn a_program_gives_a_series_by_cells_or_as_a_list() {
    let outputs = "outputs.sum = \"nN\"\noutputs.y = { length = 4, axis = \"time\", axis_unit = \"ms\", positions = [1, 0.5], unit = \"nN\" }\n";
    let folder = Folder::new();
    let cells = python("print(i, a + b, *[a * k + b for k in range(4)], sep=',', flush=True)");
    let (by_cells, _) = run(&folder, &format!("{outputs}{COMMAND}"), &cells);
    let list = "import json, sys\nfor line in sys.stdin:\n    x = json.loads(line)\n    a, b = x['a'], x['b']\n    \
                print(json.dumps({'id': x['id'], 'y': [a * k + b for k in range(4)], 'sum': a + b}), flush=True)\n";
    let folder = Folder::new();
    let (by_list, _) = run(&folder, &format!("{outputs}{COMMAND}protocol = \"json-lines\"\n"), list);
    assert_eq!((&by_cells.outputs, &by_cells.series), (&by_list.outputs, &by_list.series));
    let series = &by_cells.series[0];
    assert_eq!((series.name.as_str(), series.unit.as_str(), series.axis.as_str()), ("y", "nN", "time"));
    assert_eq!(
        (series.axis_unit.as_str(), series.first_output, &series.positions),
        ("ms", 1, &vec![1.0, 1.5, 2.0, 2.5])
    );
    assert_eq!(by_cells.outputs[4].name, "y[3]");
    // V_a(k) = k^2 / 12, V_b(k) = 1/12: over k = 0 to 3, 14 of 18 parts are of a.
    let indices = series.indices.as_ref().unwrap();
    assert!((indices[0].effect.total.estimate - 14.0 / 18.0).abs() < 0.02, "{indices:?}");
    assert!(page(&folder.path("out")).contains("id=\"output-1\""));
}

#[test]
fn a_list_of_the_wrong_length_is_not_an_answer() {
    let folder = Folder::new();
    folder.with("model.py", "import json, sys\nfor line in sys.stdin:\n    print(json.dumps({'id': json.loads(line)['id'], 'y': [1, 2, 3]}), flush=True)\n");
    let study = format!(
        "model = \"command\"\noutputs.y = {{ length = 4 }}\n{COMMAND}protocol = \"json-lines\"\n[design]\nbase_samples = 64\n{FACTORS}"
    );
    let (path, out) = (folder.with("s.toml", study), folder.path("out"));
    let output = apportion(&["run", text(&path), "--no-journal", "--out", text(&out)]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let result = read_result(&out.join("s.json")).unwrap();
    messages!().add("a list of 3", &result.outputs[0].failures[0].reason);
}

#[test]
fn a_program_that_runs_once_leaves_a_series_in_a_table() {
    let folder = Folder::new();
    folder.with("in.txt", "{{a}} {{b}}\n");
    let program = "a, b = map(float, open('in.txt').read().split())\n\
                   open('out.csv', 'w').write('t,y\\n' + ''.join(f'{k},{a * k + b}\\n' for k in range(4)))\n\
                   open('out.json', 'w').write(str({'y': [a * k + b for k in range(4)]}).replace(\"'\", '\"'))\n\
                   for k in range(4): print('z =', a * k + b)\n";
    let study = "outputs.table = { length = 4, file = \"out.csv\", column = \"y\" }\n\
                 outputs.json = { length = 4, file = \"out.json\", pointer = \"/y\" }\n\
                 outputs.printed = { length = 4, regex = 'z = (\\S+)' }\n\
                 [command]\nprogram = [\"python3\", \"model.py\"]\ntemplate = \"in.txt\"\nfiles = [\"model.py\"]\n";
    let study = format!("{study}\n[design]\nbase_samples = 8\n{FACTORS}").replace("[design]\nbase_samples = 8\n", "");
    let out = folder.path("out");
    folder.with("model.py", program);
    let path = folder.with("s.toml", format!("model = \"command\"\n{study}"));
    let set = ["--set", "design.base_samples=8", "--no-journal", "--out", text(&out)];
    succeed(&[&["run", text(&path)], &set[..]].concat());
    let result = read_result(&out.join("s.json")).unwrap();
    let names: Vec<&str> = result.series.iter().map(|series| series.name.as_str()).collect();
    assert_eq!(names, ["table", "json", "printed"]);
    let means =
        |series: usize| result.outputs[4 * series..][..4].iter().map(|output| output.mean.unwrap()).collect::<Vec<_>>();
    assert_eq!((means(0), means(0)), (means(1), means(2)));
    assert!((means(0)[3] - means(0)[0] - 3.0 * 0.5).abs() < 0.2, "{:?}", means(0));
    // In the settings a series is one output, by its length.
    assert_eq!(result.study.settings["outputs"]["json"]["length"], 4);
    assert_eq!(result.study.settings["outputs"]["json"]["pointer"], "/y");
}

#[test]
fn tables_have_a_column_for_each_value_or_one_header_for_all() {
    let folder = Folder::new();
    let study = format!(
        "model = \"external\"\n[outputs]\npeak = \"1\"\ny = {{ length = 3, axis = \"day\" }}\n[design]\nbase_samples = 64\n{FACTORS}"
    );
    let (study, design) = (folder.with("s.toml", study), folder.path("design.csv"));
    succeed(&["sample", text(&study), "-o", text(&design)]);
    let rows = std::fs::read_to_string(&design).unwrap();
    let answers = |header: &str| -> String {
        let answer = |row: &str| {
            let x: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
            format!("{},{},{},{}\n", x[0] + x[1], x[0], x[0] + x[1], x[1])
        };
        rows.lines().skip(1).fold(format!("{header}\n"), |text, row| text + &answer(row))
    };
    let mut results = Vec::new();
    for header in ["peak,y[0],y[1],y[2]", "peak,y[0..3]"] {
        let (data, out) = (folder.with("answers.csv", answers(header)), folder.path("out"));
        succeed(&["analyze", text(&data), "--design", text(&design), "--out", text(&out)]);
        let result = read_result(&out.join("s.json")).unwrap();
        assert_eq!(result.series[0].name, "y");
        results.push((result.outputs, result.series));
    }
    assert_eq!(results[0], results[1]);
    // A row that is shorter than the header says is refused by its line.
    let short = answers("peak,y[0..4]");
    let short = folder.with("answers.csv", short);
    messages!().refused(&["analyze", text(&short), "--design", text(&design)]);
}

#[test]
fn a_thousand_values_are_a_few_files_and_a_page_of_a_few_megabytes() {
    let folder = Folder::new();
    let program = python(
        "print(i, *[a * k * k / 1e6 + (1 - k / 1e3) * b + a * b * (k % 100) / 100 for k in range(1000)], sep=',', flush=True)",
    );
    let outputs = "outputs.y = { length = 1000, axis = \"time\", axis_unit = \"s\" }\n";
    let (result, printed) = run(&folder, &format!("{outputs}{COMMAND}"), &program);
    let (out, names) = (folder.path("out"), all_files(&folder.path("out")));
    assert!(names.len() < 40, "{names:?}");
    for chart in ["along", "together"] {
        assert!(names.contains(&format!("charts/s-{chart}.svg")), "{chart}: {names:?}");
    }
    let html = page(&out);
    assert!(html.len() < 3_000_000, "{} bytes", html.len());
    assert!(html.find("id=\"series-1\"").unwrap() < html.find("id=\"cost\"").unwrap());
    assert!(!html.contains("id=\"overview\""));
    assert!(printed.lines().count() < 120, "{printed}");
    let series = &result.series[0];
    assert!(series.indices.is_some());
    let csv = std::fs::read_to_string(out.join("s.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 2 * 1000 + 2);
    assert!(csv.lines().last().unwrap().starts_with("y,aggregate,b,"), "{csv}");
    // The same page can be drawn from the result only.
    succeed(&["report", text(&out.join("s.json")), "--out", text(&folder.path("again"))]);
    assert!(std::fs::read_to_string(folder.path("again/s.html")).unwrap() == html);
}

#[test]
fn the_epidemic_runs() {
    let folder = Folder::new();
    let study = study_path("epidemic/epidemic");
    let set =
        ["--set", "design.base_samples=64", "--no-journal", "--out", text(&folder.path("out"))].map(str::to_owned);
    let set: Vec<&str> = set.iter().map(String::as_str).collect();
    succeed(&[&["run", text(&study)], &set[..]].concat());
    let result = read_result(&folder.path("out/epidemic.json")).unwrap();
    assert_eq!((result.outputs.len(), result.series[0].positions.len()), (61, 60));
    // On day 0 the infected are the first cases, and nothing else.
    let first = result.outputs[0].indices.as_ref().unwrap();
    assert!((first[3].effect.first_order.estimate - 1.0).abs() < 1e-3 && first[0].effect.total.estimate.abs() < 1e-9);
    let names = all_files(&folder.path("out"));
    assert!(
        names.contains("charts/epidemic-infected-along.svg") && names.contains("charts/epidemic-peak-indices.svg"),
        "{names:?}"
    );
}

#[test]
fn errors_of_a_series_have_a_place() {
    let mut messages = messages!();
    let mut refused = |model: &str, outputs: &str, place: &str| {
        let program = if model == "command" { "command.program = [\"true\"]\n" } else { "" };
        let study = format!("model = \"{model}\"\n{outputs}\n{program}{FACTORS}");
        messages.refused_study(&Folder::new(), &format!("{model}: {outputs}"), &study, place);
    };
    for model in ["command", "external"] {
        for (outputs, place) in [
            ("outputs.y = { length = 1 }", "2:13"),
            ("outputs.y = { length = 1e9 }", "2:13"),
            ("outputs.y = { axis = \"day\" }", "2:13"),
            ("outputs.y = { length = 3, positions = [3, 2, 1] }", "2:13"),
            ("outputs.y = { lenght = 3 }", "2:13"),
            ("outputs.\"y[1]\" = \"1\"\noutputs.y = { length = 3 }", "2:1"),
            ("outputs.y = { length = 3 }\noutputs.\"y[1]\" = \"1\"", "2:1"),
        ] {
            refused(model, outputs, place);
        }
    }
    let pick = "command.template = \"s.toml\"\noutputs.y = { length = 3, column = \"y\", match = \"last\" }";
    refused("command", pick, "3:13");
}
