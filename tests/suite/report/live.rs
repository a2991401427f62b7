//! `apportion live`: interactive pages. Their computations are tested in a browser (`tests/browser/live.py`).

use serde_json::Value;

use crate::common::{Folder, all_files, apportion, stderr, study_path, succeed, text};
use crate::messages::messages;

/// The text of the element `id` of a page.
fn element<'a>(page: &'a str, id: &str) -> &'a str {
    let begin = page.find(&format!("id=\"{id}\">")).expect("the element is there") + id.len() + 6;
    &page[begin..begin + page[begin..].find("</").expect("the element ends")]
}

fn presets(page: &str) -> Vec<(String, String)> {
    let study: Value = serde_json::from_str(element(page, "study")).unwrap();
    let preset =
        |preset: &Value| (preset["title"].as_str().unwrap().to_owned(), preset["text"].as_str().unwrap().to_owned());
    study["presets"].as_array().unwrap().iter().map(preset).collect()
}

#[test]
fn a_page_has_the_engine_the_study_as_it_was_changed_and_its_result() {
    let folder = Folder::new();
    let page = folder.path("new/live.html");
    let study = study_path("soft-cantilever");
    let out = ["-o", text(&page)];
    let changes = ["--set", "factor.thickness.min=1.5", "--set", "factor.velocity=60 nm/s", "--base-samples", "256"];
    succeed(&[&["live", text(&study)], &changes[..], &out[..]].concat());
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.len() < 2_000_000, "{} bytes", page.len());
    assert!(element(&page, "engine").len() > 500_000);
    for part in ["Permission is hereby granted", "Stephen Joe", "nalgebra "] {
        assert!(element(&page, "licences").contains(part), "{part}");
    }
    let presets = presets(&page);
    assert_eq!(presets.len(), 4, "its own, and the papers' three: the soft cantilever is its own");
    let (title, own) = &presets[0];
    assert_eq!(title, "Soft cantilever in humid air");
    assert!(own.contains("min = 1.5") && own.contains("velocity = \"60 nm/s\"") && own.contains("base_samples = 256"));
    assert!(!own.contains("name = \"velocity\""));
    for id in ["indices", "distribution", "validity"] {
        assert!(page.contains(&format!("<section id=\"{id}\"")), "{id}");
    }
}

#[test]
fn a_study_of_series_has_a_page() {
    let folder = Folder::new();
    let page = folder.path("live.html");
    let outputs = ["--set", "outputs=[\"force_history\", \"position_history\"]"];
    let out = ["--base-samples", "64", "-o", text(&page)];
    succeed(&[&["live", text(&study_path("push-history"))], &outputs[..], &out[..]].concat());
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.contains("<section id=\"series-1\"") && !page.contains("<section id=\"series-2\""));
}

#[test]
fn only_live_writes_a_live_page() {
    let folder = Folder::new();
    let to = folder.path("out");
    let out = ["--charts", "none", "--base-samples", "256", "--out", text(&to)];
    let done = stderr(&apportion(&[&["run", text(&study_path("ishigami"))], &out[..]].concat()));
    assert!(done.contains("ishigami.html") && !done.contains("live"), "{done}");
    assert!(all_files(&to).iter().all(|file| !file.contains("live")));
    assert!(!std::fs::read_to_string(to.join("ishigami.html")).unwrap().contains("apportion live"));
}

#[test]
fn a_run_that_decides_its_own_length_gets_that_of_the_page() {
    let folder = Folder::new();
    let page = folder.path("live.html");
    succeed(&["live", text(&study_path("sobol-g-target")), "-o", text(&page)]);
    let presets = presets(&std::fs::read_to_string(page).unwrap());
    assert_eq!(presets.len(), 1);
    assert!(!presets[0].1.contains("half_width") && !presets[0].1.contains("max_runs ="), "{}", presets[0].1);
}

#[test]
fn a_title_does_not_break_out_of_the_page() {
    let folder = Folder::new();
    let study =
        "title = \"</script><script>alert(1)</script>\"\nmodel = \"ishigami\"\n[factors.x1]\nmin = 0\nmax = 1\n";
    let study = folder.with("s.toml", study);
    let page = folder.path("live.html");
    succeed(&["live", text(&study), "--base-samples", "64", "-o", text(&page)]);
    let page = std::fs::read_to_string(page).unwrap();
    assert!(!page.contains("<script>alert"));
    assert_eq!(presets(&page)[0].0, "</script><script>alert(1)</script>");
}

#[test]
fn studies_that_a_page_cannot_run_are_refused() {
    let folder = Folder::new();
    let page = folder.path("live.html");
    let mut messages = messages!();
    for study in ["command-python/command-python", "epidemic/epidemic"] {
        messages.refused(&["live", text(&study_path(study)), "-o", text(&page)]);
        assert!(!page.exists());
    }
}
