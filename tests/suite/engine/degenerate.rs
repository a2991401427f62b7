//! Degenerate studies: each has a result or a reason, and none has a meaningless number.

use std::path::Path;

use apportion::result::{OutputResult, StudyResult, Warning, parse_result};
use apportion::uncertainty::{Estimate, Interval};

use crate::common::HOLES;
use crate::messages::messages;

fn analysed(text: &str) -> StudyResult {
    let study =
        apportion_files::parse_study(text, Path::new("degenerate.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    study.run().unwrap()
}

fn first_and_total(output: &OutputResult) -> Vec<(f64, f64)> {
    let indices = output.indices.as_ref().unwrap_or_else(|| panic!("{:?}", output.reason));
    indices.iter().map(|index| (index.effect.first_order.estimate, index.effect.total.estimate)).collect()
}

#[test]
fn a_constant_output_has_a_reason_and_no_indices() {
    let result = analysed("model = \"linear\"\n[function]\nc = [0, 0]");
    let output = &result.outputs[0];
    assert_eq!((&output.indices, output.variance), (&None, Some(0.0)));
    messages!().add("the reason", &output.reason.unwrap().to_string());
    assert!(output.convergence.is_empty());
}

#[test]
fn failures_by_several_factors_are_distinguished_from_those_by_one() {
    let warnings = |formula: &str| -> Vec<Warning> {
        let factors = "[factors]\nx = { min = 0, max = 1 }\ny = { min = 0, max = 1 }\n";
        let output =
            format!("model = \"expression\"\noutputs.z.formula = \"{formula}\"\n[design]\nbase_samples = 16384\n");
        analysed(&format!("{output}{factors}")).outputs.remove(0).warnings
    };
    // There are many samples: advice to use more would be wrong.
    for formula in ["if(x/y > 10, sqrt(-1), x + y)", "if((x > 0.5) + (y > 0.9) > 1, sqrt(-1), x*y)"] {
        let warnings = warnings(formula);
        let is_joint =
            matches!(warnings[..], [Warning::RunsFailed { .. }, Warning::JointFailures { base_samples: 16384, .. }]);
        assert!(is_joint, "{warnings:?}");
    }
    // Where runs succeed the factors are independent, of smaller ranges.
    let warnings = warnings("if(x > 0.9, sqrt(-1), if(y < 0.05, sqrt(-1), x + y))");
    assert!(matches!(warnings[..], [Warning::RunsFailed { .. }]), "{warnings:?}");
}

#[test]
fn one_factor_is_everything_for_two_runs_a_base_sample() {
    let result = analysed("model = \"linear\"\n[[factor]]\nname = \"x1\"\n[analysis]\nsecond_order = true");
    assert_eq!(result.provenance.model_runs, 2 * result.provenance.base_samples);
    let whole = &result.outputs[0].indices.as_ref().unwrap()[0].effect;
    let exact = Estimate { estimate: 1.0, interval: Some(Interval { low: 1.0, high: 1.0 }) };
    assert_eq!((whole.first_order, whole.total, result.outputs[0].sum_total), (exact, exact, Some(exact)));
    assert_eq!(result.outputs[0].second_order.as_ref().unwrap().len(), 0);
    assert_eq!(result.outputs[0].indices.as_ref().unwrap()[0].effect.probability_first, Some(1.0));
}

#[test]
fn all_factors_together_are_everything() {
    let text = "model = \"ishigami\"\n[design]\nbase_samples = 64\n\
                [analysis]\nsubsets = [[\"x1\", \"x2\"], [\"x1\", \"x2\", \"x3\"]]";
    let result = analysed(text);
    let [part, all] = &result.outputs[0].subsets.as_ref().unwrap()[..] else { panic!("two subsets") };
    assert_eq!((all.effect.first_order.estimate, all.effect.total.estimate), (1.0, 1.0));
    assert_eq!(all.effect.total.interval, Some(Interval { low: 1.0, high: 1.0 }));
    assert!(part.effect.first_order.estimate < 0.9);
    // A formula that reads one of two factors: all of the variance is its own, unless the other one tells of it.
    let text =
        "model = \"expression\"\noutputs.y = \"x\"\n[factors]\nx = { min = 0, max = 1 }\nz = { min = 0, max = 1 }\n";
    assert_eq!(first_and_total(&analysed(text).outputs[0]), [(1.0, 1.0), (0.0, 0.0)]);
    let dependent =
        "[[dependence]]\nfactors = [\"x\", \"z\"]\ncorrelation = 0.8\n[analysis]\nsubsets = [[\"x\", \"z\"]]";
    let result = analysed(&format!("{text}{dependent}"));
    let (_, total) = first_and_total(&result.outputs[0])[0];
    // Of uniform factors a little above 1 - 0.8^2.
    assert!((total - 0.36).abs() < 0.05, "{total}");
    assert_eq!(result.outputs[0].subsets.as_ref().unwrap()[0].effect.total.estimate, 1.0);
}

#[test]
fn a_factor_without_effect_has_exactly_none_and_one_that_is_everything_all() {
    let text = "model = \"linear\"\n[function]\nc = [1, 0, 0]\n[analysis]\nsecond_order = true\ndummy = true";
    let result = analysed(text);
    let output = &result.outputs[0];
    let indices = first_and_total(output);
    assert!((indices[0].0 - 1.0).abs() < 1e-3 && (indices[0].1 - 1.0).abs() < 1e-3, "{indices:?}");
    assert_eq!(indices[1..], [(0.0, 0.0); 2]);
    let inert = &output.indices.as_ref().unwrap()[1].effect;
    // A function of the list is not a formula whose factors are known: no row shows this one.
    assert!(inert.total.interval.is_some_and(|interval| interval.low == 0.0 && interval.high < 2e-3));
    assert!(inert.probability_first == Some(0.0) && inert.probability_above_threshold.is_some_and(|p| p < 1e-4));
    assert_eq!(output.dummy.as_ref().unwrap().total.estimate, 0.0);
    assert!(output.second_order.as_ref().unwrap().iter().all(|pair| pair.index.estimate == 0.0));
}

#[test]
fn two_base_samples_are_enough_for_estimates_and_too_few_for_more() {
    let result = analysed("model = \"ishigami\"\n[design]\nbase_samples = 2\nreplicates = 1");
    assert_eq!((result.provenance.base_samples, result.provenance.model_runs), (2, 10));
    for (first, total) in first_and_total(&result.outputs[0]) {
        assert!(first.is_finite() && total >= 0.0);
    }
    assert!(
        result.outputs[0].indices.as_ref().unwrap().iter().all(|index| index.effect.first_order.interval.is_none())
    );
    let result = analysed("model = \"ishigami\"\n[design]\nbase_samples = 4\nreplicates = 2");
    assert!(first_and_total(&result.outputs[0]).iter().all(|(first, total)| first.is_finite() && total.is_finite()));
}

#[test]
fn samples_that_are_no_power_of_two_are_allowed_and_warned_of() {
    let result = analysed("model = \"ishigami\"\n[design]\nbase_samples = 12000\nreplicates = 4");
    let output = &result.outputs[0];
    assert!(
        output.warnings.iter().any(|warning| matches!(warning, Warning::Unbalanced { .. })),
        "{:?}",
        output.warnings
    );
    let exact = [(0.313905, 0.557589), (0.442411, 0.442411), (0.0, 0.243684)];
    for (got, exact) in output.indices.as_ref().unwrap().iter().zip(exact) {
        // Some 2e-3 is the standard error of as many points on the way from one net to the next.
        let effect = &got.effect;
        assert!((effect.first_order.estimate - exact.0).abs() < 0.02 && (effect.total.estimate - exact.1).abs() < 0.02);
        assert!(
            effect.total.interval.unwrap().low < effect.total.estimate
                && effect.total.estimate < effect.total.interval.unwrap().high
        );
    }
}

#[test]
fn failed_rows_cost_their_own_indices_and_too_many_of_them_all() {
    let result = analysed(&format!("{HOLES}[design]\nbase_samples = 4096"));
    let output = &result.outputs[0];
    assert!(output.runs_failed > 0 && output.runs_ok > output.runs_failed);
    assert!(output.base_points_used < 4096 && output.indices.is_some());
    assert!(
        output.warnings.iter().any(|warning| matches!(warning, Warning::RunsFailed { .. })),
        "{:?}",
        output.warnings
    );
    let result = analysed(&format!("{HOLES}[design]\nbase_samples = 4096\n[analysis]\nmax_failed = 0.0001"));
    assert_eq!(result.outputs[0].indices, None);
    messages!().add("the reason", &result.outputs[0].reason.unwrap().to_string());
}

#[test]
fn outputs_of_any_size_that_doubles_hold_have_the_same_indices() {
    let of = |c: &str| {
        let result = analysed(&format!("model = \"linear\"\n[function]\nc = [{c}]\n[design]\nbase_samples = 1024"));
        first_and_total(&result.outputs[0])
    };
    let plain = of("2, 1");
    for (c, size) in [("2e140, 1e140", "1e140"), ("2e-140, 1e-140", "1e-140")] {
        for ((first, total), (expected_first, expected_total)) in of(c).into_iter().zip(&plain) {
            // Powers of ten round, and the roundings of 1024 sums differ.
            assert!((first - expected_first).abs() < 1e-12 && (total - expected_total).abs() < 1e-12, "{size}");
        }
    }
    // The squares of 1e300 and of 1e-300 leave the range of doubles: a reason, not a zero.
    let mut messages = messages!();
    for c in ["2e300, 1e300", "2e-300, 1e-300"] {
        let result = analysed(&format!("model = \"linear\"\n[function]\nc = [{c}]\n[design]\nbase_samples = 64"));
        let output = &result.outputs[0];
        assert_eq!(output.indices, None);
        messages.add(c, &output.reason.unwrap().to_string());
    }
}

/// A mean beyond doubles, or the bound of its interval, has no place in JSON: it is left out, and the file can be read.
#[test]
fn results_beyond_doubles_can_be_read_back() {
    for c in ["1.7e308, 1e308", "1e308, 9e307", "6e307, 6e307"] {
        let text = format!("model = \"linear\"\n[function]\nc = [{c}]\n[design]\nbase_samples = 16");
        let result = analysed(&text);
        let json = result.json();
        let read = parse_result(json.as_bytes()).unwrap_or_else(|error| panic!("{c}: {error}"));
        assert_eq!(read.json(), json);
    }
}

#[test]
fn a_thousand_factors() {
    let c: Vec<String> = (0..1000).map(|j| if j == 700 { "30" } else { "1" }.to_owned()).collect();
    let text = format!("model = \"linear\"\n[function]\nc = [{}]\n[design]\nbase_samples = 512", c.join(", "));
    let result = analysed(&text);
    assert_eq!(result.provenance.model_runs, 512 * 1002);
    let indices = first_and_total(&result.outputs[0]);
    // 900 of 1899 shares of the variance; the standard error at this size is some 0.02.
    assert!((indices[700].1 - 900.0 / 1899.0).abs() < 0.06, "{:?}", indices[700]);
    let first = result.outputs[0].indices.as_ref().unwrap()[700].effect.probability_first;
    assert!(first.unwrap() > 0.99, "{first:?}");
}
