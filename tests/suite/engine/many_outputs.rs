//! Studies with many outputs: an overview, few files, a page that a browser opens at once.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::common::{Folder, all_files, apportion, stderr, stdout, succeed, text};
use crate::messages::messages;

/// A wave with three influential factors and one with little effect, at so many times; the output `flat` does not vary.
fn study(outputs: usize, more: &str) -> String {
    let output = |k: usize| {
        let time = k as f64 / outputs as f64;
        format!("\"wave[{k}]\" = \"a * exp(-3 * {time} * b) + {time} * c * (1 + a) + 0.01 * d\"\n")
    };
    let outputs: String = (0..outputs).map(output).collect();
    let factor = |name: &str| format!("[[factor]]\nname = \"{name}\"\nmin = 0\nmax = 1\n");
    let factors: String = ["a", "b", "c", "d"].map(factor).concat();
    format!("model = \"expression\"\n{more}[outputs]\n{outputs}{factors}")
}

/// Runs the study `content` and gives the folder of its files.
#[track_caller]
fn run(folder: &Folder, content: &str, more: &[&str]) -> (PathBuf, String) {
    let (study, out) = (folder.with("s.toml", content), folder.path("out"));
    let printed = succeed(&[&["run", text(&study), "--out", text(&out), "--no-journal"], more].concat());
    (out, printed)
}

fn page(out: &Path) -> String {
    std::fs::read_to_string(out.join("s.html")).unwrap()
}

