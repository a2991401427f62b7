use proptest::prelude::*;
use serde_json::json;

use super::*;
use crate::model::{CounterKind, Counts, RowFailure};

fn block(first: u64, rows: usize) -> RowBlock {
    let values = (0..rows).map(|row| if row == 2 { f64::NAN } else { (first as f64 + row as f64).sqrt() }).collect();
    let failures = if rows > 2 { vec![(2, 0, RowFailure::new("the tip slipped: \u{3bc} < 0"))] } else { Vec::new() };
    let counts = [(CounterKind::Sum, rows as f64), (CounterKind::Sum, 7.0), (CounterKind::Maximum, 1e-9)];
    let counts = Counts(counts.to_vec());
    RowBlock { replicate: 3, first, values, failures, flags: vec![1, 2], counts }
}

#[track_caller]
fn assert_same(found: &[RowBlock], expected: &[RowBlock]) {
    // NaN is not equal to itself, but its text is.
    assert_eq!(format!("{found:?}"), format!("{expected:?}"));
}

fn written(blocks: &[RowBlock]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.journal");
    let journal = Journal::create(&path, &json!({ "study": "a" })).unwrap();
    blocks.iter().for_each(|block| journal.append(block).unwrap());
    (folder, path)
}

#[test]
fn appended_records_are_read_back() {
    let blocks = [block(0, 5), block(5, 1), block(6, 300)];
    let (_folder, path) = written(&blocks[..2]);
    let (journal, contents) = Journal::resume(&path).unwrap();
    assert_eq!((contents.header, contents.cut_off), (json!({ "study": "a" }), 0));
    assert_same(&contents.blocks, &blocks[..2]);
    journal.append(&blocks[2]).unwrap();
    drop(journal);
    assert_same(&read_journal(&path, &std::fs::read(&path).unwrap()).unwrap().blocks, &blocks);
    // A new one replaces the old one.
    drop(Journal::create(&path, &json!({ "study": "b" })).unwrap());
    let contents = read_journal(&path, &std::fs::read(&path).unwrap()).unwrap();
    assert_eq!((contents.header, contents.blocks.len()), (json!({ "study": "b" }), 0));
}

#[cfg(unix)]
#[test]
fn a_journal_that_is_cut_off_or_removed_during_a_run_takes_nothing_more() {
    for remove in [false, true] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.journal");
        let journal = Journal::create(&path, &json!({ "study": "a" })).unwrap();
        journal.append(&block(0, 5)).unwrap();
        if remove {
            std::fs::remove_file(&path).unwrap();
        } else {
            OpenOptions::new().write(true).open(&path).unwrap().set_len(20).unwrap();
        }
        assert!(matches!(journal.append(&block(5, 1)), Err(RunError::NotKept { .. })), "{remove}");
    }
}

#[test]
fn a_truncated_journal_keeps_every_complete_record_and_resumes() {
    let blocks = [block(0, 5), block(5, 1), block(6, 4)];
    let (_folder, path) = written(&blocks);
    let bytes = std::fs::read(&path).unwrap();
    let ends: Vec<usize> = (0..=3).map(|count| std::fs::read(&written(&blocks[..count]).1).unwrap().len()).collect();
    for length in 0..bytes.len() {
        if length < ends[0] {
            assert!(
                matches!(
                    read_journal(&path, &bytes[..length]),
                    Err(JournalError { problem: JournalProblem::Invalid(_), .. })
                ),
                "{length}"
            );
            continue;
        }
        let complete = ends.iter().rposition(|end| *end <= length).unwrap();
        std::fs::write(&path, &bytes[..length]).unwrap();
        let (journal, contents) = Journal::resume(&path).unwrap();
        assert_same(&contents.blocks, &blocks[..complete]);
        assert_eq!(contents.cut_off, (length - ends[complete]) as u64);
        journal.append(&block(40, 1)).unwrap();
        drop(journal);
        let contents = read_journal(&path, &std::fs::read(&path).unwrap()).unwrap();
        assert_same(&contents.blocks[complete..], &[block(40, 1)]);
        assert_eq!(contents.cut_off, 0);
    }
}

