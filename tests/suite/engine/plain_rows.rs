//! Plain rows: runs at points of their own, whose surrogate gives all indices.

use std::path::Path;

use apportion::result::{AccuracyReason, StudyResult};
use apportion::{Estimate, Interval, Study};

fn study(text: &str, changes: &[&str]) -> Study {
    let changes: Vec<String> = changes.iter().map(|text| (*text).to_owned()).collect();
    apportion_files::parse_study(text, Path::new("mine.toml"), &changes).unwrap()
}

fn expression(formula: &str, factors: &str) -> String {
    let lines: String = factors.chars().map(|name| format!("{name} = {{ min = -1, max = 1 }}\n")).collect();
    format!("model = \"expression\"\noutputs.y = \"{formula}\"\n[factors]\n{lines}")
}

fn holds(index: Estimate, exact: f64) -> bool {
    let interval = index.interval.unwrap();
    (interval.low - 1e-9..=interval.high + 1e-9).contains(&exact) && interval.width() < 0.1
}

/// Of uniform factors on (-1, 1): a linear term c x has the variance c^2/3, a product c x y c^2/9.
#[test]
fn all_effects_come_from_the_same_two_hundred_runs() {
    let text = expression("2*a + b + c*d + 0.5*e*f + 0*g + 0*h", "abcdefgh").replace(
        "e = { min = -1, max = 1 }\nf = { min = -1, max = 1 }",
        "e = { min = -1, max = 1, group = \"ef\" }\nf = { min = -1, max = 1, group = \"ef\" }",
    );
    let more =
        ["design.runs=200", "analysis.second_order=true", "analysis.shapley=true", "analysis.subsets=[[\"a\",\"c\"]]"];
    let result = study(&text, &more).run().unwrap();
    assert!(result.provenance.plain && result.provenance.model_runs == 200);
    let output = &result.outputs[0];
    let [a, b, cd, ef] = [4.0 / 3.0, 1.0 / 3.0, 1.0 / 9.0, 0.25 / 9.0];
    let all = a + b + cd + ef;
    let first = [a, b, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let total = [a, b, cd, cd, ef, ef, 0.0, 0.0];
    let shapley = [a, b, cd / 2.0, cd / 2.0, ef / 2.0, ef / 2.0, 0.0, 0.0];
    for (k, index) in output.indices.as_ref().unwrap().iter().enumerate() {
        assert!(
            holds(index.effect.first_order, first[k] / all) && holds(index.effect.total, total[k] / all),
            "{index:?}"
        );
        assert!(holds(index.effect.shapley.unwrap(), shapley[k] / all), "{index:?}");
    }
    let group = &output.group("ef").unwrap();
    assert!(holds(group.first_order, ef / all) && holds(group.total, ef / all), "{group:?}");
    let subset = output.subsets.as_ref().unwrap()[0].effect;
    assert!(holds(subset.first_order, a / all) && holds(subset.total, (a + cd) / all), "{subset:?}");
    for pair in output.second_order.as_ref().unwrap() {
        let exact = match [&*pair.factors[0], &*pair.factors[1]] {
            ["c", "d"] => cd / all,
            ["e", "f"] => ef / all,
            _ => 0.0,
        };
        assert!(holds(pair.index, exact), "{pair:?}");
    }
    assert!((output.mean.unwrap()).abs() < 1e-9 && (output.variance.unwrap() - all).abs() < 1e-9);
}

fn bits(result: StudyResult) -> String {
    serde_json::to_string(&result.outputs).unwrap()
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let study = study("model = \"sobol-g\"\n", &["design.runs=120"]);
    let [one, two] = [1, 2].map(|threads| bits(study.runner().threads(threads).run().unwrap()));
    assert_eq!(one, two);
}

/// A wave of period 1/13 is noise for polynomials: its points get swaps, and the runs stay within their number.
#[test]
fn what_a_surrogate_does_not_explain_is_measured_by_swaps() {
    let text = expression("sin(13*pi*a) + b", "ab");
    let result = study(&text, &["design.runs=500"]).run().unwrap();
    assert!(!result.provenance.plain && result.provenance.model_runs <= 500);
    let [a, b] = [0.5, 1.0 / 3.0].map(|part| part / (0.5 + 1.0 / 3.0));
    for (name, exact) in [("a", a), ("b", b)] {
        let total = result.output("y").unwrap().factor(name).unwrap().total;
        assert!((total.estimate - exact).abs() < 0.2, "{total:?}");
    }
}

#[test]
fn an_accuracy_takes_some_sixty_plain_rows_of_a_smooth_program() {
    for (name, most) in [("borehole", 72), ("wing-weight", 72), ("ishigami", 100), ("sobol-g", 150)] {
        // As long as the rows of a program.
        let study = study(&format!("accuracy = 0.02\nsmallest_region = 0.05\nmodel = \"{name}\"\n"), &[]);
        let result = study.run().unwrap();
        let spending = result.spending.as_ref().unwrap();
        assert!(spending.runs <= most && result.stopping.as_ref().unwrap().target_met == Some(true), "{spending:?}");
        assert!(matches!(spending.reasons[..], [AccuracyReason::PlainRows { .. }]), "{spending:?}");
        assert!(result.outputs[0].largest_half_width().unwrap() <= 0.02);
    }
}

/// What a model does not read has no effect, whatever a surrogate makes of chance.
#[test]
fn an_input_that_is_not_read_is_exactly_without_effect() {
    let result = study(&expression("a + exp(b)", "abc"), &["design.runs=64"]).run().unwrap();
    let effect = result.output("y").unwrap().factor("c").unwrap();
    for index in [effect.first_order, effect.total] {
        assert_eq!((index.estimate, index.interval.unwrap().width()), (0.0, 0.0));
    }
}

/// An output that is 0 in all rows may not be so elsewhere.
#[test]
fn an_output_that_does_not_vary_meets_no_accuracy() {
    let text = format!("accuracy = 0.1\nsmallest_region = 0.05\n{}", expression("if(a*b>0.9999, 1, 0)", "ab"));
    let result = study(&text, &[]).run().unwrap();
    assert_eq!(result.stopping.as_ref().unwrap().target_met, Some(false));
    assert!(result.spending.unwrap().runs > 1000);
}

/// Polynomials of counts are huge at the rarest ones, which some rows have: the intervals missed half of the indices.
#[test]
fn rare_counts_do_not_mislead() {
    let text = "model = \"expression\"\noutputs.y = \"if(a > 1, b, 0)\"\n[factors]\n\
                a = { distribution = \"poisson\", mean = 0.7 }\nb = { distribution = \"poisson\", mean = 4 }\n";
    let p = 1.0 - 1.7 * (-0.7f64).exp();
    let [of_a, of_b, all] = [16.0 * p * (1.0 - p), 4.0 * p * p, p * 20.0 - 16.0 * p * p];
    let exact = [(of_a / all, 1.0 - of_b / all), (of_b / all, 1.0 - of_a / all)];
    let (mut held, mut indices) = (0, 0);
    for seed in 0..4 {
        for size in ["design.runs=500", "design.runs=2000", "design.base_samples=1024"] {
            let result = study(text, &[size, &format!("design.seed={seed}")]).run().unwrap();
            for (index, (first_order, total)) in result.outputs[0].indices.as_ref().unwrap().iter().zip(exact) {
                for (index, exact) in [(index.effect.first_order, first_order), (index.effect.total, total)] {
                    let Interval { low, high } = index.interval.unwrap();
                    held += usize::from((low..=high).contains(&exact));
                    indices += 1;
                    let error = (index.estimate - exact).abs();
                    assert!(error < 3.0 * (high - low) / 2.0 + 1e-3, "{size}, {seed}: {index:?}, {exact}");
                }
            }
        }
    }
    assert!(held * 100 >= indices * 92, "{held} of {indices}");
}
