//! Values by hand, and exact answers against `tests/oracle/known-answers.json`, which Python wrote from its own formulas.

use std::f64::consts::{E, PI};

use serde_json::Value;

use super::exact::relative_variance_of_exponential;
use super::parameters::MAX_INPUTS;
use super::*;

/// Names with their numbers; one number is a number, others are lists.
type Parameters<'a> = &'a [(&'a str, &'a [f64])];

fn known(name: &str, parameters: Parameters<'_>) -> Result<KnownFunction, ParameterError> {
    let value = |list: &[f64]| match list {
        [number] => ParameterValue::Number(*number),
        list => ParameterValue::List(list.to_vec()),
    };
    let parameters: Vec<_> = parameters.iter().map(|(name, list)| ((*name).to_owned(), value(list))).collect();
    KnownAnswer::from_name(name).unwrap().with(&parameters)
}

fn value(name: &str, parameters: Parameters<'_>, x: &[f64]) -> f64 {
    known(name, parameters).unwrap().value(x)
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

#[track_caller]
fn assert_close(got: f64, expected: f64, tolerance: f64) {
    assert!((got - expected).abs() <= tolerance * (1.0 + expected.abs()), "{got}, not {expected}");
}

#[test]
fn values_by_hand() {
    assert_close(value("ishigami", &[], &[PI / 2.0, PI / 2.0, 1.0]), 8.1, 1e-15);
    assert_close(value("ishigami", &[("a", &[2.0]), ("b", &[0.0])], &[PI / 2.0, PI / 2.0, 1.0]), 3.0, 1e-15);
    assert_eq!(value("sobol-g", &[], &[0.5; 8]), 0.0);
    assert_eq!(value("sobol-g", &[], &[0.75; 8]), 1.0);
    assert_eq!(value("sobol-g", &[("a", &[1.0, 3.0])], &[1.0, 0.5]), 1.5 * 0.75);
    // frac(0.25 + 0.5) = 0.75: |2 * 0.75 - 1| = 0.5, (1 + 2) * 0.25 = 0.75.
    let shifted: [(&str, &[f64]); 3] = [("a", &[0.0, 1.0]), ("delta", &[0.5, 0.0]), ("alpha", &[2.0])];
    assert_eq!(value("g-star", &shifted, &[0.25, 1.0]), 0.75 * 2.0);
    assert_eq!(value("bratley", &[("dimension", &[3.0])], &[0.5, 0.5, 0.5]), -0.5 + 0.25 - 0.125);
    assert_close(
        value("sobol-levitan", &[("b", &[1.0, 1.0]), ("c0", &[5.0])], &[1.0, 1.0]),
        E * E - (E - 1.0).powi(2) + 5.0,
        1e-15,
    );
    assert_eq!(value("linear", &[], &[1.0, 0.5, 0.25, 2.0, 9.0]), 4.0 + 1.0 + 0.25 + 1.0);
    assert_eq!(value("product", &[], &[2.0, 3.0, -4.0]), -24.0);
    assert_eq!(value("minimum", &[("dimension", &[3.0])], &[0.5, 0.25, 0.75]), 0.25);
    assert_eq!(value("steps", &[("c", &[2.0, 1.0]), ("t", &[0.5, 0.25])], &[0.75, 0.125]), 2.0 * 0.25);
    assert_eq!(value("simplex", &[], &[0.25, 0.25, 0.5]), 1.0);
    assert_eq!(value("simplex", &[], &[0.25, 0.25, 0.75]), 0.0);
    // All w are 1 at x = 1 but those of 3, 5 and 7, which are 2 (1.1 / 1.1 - 0.5) = 1 as well.
    let pairs: f64 = 15.0 * -15.0
        + (6..20).map(|j| (0..j).map(|i| if (i + j) % 2 == 0 { 1.0 } else { -1.0 }).sum::<f64>()).sum::<f64>();
    assert_close(value("morris", &[], &[1.0; 20]), 200.0 + pairs - 10.0 * 10.0 + 5.0, 1e-14);
    assert_close(value("oakley-ohagan", &[], &[0.0; 15]), 15.756, 1e-13);
    // Q = B Ks sqrt(slope) makes H = 1.
    assert_close(
        value("flood", &[], &[300.0 * 30.0 * 0.001f64.sqrt(), 30.0, 50.0, 55.0, 8.0, 55.5, 5000.0, 300.0]),
        -12.5,
        1e-15,
    );
    // ln(r/rw) = 1, 2 L Tu = rw^2 Kw and Tu = Tl: the denominator is 3.
    assert_close(value("borehole", &[], &[1.0, E, 2.0, 5.0, 2.0, 2.0, 3.0, 12.0]), 4.0 * PI, 1e-15);
    assert_close(value("wing-weight", &[], &[1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 0.01, 1.0, 1.0, 2.0]), 2.036, 1e-15);
    // c = 90 and Rf = 10: Vb1 = 6.
    let otl = 6.74 * 0.9 + 1.135 + 0.74 * 9.0 / 2.0;
    assert_close(value("otl-circuit", &[], &[1.0, 1.0, 10.0, 2.0, 1.0, 9.0]), otl, 1e-15);
    // S = k = 1, A = 1 + 19.62 - 20.62 = 0 and P0 V0 Ta/T0 = 20.62 = V^2.
    let cycle = 2.0 * PI * (1.0f64 / (1.0 + 20.62 / 20.62)).sqrt();
    assert_close(value("piston", &[], &[1.0, 1.0, 20.62, 1.0, 1.0, 300.0, 300.0]), cycle, 1e-14);
}

#[test]
fn exact_answers_are_those_of_the_oracle() {
    let oracle: Value = serde_json::from_str(include_str!("../../../tests/oracle/known-answers.json")).unwrap();
    let case_3: [f64; 10] = [0.0, 0.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0];
    let bent = &oracle["G* alpha=0.5"]["parameters"];
    let cases = [
        ("ishigami a=7 b=0.1", known("ishigami", &[])),
        ("ishigami a=7 b=0.05", known("ishigami", &[("b", &[0.05])])),
        ("sobol-g (0,1,4.5,9,99x4)", known("sobol-g", &[])),
        ("sobol-g 3B a=6.52 d=10", known("sobol-g", &[("a", &[6.52]), ("dimension", &[10.0])])),
        ("G* alpha=1 (case 3 of Saltelli 2010 a)", known("g-star", &[("a", &case_3)])),
        (
            "G* alpha=0.5",
            known("g-star", &[("a", &numbers(&bent["a"])), ("delta", &numbers(&bent["delta"])), ("alpha", &[0.5])]),
        ),
        ("sobol-levitan 1999 d=7", known("sobol-levitan", &[])),
        ("product of normals", known("product", &[])),
        ("linear", known("linear", &[])),
        ("bratley 1992 (K, 1A) d=8", known("bratley", &[])),
        ("morris 1991 d=20, remaining coefficients (-1)^i, (-1)^(i+j)", known("morris", &[])),
        ("oakley-o'hagan 2004 d=15", known("oakley-ohagan", &[])),
        ("minimum d=2", known("minimum", &[])),
    ];
    for (name, function) in cases {
        let (case, exact) = (&oracle[name], function.unwrap().exact());
        // The oracle subtracts: its own indices are good to some 1e-14 of the variance.
        assert_close(exact.mean, case["mean"].as_f64().unwrap(), 1e-12);
        let variance = case["var"].as_f64().unwrap();
        assert!((exact.variance / variance - 1.0).abs() < 1e-12, "{name}: {}", exact.variance);
        let indices = exact.indices.unwrap();
        for (got, key) in [(&indices.first_order, "S1"), (&indices.total, "ST")] {
            let expected = numbers(&case[key]);
            assert_eq!(got.len(), expected.len());
            for (got, expected) in got.iter().zip(expected) {
                assert!((got - expected).abs() < 1e-12, "{name} {key}: {got}, not {expected}");
            }
        }
    }
}

#[test]
fn references_are_those_of_the_quadrature_and_of_the_oracle() {
    let quadrature: Value = serde_json::from_str(include_str!("../../../tests/oracle/known-reference.json")).unwrap();
    for case in quadrature.as_array().unwrap() {
        let exact = known(case["function"].as_str().unwrap(), &[]).unwrap().exact();
        let Basis::Quadrature { error } = exact.basis else { panic!("by quadrature") };
        assert!(error >= case["error"].as_f64().unwrap());
        let indices = exact.indices.unwrap();
        assert_eq!((exact.mean, exact.variance), (case["mean"].as_f64().unwrap(), case["variance"].as_f64().unwrap()));
        assert_eq!((indices.first_order, indices.total), (numbers(&case["first_order"]), numbers(&case["total"])));
    }
    // The oracle's own values come from some 5e6 random points, with their standard errors.
    let oracle: Value = serde_json::from_str(include_str!("../../../tests/oracle/known-answers.json")).unwrap();
    for (name, function) in
        [("flood S (Iooss-Lemaitre 2015)", "flood"), ("otl circuit", "otl-circuit"), ("piston", "piston")]
    {
        let (case, indices) = (&oracle[name], known(function, &[]).unwrap().exact().indices.unwrap());
        for (got, key, error) in [(&indices.first_order, "S1", "se_S1"), (&indices.total, "ST", "se_ST")] {
            for ((got, expected), error) in got.iter().zip(numbers(&case[key])).zip(numbers(&case[error])) {
                assert!((got - expected).abs() < 4.0 * error, "{name} {key}: {got}, not {expected} +- {error}");
            }
        }
    }
}

#[test]
fn indices_of_every_function_are_consistent() {
    for answer in KnownAnswer::all() {
        let function = answer.default_function();
        assert_eq!(KnownAnswer::from_name(answer.name).map(|answer| answer.name), Some(answer.name));
        let named: Vec<_> = function.parameters().iter().map(|(name, _)| *name).collect();
        for name in &named {
            assert!(answer.parameters.iter().any(|parameter| parameter.name == *name), "{answer:?} {name}");
        }
        // The current parameters give the same function.
        let given: Vec<_> =
            function.parameters().iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
        assert_eq!(answer.with(&given).unwrap(), function);
        let inputs = function.inputs();
        let middle: Vec<f64> = inputs.iter().map(|input| input.distribution.median()).collect();
        assert!(function.value(&middle).is_finite(), "{answer:?}");
        let indices = function.exact().indices.unwrap();
        assert_eq!((indices.first_order.len(), indices.total.len()), (inputs.len(), inputs.len()));
        for (first, total) in indices.first_order.iter().zip(&indices.total) {
            // To rounding, or to the error of a quadrature.
            assert!(*first >= 0.0 && *first <= total + 1e-13, "{answer:?}");
        }
        assert!(indices.first_order.iter().sum::<f64>() <= 1.0 + 1e-13, "{answer:?}");
        assert!(indices.total.iter().sum::<f64>() >= 1.0 - 1e-13, "{answer:?}");
    }
}

#[test]
fn low_dimensions_are_explained_entirely() {
    // Two inputs: ST_1 = 1 - S_2, for every family that can have two.
    let two: [(&str, Parameters<'_>); 7] = [
        ("sobol-g", &[("a", &[0.5, 2.0])]),
        ("bratley", &[("dimension", &[2.0])]),
        ("sobol-levitan", &[("b", &[-2.0, 1e-9])]),
        ("product", &[("mu", &[0.0, 3.0]), ("sigma", &[0.5, 2.0])]),
        ("product", &[("mu", &[0.0, 0.0])]),
        ("minimum", &[("dimension", &[2.0])]),
        ("simplex", &[("dimension", &[2.0])]),
    ];
    for (name, parameters) in two {
        let indices = known(name, parameters).unwrap().exact().indices.unwrap();
        let [s1, s2] = indices.first_order[..] else { panic!("two inputs") };
        assert!((indices.total[0] + s2 - 1.0).abs() < 1e-14 && (indices.total[1] + s1 - 1.0).abs() < 1e-14, "{name}");
    }
    let both_zero = known("product", &[("mu", &[0.0, 0.0])]).unwrap().exact();
    assert_eq!((both_zero.mean, both_zero.variance), (0.0, 0.0625));
    assert_eq!(both_zero.indices.unwrap().first_order, [0.0, 0.0]);
}

#[test]
fn three_inputs_of_a_simplex_by_hand() {
    let exact = known("simplex", &[]).unwrap().exact();
    assert_close(exact.mean, 1.0 / 6.0, 1e-15);
    assert_close(exact.variance, 5.0 / 36.0, 1e-15);
    let indices = exact.indices.unwrap();
    assert_close(indices.first_order[0], 0.16, 1e-15);
    assert_close(indices.total[0], 0.6, 1e-15);
}

#[test]
fn the_series_of_the_exponential_meets_the_formula() {
    let direct = |b: f64| libm::expm1(2.0 * b) / (2.0 * b) / (libm::expm1(b) / b).powi(2) - 1.0;
    for b in [0.5, 0.599, 0.601, 1.0, -0.599, -3.0, 20.0] {
        // The direct formula loses a factor of 12 / b^2.
        assert!((relative_variance_of_exponential(b) / direct(b) - 1.0).abs() < 1e-14, "{b}");
    }
    assert!((relative_variance_of_exponential(1e-9) / (1e-18 / 12.0) - 1.0).abs() < 1e-15);
    assert_eq!(relative_variance_of_exponential(0.0), 0.0);
}

#[test]
fn a_thousand_inputs_and_more() {
    for dimension in [1.0, 1000.0, MAX_INPUTS as f64] {
        for name in ["sobol-g", "g-star", "bratley", "linear", "steps"] {
            let function = known(name, &[("dimension", &[dimension])]).unwrap();
            assert_eq!(function.inputs().len(), dimension as usize);
            assert!(function.value(&vec![0.75; dimension as usize]).is_finite(), "{name}");
        }
        let hard = known("sobol-g", &[("a", &[0.0]), ("dimension", &[dimension])]).unwrap().exact();
        let indices = hard.indices.unwrap();
        // ST = r / (1 + r) / (1 - (1 + r)^-d), r = 1/3, although the variance overflows.
        let total = 0.25 / (1.0 - libm::pow(0.75f64, dimension));
        assert!(indices.total.iter().all(|st| (st - total).abs() < 1e-14));
    }
    let g = known("sobol-g", &[("a", &[6.52]), ("dimension", &[1000.0])]).unwrap().exact().indices.unwrap();
    assert!(g.first_order.iter().sum::<f64>() < 1.0 && g.total.iter().sum::<f64>() > 1.0);
}

#[test]
fn outside_their_domain_functions_have_a_reason_and_no_value() {
    for name in ["flood", "borehole", "wing-weight", "otl-circuit", "piston"] {
        let function = known(name, &[]).unwrap();
        let medians: Vec<f64> = function.inputs().iter().map(|input| input.distribution.median()).collect();
        for (place, input) in function.inputs().iter().enumerate().filter(|(_, input)| input.domain.is_some()) {
            for wrong in [-1.0, 0.0, f64::NAN, f64::INFINITY] {
                let mut x = medians.clone();
                x[place] = wrong;
                assert!(function.value(&x).is_nan(), "{name} {} = {wrong}", input.name);
                assert!(function.checked_value(&x).is_err());
            }
        }
    }
    let mut flat = [1000.0, 30.0, 55.0, 55.0, 8.0, 55.5, 5000.0, 300.0];
    assert!(value("flood", &[], &flat).is_nan());
    flat[2] = 50.0;
    assert!(value("flood", &[], &flat).is_finite());
    assert!(value("wing-weight", &[], &[1.0, 1.0, 1.0, 90.0, 1.0, 1.0, 0.01, 1.0, 1.0, 2.0]).is_nan());
}

#[test]
fn parameters_that_make_no_sense_are_refused() {
    let cases: [(&str, Parameters<'_>); 14] = [
        ("flood", &[("a", &[1.0])]),
        ("sobol-g", &[("a", &[0.0, -1.0])]),
        ("sobol-g", &[("a", &[])]),
        ("sobol-g", &[("a", &[0.0, 1.0]), ("dimension", &[3.0])]),
        ("sobol-g", &[("dimension", &[2.5])]),
        ("sobol-g", &[("dimension", &[1e9])]),
        ("ishigami", &[("a", &[1.0, 2.0])]),
        ("ishigami", &[("b", &[f64::NAN])]),
        ("minimum", &[("dimension", &[1.0])]),
        ("simplex", &[("dimension", &[13.0])]),
        ("sobol-levitan", &[("b", &[300.0]), ("dimension", &[2.0])]),
        ("product", &[("sigma", &[0.0])]),
        ("product", &[("sigma", &[1e308])]),
        ("g-star", &[("delta", &[1.5])]),
    ];
    let messages = cases.map(|(name, parameters)| format!("{name}: {}", known(name, parameters).unwrap_err()));
    insta::assert_snapshot!(messages.join("\n"));
}
