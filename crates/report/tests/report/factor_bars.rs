//! Bars of indices, one for each factor.

use apportion::uncertainty::Estimate;
use apportion_report::chart::{Bar, Chart, Shape};
use apportion_report::comparison::{NamedResult, compare_results, comparison_document};
use apportion_report::{indices_chart, shapley_chart};

use super::{about, of_factors};

/// What is drawn for an index that cannot be one, or whose interval is longer than 1.
const UNKNOWN: &str = "unknown: too few samples";

fn drawn(chart: &Chart) -> Vec<&Bar> {
    let marks = chart.panels[0].marks.iter();
    marks.filter_map(|mark| if let Shape::Bar(bar) = &mark.shape { Some(bar) } else { None }).collect()
}

#[test]
fn the_largest_of_many_factors_are_drawn() {
    let mut result = of_factors(30);
    for (number, index) in (0..).map(f64::from).zip(result.outputs[0].indices.iter_mut().flatten()) {
        (index.effect.first_order, index.effect.total) = (about(0.01 * number, 1e-4), about(0.02 * number, 1e-4));
    }
    let chart = indices_chart(&result, &result.outputs[0]);
    let names = &chart.panels[0].y.names;
    assert_eq!((names.len(), names[0].as_str(), names[19].as_str()), (20, "x30", "x11"));
    let bars = drawn(&chart);
    let of_x30: Vec<&Bar> = bars.iter().copied().filter(|bar| bar.row == 0).collect();
    assert_eq!((bars.len(), of_x30[0].label.as_str(), of_x30[0].beyond.is_none()), (40, "0.2900", true));
    let split = of_x30[1].beyond.as_ref().map(|(split, _)| *split).unwrap_or_default();
    assert!((split - 0.29).abs() < 1e-12 && (of_x30[1].to - 0.58).abs() < 1e-12);
}

#[test]
fn an_index_without_estimate_has_no_bar() {
    let mut result = of_factors(4);
    let values = [about(-1.73, 0.2), Estimate::alone(2.73), about(0.4, 0.6), about(0.02, 0.04)];
    for (index, value) in result.outputs[0].indices.iter_mut().flatten().zip(values) {
        index.effect.shapley = Some(value);
    }
    let chart = shapley_chart(&result, &result.outputs[0]);
    let bars = drawn(&chart);
    assert_eq!(bars.iter().map(|bar| bar.label.as_str()).collect::<Vec<_>>(), [UNKNOWN, UNKNOWN, UNKNOWN, "0.02"]);
    assert!(bars[0].to.is_nan() && bars[3].value_text == "0.02 ± 0.04");

    let [a, b] = ["a", "b"].map(|label| NamedResult { result: &result, label, file: label });
    let mut file = compare_results(&a, &b).unwrap();
    let values = [about(-0.73, 0.2), Estimate::alone(2.73), about(0.4, 0.3), about(0.000_013, 0.000_002)];
    for (factor, value) in file.outputs[0].factors.iter_mut().zip(values) {
        factor.first_order.difference = Some(value);
    }
    let document = comparison_document(&file, "a-vs-b");
    let figure = document.figures().into_iter().find(|figure| figure.chart.title.contains(" minus ")).unwrap();
    let labels: Vec<&str> = drawn(&figure.chart).iter().take(4).map(|bar| bar.label.as_str()).collect();
    assert_eq!(labels, ["\u{2212}0.7", UNKNOWN, "0.4", "0.000013"]);
}
