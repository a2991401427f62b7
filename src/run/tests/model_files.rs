use super::*;

use serde_json::json;

#[test]
fn files_are_known_by_name_wherever_they_are_and_those_of_one_name_apart() {
    let before = json!({ "study/a/table.csv": "1", "study/b/table.csv": "2", "study/model": "3" });
    let moved = json!({ "/far/study/model": "3", "/far/study/b/table.csv": "2", "/far/study/a/table.csv": "1" });
    assert_eq!(differing(&before, &moved), None);
    let swapped = json!({ "study/a/table.csv": "2", "study/b/table.csv": "1", "study/model": "3" });
    assert_eq!(differing(&before, &swapped).as_deref(), Some("table.csv"));
    let fewer = json!({ "study/a/table.csv": "1", "study/model": "4" });
    assert_eq!(differing(&before, &fewer).as_deref(), Some("model, table.csv"));
}

#[test]
fn a_changed_file_is_noticed_and_a_touched_one_is_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.py");
    std::fs::write(&path, "y = 1").unwrap();
    let files = ModelFiles::new(vec![path.clone(), folder.path().join("none")]);
    let modified = std::fs::metadata(&path).unwrap().modified().unwrap();
    let touch = |time| std::fs::File::options().write(true).open(&path).unwrap().set_modified(time).unwrap();
    touch(modified + std::time::Duration::from_secs(5));
    files.check().unwrap();
    std::fs::write(&path, "y = 2").unwrap();
    let is_changed = |checked| matches!(checked, Err(RunError::OtherFiles { files }) if files == "model.py");
    assert!(is_changed(files.check()));
    // With the time of before, only its content shows it.
    touch(modified);
    files.check().unwrap();
    assert!(is_changed(files.check_contents()));
}
