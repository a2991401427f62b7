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
