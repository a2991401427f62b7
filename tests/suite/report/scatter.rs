//! Scatter plots of a result: their points and their conditional means.

use std::path::Path;

use apportion::result::{ConditionalMeansRecord, ScatterRecord, StudyResult};
use apportion_files::parse_study;

fn analysed(text: &str) -> StudyResult {
    let study = parse_study(text, Path::new("scatter.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    study.run().expect("a run")
}

fn scatter(text: &str) -> ScatterRecord {
    analysed(text).outputs[0].scatter.clone().expect("a record")
}

fn means(scatter: &ScatterRecord, factor: &str) -> ConditionalMeansRecord {
    scatter.conditional_means.iter().find(|means| means.factor == factor).cloned().expect("a factor")
}

#[test]
fn points_are_runs_of_the_model() {
    let scatter = scatter("model = \"ishigami\"\n[design]\nbase_samples = 1024\nreplicates = 2");
    assert_eq!(scatter.factors, ["x1", "x2", "x3"]);
    assert_eq!(scatter.points.len(), 400);
    for point in &scatter.points {
        let [x1, x2, x3, y] = point[..] else { panic!("three factors and the output") };
        let exact = libm::sin(x1) + 7.0 * libm::sin(x2).powi(2) + 0.1 * x3.powi(4) * libm::sin(x1);
        // The same formula, up to the order of its operations.
        assert!((y - exact).abs() < 1e-12 * (1.0 + exact.abs()), "{y} at {x1}, {x2}, {x3}");
    }
}

#[test]
fn means_of_a_sum_are_its_terms() {
    let scatter = scatter("model = \"linear\"\n[design]\nbase_samples = 4096");
    assert_eq!(scatter.factors[..4], ["x1", "x2", "x3", "x4"]);
    // c = (4, 2, 1, 0.5, 0) on the unit cube: E[Y | x_i] = c_i x_i + (7.5 - c_i) / 2.
    for (factor, c) in [("x1", 4.0), ("x2", 2.0), ("x3", 1.0), ("x4", 0.5)] {
        let means = means(&scatter, factor);
        assert_eq!((means.x.len(), means.x[0], means.x[19]), (20, 0.025, 0.975));
        for (place, x) in means.x.iter().enumerate() {
            let [mean, low, high] = [&means.mean, &means.low, &means.high].map(|list| list[place].expect("values"));
            assert!(low < mean && mean < high);
            // Slices of 2 * 4096 / 20 values: four standard errors, were they independent, which over 80 of them is rare.
            let error = (high - low) / 2.0 / 1.96;
            let exact = c * x + (7.5 - c) / 2.0;
            assert!((mean - exact).abs() < 4.0 * error, "{factor} at {x}: {mean} for {exact}, error {error}");
        }
    }
}

#[test]
fn every_value_of_a_discrete_factor_is_a_slice() {
    let factor = |rest: &str| format!("[[factor]]\nname = \"x1\"\n{rest}\n[[factor]]\nname = \"x2\"\n");
    let study = |rest: &str| {
        let factors = factor(rest);
        format!("model = \"linear\"\n{factors}\n[function]\nc = [4, 2]\n[design]\nbase_samples = 4096\n")
    };
    let three = study("distribution = \"discrete\"\nvalues = [0.25, 0.0, 1.0, 0.25]");
    let three = means(&scatter(&three), "x1");
    assert_eq!(three.x, [0.0, 0.25, 1.0]);
    for (x, mean) in three.x.iter().zip(&three.mean) {
        // 2 x2 over a slice of 2000 values or more: sd 0.577 / 45, five of them.
        assert!((mean.expect("values") - (4.0 * x + 1.0)).abs() < 0.065, "{mean:?} at {x}");
    }
}

#[test]
fn failed_runs_are_left_out() {
    let text = "model = \"expression\"\noutputs.y = \"x1 + x2*sqrt(3 - abs(x3))\"\n[factors]\n\
         x1 = { min = 0, max = 1 }\nx2 = { min = 0, max = 1 }\nx3 = { min = -3.14159, max = 3.14159 }\n\
         [design]\nbase_samples = 1024\n[analysis]\nmax_failed = 0.1";
    let scatter = scatter(text);
    // 4.5 % of the rows fail: a binomial of 400 has 18 of them, give or take 4.
    assert!((360..400).contains(&scatter.points.len()), "{}", scatter.points.len());
    assert!(scatter.points.iter().flatten().all(|number| number.is_finite()));
    let means = means(&scatter, "x3");
    assert!(means.mean.iter().flatten().all(|mean| mean.is_finite()));
}

#[test]
fn few_rows_leave_slices_without_means() {
    let scatter = scatter("model = \"ishigami\"\n[design]\nbase_samples = 2\nreplicates = 1");
    assert_eq!(scatter.points.len(), 2);
    let means = means(&scatter, "x1");
    assert_eq!(means.mean.iter().flatten().count(), 4, "four rows in four slices, by the net");
    assert_eq!(means.low.iter().chain(&means.high).flatten().count(), 0);
}

#[test]
fn at_most_six_factors_of_many_and_none_without_indices() {
    let scatter = scatter("model = \"sobol-g\"\n[function]\ndimension = 50\n[design]\nbase_samples = 512");
    assert_eq!(scatter.factors.len(), 6);
    assert_eq!(scatter.factors[..4], ["x1", "x2", "x3", "x4"]);
    assert!(scatter.points.iter().all(|point| point.len() == 7));
    assert_eq!(analysed("model = \"linear\"\n[function]\nc = [0, 0]").outputs[0].scatter, None);
}

#[test]
fn outputs_of_any_size_have_means() {
    // Squares of 1e200 exceed doubles.
    let factor = "[[factor]]\nname = \"x1\"\nmin = 1e200\nmax = 2e200\n[[factor]]\nname = \"x2\"\n";
    let text = format!("model = \"linear\"\n{factor}[function]\nc = [1, 1]\n[design]\nbase_samples = 256\n");
    let result = analysed(&text);
    if let Some(scatter) = &result.outputs[0].scatter {
        let bounds = means(scatter, "x1");
        assert!(bounds.low.iter().zip(&bounds.high).all(|(low, high)| low.unwrap() < high.unwrap()));
    } else {
        assert!(result.outputs[0].indices.is_none(), "{:?}", result.outputs[0].reason);
    }
}
