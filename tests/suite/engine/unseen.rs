//! What rows do not show: switches whose effect they miss, thin regions, and inputs that are not read.

use std::path::Path;

use apportion::result::StopReason;
use apportion::{EffectEstimates, Interval, Study};
use apportion_files::parse_study;

use crate::common::effects;

const UNIFORM: &str = "min = 0, max = 1";
const SWITCH: &str = r#"distribution = "discrete", values = [0, 1], weights = [0.5, 0.5]"#;

fn formula(formula: &str, factors: &[(&str, &str)], sets: &[String]) -> Study {
    let mut text = format!("model = \"expression\"\n[outputs]\ny = \"{formula}\"\n[factors]\n");
    for (factor, law) in factors {
        text.push_str(&format!("{factor} = {{ {law} }}\n"));
    }
    parse_study(&text, Path::new("formula.toml"), sets).unwrap()
}

fn sets(base_samples: u64, seed: u64) -> [String; 2] {
    [format!("design.base_samples={base_samples}"), format!("design.seed={seed}")]
}

fn indices(study: &Study) -> Vec<EffectEstimates> {
    effects(&study.run().unwrap().outputs[0])
}

fn holds(interval: Option<Interval>, exact: f64) -> bool {
    interval.is_some_and(|interval| (interval.low - 1e-12..=interval.high + 1e-12).contains(&exact))
}

#[test]
fn no_acting_switch_is_without_effect() {
    let factors = ["a", "b", "c", "d", "e", "f", "g", "h"].map(|factor| (factor, SWITCH));
    // By enumeration: the first six have S_T = 0.1678, the last two 0.3914.
    let exact = [0.167_759, 0.167_759, 0.167_759, 0.167_759, 0.167_759, 0.167_759, 0.391_437, 0.391_437];
    let (mut held, mut all) = (0, 0);
    for (base_samples, seeds) in [(1024, 22..23), (64, 0..16)] {
        for seed in seeds {
            let study = formula("max(a*b*c, max(d*e*f, g*h))", &factors, &sets(base_samples, seed));
            for (of, exact) in indices(&study).iter().zip(exact) {
                let total = of.total;
                assert!(total.interval.unwrap().high > 0.0, "{base_samples}, {seed}: {total:?}");
                held += usize::from(holds(total.interval, exact));
                all += 1;
            }
        }
    }
    assert!(held * 100 >= all * 90, "{held} of {all}");
}

#[test]
fn what_no_swap_changed_is_not_settled() {
    // The fourth of four switches acts only where the others are on: in one of eight pairs.
    let factors = [("a", SWITCH), ("b", SWITCH), ("c", SWITCH), ("d", SWITCH)];
    let mut missed = 0;
    for seed in 0..32 {
        let study = formula("a*b*c*d + a + b + c", &factors, &[&sets(8, seed)[..], &surrogate_off()].concat());
        let d = indices(&study)[3];
        if d.total.estimate == 0.0 {
            missed += 1;
            // S_T(d) = 0.0314.
            assert!(holds(d.total.interval, 0.0314), "{d:?}");
            assert!(d.probability_above_threshold.unwrap() > 0.01 && d.first_order.interval.unwrap().low == 0.0);
        }
    }
    assert!(missed > 0);
}

fn surrogate_off() -> Vec<String> {
    vec!["analysis.surrogate=\"off\"".to_owned()]
}

#[test]
fn an_input_that_is_not_read_has_no_effect() {
    let factors = [("a", UNIFORM), ("b", UNIFORM), ("c", UNIFORM), ("k", "distribution = \"constant\", value = 3")];
    let of = indices(&formula("a + k*b^2", &factors, &sets(64, 1)));
    let nothing = Interval { low: 0.0, high: 0.0 };
    for unread in [of[2], of[3]] {
        assert_eq!((unread.total.estimate, unread.total.interval), (0.0, Some(nothing)));
        assert_eq!((unread.probability_above_threshold, unread.probability_first), (Some(0.0), Some(0.0)));
    }
    // It is read here, and its effect is below what the surrogate leaves unexplained.
    let read = indices(&formula("a + k*b^2 + 0*c", &factors, &sets(64, 1)))[2].total.interval.unwrap();
    assert!(read.low == 0.0 && read.high > 0.0 && read.high < 1e-4, "{read:?}");
}

#[test]
fn an_accuracy_is_not_met_before_its_regions_have_values() {
    // With V = 0.5942: S_T(a) = 0.7195, the others 0.1403.
    let factors = ["a", "b", "c"].map(|factor| (factor, UNIFORM));
    let text = "3*(abs(a - 0.6) < 0.025) + b + c";
    for seed in 0..2 {
        let at = |region: f64| {
            let sets = ["accuracy=0.05".into(), format!("smallest_region={region}"), format!("design.seed={seed}")];
            formula(text, &factors, &sets).run().unwrap()
        };
        for region in [0.05, 0.001] {
            let result = at(region);
            let spending = result.spending.as_ref().unwrap();
            assert!(spending.excluded_region <= region, "{spending:?}");
            let met = matches!(result.stopping.as_ref().unwrap().reason, StopReason::TargetMet { .. });
            let error = (effects(&result.outputs[0])[0].total.estimate - 0.7195).abs();
            assert!(met && error < 0.075, "{region}, {seed}: {error}");
        }
    }
}

