//! A program that changes under its journal: no result mixes two models in silence.

use std::path::PathBuf;
use std::process::Output;

use apportion::report::{ResultFile, read_result};

use crate::common::{Folder, apportion, stderr, text};

const STUDY: &str = "model = \"command\"\ncommand = [\"python3\", \"model.py\"]\noutputs = [\"y\"]\n\
                     design.base_samples = 64\n\
                     [[factor]]\nname = \"a\"\nmin = 0\nmax = 1\n[[factor]]\nname = \"b\"\nmin = 0\nmax = 2\n";

/// Runs of the study: 64 base points of A, B and two swaps.
const RUNS: u64 = 256;

fn program(formula: &str) -> String {
    format!(
        "import csv, sys\nfor x in csv.DictReader(sys.stdin):\n    a, b = float(x['a']), float(x['b'])\n    print(x['id'], {formula}, sep=',', flush=True)\n"
    )
}

struct Case {
    folder: Folder,
}

impl Case {
    fn new(formula: &str) -> Self {
        let case = Self { folder: Folder::new() };
        case.folder.with("study.toml", STUDY);
        case.model(formula);
        case
    }

    fn model(&self, formula: &str) {
        self.folder.with("model.py", program(formula));
    }

    fn out(&self) -> PathBuf {
        self.folder.path("out")
    }

    fn run(&self, more: &[&str]) -> Output {
        let (study, out) = (self.folder.path("study.toml"), self.out());
        apportion(&[&["run", text(&study), "--out", text(&out)], more].concat())
    }

    #[track_caller]
    fn result(&self, more: &[&str]) -> (ResultFile, String) {
        let output = self.run(more);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        (read_result(&self.out().join("study.json")).unwrap(), stderr(&output))
    }

    #[track_caller]
    fn refused(&self, more: &[&str], expected: &str) {
        let output = self.run(more);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{}", stderr(&output));
    }
}

#[test]
fn edited_resumed_reverted_resumed_is_never_a_silent_mixture() {
    const DOUBLE: [&str; 2] = ["--base-samples", "128"];
    let with = |more: &'static str| [&DOUBLE[..], &[more]].concat();
    let case = Case::new("a + b");
    case.result(&[]);
    // Edited.
    case.model("a + b + 10");
    let refusal = format!("model.py changed since {RUNS} of the runs on record were evaluated");
    case.refused(&with("--resume"), &refusal);
    case.refused(&with("--retry-failed"), &refusal);
    let (mixed, said) = case.result(&[&DOUBLE[..], &["--resume", "--mix-models"]].concat());
    assert!(
        said.contains(&format!("warning: {RUNS} of the runs on record were evaluated with another model.py")),
        "{said}"
    );
    let noted = &mixed.provenance.mixed_models;
    assert_eq!((noted.len(), noted[0].files.as_str(), noted[0].runs), (1, "model.py", Some(RUNS)));
    assert!(mixed.outputs[0].warnings.iter().any(|warning| warning.contains("the numbers mix two models")));
    let page = std::fs::read_to_string(case.out().join("study.html")).unwrap();
    assert!(page.contains("mix two models") && page.contains("another version of the model"));
    // Reverted: the other half is the stranger now.
    case.model("a + b");
    case.refused(&with("--resume"), &refusal);
    let (plain, said) = case.result(&DOUBLE);
    assert!(said.contains("were evaluated with another model.py: they are evaluated again"), "{said}");
    let fresh = Case::new("a + b").result(&DOUBLE).0;
    assert_eq!((plain.outputs, plain.provenance.mixed_models.len()), (fresh.outputs, 0));
    // And all is well again.
    let (again, said) = case.result(&with("--resume"));
    assert!(said.contains(&format!("note: {} of {} runs are on record", 2 * RUNS, 2 * RUNS)), "{said}");
    assert!(again.provenance.mixed_models.is_empty());
    assert!(
        !again.outputs[0].warnings.iter().any(|warning| warning.contains("mix")),
        "{:?}",
        again.outputs[0].warnings
    );
}

