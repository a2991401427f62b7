//! Result files: whatever is read as one can be drawn.

use apportion::report::comparison::{
    compare_results, comparison_charts, comparison_csv, comparison_json, comparison_summary,
};
use apportion::report::{
    ResultFile, convergence_chart, convergence_csv, distribution_chart, estimators_csv, indices_chart, indices_csv,
    interactions_chart, parse_result, result_json, run_page, scatter_chart, second_order_csv, study_chart, summary,
};

/// A result is refused, or drawn in every way there is; written again it is the same.
pub fn run(bytes: &[u8]) {
    let Ok(result) = parse_result(bytes) else { return };
    drawn(&result);
    let json = result_json(&result);
    let again = parse_result(json.as_bytes()).unwrap_or_else(|error| panic!("what was read is refused: {error}"));
    assert_eq!(result_json(&again), json);
}

/// Draws everything that can be drawn of a result.
pub fn drawn(result: &ResultFile) {
    run_page(result, &["a.csv".to_owned()]).html().expect("a page");
    for output in &result.outputs {
        let charts =
            [study_chart, indices_chart, interactions_chart, scatter_chart, distribution_chart, convergence_chart];
        for draw in charts {
            draw(result, output).svg().expect("a chart");
        }
    }
    for table in [indices_csv, second_order_csv, estimators_csv, convergence_csv, summary] {
        table(result);
    }
    if let Ok(file) = compare_results((result, "A", "a.json"), (result, "B", "b.json")) {
        for drawing in comparison_charts(&file) {
            drawing.chart.svg().expect("a chart");
        }
        for table in [comparison_csv, comparison_json, comparison_summary] {
            table(&file);
        }
    }
}
