//! Takes the blocks of a page in order.

use std::process::Command;
use std::sync::OnceLock;

use jsonschema::Validator;
use serde_json::Value;

use super::page::{Block, Page, Role};
use super::update;
use crate::common::{Folder, search_path, succeed, text};

/// Errors of a page, each with its place. `BOOK=update` in the environment puts outputs that differ into the page.
pub fn faults(page: &Page) -> Vec<String> {
    let is_update = std::env::var("BOOK").is_ok_and(|wish| wish == "update");
    let mut corrections = Vec::new();
    let mut faults = page.faults.clone();
    let folder = Folder::new();
    let studies = crate::common::root().join("studies");
    std::os::unix::fs::symlink(studies, folder.path("studies")).unwrap();
    let mut printed: Option<String> = None;
    for block in &page.blocks {
        let fault = match (&block.role, block.language.as_str()) {
            (Role::NotRun, _) => None,
            (Role::File(name), _) => write(&folder, name, &block.text),
            (Role::Output, "text") => match &printed {
                Some(printed) => {
                    let fault = compare(&block.text, printed);
                    if is_update && fault.is_some() {
                        corrections.push((block, update::corrected(&block.text, printed)));
                    }
                    fault
                }
                // Of a block of Python.
                None => None,
            },
            (Role::Plain, "sh") => run(&folder, block, 0, &mut printed),
            (Role::Exit(code), "sh") => run(&folder, block, *code, &mut printed),
            (Role::Plain, "toml") => fragment(&block.text),
            (Role::Plain, "rust") => in_an_example(&block.text),
            (Role::Plain, "python") => {
                printed = None;
                None
            }
            (Role::Plain, "text" | "json" | "csv") => None,
            (role, language) => Some(format!("nobody knows what to do with {role:?} in `{language}`")),
        };
        faults.extend(fault.map(|fault| format!("{}:{}: {fault}", page.name, block.line)));
    }
    if !corrections.is_empty() {
        update::write(page, &corrections);
    }
    faults
}

fn write(folder: &Folder, name: &str, content: &str) -> Option<String> {
    let path = folder.path(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    let is_program = content.starts_with("#!");
    folder.with(name, content);
    if is_program {
        Command::new("chmod").args(["+x", text(&path)]).status().unwrap();
    }
    None
}

fn run(folder: &Folder, block: &Block, code: i32, printed: &mut Option<String>) -> Option<String> {
    // The program is two folders above the tests, which are in `deps`.
    let tests = std::env::current_exe().unwrap();
    let path = format!("{}:{}", text(tests.ancestors().nth(2).unwrap()), search_path().to_str().unwrap());
    let script = format!("exec 2>&1\n{}", block.text);
    let mut shell = Command::new("sh");
    let output = shell.args(["-euc", &script]).env("PATH", path).current_dir(folder.path("")).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let ended = output.status.code();
    let fault = (ended != Some(code)).then(|| format!("ended with {ended:?}:\n{}{said}", block.text));
    *printed = Some(said);
    fault
}

/// A `...` among the lines of `shown` stands for any lines of what was printed, `[..]` in a line for anything.
fn compare(shown: &str, printed: &str) -> Option<String> {
    let lines = |text: &str| text.lines().map(|line| line.trim_end().to_owned()).collect::<Vec<_>>();
    let (expected, actual) = (lines(shown), lines(printed));
    let mut first_left = expected.len();
    (!are_alike(&expected, &actual, &mut first_left)).then(|| {
        let line = expected.len() - first_left;
        let missed = expected.get(line).map_or("(the end)", String::as_str);
        format!("line {} of what is shown did not come out:\n{missed}\nPrinted was\n{printed}", line + 1)
    })
}

/// `left` is set to the number of lines left at the last matching line.
fn are_alike(shown: &[String], printed: &[String], left: &mut usize) -> bool {
    *left = shown.len().min(*left);
    match shown.split_first() {
        None => printed.is_empty(),
        Some((first, rest)) if first == "..." => {
            (0..=printed.len()).any(|skipped| are_alike(rest, &printed[skipped..], left))
        }
        Some((first, rest)) => {
            printed.split_first().is_some_and(|(line, others)| is_alike(first, line) && are_alike(rest, others, left))
        }
    }
}

pub fn is_alike(shown: &str, printed: &str) -> bool {
    let mut parts = shown.split("[..]");
    let Some(mut left) = printed.strip_prefix(parts.next().unwrap_or_default()) else { return false };
    let mut is_open = false;
    let parts: Vec<&str> = parts.collect();
    for (place, part) in parts.iter().enumerate() {
        is_open = true;
        if place + 1 == parts.len() {
            return left.ends_with(part);
        }
        let Some(found) = left.find(part) else { return false };
        left = &left[found + part.len()..];
    }
    is_open || left.is_empty()
}

/// The keys of a part of a study are known, and have values of their kinds.
fn fragment(text: &str) -> Option<String> {
    static SCHEMA: OnceLock<Validator> = OnceLock::new();
    let schema = SCHEMA.get_or_init(|| {
        let schema: Value = serde_json::from_str(&succeed(&["schema", "study"])).unwrap();
        jsonschema::draft7::new(&schema).unwrap()
    });
    let table: toml::Table = match toml::from_str(text) {
        Ok(table) => table,
        Err(error) => return Some(error.to_string()),
    };
    let value = serde_json::to_value(table).unwrap();
    let complaints: Vec<String> = schema
        .iter_errors(&value)
        .map(|error| format!("{}: {error}", error.instance_path()))
        .filter(|complaint| !complaint.contains("is a required property"))
        .collect();
    (!complaints.is_empty()).then(|| complaints.join("\n"))
}

/// The lines follow each other in a program of `examples`, with any indentation.
fn in_an_example(shown: &str) -> Option<String> {
    let lines = |text: &str| -> Vec<String> {
        text.lines().map(str::trim).filter(|line| !line.is_empty()).map(str::to_owned).collect()
    };
    let wanted = lines(shown);
    let folder = crate::common::root().join("examples");
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let is_there = paths.filter(|path| path.extension().is_some_and(|ending| ending == "rs")).any(|path| {
        let program = lines(&std::fs::read_to_string(path).unwrap());
        program.windows(wanted.len()).any(|part| part == wanted)
    });
    (!is_there).then(|| "no program of `examples` has these lines".to_owned())
}

#[test]
fn elisions_match_any_text() {
    for (shown, printed, expected) in [
        ("a\n...\nc\n", "a\nb\nb\nc\n", true),
        ("a\n...\n", "a\n", true),
        ("a\n", "a\nb\n", false),
        ("took [..] s\n", "took 0.31 s\n", true),
        ("[..] of [..] runs", "1 of 2 runs", true),
        ("took [..] s\n", "took 0.31 ms and\n", false),
        ("a [..]", "b 1", false),
        ("a", "ab", false),
    ] {
        assert_eq!(compare(shown, printed).is_none(), expected, "{shown:?} {printed:?}");
    }
}