#[test]
fn damage_is_cut_off_and_never_read_as_outputs() {
    let blocks = [block(0, 5), block(5, 3), block(8, 4)];
    let (_folder, path) = written(&blocks);
    let bytes = std::fs::read(&path).unwrap();
    let header = std::fs::read(&written(&[]).1).unwrap().len();
    for at in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x10;
        match read_journal(&path, &damaged) {
            Err(_) => assert!(at < header, "byte {at}"),
            Ok(contents) => {
                assert!(at >= header && contents.blocks.len() < 3, "byte {at}");
                assert_same(&contents.blocks, &blocks[..contents.blocks.len()]);
            }
        }
    }
    // The content that some file systems leave at the end of a file that was not completely written to the disk.
    let zeros = [&bytes[..], &[0; 4096]].concat();
    let contents = read_journal(&path, &zeros).unwrap();
    assert_eq!((contents.blocks.len(), contents.cut_off), (3, 4096));
}

#[test]
fn other_files_are_refused_with_the_reason() {
    let messages =
        [&b""[..], b"y\n1.0\n", b"apportion journal\x03\0\0\0", b"apportion journal\x01\0\0\0\xff\xff\xff\xff\0\0\0\0"]
            .map(|bytes| read_journal(Path::new("x"), bytes).unwrap_err().to_string());
    insta::assert_snapshot!(messages.join("\n"));
}

#[cfg(unix)]
#[test]
fn paths_that_are_not_files_are_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for path in [&pipe, Path::new("/dev/null"), folder.path()] {
        assert!(
            matches!(Journal::create(path, &json!({})), Err(JournalError { problem: JournalProblem::NoFile, .. })),
            "{path:?}"
        );
        assert!(matches!(Journal::resume(path), Err(JournalError { problem: JournalProblem::NoFile, .. })));
        assert!(matches!(read_journal_file(path), Err(JournalError { problem: JournalProblem::NoFile, .. })));
    }
}

#[test]
fn two_runs_cannot_write_one_journal() {
    let (_folder, path) = written(&[]);
    let (journal, _) = Journal::resume(&path).unwrap();
    let refused = Journal::resume(&path).unwrap_err();
    assert!(matches!(refused.problem, JournalProblem::InUse), "{refused}");
    let refused = Journal::create(&path, &json!({})).unwrap_err();
    assert!(matches!(refused.problem, JournalProblem::InUse), "{refused}");
    drop(journal);
    assert!(Journal::resume(&path).is_ok());
}

#[test]
fn differences_are_described_in_sentences() {
    let a = json!({ "model": "afm", "factors": [{ "name": "x", "max": 1.0 }], "design": { "seed": 1 } });
    let b = json!({ "model": "afm", "factors": [{ "name": "x", "max": 2.0 }], "design": { "seed": 1, "sampler": "sobol" } });
    // Their order is that of the keys, which a feature of serde_json changes.
    let mut found = differences(&a, &b);
    found.sort();
    let expected =
        ["design.sampler is \"sobol\" in the study, and not in the journal", "factors.x.max was 1.0 and is now 2.0"];
    assert_eq!(found, expected);
    assert_eq!(differences(&a, &a), [] as [String; 0]);
    let many = |add: u64| json!([0, 1, 2, 3, 4].map(|n| n + add));
    let found = differences(&json!({ "n": many(0) }), &json!({ "n": many(1) }));
    assert_eq!((found.len(), found[3].as_str()), (4, "and 2 more"));
}

proptest! {
    #[test]
    fn no_bytes_panic(tail in prop::collection::vec(any::<u8>(), 0..200), cut in 0_usize..100) {
        let mut bytes = Vec::new();
        format::write_header(&mut bytes, &json!({}));
        bytes.truncate(bytes.len().saturating_sub(cut));
        bytes.extend(tail);
        let _ = read_journal(Path::new("x"), &bytes);
    }
}

#[test]
fn sibling_files_of_journals_have_distinct_names() {
    let of = |name: &str, ending: &str| with_ending(Path::new(name), ending).display().to_string();
    assert_eq!(of("results/s.journal", ".new"), "results/s.journal.new");
    assert_eq!(
        (of("jr/j_0.1", ".old"), of("jr/j_0.2", ".old")),
        ("jr/j_0.1.old".to_owned(), "jr/j_0.2.old".to_owned())
    );
}