#[test]
fn a_thousand_outputs_are_a_few_files_and_a_page_of_a_few_megabytes() {
    let folder = Folder::new();
    let (out, printed) =
        run(&folder, &study(1000, "[design]\nbase_samples = 128\n[analysis]\nsurrogate = \"on\"\n"), &[]);
    let files = all_files(&out);
    let expected = ["s.html", "s.json", "s.csv", "s-convergence.csv", "charts/s-map.svg", "charts/s-together.png"];
    assert!(files.len() < 40 && expected.iter().all(|file| files.contains(*file)), "{files:?}");
    let page = page(&out);
    assert!(page.len() < 3_000_000, "{} bytes", page.len());
    assert!(page.find("All outputs at a glance").unwrap() < page.find("Every output").unwrap());
    assert!(printed.lines().count() < 120, "{printed}");
    // Nothing is lost.
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(out.join("s.json")).unwrap()).unwrap();
    let outputs = json["outputs"].as_array().unwrap();
    assert_eq!(outputs.len(), 1000);
    assert!(
        outputs.iter().all(|output| output["indices"].as_array().unwrap().len() == 4 && output["scatter"].is_null())
    );
    assert!(outputs.iter().all(|output| output["surrogate"]["explained"].as_f64().unwrap() > 0.999));
    let csv = std::fs::read_to_string(out.join("s.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 4 * 1000 + 4);
    assert!(csv.lines().last().unwrap().starts_with("all outputs,aggregate,d,"), "{csv}");
    // The same page can be drawn from the result only.
    succeed(&["report", text(&out.join("s.json")), "--out", text(&folder.path("again"))]);
    assert!(std::fs::read_to_string(folder.path("again/s.html")).unwrap() == page);
}

#[test]
fn up_to_eleven_outputs_have_files_and_sections_of_their_own() {
    let design = "[design]\nbase_samples = 64\n";
    let charts =
        |out: &Path| all_files(out).into_iter().filter(|name| name.starts_with("charts/")).collect::<BTreeSet<_>>();
    let folder = Folder::new();
    let (out, printed) = run(&folder, &study(11, design), &[]);
    assert_eq!(charts(&out).len(), 11 * 4 * 2);
    assert!(page(&out).contains("id=\"output-11\""));
    messages!().add_printed("11 outputs", &printed);
    assert!(!std::fs::read_to_string(out.join("s.csv")).unwrap().contains("aggregate"));
    let folder = Folder::new();
    let (out, _) = run(&folder, &study(12, design), &[]);
    let expected = ["charts/s-map.png", "charts/s-map.svg", "charts/s-together.png", "charts/s-together.svg"];
    assert_eq!(charts(&out), expected.map(str::to_owned).into());
    assert!(page(&out).contains("id=\"overview\"") && !page(&out).contains("id=\"output-1\""));
}

#[test]
fn the_same_numbers_on_any_number_of_threads() {
    // So many share the terms of their surrogates.
    let content = study(70, "[design]\nbase_samples = 64\n[analysis]\nsurrogate = \"on\"\n");
    let table = |threads: &str| {
        let folder = Folder::new();
        let (out, _) = run(&folder, &content, &["--threads", threads, "--charts", "none"]);
        ["s.csv", "s-convergence.csv"].map(|name| std::fs::read_to_string(out.join(name)).unwrap())
    };
    assert!(table("1") == table("7"));
}

#[cfg(unix)]
#[test]
fn a_signal_takes_effect_after_the_result_is_written() {
    use std::io::Read;
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    let folder = Folder::new();
    let (study, out) = (folder.with("s.toml", study(1500, "[design]\nbase_samples = 128\n")), folder.path("out"));
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("apportion"));
    command.args(["run", text(&study), "--out", text(&out), "--no-journal"]);
    let mut run = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let begun = Instant::now();
    while !out.join("s.json").exists() {
        assert!(begun.elapsed() < Duration::from_secs(240));
        if let Some(code) = run.try_wait().unwrap() {
            // On a busy machine the run may end between two checks.
            assert!(code.success());
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(Command::new("kill").args(["-INT", &run.id().to_string()]).status().unwrap().success());
    let heard = Instant::now();
    let code = run.wait().unwrap().code();
    assert!(heard.elapsed() < Duration::from_secs(30), "{:?}", heard.elapsed());
    let mut said = String::new();
    run.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    // A busy machine may have drawn the page before the signal came.
    if !out.join("s.html").exists() {
        assert_eq!(code, Some(1), "{said}");
    }
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(out.join("s.json")).unwrap()).unwrap();
    assert_eq!(json["outputs"].as_array().unwrap().len(), 1500);
    assert!(!all_files(&out).iter().any(|name| name.contains(".apportion-")));
}

#[test]
fn outputs_that_differ_only_by_name_have_rows() {
    let folder = Folder::new();
    let names =
        ["mass", "cost", "stress", "drag", "lift", "range", "noise", "fuel", "speed", "climb", "load", "heat", "flat"];
    let output = |(k, name): (usize, &&str)| match *name {
        "flat" => "flat = \"1\"\n".to_owned(),
        _ => format!("{name} = \"a^{} + {k} * b * c\"\n", 1 + k % 3),
    };
    let outputs: String = names.iter().enumerate().map(output).collect();
    let factors: String =
        ["a", "b", "c"].map(|name| format!("[[factor]]\nname = \"{name}\"\nmin = 0\nmax = 1\n")).concat();
    let content = format!("model = \"expression\"\n[design]\nbase_samples = 64\n[outputs]\n{outputs}{factors}");
    let (out, printed) = run(&folder, &content, &[]);
    let map = std::fs::read_to_string(out.join("charts/s-map.svg")).unwrap();
    assert!(names.iter().all(|name| map.contains(&format!(">{name}</text>"))), "{map}");
    messages!().add_printed("13 outputs", &printed);
}

#[test]
fn failures_of_many_outputs_are_reported_once() {
    let folder = Folder::new();
    let outputs: String = (0..20).map(|k| format!("y{k} = \"sqrt(a - 0.01) + {k} * b\"\n")).collect();
    let factors: String = ["a", "b"].map(|name| format!("[[factor]]\nname = \"{name}\"\nmin = 0\nmax = 1\n")).concat();
    let content = format!("model = \"expression\"\n[design]\nbase_samples = 128\n[outputs]\n{outputs}{factors}");
    let study = folder.with("s.toml", content);
    let out = folder.path("out");
    let output = apportion(&["run", text(&study), "--out", text(&out), "--no-journal"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let printed = stdout(&output);
    assert!(printed.lines().count() < 60, "{printed}");
    messages!().add_printed("20 outputs", &printed);
}
