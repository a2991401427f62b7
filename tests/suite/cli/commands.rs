//! What a user does with results and studies besides running them: report, compare, new.

use std::path::Path;

use apportion::space::{Distribution, Factor};
use apportion::study::Study;
use apportion_files::{ModelKind, TemplateRequest, template};

use crate::common::{Folder, apportion, contents, stderr, study_path, succeed, text};
use crate::messages::messages;

fn run(study: &str, folder: &Path, changes: &[&str]) {
    let path = study_path(study);
    let mut arguments = vec!["run", text(&path), "--out", text(folder), "--base-samples", "256", "--no-journal"];
    changes.iter().for_each(|change| arguments.extend(["--set", change]));
    succeed(&arguments);
}

#[test]
fn report_draws_every_file_of_a_run_again_to_the_byte() {
    let folder = tempfile::tempdir().unwrap();
    for (study, changes) in
        [("soft-cantilever", vec![]), ("ishigami-second-order", vec!["analysis.estimators=['jansen']"])]
    {
        let (original, copy) = (folder.path().join(study), folder.path().join(format!("{study}-again")));
        run(study, &original, &changes);
        let before = contents(&original);
        assert!(before.keys().any(|name| name.starts_with("charts/")));
        let json = original.join(format!("{study}.json"));
        succeed(&["report", text(&json), "--out", text(&copy)]);
        assert_eq!(contents(&copy), before);
        // In its own folder: all but the result comes again.
        for name in before.keys().filter(|name| !name.ends_with(&format!("{study}.json"))) {
            std::fs::remove_file(original.join(name)).unwrap();
        }
        succeed(&["report", text(&json)]);
        assert_eq!(contents(&original), before);
    }
}

#[test]
fn report_overwrites_no_other_result_and_keeps_unknown_keys() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b) = (folder.path().join("a"), folder.path().join("b"));
    run("ishigami", &a, &[]);
    run("ishigami", &b, &["design.seed=7"]);
    let before = contents(&b);
    let json = a.join("ishigami.json");
    messages!().refused(&["report", text(&json), "--out", text(&b)]);
    assert_eq!(contents(&b), before);
    // A key of a later version is kept, since the result is copied unchanged.
    let later = std::fs::read_to_string(&json).unwrap().replacen('{', "{\n  \"later\": 1,", 1);
    std::fs::write(&json, &later).unwrap();
    let c = folder.path().join("c");
    succeed(&["report", text(&json), "--out", text(&c)]);
    assert_eq!(std::fs::read_to_string(c.join("ishigami.json")).unwrap(), later);
}

#[test]
fn invalid_result_files_are_refused_with_file_and_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.json");
    let mut messages = messages!();
    messages.refused(&["report", text(&path)]);
    for (content, place) in [
        ("{\n  \"format\": 3\n}", "line 2 column 13"),
        ("\u{feff}", "line 1 column 1"),
        ("{\"format\": \"apportion-screening\", \"version\": 1}", ""),
        ("{\"format\": \"apportion-result\", \"version\": 9}", ""),
    ] {
        std::fs::write(&path, content).unwrap();
        let message = messages.refused(&["report", text(&path)]);
        assert!(message.contains("x.json: ") && message.contains(place), "{message}");
        assert_eq!(stderr(&apportion(&["compare", text(&path), text(&path)])), message);
    }
    run("ishigami", folder.path(), &[]);
    let json = std::fs::read_to_string(folder.path().join("ishigami.json")).unwrap();
    std::fs::write(&path, json.replacen("\"name\": \"ishigami\"", "\"name\": \"../escaped\"", 1)).unwrap();
    messages.refused(&["report", text(&path)]);
    // At the end of a line: half of a number or of a letter has another message.
    let half = json[..json.floor_char_boundary(json.len() / 2)].rfind('\n').unwrap();
    std::fs::write(&path, &json.as_bytes()[..half]).unwrap();
    let cut = apportion(&["report", text(&path)]);
    let line = json[..half].lines().count();
    assert!(cut.status.code() == Some(2) && stderr(&cut).contains(&format!("line {line} ")), "{}", stderr(&cut));
    std::fs::write(&path, [0xff, 0xfe, 0x00]).unwrap();
    messages.refused(&["report", text(&path)]);
}