#[test]
fn a_wavy_step_is_not_met_by_a_few_runs() {
    let factors = ["a", "b", "c"].map(|factor| (factor, UNIFORM));
    for seed in 0..3 {
        let sets = ["accuracy=0.05".into(), "smallest_region=0.05".into(), format!("design.seed={seed}")];
        let of = indices(&formula("if(a > 0.5 + 0.1*sin(6*b), 1, 0) + 0.2*c", &factors, &sets));
        for (of, exact) in of.iter().zip([0.9662, 0.1629, 0.0132]) {
            assert!((of.total.estimate - exact).abs() < 0.075, "{seed}: {:?}", of.total);
        }
    }
}

#[test]
fn a_smallest_region_needs_an_accuracy() {
    let refused = |sets: &[&str]| {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        let text = "model = \"expression\"\n[outputs]\ny = \"a\"\n[factors]\na = { min = 0, max = 1 }\n";
        parse_study(text, Path::new("formula.toml"), &sets).unwrap_err()
    };
    for sets in
        [&["smallest_region=0.1"][..], &["accuracy=0.1", "smallest_region=0"], &["accuracy=0.1", "smallest_region=1"]]
    {
        let error = refused(sets);
        assert!(error.to_string().contains("smallest_region"), "{error}");
    }
}

/// A surrogate has three hyperparameters for each of 30 factors, and 128 rows: two of these seeds ended with S_T off by .08 and .10.
#[test]
fn many_factors_do_not_make_a_surrogate_sure_of_itself() {
    let names: Vec<String> = (1..=30).map(|number| format!("x{number}")).collect();
    let factors: Vec<(&str, &str)> = names.iter().map(|name| (&name[..], UNIFORM)).collect();
    let text = "(x3 > 0.4)*(x7 > 0.6) + abs(x11 - 0.3) + 0.5*(x20 > 0.7)";
    let exact = [(3, 0.350_195), (7, 0.525_292), (11, 0.143_118), (20, 0.191_512)];
    for seed in [10, 16, 0] {
        let sets = ["accuracy=0.05".into(), "smallest_region=0.05".into(), format!("design.seed={seed}")];
        for (place, of) in indices(&formula(text, &factors, &sets)).iter().enumerate() {
            let exact = exact.iter().find(|(number, _)| number - 1 == place).map_or(0.0, |(_, exact)| *exact);
            assert!((of.total.estimate - exact).abs() < 0.05, "{seed}, {place}: {:?}", of.total);
        }
    }
}

/// Some of the 32 or 64 combinations of levels are in no row of a short search: 6 of 10 ended with indices that were wrong.
#[test]
fn no_search_ends_on_combinations_of_levels_that_no_row_has() {
    let factors = ["a", "b", "c", "d", "e", "f"].map(|factor| (factor, SWITCH));
    let (alone, paired) = ([0.163_636, 0.581_818], [0.018_182, 0.193_939]);
    let cases = [
        ("if(a+b+c+d+e > 2.5, 1, 0)", 5, vec![[0.140_625, 0.375]; 5]),
        ("max(max(a*b, c*d), max(e, f))", 6, vec![paired, paired, paired, paired, alone, alone]),
    ];
    for (text, count, exact) in cases {
        for seed in 0..6 {
            let sets = ["accuracy=0.05".into(), "smallest_region=0.05".into(), format!("design.seed={seed}")];
            for (of, [first, total]) in indices(&formula(text, &factors[..count], &sets)).iter().zip(&exact) {
                let errors = [of.first_order.estimate - first, of.total.estimate - total];
                assert!(errors.iter().all(|error| error.abs() < 0.05), "{text}, {seed}: {of:?}");
            }
        }
    }
}

#[test]
fn combinations_of_levels_that_no_run_has_widen_intervals() {
    let factors = ["a", "b", "c", "d", "e", "f", "g"].map(|factor| (factor, SWITCH));
    // By enumeration: four of them act together, the other three more often.
    let exact = [[0.020_290, 0.185_507], [0.093_168, 0.397_516]];
    let (mut held, mut all) = (0, 0);
    for seed in 0..8 {
        for (factor, of) in indices(&formula("max(a*b*c*d, e*f*g)", &factors, &sets(32, seed))).iter().enumerate() {
            let [first, total] = exact[usize::from(factor > 3)];
            held += usize::from(holds(of.first_order.interval, first)) + usize::from(holds(of.total.interval, total));
            all += 2;
        }
    }
    // It was 68 of 112 by intervals of no width.
    assert!(held * 100 >= all * 92, "{held} of {all}");
}
