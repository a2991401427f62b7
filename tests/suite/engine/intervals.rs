//! Intervals and sentences for difficult outputs: rare events, values of 0 and 1, ties, failed rows.

use std::path::Path;

use apportion::Estimate;
use apportion::result::{OutputResult, StudyResult, Warning};
use apportion_report::{give_or_take, run_document, significant};

const UNIFORM: &str = "distribution = \"uniform\"\nmin = 0\nmax = 1";
const NORMAL: &str = "distribution = \"normal\"\nmean = 0\nsd = 1";

/// The result of `y` = `formula` of three factors a, b and c of one distribution.
fn analysed(formula: &str, distribution: &str, design: &str) -> StudyResult {
    let factors: String =
        ["a", "b", "c"].map(|name| format!("[[factor]]\nname = \"{name}\"\n{distribution}\n")).concat();
    let text = format!("model = \"expression\"\n[outputs]\ny = \"{formula}\"\n[design]\n{design}\n{factors}");
    let study =
        apportion_files::parse_study(&text, Path::new("small.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    study.run().unwrap()
}

fn output(result: &StudyResult) -> &OutputResult {
    &result.outputs[0]
}

/// First-order and total index of factor number `factor`: low, estimate, high.
fn bounds(result: &StudyResult, factor: usize) -> [(f64, f64, f64); 2] {
    let output = output(result);
    let effect = &output.indices.as_ref().unwrap_or_else(|| panic!("{:?}", output.reason))[factor].effect;
    [effect.first_order, effect.total]
        .map(|index| (index.interval.unwrap().low, index.estimate, index.interval.unwrap().high))
}

#[test]
fn an_output_of_0_and_1_has_no_interval_of_width_0() {
    // S1(c) = 0.0058 (by quadrature): at 256 base samples most designs have no base point that shows it.
    let formula = "if(0.8*a+0.5*b+0.1*c > 0.7, 1, 0)";
    let mut held = 0;
    for seed in 1..=5 {
        let result =
            analysed(formula, NORMAL, &format!("base_samples = 256\nseed = {seed}\n[analysis]\nsecond_order = true"));
        for factor in 0..3 {
            for (low, estimate, high) in bounds(&result, factor) {
                // A width that is more than rounding.
                assert!(high - low > 1e-3, "seed {seed}, factor {factor}: {estimate} in {low} to {high}");
            }
        }
        let pairs = output(&result).second_order.as_ref().unwrap();
        assert!(
            pairs.iter().all(|pair| pair.index.interval.unwrap().high - pair.index.interval.unwrap().low > 1e-3),
            "seed {seed}"
        );
        let [(low, _, high), _] = bounds(&result, 2);
        held += usize::from(low <= 0.0058 && 0.0058 <= high);
    }
    // It was 18 of 40 (45 % over 200 seeds), and is 94 % over 200 seeds.
    assert!(held >= 4, "{held} of 5 intervals hold S1(c)");
}

#[test]
fn a_step_lies_anywhere_between_the_rows_that_show_it() {
    // At places that depend on another factor (indices to 2e-4), and in a part of the rows, which are plain.
    let oblique = [[0.8306, 0.8418], [0.0646, 0.0992], [0.0702, 0.0936]];
    let (p, all) = ([0.6, 0.7, 0.8], 0.336);
    let corner = p.map(|p| [all / p * all * (1.0 - p), all * (1.0 - p)].map(|v| v / (all * (1.0 - all))));
    let cases = [
        ("if(a > 0.5 + 0.02*b, 1, 0) + b*c", "base_samples = 32", oblique),
        ("(a > 0.4)*(b > 0.3)*(c > 0.2)", "runs = 200", corner),
    ];
    for (formula, length, exact) in cases {
        let mut held = 0;
        for seed in 1..=4 {
            let result = analysed(formula, UNIFORM, &format!("{length}\nseed = {seed}"));
            for (factor, exact) in exact.iter().enumerate() {
                let bounds = bounds(&result, factor).into_iter().zip(exact);
                held +=
                    bounds.filter(|((low, _, high), exact)| low - 2e-4 <= **exact && **exact <= high + 2e-4).count();
            }
        }
        assert!(held >= 22, "{held} of 24 intervals of {formula}");
    }
}

#[test]
fn a_factor_without_effect_has_an_interval_of_width_0() {
    let result = analysed("if(a+b > 1, 1, 0)", UNIFORM, "base_samples = 256\n[analysis]\nsecond_order = true");
    assert_eq!(bounds(&result, 2), [(0.0, 0.0, 0.0); 2]);
    // A half-plane of one factor is integrated exactly by every net; its indices are 1, which 256 rows do not prove.
    let exact = analysed("if(a + 0*b > 0.5, 1, 0)", UNIFORM, "base_samples = 256");
    let [(low, first, high), _] = bounds(&exact, 0);
    assert!((first - 1.0).abs() < 1e-9 && low < 0.999 && high > 1.001, "{low} {first} {high}");
    // The formula does: it reads no other factor.
    let alone = analysed("if(a > 0.5, 1, 0)", UNIFORM, "base_samples = 256");
    assert_eq!((bounds(&alone, 0), bounds(&alone, 1)), ([(1.0, 1.0, 1.0); 2], [(0.0, 0.0, 0.0); 2]));
}

#[test]
fn a_rare_event_has_indices_and_a_warning() {
    // Mean .001: with a few events in a thousand rows, most nets have none, and half of the designs none in A or in B.
    for seed in 1..=12 {
        let result = analysed("if(a > 0.999, 1, 0)", UNIFORM, &format!("base_samples = 1024\nseed = {seed}"));
        let output = output(&result);
        if output.variance == Some(0.0) {
            assert!(output.reason.is_some() && output.indices.is_none());
            continue;
        }
        let indices = output.indices.as_ref().unwrap_or_else(|| panic!("seed {seed}: {:?}", output.reason));
        let (first, total) = (indices[0].effect.first_order, indices[0].effect.total);
        assert!((total.estimate - 1.0).abs() < 0.01 && indices[1].effect.total.estimate == 0.0, "seed {seed}");
        // Without an interval there is a reason; with one, S1 = 1 is in it.
        match first.interval {
            Some(interval) => assert!(interval.high > 0.9, "seed {seed}: S1 = 1, but {first:?}"),
            None => assert!(output.warnings.contains(&Warning::NoIntervals), "seed {seed}: {:?}", output.warnings),
        }
        assert!(output.warnings.iter().any(has_few_rows), "seed {seed}: {:?}", output.warnings);
    }
}

fn has_few_rows(warning: &Warning) -> bool {
    matches!(warning, Warning::FewRows { .. })
}

#[test]
fn a_heavy_tail_reaches_further_up_and_is_warned_of() {
    let result = analysed("exp(a+b+c)", NORMAL, "base_samples = 256");
    let warnings = &output(&result).warnings;
    assert!(warnings.iter().any(has_few_rows), "{warnings:?}");
    let [_, (low, total, high)] = bounds(&result, 0);
    assert!(high - total > 1.2 * (total - low), "{low} {total} {high}");
    let result = analysed("a+2*b+3*c", UNIFORM, "base_samples = 256");
    assert!(output(&result).warnings.is_empty(), "{:?}", output(&result).warnings);
}

#[test]
fn mean_and_variance_are_those_of_all_rows_that_succeeded() {
    // Rows with a < 0.05 fail: some base points lose A, some B.
    let result = analysed(
        "if(a < 0.05, ln(-1), a+b*c)",
        UNIFORM,
        "base_samples = 256\n[analysis]\nsurrogate = \"on\"\nmax_failed = 0.2",
    );
    let output = output(&result);
    let (mean, variance, distribution) =
        (output.mean.unwrap(), output.variance.unwrap(), output.distribution.as_ref().unwrap());
    let n = distribution.values as f64;
    assert!(n < 512.0 && n > 450.0);
    assert!((mean - distribution.mean).abs() < 1e-14 * mean, "{mean} {}", distribution.mean);
    let sd = (variance * n / (n - 1.0)).sqrt();
    assert!((sd / distribution.sd.unwrap() - 1.0).abs() < 1e-13, "{sd} {:?}", distribution.sd);
    let interval = output.mean_interval.unwrap();
    assert!(((interval.low + interval.high) / 2.0 - mean).abs() < 1e-12, "{interval:?} about {mean}");
    let interval = output.variance_interval.unwrap();
    assert!(interval.low < variance && variance < interval.high);
    let bounds = output.mean_interval.unwrap();
    let mean = Estimate { estimate: mean, interval: Some(bounds) };
    let text = run_document(&result).text();
    // The polynomials determine the variance so well that a divisor n - 1 would be outside its interval.
    let sd = significant((1e5 * variance.sqrt()).round() / 1e5);
    let heading = format!("Mean {}, standard deviation {sd}", give_or_take(mean));
    assert!(text.contains(&heading), "{heading} in {text}");
}

/// At 16 points a net some of 20 columns share leading digits. Where all four nets do so alike, rows that differ in such a factor
/// alone differ too little in it: one design of twelve missed the total index of the ninth factor without surrogates.
#[test]
fn intervals_hold_where_the_columns_of_a_factor_are_correlated() {
    let text = "model = \"wing-weight\"\n[design]\nbase_samples = 64\n[analysis]\nsurrogate = \"off\"\n";
    let held = (1..=120).filter(|seed| {
        let result = apportion_files::parse_study(text, Path::new("wing.toml"), &[format!("design.seed={seed}")])
            .unwrap()
            .run()
            .unwrap();
        let [_, (low, _, high)] = bounds(&result, 8);
        // By a corrected run of 65,536 base samples.
        low <= 0.0876 && 0.0876 <= high
    });
    let held = held.count();
    assert!(held >= 114, "{held} of 120 intervals hold it");
}