#[test]
fn compare_shows_differences_and_their_sizes() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b, out) = (folder.path().join("a"), folder.path().join("b"), folder.path().join("out"));
    run("soft-cantilever", &a, &[]);
    run("soft-cantilever", &b, &["afm.friction=hk", "factor.thickness.max=2.8", "design.seed=2"]);
    let (a, b) = (a.join("soft-cantilever.json"), b.join("soft-cantilever.json"));
    let said = succeed(&["compare", text(&a), text(&b), "--out", text(&out)]);
    for expected in ["friction", "coulomb", "hk", "factor thickness", "max 2.8", "seed", "critical time (s)"] {
        assert!(said.contains(expected), "{expected}: {said}");
    }
    // The studies have one name and the files too: their folders distinguish them.
    let written = contents(&out);
    let charts = ["critical_force", "critical_force-differences", "critical_time", "critical_time-differences"];
    for chart in
        charts.iter().flat_map(|chart| [format!("charts/a-vs-b-{chart}.svg"), format!("charts/a-vs-b-{chart}.png")])
    {
        assert!(written.contains_key(&chart), "{chart}: {:?}", written.keys());
    }
    assert_eq!(written.len(), 3 + 8);
    let json: serde_json::Value = serde_json::from_slice(&written["a-vs-b.json"]).unwrap();
    assert_eq!((&json["format"], &json["version"]), (&"apportion-comparison".into(), &1.into()));
    // Every number of the table is that of the results.
    let csv = String::from_utf8(written["a-vs-b.csv"].clone()).unwrap();
    let index = |json: &Path| {
        let result: serde_json::Value = serde_json::from_slice(&std::fs::read(json).unwrap()).unwrap();
        result["outputs"][0]["indices"][0]["total"]["estimate"].as_f64().unwrap()
    };
    let line = csv.lines().find(|line| line.starts_with("critical_force,factor,thickness,total,")).unwrap();
    let cells: Vec<f64> = line.split(',').skip(4).take(9).map(|cell| cell.parse().unwrap()).collect();
    assert_eq!((cells[0], cells[3], cells[6]), (index(&a), index(&b), index(&b) - index(&a)));
    // Labels of the user.
    let said = succeed(&["compare", text(&a), text(&b), "--out", text(&out), "--label-a", "dry", "--label-b", "humid"]);
    assert!(said.contains("A: dry") && said.contains("B: humid"), "{said}");
}

#[test]
fn compare_refuses_other_outputs_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    run("ishigami", folder.path(), &[]);
    run("coulomb-dimensional", folder.path(), &[]);
    let (a, b) = (folder.path().join("ishigami.json"), folder.path().join("coulomb-dimensional.json"));
    let out = folder.path().join("out");
    messages!().refused(&["compare", text(&a), text(&b), "--out", text(&out)]);
    assert!(!out.exists());
}

/// The commands that the program's own help lists.
fn commands() -> Vec<String> {
    let help = succeed(&["--help"]);
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names = listed.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names = names.filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help");
    names.map(str::to_owned).collect()
}

#[test]
fn completions_contain_every_command() {
    let commands = commands();
    assert!(commands.len() > 10, "{commands:?}");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = succeed(&["completions", shell]);
        for name in &commands {
            assert!(script.contains(name.as_str()), "{shell}: {name}");
        }
    }
    messages!().refused(&["completions", "tcsh"]);
}

/// bash accepts the script, and it completes.
#[test]
#[cfg(unix)]
fn bash_completes_with_the_script() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("apportion.bash");
    std::fs::write(&script, succeed(&["completions", "bash"])).unwrap();
    let ask = format!(
        "source {}; COMP_WORDS=(apportion comp); COMP_CWORD=1; _apportion apportion comp apportion; echo ${{COMPREPLY[@]}}",
        text(&script)
    );
    let Ok(answer) = std::process::Command::new("bash").args(["-c", &ask]).output() else { return };
    assert_eq!(String::from_utf8(answer.stdout).unwrap().trim(), "compare completions", "{:?}", answer.stderr);
}

