//! The corpus of the fuzzers, and texts made from it at random, through the same targets on any compiler.

use std::time::{Duration, Instant};

use crate::files::fuzz::{Dictionary, Random, TARGETS, Target, mutated, mutated_bytes, target};

/// Texts made at random from every one of the corpus, unless the environment has another number in `CORPUS_CHANGES`.
const CHANGES: u64 = 40;

/// Time limit of a text: a fuzzer reports a hang far earlier, but machines may be busy.
const LONGEST: Duration = Duration::from_secs(60);

/// The files of a target's corpus, by name; none in the published crate, which has no corpus.
fn corpus(target: &Target) -> Vec<(String, Vec<u8>)> {
    let folder = crate::common::root().join("fuzz/corpus").join(target.name);
    let Ok(entries) = std::fs::read_dir(&folder) else { return Vec::new() };
    let mut files: Vec<(String, Vec<u8>)> = entries
        .map(|entry| entry.unwrap().path())
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(&path).unwrap()))
        .collect();
    files.sort();
    files
}

/// Runs the target on `bytes`; a panic says on what.
fn run(target: &Target, name: &str, bytes: &[u8]) {
    let begun = Instant::now();
    if let Err(panic) = std::panic::catch_unwind(|| (target.run)(bytes)) {
        eprintln!("the target `{}` on {name}:\n{}", target.name, String::from_utf8_lossy(bytes));
        std::panic::resume_unwind(panic);
    }
    assert!(begun.elapsed() < LONGEST, "{} on {name} took {:?}", target.name, begun.elapsed());
}

fn all_of(name: &str) {
    let target = target(name);
    let dictionary = Dictionary::read(target.dictionary);
    let files = corpus(target);
    let asked = std::env::var("CORPUS_CHANGES").ok().map(|text| text.parse().expect("CORPUS_CHANGES: a whole number"));
    let changes = asked.unwrap_or(CHANGES);
    // Another number of changes also gives other changes.
    let mut random = Random(changes);
    for (file, bytes) in &files {
        run(target, file, bytes);
        let Ok(text) = std::str::from_utf8(bytes) else {
            for number in 0..10 * changes {
                let bytes = mutated_bytes(bytes, &mut random);
                run(target, &format!("{file}, changed for the {}. time", number + 1), &bytes);
            }
            continue;
        };
        for number in 0..changes {
            let text = mutated(text, &dictionary, &mut random);
            run(target, &format!("{file}, changed for the {}. time", number + 1), text.as_bytes());
        }
    }
    // From an empty text, with the words of the language only.
    let mut text = String::new();
    for number in 0..50 * changes {
        text = if text.len() < 200 { mutated(&text, &dictionary, &mut random) } else { String::new() };
        run(target, &format!("text {number} made of nothing"), text.as_bytes());
    }
}

#[test]
fn answers_of_programs() {
    all_of("answers");
}

#[test]
fn journals() {
    all_of("journal");
}

#[test]
fn files_of_rows() {
    all_of("rows");
}

#[test]
fn formulas() {
    all_of("expression");
}

#[test]
fn results() {
    all_of("result");
}

#[test]
fn studies() {
    all_of("study");
}

#[test]
fn tables() {
    all_of("tables");
}

/// Every target of `fuzz/` is one of those above.
#[test]
fn no_target_is_left_out() {
    let folder = crate::common::root().join("fuzz/fuzz_targets");
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut fuzzers: Vec<String> =
        entries.map(|entry| entry.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned()).collect();
    fuzzers.sort();
    assert_eq!(fuzzers, TARGETS.map(|target| target.name));
}
