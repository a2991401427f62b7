//! The wording of all warnings in one snapshot, and their codes in the documentation.

use super::*;

fn text(text: &str) -> String {
    text.to_owned()
}

/// One warning of each kind.
fn examples() -> Vec<Warning> {
    let level = RareLevel {
        number: 2,
        factor: text("leak"),
        partner: None,
        level: text("true"),
        probability: 0.001,
        draws: 0,
        values: 256,
    };
    let unlikely = Unlikely { value: -9999.0, count: 14, first: 2, of: 640, others: (0.5, 2.25) };
    vec![
        Warning::AllRunsFailed { runs: 640 },
        Warning::RunsFailed { failed: 12, runs: 640, left_out: 9, base_samples: 128 },
        Warning::JointFailures { points: 3, base_samples: 128 },
        Warning::Unbalanced { points: 100, fewer: 256, more: 512 },
        Warning::SingleReplicate,
        Warning::SingleNet,
        Warning::ModelFlag { flag: text("jkr"), description: text("contact outside the range of JKR"), runs: 1 },
        Warning::FewRows { rows: 3.0, values: 256, kurtosis: 82.0 },
        Warning::FewDigits { error: 0.002 },
        Warning::NoIntervals,
        Warning::HeavyTailedSurrogate,
        Warning::DoubtedSurrogate,
        Warning::ContradictedSurrogate { times: 2.5 },
        Warning::InflatedSurrogate { times: 30.0 },
        Warning::UnmetLowFidelity { name: text("coarse"), share: 0.12 },
        Warning::RareLevel(level),
        Warning::PoorSurrogate { explained: 0.4 },
        Warning::DependentSteps { factors: vec![text("pumps"), text("valves")] },
        Warning::NoNoise { factor: text("seed") },
        Warning::AllNoise { factor: text("seed") },
        Warning::AboveTotal { name: text("a"), first_order: 0.5, total: 0.4 },
        Warning::Contradictory { name: text("a"), first_order: 0.5, total: 0.4 },
        Warning::FormulasDiffer { name: text("a"), gap: 0.03 },
        Warning::EstimatorsDiffer { name: text("a"), index: IndexKind::Total, estimator: text("jansen"), gap: -0.02 },
        Warning::NoFirstOrder,
        Warning::FirstOrderAboveOne { sum: 1.2 },
        Warning::TotalsBelowOne { sum: 0.8 },
        Warning::TotalAboveOne { name: text("a"), total: 1.1 },
        Warning::Shuffled,
        Warning::UnlikelyValue(unlikely),
        Warning::UnlikelyInTable(unlikely),
        Warning::Irreproducible { differing: 4, rows: 6, cause: Irreproducible::Random, has_noise: false },
    ]
}

fn json(warnings: &[Warning]) -> Vec<serde_json::Value> {
    crate::result::with_text::with_texts(warnings, serde_json::value::Serializer).unwrap().as_array().unwrap().clone()
}

#[test]
fn all_warnings_say_what_was_reviewed() {
    let word = |warning: &serde_json::Value, key: &str| warning[key].as_str().unwrap().to_owned();
    let lines: Vec<String> =
        json(&examples()).iter().map(|of| format!("{}: {}", word(of, "code"), word(of, "text"))).collect();
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn every_kind_has_an_example_and_a_documented_code() {
    let documented = include_str!("../../../docs/reference/result-format.md");
    let json = json(&examples());
    let codes: std::collections::BTreeSet<&str> =
        json.iter().map(|warning| warning["code"].as_str().unwrap()).collect();
    let kinds = include_str!("../warning.rs").matches("#[error(").count();
    assert_eq!((codes.len(), json.len()), (kinds, kinds));
    for code in codes {
        assert!(
            documented.contains(&format!("| `{code}` |")),
            "docs/reference/result-format.md says nothing of `{code}`"
        );
    }
}

#[test]
fn warnings_that_were_read_are_those_that_were_written() {
    let infinite = Warning::InflatedSurrogate { times: f64::INFINITY };
    for warning in examples().into_iter().chain([infinite]) {
        let json = json(std::slice::from_ref(&warning)).remove(0).to_string();
        assert_eq!(serde_json::from_str::<Warning>(&json).unwrap(), warning, "{json}");
    }
}

#[test]
fn a_warning_has_code_numbers_and_text_in_json() {
    let warning = Warning::FewRows { rows: 3.5, values: 256, kurtosis: 82.0 };
    let text = warning.to_string();
    let keys = serde_json::json!({ "code": "few-rows", "rows": 3.5, "values": 256, "kurtosis": 82.0, "text": text });
    assert_eq!(json(&[warning]), [keys]);
}

#[test]
fn small_indices_have_digits_in_warnings() {
    assert_eq!([0.31, 0.01, 3.14e-5, -2e-4, 0.0].map(decimals), ["0.3100", "0.0100", "3.14e-5", "-2.00e-4", "0.0000"]);
}
