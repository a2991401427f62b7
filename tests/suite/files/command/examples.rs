//! The worked examples in `studies/` run and give the indices that are known.

use apportion::result::OutputResult;

use crate::common::{gap, numbers, study_path};

fn analysed(name: &str, base_samples: u64) -> Vec<OutputResult> {
    let path = study_path(&format!("{name}/{name}"));
    let study = apportion_files::load_study(&path, &[format!("design.base_samples={base_samples}")]).unwrap();
    let result = study.run().unwrap();
    assert_eq!(
        result.outputs.iter().map(|output| output.runs_failed).sum::<u64>(),
        0,
        "{:?}",
        result.outputs[0].failures
    );
    result.outputs
}

#[track_caller]
fn is_ishigami(outputs: &[OutputResult], tolerance: f64) {
    let (first, total) = numbers(&outputs[0]);
    assert!(gap(&first, &[0.3139, 0.4424, 0.0]) < tolerance, "{first:?}");
    assert!(gap(&total, &[0.5576, 0.4424, 0.2437]) < tolerance, "{total:?}");
}

/// Indices of a product of powers of uniform factors, each as (least, largest, power): with the second moment of a factor's
/// power over its squared mean as r, S = (r - 1) / (product of all r - 1), ST = (1 - 1/r) / (1 - 1/product).
fn of_product(factors: &[(f64, f64, f64)]) -> (Vec<f64>, Vec<f64>) {
    let moment = |(a, b, p): (f64, f64, f64)| {
        if p == -1.0 { (b / a).ln() / (b - a) } else { (b.powf(p + 1.0) - a.powf(p + 1.0)) / ((p + 1.0) * (b - a)) }
    };
    let ratio = |&(a, b, p): &(f64, f64, f64)| moment((a, b, 2.0 * p)) / moment((a, b, p)).powi(2);
    let ratios: Vec<f64> = factors.iter().map(ratio).collect();
    let all: f64 = ratios.iter().product();
    let first = ratios.iter().map(|r| (r - 1.0) / (all - 1.0)).collect();
    (first, ratios.iter().map(|r| (1.0 - 1.0 / r) / (1.0 - 1.0 / all)).collect())
}

/// Deflection 4 F L^3 / (E w t^3) and stress 6 F L / (w t^2).
#[track_caller]
fn is_beam(outputs: &[OutputResult]) {
    let (length, thickness, load) = ((95.0, 105.0), (1.9, 2.1), (4.0, 6.0));
    for (output, powers) in outputs.iter().zip([[3.0, -3.0, 1.0], [1.0, -2.0, 1.0]]) {
        let factors: Vec<_> = [length, thickness, load].iter().zip(powers).map(|(f, p)| (f.0, f.1, p)).collect();
        let (exact, exact_total) = of_product(&factors);
        let (first, total) = numbers(output);
        // The error of 128 Sobol' points is some 0.015.
        assert!(
            gap(&first, &exact) < 0.05 && gap(&total, &exact_total) < 0.05,
            "{first:?} {exact:?} {total:?} {exact_total:?}"
        );
    }
}

#[test]
fn a_python_function_has_its_exact_indices() {
    // The half widths of 2048 Sobol' points reach 0.04.
    is_ishigami(&analysed("command-python", 2048), 0.06);
}

#[test]
#[ignore = "needs numpy, which .ci/run has"]
fn numpy_has_them_too() {
    is_ishigami(&analysed("command-numpy", 16384), 0.01);
}

#[test]
fn a_shell_script_has_them() {
    is_beam(&analysed("command-awk", 256));
}

#[test]
fn a_simulator_with_input_and_output_files_has_them() {
    let outputs = analysed("command-template", 32);
    is_beam(&outputs);
    // 2.7e-3 g/mm^3 times 100 x 10 x 2 mm^3.
    assert!((outputs[2].mean.unwrap() - 5.4).abs() < 0.01, "{:?} {}", outputs[2].mean, outputs[2].unit);
}
