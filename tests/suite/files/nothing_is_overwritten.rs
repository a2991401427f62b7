//! No file of the user is overwritten: inputs, two outputs of one name, and existing files of other content.
#![cfg(unix)]

use std::path::Path;

use crate::common::{Folder, contents, succeed, text};
use crate::messages::{Messages, messages};

/// A study of a program with a template, files that it depends on, and measured values; the program is never started here.
const PROGRAM: &str = "model = \"command\"\n[outputs]\ny = { regex = 'y = (\\S+)' }\n[command]\nprogram = [\"sh\", \"model.sh\"]\n\
                       template = \"model.in\"\nfiles = [\"mesh.csv\", \"model.sh\"]\ndepends_on = [\"table.csv\"]\n[design]\nbase_samples = 8\n\
                       replicates = 1\n[factors]\na = { distribution = \"empirical\", file = \"data.csv\" }\nb = { min = 0, max = 1 }\n\
                       [[dependence]]\nfactors = [\"a\", \"b\"]\nfile = \"joint.csv\"\n";

const SMALL: &str = "model = \"ishigami\"\n[design]\nbase_samples = 64\n";

/// A command is refused, and no file in the folder has changed.
#[track_caller]
fn refused(messages: &mut Messages, folder: &Path, arguments: &[&str]) {
    let before = contents_of_files(folder);
    messages.refused(arguments);
    assert_eq!(contents_of_files(folder), before, "{arguments:?}");
}

/// Without the hidden lists of results.
fn contents_of_files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let name = entry.file_name().into_string().unwrap();
        if entry.path().is_dir() {
            files.extend(contents(&entry.path()).into_iter().map(|(file, bytes)| (format!("{name}/{file}"), bytes)));
        } else if !name.ends_with(".written") {
            files.push((name, std::fs::read(entry.path()).unwrap()));
        }
    }
    files.sort();
    files
}

#[test]
fn no_output_is_an_input_or_another_output() {
    let (folder, mut messages) = (Folder::new(), messages!());
    let study = folder.with("s.toml", PROGRAM);
    folder.with("model.sh", "#!/bin/sh\necho y = 1\n");
    folder.with("model.in", "{{a}} {{b}}\n");
    for name in ["mesh.csv", "table.csv"] {
        folder.with(name, "1\n2\n");
    }
    folder.with("data.csv", "1\n2\n3\n5\n");
    folder.with("points.csv", "a,b\n1,0.5\n");
    folder.with("joint.csv", "a,b\n1,0.3\n2,0.1\n3,0.5\n5,0.4\n7,0.9\n");
    std::os::unix::fs::symlink(folder.path("data.csv"), folder.path("link.csv")).unwrap();
    let (here, out, points) = (folder.path(""), folder.path("out"), folder.path("points.csv"));
    std::fs::create_dir(&out).unwrap();
    // The study is right.
    let points_of_study = folder.path("design.csv");
    succeed(&["sample", text(&study), "-o", text(&points_of_study)]);
    for name in ["data.csv", "joint.csv", "mesh.csv", "table.csv", "link.csv", "out/../data.csv"] {
        let output = folder.path(name);
        let run = ["run", text(&study), "--force", "--out", text(&out), "--save-outputs", text(&output)];
        refused(&mut messages, &here, &run);
        refused(&mut messages, &here, &["sample", text(&study), "--force", "-o", text(&output)]);
    }
    for name in ["s.toml", "model.in", "model.sh", "points.csv"] {
        let output = folder.path(name);
        refused(&mut messages, &here, &["evaluate", text(&study), text(&points), "--force", "-o", text(&output)]);
    }
    let small = folder.with("small.toml", SMALL);
    refused(&mut messages, &here, &["live", text(&small), "--force", "-o", text(&small)]);
    // The indices of the run would replace its outputs.
    let twice = out.join("small.csv");
    refused(&mut messages, &here, &["run", text(&small), "--out", text(&out), "--save-outputs", text(&twice)]);
}

#[test]
fn existing_files_are_replaced_if_they_are_unchanged_results() {
    let (folder, mut messages) = (Folder::new(), messages!());
    let study = folder.with("s.toml", SMALL);
    let here = folder.path("");
    let run = ["run", text(&study), "--out", text(&here), "--charts", "svg"];
    std::fs::create_dir(folder.path("charts")).unwrap();
    for name in ["s.csv", "s.json", "s.html", "s-convergence.csv", "charts/s-indices.svg"] {
        folder.with(name, "measured for years\n");
        refused(&mut messages, &here, &run);
        std::fs::remove_file(folder.path(name)).unwrap();
    }
    let notes = folder.with("s-notes.csv", "mine\n");
    for seed in ["1", "1", "3"] {
        succeed(&[&run[..], &["--seed", seed]].concat());
    }
    folder.with("s.csv", "edited\n");
    refused(&mut messages, &here, &run);
    succeed(&[&run[..], &["--force"]].concat());
    assert_eq!(std::fs::read_to_string(notes).unwrap(), "mine\n");
    // The page again, from the result alone in another folder.
    let alone = folder.path("alone");
    std::fs::create_dir(&alone).unwrap();
    std::fs::copy(folder.path("s.json"), alone.join("s.json")).unwrap();
    succeed(&["report", text(&alone.join("s.json"))]);
}

#[test]
fn outputs_elsewhere_are_replaced_if_a_result_lists_them() {
    let (folder, mut messages) = (Folder::new(), messages!());
    let here = folder.path("");
    let (study, out, saved) = (folder.with("s.toml", SMALL), folder.path("out"), folder.path("y.csv"));
    let run = ["run", text(&study), "--out", text(&out), "--charts", "none", "--save-outputs", text(&saved)];
    succeed(&run);
    succeed(&run);
    folder.with("y.csv", "measured\n");
    refused(&mut messages, &here, &run);
    let points = folder.with("p.csv", "x1,x2,x3\n1,1,1\n");
    let evaluate = ["evaluate", text(&study), text(&points), "-o", text(&saved)];
    refused(&mut messages, &here, &evaluate);
    succeed(&[&evaluate[..], &["--force"]].concat());
    let page = folder.with("page.html", "mine\n");
    let live = ["live", text(&study), "-o", text(&page)];
    refused(&mut messages, &here, &live);
    succeed(&[&live[..], &["--force"]].concat());
}
