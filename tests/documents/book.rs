//! Runs what the README and the book show: their commands, the files that they name, the outputs that they print.
//!
//! A page is read for its fenced blocks, which are taken in order in one folder of the page's own, with the `studies` of
//! the sources in it:
//!
//! | block | use |
//! |---|---|
//! | `sh` | runs with `sh -eu`, and must succeed |
//! | `toml` | is a part of a study, whose keys must be known |
//! | `rust` | must be, line by line, in a program of `examples`, which the tests run |
//! | `python` | runs in `python/tests/test_documentation.py`, where the Python package is |
//! | `text`, `json`, `csv` | is ignored |
//!
//! A comment in the line above a block changes this:
//!
//! | comment | meaning |
//! |---|---|
//! | `<!-- file: NAME -->` | the block is the file NAME, for the blocks that follow |
//! | `<!-- output -->` | the block before it printed this; a line `...` stands for any lines, `[..]` for anything in a line |
//! | `<!-- exit: 2 -->` | the block ends with this exit code |
//! | `<!-- not run: REASON -->` | the block is not for this machine |
//! | `<!-- setup: COMMAND -->` | without a block: runs, and is not shown |
//!
//! Indented code is refused, since it would not be checked; except for the two commands of the README. `BOOK_PAGE=first`
//! in the environment tries only the pages with `first` in their names. Where the program prints something else than before,
//! `BOOK=update` writes it into the pages, keeps elisions, and leaves the review to you.

mod page;
mod play;
mod update;
mod words;

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Instant;

use page::Page;

/// The README, the pages of `docs`, and the others that users read.
fn pages() -> Vec<PathBuf> {
    let root = crate::common::root();
    let mut found = vec![root.join("README.md"), root.join("studies/README.md"), root.join("python/README.md")];
    for folder in ["docs", "docs/guide", "docs/reference", "docs/background", "docs/accuracy"] {
        let entries = std::fs::read_dir(root.join(folder)).unwrap().map(|entry| entry.unwrap().path());
        found.extend(entries.filter(|path| path.extension().is_some_and(|ending| ending == "md")));
    }
    let wanted = std::env::var("BOOK_PAGE").unwrap_or_default();
    found.retain(|path| path.to_string_lossy().contains(&wanted));
    found.sort();
    found
}

fn read(path: &Path) -> Page {
    let name = path.strip_prefix(crate::common::root()).unwrap().display().to_string();
    Page::new(&name, &std::fs::read_to_string(path).unwrap())
}

/// Every page is tried before the test fails, two at a time.
#[test]
fn outputs_of_the_pages_are_reproduced() {
    let (waiting, faults) = (Mutex::new(pages()), Mutex::new(Vec::new()));
    let work = || {
        while let Some(path) = { waiting.lock().unwrap().pop() } {
            let (page, start) = (read(&path), Instant::now());
            let found = play::faults(&page);
            eprintln!("{}: {:.1} s", page.name, start.elapsed().as_secs_f64());
            faults.lock().unwrap().extend(found);
        }
    };
    std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(work))));
    let mut faults = faults.into_inner().unwrap();
    faults.sort();
    assert!(faults.is_empty(), "{}", faults.join("\n\n"));
}

/// A command in a sentence, or in a block that is not run here, names an existing command and existing options.
#[test]
fn commands_in_sentences_are_there() {
    let mut known = words::Known::new();
    let faults: Vec<String> = pages().iter().flat_map(|path| known.faults(&read(path))).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Other programs read these lines of the README.
#[test]
fn the_two_commands_are_in_the_readme() {
    let readme = include_str!("../../README.md");
    assert!(readme.contains("\n    cargo run --release -- reproduce\n    cargo test --release\n"));
}

/// The citation is of this version.
#[test]
fn the_citation_is_of_this_version() {
    let citation = include_str!("../../CITATION.cff");
    assert!(citation.contains(concat!("\nversion: ", env!("CARGO_PKG_VERSION"), "\n")));
}
