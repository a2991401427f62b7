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
        Warning::RareLevel(level),
        Warning::PoorSurrogate { explained: 0.4 },
        Warning::DependentSteps { factors: vec![text("pumps"), text("valves")] },
        Warning::NoNoise { factor: text("seed") },
        Warning::AllNoise { factor: text("seed") },
        Warning::AboveTotal { name: text("a"), first_order: 0.5, total: 0.4 },
        Warning::Contradictory { name: text("a"), first_order: 0.5, total: 0.4 },
        Warning::FormulasDiffer { name: text("a"), gap: 0.03 },
        Warning::EstimatorsDiffer { name: text("a"), index: "total", estimator: "jansen", gap: -0.02 },
        Warning::NoFirstOrder,
        Warning::FirstOrderAboveOne { sum: 1.2 },
        Warning::TotalsBelowOne { sum: 0.8 },
        Warning::TotalAboveOne { name: text("a"), total: 1.1 },
        Warning::Shuffled,
        Warning::Unlikely { text: text("the value -9999 occurs in 14 of 640 runs") },
        Warning::Irreproducible { text: text("4 of 6 runs had another value when they were run again") },
    ]
}

#[test]
fn all_warnings_say_what_was_reviewed() {
    let lines: Vec<String> = examples().iter().map(|warning| format!("{}: {warning}", warning.code())).collect();
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn every_code_is_one_of_a_kind_and_documented() {
    let documented = include_str!("../../../docs/result-format.md");
    let examples = examples();
    let codes: std::collections::BTreeSet<&str> = examples.iter().map(Warning::code).collect();
    let kinds = include_str!("../warning.rs").matches(" => \"").count();
    assert_eq!((codes.len(), examples.len()), (kinds, kinds));
    for code in codes {
        assert!(documented.contains(&format!("| `{code}` |")), "docs/result-format.md says nothing of `{code}`");
    }
}

#[test]
fn warnings_that_were_read_are_those_that_were_written() {
    let written = examples();
    let json = serialize(&written, serde_json::value::Serializer).unwrap();
    assert_eq!(deserialize(json).unwrap(), written);
    let without_codes = deserialize(serde_json::json!({ "warnings": ["few rows"] })).unwrap();
    assert_eq!(without_codes, [Warning::Recorded { code: String::new(), text: text("few rows") }]);
}

#[test]
fn small_indices_have_digits_in_warnings() {
    assert_eq!([0.31, 0.01, 3.14e-5, -2e-4, 0.0].map(decimals), ["0.3100", "0.0100", "3.14e-5", "-2.00e-4", "0.0000"]);
}