#[test]
fn a_new_study_runs_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    for (name, more) in [
        ("force.toml", vec!["--factors", "thickness,velocity", "--outputs", "critical_force,critical_time"]),
        ("g.toml", vec!["--model", "sobol-g"]),
        ("quoted.toml", vec!["--title", "the \"first\" try"]),
    ] {
        let study = folder.path().join(name);
        succeed(&[&["new", text(&study)][..], &more].concat());
        let checked = apportion(&["check", text(&study)]);
        assert_eq!(checked.status.code(), Some(0), "{}", stderr(&checked));
        assert!(!stderr(&checked).contains("note:"), "{}", stderr(&checked));
        succeed(&["run", text(&study), "--out", text(&out), "--base-samples", "256"]);
    }
    let written = std::fs::read_to_string(folder.path().join("force.toml")).unwrap();
    assert!(written.contains("outputs = [\"critical_force\", \"critical_time\"]") && written.contains(", nominal "));
}

#[test]
fn a_problem_of_another_tool_becomes_a_study() {
    let (folder, mut messages) = (Folder::new(), messages!());
    let study = folder.path("study.toml");
    let factors = |name: &str, content: &str| {
        succeed(&["new", text(&study), "--force", "--problem", text(&folder.with(name, content))]);
        let study = apportion_files::load_study(&study, &[]).unwrap();
        assert_eq!((study.subject().name(), study.notes().len()), ("external", 0));
        study.space().factors().to_vec()
    };
    let of_group = |factor: &Factor| factor.group.clone().unwrap_or_default();
    let plain = factors("a.txt", "# name low high\nP1 0.0 1.0\n\nP2\t-5e-1   2\n");
    assert_eq!(plain[1].distribution(), &Distribution::uniform(-0.5, 2.0).unwrap());
    let full = factors("b.txt", "P1,0,1,G,unif\nP2,3,0.5,G,norm\nsome name,1,2,NA,logunif\nP4,0,1,alone\n");
    assert_eq!(full.iter().map(of_group).collect::<Vec<_>>(), ["G", "G", "", "alone"]);
    assert_eq!(full[1].distribution(), &Distribution::normal(3.0, 0.5).unwrap());
    assert_eq!((&*full[2].name, full[2].distribution()), ("some name", &Distribution::log_uniform(1.0, 2.0).unwrap()));
    let json = r#"{"num_vars": 3, "names": ["a", "b", "c"], "groups": ["g", "g", "h"],
        "bounds": [[0, 10, 0.2], [1, 4, 2, 0.5], [0.5, 0.25]], "dists": ["triang", "truncnorm", "lognorm"]}"#;
    let json = factors("c.json", json);
    assert_eq!(json.iter().map(of_group).collect::<Vec<_>>(), ["g", "g", "h"]);
    let expected = [
        Distribution::triangular(0.0, 2.0, 10.0),
        Distribution::truncated_normal(2.0, 0.5, 1.0, 4.0),
        Distribution::log_normal_of_logs(0.5, 0.25),
    ];
    for (factor, expected) in json.iter().zip(expected) {
        assert_eq!(factor.distribution(), &expected.unwrap());
    }
    let csv = factors("d.csv", "Unit;Max;Min;Parameter\nEUR/kWh;3;1;price\n;2;1;\"k;1\"\n");
    assert_eq!((csv[0].unit().symbol(), csv[0].distribution().support()), ("EUR/kWh", (1.0, 3.0)));
    assert_eq!((csv[1].unit().symbol(), &*csv[1].name), ("1", "k;1"));
    for (number, content) in [
        "",
        "P1 0 high",
        "P1 0",
        "P1 3 1",
        "P1 0 1 G gamma",
        "P1 0 1 G triang",
        "name,min,max,baseline\nP1,0,1,0.5",
        "{'names': ['a']}",
        r#"{"names": ["a", "b"], "bounds": [[0, 1]]}"#,
        "P1 0 1\nP1 0 2",
    ]
    .into_iter()
    .enumerate()
    {
        let problem = folder.with(&format!("wrong{number}"), content);
        messages.refused(&["new", text(&folder.path("other.toml")), "--problem", text(&problem)]);
    }
    let problem = folder.with("e.txt", "P1 0 1\n");
    messages.refused(&["new", text(&folder.path("other.toml")), "--model", "ishigami", "--problem", text(&problem)]);
    assert!(!folder.path("other.toml").exists());
}

