//! Names of any kind, through the program: no file outside the folder, no file of another study, no name too long.

use std::time::{Duration, Instant};

use crate::common::{Folder, all_files, apportion, files, stderr, text};
use crate::messages::{Messages, messages};

/// A study of formulas with these outputs, all the sum of its two factors.
fn study(names: &[&str]) -> String {
    let outputs: String = names.iter().map(|name| format!("{} = \"a + b\"\n", toml::Value::from(*name))).collect();
    format!(
        "model = \"expression\"\n[design]\nbase_samples = 64\n[outputs]\n{outputs}[[factor]]\nname = \"a\"\nmin = 0\nmax = 1\n\
         [[factor]]\nname = \"b\"\nmin = 0\nmax = 2\n"
    )
}

#[track_caller]
fn refused(messages: &mut Messages, folder: &Folder, case: &str, arguments: &[&str]) {
    let begun = Instant::now();
    let message = messages.refused_as(case, arguments);
    assert!(message.len() < 4000 && begun.elapsed() < Duration::from_secs(60));
    assert!(!folder.path("EVIL.svg").exists() && !folder.path("EVIL-indices.svg").exists());
}

#[test]
fn no_name_of_an_output_leads_out_of_the_folder() {
    let folder = Folder::new();
    let (out, mut messages) = (folder.path("a/b/c/out"), messages!());
    for name in ["x/../../../../EVIL", "/tmp/EVIL", "..\\EVIL", "C:EVIL", "../EVIL"] {
        for other in [&[name][..], &[name, "y"]] {
            let path = folder.with("s.toml", study(other));
            for command in ["run", "check", "screen", "sweep"] {
                let case = format!("{command} {other:?}");
                refused(&mut messages, &folder, &case, &[command, text(&path), "--out", text(&out)]);
            }
        }
    }
    // Outputs from a file.
    let outside = "model = \"external\"\n[outputs]\ny = \"1\"\n[design]\nbase_samples = 8\n[[factor]]\nname = \"a\"\nmin = 0\nmax = 1\n";
    let (path, design) = (folder.with("e.toml", outside), folder.path("design.csv"));
    assert_eq!(apportion(&["sample", text(&path), "-o", text(&design)]).status.code(), Some(0));
    let points = std::fs::read_to_string(&design).unwrap();
    let answers: String = points.lines().skip(1).map(|line| format!("{line},{line}\n")).collect();
    let data = folder.with("answers.csv", format!("a,x/../../../../EVIL\n{answers}"));
    let outputs = ["--outputs", "x/../../../../EVIL", "--out", text(&out)];
    let analyze = [&["analyze", text(&data), "--design", text(&design)], &outputs[..]].concat();
    refused(&mut messages, &folder, "analyze", &analyze);
    // Names of columns that are no outputs of a study become plain names of files.
    let mut rows = "x1,../../EVIL,a/../../../../EVIL\n".to_owned();
    (0..64).for_each(|k| rows.push_str(&format!("{},{},{}\n", (k * 37 % 64), k, 64 - k)));
    let table = folder.with("table.csv", rows);
    let named = ["--outputs", "../../EVIL,a/../../../../EVIL", "--out", text(&out)];
    let output = apportion(&[&["given-data", text(&table)], &named[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(files(&out.join("charts")).contains("table-.._.._EVIL.svg"), "{:?}", all_files(&out));
    assert_eq!(files(&folder.path("a/b/c")).len(), 1);
}

#[test]
fn outputs_whose_files_would_be_the_same_have_files_of_their_own() {
    let folder = Folder::new();
    let names = ["y", "y-indices", "Y", "y-2", "y-indices-2"];
    let (path, out) = (folder.with("s.toml", study(&names)), folder.path("out"));
    let output = apportion(&["run", text(&path), "--out", text(&out)]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let there = all_files(&out);
    // Page, result, indices, convergence; and four charts of each output, twice.
    assert_eq!(there.len(), 4 + names.len() * 8, "{there:?}");
    assert_eq!(
        there.iter().map(|name| name.to_lowercase()).collect::<std::collections::BTreeSet<_>>().len(),
        there.len()
    );
    // Each chart is that of its output: the title names it.
    let title = |file: &str| std::fs::read_to_string(out.join(file)).unwrap();
    assert!(title("charts/s-y-indices.svg").contains(" y<"), "the chart of the indices of y");
    // The same again from the result, and from two of them.
    let (json, again) = (out.join("s.json"), folder.path("again"));
    assert_eq!(apportion(&["report", text(&json), "--out", text(&again)]).status.code(), Some(0));
    assert_eq!(all_files(&again).len(), 4 + names.len() * 8);
    let (both, screened) = (folder.path("both"), folder.path("screened"));
    assert_eq!(apportion(&["compare", text(&json), text(&json), "--out", text(&both)]).status.code(), Some(0));
    assert_eq!(all_files(&both).len(), 3 + names.len() * 4);
    assert_eq!(apportion(&["screen", text(&path), "--out", text(&screened)]).status.code(), Some(0));
    assert_eq!(all_files(&screened).len(), 3 + names.len() * 4);
}

#[test]
fn names_with_marks_that_are_not_seen_and_long_ones_are_refused_before_the_work() {
    let folder = Folder::new();
    let (out, mut messages) = (folder.path("out"), messages!());
    let mut run = |case: &str, content: String| {
        let path = folder.with("s.toml", content);
        refused(&mut messages, &folder, case, &["run", text(&path), "--out", text(&out)]);
        assert!(!out.exists());
    };
    let plain = study(&["y"]);
    let title = |text: &str| format!("title = {}\n{plain}", toml::Value::from(text));
    run("a long title", title(&"t".repeat(1 << 20)));
    run("a title that turns", title("a\u{202e}b"));
    for name in ["y\u{202e}z", "y\u{2066}", "y\u{200f}", "y\u{7}", "y\u{200b}"] {
        run(&format!("output {name:?}"), study(&[name]));
        let group = format!("name = \"b\"\ngroup = {}", toml::Value::from(name));
        run(&format!("group {name:?}"), plain.replace("name = \"b\"", &group));
    }
    run("a long output", study(&[&"y".repeat(1 << 20)]));
    run("a long name", format!("name = \"{}\"\n{plain}", "n".repeat(300)));
    // The longest that are allowed are drawn.
    let long = "w".repeat(200);
    let names = [long.as_str(), "y"];
    let longest = format!("title = \"{}\"\nname = \"{}\"\n{}", "title ".repeat(83), "n".repeat(120), study(&names));
    let path = folder.with("s.toml", longest);
    let output = apportion(&["run", text(&path), "--out", text(&out)]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(all_files(&out).len(), 4 + 2 * 8);
}

#[test]
fn a_hundred_thousand_factors_are_refused_at_once() {
    let folder = Folder::new();
    let factors: String = (0..100_000).map(|k| format!("[[factor]]\nname = \"x{k}\"\nmin = 0\nmax = 1\n")).collect();
    let path = folder.with("many.toml", format!("model = \"external\"\n[outputs]\ny = \"1\"\n{factors}"));
    refused(&mut messages!(), &folder, "check", &["check", text(&path)]);
}

/// Every key of a study that names a path, with one that leads out of the folder, by its name or through a link. Tables of
/// measured values may lie anywhere: nothing but numbers is read from them.
#[cfg(unix)]
#[test]
fn paths_outside_the_study_folder_need_files_outside() {
    const TEMPLATE: &str = "template = \"own.in\"\n";
    const KEYS: [(&str, &str, bool); 16] = [
        ("template = \"../secret.in\"", "", true),
        ("template = \"link.in\"", "", true),
        ("files = [\"../secret.in\"]", TEMPLATE, true),
        ("files = [\"link/secret.in\"]", TEMPLATE, true),
        ("keep = \"/tmp/x\"", TEMPLATE, true),
        ("keep = \"../../x\"", TEMPLATE, true),
        ("keep = \"new/../../x\"", TEMPLATE, true),
        ("keep = \"link\"", TEMPLATE, true),
        ("keep = \"link/new\"", TEMPLATE, true),
        ("keep = \"dangling\"", TEMPLATE, true),
        ("keep = \"runs/of/mine\"", TEMPLATE, false),
        ("depends_on = [\"../secret.in\"]", TEMPLATE, true),
        ("directory = \"..\"", TEMPLATE, true),
        ("outputs.z = { file = \"/etc/passwd\", regex = \"(.*)\" }", TEMPLATE, true),
        ("outputs.z = { file = \"../y.out\", regex = \"(.*)\" }", TEMPLATE, true),
        ("outputs.z = { file = \"out/y.out\", regex = \"(.*)\" }", TEMPLATE, false),
    ];
    let folder = Folder::new();
    let inner = folder.path("inner");
    std::fs::create_dir(&inner).unwrap();
    folder.with("secret.in", "{{a}}\n");
    folder.with("inner/own.in", "{{a}}\n");
    for (target, link) in [("../secret.in", "link.in"), ("..", "link"), ("../nowhere", "dangling")] {
        std::os::unix::fs::symlink(target, inner.join(link)).unwrap();
    }
    let load = |keys: &str, more: &str| {
        let (outputs, keys) = if keys.starts_with("outputs.") { (keys, "") } else { ("", keys) };
        let study = format!(
            "model = \"command\"\noutputs.y = {{ regex = \"(.*)\" }}\n{outputs}\n[command]\nprogram = [\"true\"]\n{keys}\n{more}\
             [[factor]]\nname = \"a\"\nmin = 0\nmax = 1\n"
        );
        apportion_files::load_study(&folder.with("inner/s.toml", study), &[]).map_err(|error| error.to_string())
    };
    let mut messages = messages!();
    for (keys, more, is_refused) in KEYS {
        let loaded = load(keys, more);
        assert_eq!(loaded.is_err(), is_refused, "{keys}");
        loaded.err().into_iter().for_each(|error| messages.add(keys, &error));
        if !keys.contains("dangling") {
            load(keys, &format!("files_outside = true\n{more}")).unwrap();
        }
    }
    folder.with("table.csv", "1\n2\n4\n7\n");
    let measured = "model = \"expression\"\noutputs.y = \"a\"\n[[factor]]\nname = \"a\"\n\
                    distribution = \"empirical\"\nfile = \"../table.csv\"\n";
    apportion_files::load_study(&folder.with("inner/s.toml", measured), &[]).unwrap();
}
