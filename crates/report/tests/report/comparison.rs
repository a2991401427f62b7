//! Comparisons of two results.

use apportion::result::{StudyResult, json};
use apportion::{Estimate, Undefined};
use apportion_report::comparison::{
    CompareError, ComparedIndex, ComparisonFile, NamedResult, compare_results, comparison_document,
};
use proptest::prelude::*;

use super::{about, result};

fn linear(coefficients: &str, design: &str) -> StudyResult {
    result(&format!("model = \"linear\"\n[function]\nc = {coefficients}\n[design]\nbase_samples = 1024\n{design}"))
}

fn compared(a: &StudyResult, b: &StudyResult) -> Result<ComparisonFile, CompareError> {
    let [a, b] = [(a, "before", "a.json"), (b, "after", "b.json")].map(|(result, label, file)| NamedResult {
        result,
        label,
        file,
    });
    compare_results(&a, &b)
}

#[test]
fn differences_of_known_indices_are_found() {
    // Equal inputs: S_i = c_i^2 / sum c_j^2, so 1/21, 16/21, 4/21 against 4/21, 16/21, 1/21.
    let (a, b) = (linear("[1.0, 4.0, 2.0]", "seed = 1"), linear("[2.0, 4.0, 1.0]", "seed = 2"));
    let file = compared(&a, &b).unwrap();
    for (factor, exact) in file.outputs[0].factors.iter().zip([3.0 / 21.0, 0.0, -3.0 / 21.0]) {
        for index in [factor.first_order, factor.total] {
            let change = index.difference.unwrap();
            // Sobol' points on a linear function at 1024 base samples: errors below 1e-3.
            assert!((change.estimate - exact).abs() < 3e-3, "{factor:?}");
            assert_eq!(index.differs, Some(exact != 0.0), "{factor:?}");
        }
    }
    assert!(!file.shared_points);
    let settings: Vec<&str> = file.settings.iter().map(|s| s.what.as_str()).collect();
    assert_eq!(settings, ["c", "seed"]);
    let text = comparison_document(&file, "a-vs-b").text();
    assert!(text.contains("A: before (a.json)") && text.contains("x2 has the largest total index in both"), "{text}");
    assert!(text.contains("4 of 6"), "{text}");
    let mean = text.lines().find(|line| line.contains("Mean: A")).unwrap();
    // Sobol' points know the mean of a linear function but for rounding.
    assert!(mean.contains("A 3.5, B 3.5"), "{mean}");
}

#[test]
fn a_result_does_not_differ_from_itself() {
    let a = linear("[1.0, 4.0, 2.0]", "");
    let file = compared(&a, &a).unwrap();
    assert!(file.settings.is_empty() && file.shared_points);
    for factor in &file.outputs[0].factors {
        assert_eq!(factor.total.difference.unwrap().estimate, 0.0);
        assert_eq!(factor.total.differs, Some(false));
    }
    assert!(comparison_document(&file, "a-vs-b").text().contains("All indices are the same, to the last bit"));
}

#[test]
fn the_other_way_round_is_the_same_with_the_other_sign() {
    let (a, b) = (linear("[1.0, 4.0, 2.0]", ""), linear("[2.0, 3.0, 1.0]", ""));
    let (there, back) = (compared(&a, &b).unwrap(), compared(&b, &a).unwrap());
    for (there, back) in there.outputs[0].factors.iter().zip(&back.outputs[0].factors) {
        let (there, back) = (there.total.difference.unwrap(), back.total.difference.unwrap());
        assert_eq!(there.estimate, -back.estimate);
        let (there, back) = (there.interval.unwrap(), back.interval.unwrap());
        assert_eq!((there.low, there.high), (-back.high, -back.low));
    }
}

#[test]
fn results_that_cannot_be_compared_are_refused_with_the_reason() {
    let a = linear("[1.0, 2.0]", "");
    let mut b = a.clone();
    b.outputs[0].name = "force".to_owned();
    let nothing = |what, a: &str, b: &str| CompareError::NothingInCommon { what, a: a.to_owned(), b: b.to_owned() };
    assert_eq!(compared(&a, &b).unwrap_err(), nothing("output", "y", "force"));
    let mut b = a.clone();
    b.outputs[0].unit = "nN".to_owned();
    assert!(matches!(compared(&a, &b), Err(CompareError::OtherQuantity { output, .. }) if output == "y"));
    let mut b = a.clone();
    for (factor, index) in b.factors.iter_mut().zip(b.outputs[0].indices.as_mut().unwrap()) {
        factor.name.insert(0, 'z');
        index.name.insert(0, 'z');
    }
    assert_eq!(compared(&a, &b).unwrap_err(), nothing("factor", "x1, x2", "zx1, zx2"));
}