#[test]
fn new_overwrites_no_file_and_names_unknown_inputs() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    std::fs::write(&study, "mine").unwrap();
    let mut messages = messages!();
    messages.refused(&["new", text(&study)]);
    assert_eq!(std::fs::read_to_string(&study).unwrap(), "mine");
    succeed(&["new", text(&study), "--force"]);
    assert!(std::fs::read_to_string(&study).unwrap().contains("[factors]"));

    let other = folder.path().join("other.toml");
    for more in [
        &["--factors", "thicknes"][..],
        &["--outputs", "critical_force,critical_force"],
        &["--factors", "length,length"],
        &["--outputs", "force"],
        &["--model", "ishigam"],
        &["--model", "command", "--factors", "a,"],
    ] {
        messages.refused(&[&["new", text(&other)], more].concat());
    }
    assert!(!other.exists());
    messages.refused(&["new", text(&folder.path().join("none/study.toml"))]);
    // The suggested next commands work.
    let spaced = folder.path().join("my own.toml");
    messages.ended("a space in the name", 0, &apportion(&["new", text(&spaced), "--model", "expression"]));
}

fn studied(request: &TemplateRequest) -> Study {
    let text = template(request).unwrap_or_else(|problem| panic!("{request:?}: {problem}"));
    let study = apportion_files::parse_study(&text, Path::new("new.toml"), &[]);
    let study = study.unwrap_or_else(|error| panic!("{request:?}: {error}\n{text}"));
    assert!(study.notes().is_empty(), "{:?}", study.notes());
    study
}

fn request(model: ModelKind) -> TemplateRequest {
    TemplateRequest { model, title: None, factors: Vec::new(), tables: Vec::new(), outputs: Vec::new() }
}

#[test]
fn every_input_can_be_a_factor_and_every_output_asked_for() {
    for model in ModelKind::all() {
        assert_eq!(studied(&request(model)).subject().name(), model.name);
        let outputs: Vec<String> = model.outputs().iter().map(|output| output.name.to_string()).collect();
        for input in model.inputs() {
            let title = "a \"quoted\" \\ title\nof two lines";
            let (factors, title) = (vec![input.name.clone()], Some(title.to_owned()));
            let study =
                studied(&TemplateRequest { factors, outputs: outputs.clone(), title: title.clone(), ..request(model) });
            assert_eq!(study.space().factors()[0].name, input.name);
            assert_eq!(study.title(), title.as_deref());
        }
    }
}

#[test]
fn arguments_are_typed_as_a_shell_reads_them() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("it's $HOME")).unwrap();
    for (name, typed) in [
        ("my-study.toml", "my-study.toml"),
        ("my study.toml", "'my study.toml'"),
        ("it's $HOME/study.toml", r"'it'\''s $HOME/study.toml'"),
    ] {
        let mut program = assert_cmd::Command::cargo_bin("apportion").unwrap();
        let output = program.current_dir(folder.path()).args(["new", name, "--model", "ishigami"]).output().unwrap();
        let next = format!("`apportion check {typed}` and `apportion run {typed}`");
        assert!(stderr(&output).contains(&next), "{}", stderr(&output));
    }
}

/// A positive input may be log-normal, whose values come close to 0 without reaching it.
#[test]
fn a_positive_input_may_be_log_normal() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let factor = "[[factor]]\nname = 'adhesion'\nunit = 'mJ/m2'\n";
    std::fs::write(&study, format!("{factor}distribution = 'log-normal'\nmean = 200\nsd = 40")).unwrap();
    succeed(&["check", text(&study)]);
    std::fs::write(&study, format!("{factor}distribution = 'weibull'\nshape = 2\nscale = 200\nlocation = -1")).unwrap();
    messages!().refused(&["check", text(&study)]);
}
