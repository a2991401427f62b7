//! The section on the study itself.

use apportion::result::FactorDistribution;
use apportion_report::run_document;
use serde_json::{Value, json};

use super::{of_factors, tables};

fn distribution(json: Value) -> FactorDistribution {
    serde_json::from_value(json).unwrap()
}

#[test]
fn distributions_are_described_with_their_units() {
    let uniform = distribution(json!({"name": "uniform", "min": 0.25, "max": 2.5}));
    let many = distribution(json!({"name": "discrete", "values": [1, 2, 3, 4, 5, 6, 7, 8, 9]}));
    let cases = [
        (&uniform, "um", "uniform, min 0.25, max 2.5 (µm)"),
        (&uniform, "1", "uniform, min 0.25, max 2.5"),
        (&many, "1", "discrete, values 1; 2; 3; 4; 5; 6; 7; 8; … (9 in all)"),
    ];
    let mut result = of_factors(cases.len());
    for (factor, (distribution, unit, _)) in result.factors.iter_mut().zip(cases) {
        (factor.distribution, factor.unit) = (distribution.clone(), unit.to_owned());
    }
    let formulas: Value = (0..12).map(|k| (format!("y{k:02}"), Value::from("a"))).collect();
    result.study.settings = [("outputs".to_owned(), formulas)].into_iter().collect();
    let page = run_document(&result);
    let tables = tables(&page, "study");
    let described: Vec<&str> = tables[0].rows.iter().map(|row| row[1].text.as_str()).collect();
    assert_eq!(described, cases.map(|(.., text)| text));
    let setting = &tables[1].rows[1];
    assert!(setting[0].text == "outputs" && setting[1].text.ends_with("; y07 a; … (12 in all)"), "{setting:?}");
}