#[test]
fn one_sided_factors_and_missing_indices_have_their_place() {
    let a = linear("[1.0, 2.0]", "");
    let b = linear("[1.0, 2.0, 3.0]", "");
    let file = compared(&a, &b).unwrap();
    assert_eq!((&file.factors_left_out.a, &file.factors_left_out.b), (&vec![], &vec!["x3".to_owned()]));
    let x3 = &file.outputs[0].factors[2];
    assert!(x3.total.a.is_none() && x3.total.b.is_some() && x3.total.difference.is_none());
    assert!(comparison_document(&file, "a-vs-b").text().contains("factors only in B: x3"));

    let mut none = a.clone();
    none.outputs[0].indices = None;
    none.outputs[0].reason = Some(Undefined::ZeroVariance);
    let file = compared(&a, &none).unwrap();
    assert_eq!(file.outputs[0].reasons, [None, Some(Undefined::ZeroVariance.to_string())]);
    let text = comparison_document(&file, "a-vs-b").text();
    assert!(
        text.contains("no indices: There are none in B: the output has zero variance") && text.contains("no intervals"),
        "{text}"
    );
    for chart in comparison_document(&file, "a-vs-b").figures().into_iter().map(|figure| &figure.chart) {
        chart.svg();
    }
    let document = comparison_document(&file, "a-vs-b");
    let files = document.data_files();
    assert_eq!(files.iter().find(|file| file.name == "a-vs-b.csv").unwrap().text.lines().count(), 1 + 2 * 2);
}

#[test]
fn moments_are_compared_in_one_unit() {
    let a = result("[design]\nbase_samples = 64\n[[factor]]\nname = \"thickness\"\nmin = 1\nmax = 2\nunit = \"um\"");
    let mut b = a.clone();
    // The same forces in micronewtons.
    b.outputs[0].unit = "uN".to_owned();
    b.outputs[0].mean = a.outputs[0].mean.map(|mean| mean * 1e-3);
    b.outputs[0].variance = a.outputs[0].variance.map(|variance| variance * 1e-6);
    let output = &compared(&a, &b).unwrap().outputs[0];
    for [a, b] in [output.mean, output.sd] {
        let (a, b) = (a.unwrap(), b.unwrap());
        // A few roundings of 1e-16 each.
        assert!((a - b).abs() <= 1e-14 * a, "{a} {b}");
    }
}

#[test]
fn a_table_has_no_more_columns_than_a_page_has_room_for() {
    let file = compared(&linear("[1.0, 4.0]", ""), &linear("[2.0, 4.0]", "")).unwrap();
    let document = comparison_document(&file, "a-vs-b");
    let text = document.text();
    for heading in ["S_1 of A", "S_T of B"] {
        let line = text.lines().find(|line| line.contains(heading)).unwrap();
        assert!(line.matches("of A").count() == 1 && line.contains("B − A"), "{line}");
    }
}

#[test]
fn rounding_does_not_count_as_a_difference() {
    let record = |estimate: f64| Some(about(estimate, 0.0));
    assert_eq!(ComparedIndex::new(record(0.0), record(5e-15)).differs, Some(false));
    assert_eq!(ComparedIndex::new(record(0.0), record(5e-9)).differs, Some(true));
    assert_eq!(
        ComparedIndex::new(record(0.0), None),
        ComparedIndex { a: record(0.0), b: None, difference: None, differs: None }
    );
}

#[test]
fn a_comparison_reads_back_as_it_was() {
    let file = compared(&linear("[1.0, 4.0]", ""), &linear("[2.0, 4.0]", "")).unwrap();
    assert_eq!(serde_json::from_str::<ComparisonFile>(&json(&file)).unwrap(), file);
}

proptest! {
    /// Symmetric intervals: the half widths are those of independent errors, and never smaller than the larger one.
    #[test]
    fn half_widths_add_as_independent_errors(a in -1.0..1.0, b in -1.0..1.0, u in 0.0..0.5, v in 0.0..0.5) {
        let d = Estimate::difference(about(a, u), about(b, v));
        let (half, interval) = ((u * u + v * v).sqrt(), d.interval.unwrap());
        // Bounds are rounded to 1e-16 of numbers up to 1.5.
        prop_assert!((interval.high - d.estimate - half).abs() < 1e-14);
        prop_assert!((d.estimate - interval.low - half).abs() < 1e-14);
        prop_assert!(interval.high - d.estimate >= u.max(v) - 1e-14);
    }
}