#[test]
fn a_journal_all_of_another_model_makes_way() {
    let case = Case::new("a + b");
    case.result(&[]);
    case.model("a - b");
    let (result, said) = case.result(&[]);
    assert!(said.contains("model.py changed since the journal was written: the journal was moved to "), "{said}");
    assert_eq!(result.outputs, Case::new("a - b").result(&[]).0.outputs);
}

#[test]
fn a_program_that_changes_under_the_run_is_noticed() {
    let case = Case::new("a + b");
    // It changes itself in the middle, as an editor would.
    let text = program("a + b").replace(
        "    print(",
        "    count = globals().get('count', 0) + 1\n    if count == 40: open('model.py', 'a').write('# edited\\n')\n    print(",
    );
    case.folder.with("model.py", text);
    let (result, _) = case.result(&["--threads", "1"]);
    let noted = &result.provenance.mixed_models;
    assert_eq!((noted.len(), noted[0].files.as_str(), noted[0].runs), (1, "model.py", None));
    assert!(result.outputs[0].warnings[0].contains("model.py changed while the run was under way"));
    // Which rows are of which version nobody knows: neither counts as the one of now.
    case.refused(&["--resume"], "model.py changed since");
}

/// Parts of a mixture are not merged, however they came about.
#[test]
fn a_part_is_of_one_model() {
    let case = Case::new("a + b");
    assert_eq!(case.run(&["--shard", "1/2"]).status.code(), Some(0));
    case.model("a - b");
    assert_eq!(case.run(&["--shard", "2/2"]).status.code(), Some(0));
    let (study, out) = (case.folder.path("study.toml"), case.out());
    let merged = apportion(&["merge", text(&study), "--out", text(&out)]);
    assert_eq!(merged.status.code(), Some(2), "{}", stderr(&merged));
    assert!(stderr(&merged).contains("evaluated with another model.py than"), "{}", stderr(&merged));
}

/// However the command comes to it, a file that computes the answers is one of the model's.
#[test]
fn sources_that_a_program_names_or_imports_are_its_own() {
    let (of_helper, script) =
        ("helper.f(a, b)", "#!/bin/sh\n# Reads and writes as it is told.\nexec python3 model.py\n");
    let helper = |number: u64| format!("def f(a, b): return a + b + {number}\n");
    let ways: [(&str, &str, &str); 5] = [
        ("[\"python3\", \"model.py\"]", "import helper\n", "helper.py"),
        ("[\"python3\", \"-m\", \"model\"]", "import helper\n", "helper.py"),
        ("[\"sh\", \"-c\", \"exec python3 model.py\"]", "import helper\n", "helper.py"),
        ("[\"sh\", \"run.sh\"]", "import helper\n", "helper.py"),
        // Nothing tells of this one but the study.
        ("[\"python3\", \"model.py\"]", "helper = __import__('hel' + 'per')\n", "helper.py"),
    ];
    for (place, (command, import, changed)) in ways.into_iter().enumerate() {
        let case = Case::new(of_helper);
        let of_study = if place == 4 { "command.depends_on = [\"helper.py\"]\n" } else { "" };
        let command = format!("command.program = {command}\n{of_study}");
        case.folder.with("study.toml", STUDY.replace("command = [\"python3\", \"model.py\"]\n", &command));
        case.folder.with("model.py", format!("{import}{}", program(of_helper)));
        case.folder.with("run.sh", script);
        case.folder.with("helper.py", helper(0));
        case.result(&[]);
        case.folder.with("helper.py", helper(1_000_000));
        case.refused(&["--resume", "--base-samples", "128"], &format!("{changed} changed since {RUNS} of the runs"));
    }
    let case = Case::new("a + b");
    let nowhere = "command.program = [\"python3\", \"model.py\"]\ncommand.depends_on = [\"nowhere.dat\"]\n";
    case.folder.with("study.toml", STUDY.replace("command = [\"python3\", \"model.py\"]\n", nowhere));
    case.refused(&[], "there is no such file");
}
