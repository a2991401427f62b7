//! Result files: every accepted file can be drawn.

use apportion::result::{StudyResult, parse_result};
use apportion_report::comparison::{NamedResult, compare_results, comparison_document};
use apportion_report::document::Document;
use apportion_report::run_document;

/// A result is refused, or drawn in every form; written again it is the same.
pub fn run(bytes: &[u8]) {
    let Ok(result) = parse_result(bytes) else { return };
    drawn(&result);
    let json = result.json();
    let again = parse_result(json.as_bytes()).unwrap_or_else(|error| panic!("what was read is refused: {error}"));
    assert_eq!(again.json(), json);
}

/// Draws everything that can be drawn of a result.
pub fn drawn(result: &StudyResult) {
    written(&run_document(result));
    let [a, b] = [("A", "a.json"), ("B", "b.json")].map(|(label, file)| NamedResult { result, label, file });
    if let Ok(file) = compare_results(&a, &b) {
        written(&comparison_document(&file, "a-vs-b"));
    }
}

/// Makes all files of a document.
pub fn written(document: &Document) {
    // Every chart is on the page or among the charts that are only files.
    document.html();
    for figure in &document.charts {
        figure.chart.svg();
    }
    assert!(!document.text().is_empty());
    document.data_files();
}
