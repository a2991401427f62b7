//! The files of a document, and their names.

use std::collections::HashSet;
use std::sync::atomic::AtomicBool;

use apportion::uncertainty::{Estimate, Interval};
use apportion_report::document::{DataFile, Document, Table};
use apportion_report::{ArtefactError, Artefacts, FileList, Refusal, file_stems};

#[test]
fn nothing_is_written_once_it_shall_stop() {
    let folder = tempfile::tempdir().unwrap();
    let files = ["s.json", "charts/s.csv"].map(|name| DataFile::new(name, "{}".to_owned()));
    let document = Document { name: "s".to_owned(), files: files.to_vec(), ..Document::default() };
    let artefacts = Artefacts::new(folder.path());
    let stopped = artefacts.write_until(&document, &AtomicBool::new(true)).unwrap_err();
    assert!(matches!(stopped, ArtefactError::Stopped));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    let written = artefacts.write(&document).unwrap();
    assert_eq!(written.data, ["s.json", "charts/s.csv"].map(|name| folder.path().join(name)));
    assert!(written.charts.is_none() && written.data.iter().all(|path| path.is_file()));
    let mine = folder.path().join("charts/s.csv");
    let refused = |artefacts: &Artefacts, expected| match artefacts.write(&document) {
        Err(ArtefactError::Refused(refusal)) => assert_eq!(refusal, expected),
        other => panic!("{other:?}"),
    };
    // Its own files are written again; not an input, nor a file that was changed.
    artefacts.write(&document).unwrap();
    std::fs::write(&mine, "mine").unwrap();
    refused(&artefacts, Refusal::Exists(mine.clone()));
    refused(&Artefacts { inputs: vec![mine.clone()], ..artefacts.clone() }, Refusal::Taken(mine));
    Artefacts { replaces: true, ..artefacts }.write(&document).unwrap();
}

#[test]
fn stems_of_files_are_unique_whatever_the_names() {
    let suffixes = ["", "-indices", "-scatter"];
    let long = "n".repeat(300);
    let names = ["y", "Y", "y-indices", "y-2", "a/b", "a\\b", "y-scatter-2", "../../x", &long, &long[1..], "É", "é"];
    let stems = file_stems("s", &names, &suffixes);
    let files = stems.iter().flat_map(|stem| suffixes.map(|suffix| format!("{stem}{suffix}").to_lowercase()));
    let unique: HashSet<String> = files.clone().collect();
    assert_eq!(unique.len(), files.count());
    assert!(stems.iter().all(|stem| !stem.contains(['/', '\\']) && stem.len() < 120), "{stems:?}");
    // Names without a conflict are kept.
    assert_eq!(file_stems("s", &["y", "z"], &suffixes), ["s-y", "s-z"]);
}

#[test]
fn values_keep_their_bits_and_gaps_are_empty() {
    let known = Estimate { estimate: 0.1, interval: Some(Interval { low: -0.5, high: 1e-300 }) };
    let rows = [("=1+1", 7.0, Some(known)), ("", f64::NAN, None)];
    let table = Table::from_rows("", rows).file("a,b", |row| row.0).file("n", |row| row.1);
    let table = table.file_estimate("S", |row| row.2).file("flag", |_| true);
    let expected = format!("\"a,b\",n,S,S_low,S_high,flag\n'=1+1,7,0.1,-0.5,{},true\n,,,,,true\n", 1e-300);
    assert_eq!(table.csv(), expected);
}

#[test]
fn two_writers_of_one_result_take_turns() {
    let folder = tempfile::tempdir().unwrap();
    let files = vec![DataFile::new("s.json", "{}".to_owned())];
    let document = Document { name: "s".to_owned(), files, ..Document::default() };
    let list = FileList::open(folder.path(), "s").unwrap();
    std::thread::scope(|scope| {
        let writer = scope.spawn(|| Artefacts::new(folder.path()).write(&document).unwrap());
        std::thread::sleep(std::time::Duration::from_millis(300));
        assert!(!writer.is_finished() && !folder.path().join("s.json").exists());
        drop(list);
        writer.join().unwrap();
    });
    assert!(folder.path().join("s.json").exists());
}
