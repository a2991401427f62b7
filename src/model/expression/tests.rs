use proptest::prelude::*;

use super::*;
use crate::model::{KnownAnswer, RunContext};

fn symbol(name: &str) -> Option<Symbol> {
    match name {
        "x1" | "x" => Some(Symbol::Input(0)),
        "x2" | "y" => Some(Symbol::Input(1)),
        "x3" => Some(Symbol::Input(2)),
        "a" => Some(Symbol::Number(7.0)),
        "b" => Some(Symbol::Number(0.1)),
        _ => None,
    }
}

#[track_caller]
fn value(text: &str, x: &[f64]) -> f64 {
    Expression::parse(text, &symbol).unwrap_or_else(|error| panic!("{text}: {error} at {:?}", error.place)).value(x)
}

#[test]
fn operators_bind_as_in_mathematics() {
    let cases: [(&str, f64); 22] = [
        ("-3^2", -9.0),
        ("-x^2", -9.0),
        ("2^3^2", 512.0),
        ("2^-x", 0.125),
        ("2**x", 8.0),
        ("1 - 2 - 3", -4.0),
        ("12/2/3", 2.0),
        ("2 + 3*4", 14.0),
        ("--x", 3.0),
        ("x - -x", 6.0),
        ("1e-3*x", 3e-3),
        (".5 + 1.", 1.5),
        ("2 * (x + 1)", 8.0),
        ("min(x, 2, 5) + max(1, x)", 5.0),
        ("if(x > 2, 10, 20)", 10.0),
        ("(x <= 2) + (x != 3) + (x == 3)", 1.0),
        ("if(x < 0, ln(x), sqrt(x + 1))", 2.0),
        ("atan2(0, -1) - pi", 0.0),
        ("hypot(x, y)", 5.0),
        ("x \u{b7} y \u{2212} 1", 11.0),
        ("(x)^(1/2) - sqrt(x)", 0.0),
        ("x^-2", 1.0 / 9.0),
    ];
    for (text, expected) in cases {
        // Powers by multiplication and by logarithms differ in the last digits.
        assert!((value(text, &[3.0, 4.0]) - expected).abs() <= 1e-15 * expected.abs(), "{text}");
    }
}

/// What is said of a formula that is none, whose fault is at `place`.
#[track_caller]
fn refused(text: &str, place: &str) -> String {
    let error = Expression::parse(text, &symbol).expect_err(text);
    assert_eq!(&text[error.place.clone()], place, "{text}");
    format!("{text}: {error}")
}

#[test]
fn names_with_points_are_unknown() {
    let cases =
        [("np.sin(x)", "np.sin"), ("1 + scipy.special.erf(x)", "scipy.special.erf"), ("np.x1", "np.x1"), ("np.", ".")];
    insta::assert_snapshot!(cases.map(|(text, place)| refused(text, place)).join("\n"));
}

#[test]
fn ishigami_is_ishigami() {
    let known = KnownAnswer::from_name("ishigami").expect("in the list").default_function();
    let formula = Expression::parse("sin(x1) + a*sin(x2)^2 + b*x3^4*sin(x1)", &symbol).expect("a formula");
    for row in 0..1000 {
        let x = [0.37, 0.71, 0.13].map(|step| std::f64::consts::PI * (2.0 * (step * f64::from(row)).fract() - 1.0));
        // Values to 18 with a rounding in each of eight steps.
        assert!((formula.value(&x) - known.value(&x)).abs() < 1e-12, "{x:?}");
    }
    assert!(formula.uses(2) && !formula.uses(3));
}

#[test]
fn columns_of_any_length_are_their_rows() {
    let expression = Expression::parse("if(x > 0.5, x*y, ln(x)) - y^2", &symbol).expect("a formula");
    let unit = apportion_base::quantity::Unit::dimensionless();
    let model = ExpressionModel::new(vec![(Output::new("z", unit, "a formula"), expression.clone())]);
    let rows = 2 * TILE + 3;
    let column = |shift: f64| (0..rows).map(|row| (0.618 * row as f64 + shift).fract()).collect::<Vec<f64>>();
    let (x, y) = (column(0.0), column(0.3));
    let mut batch = Batch::new(&model);
    batch.reset(rows);
    model.worker(&RunContext::default()).run(&[&x, &y], &mut batch);
    batch.settle();
    for row in 0..rows {
        let alone = expression.value(&[x[row], y[row]]);
        assert_eq!(batch.column(0)[row].to_bits(), if alone.is_finite() { alone } else { f64::NAN }.to_bits());
    }
    let reasons: Vec<String> = batch.failures().iter().map(|(_, _, reason)| reason.to_string()).collect();
    // From ln(0), which occurs more than once.
    assert!(!reasons.is_empty() && reasons.iter().all(|reason| reason == "the formula is infinite"), "{reasons:?}");
}

#[test]
fn nan_is_never_hidden() {
    for text in ["min(0/0, x)", "max(x, 0/0)", "0/0 < x", "if(0/0, 1, 2)", "(0/0)*0"] {
        assert!(value(text, &[1.0]).is_nan(), "{text}");
    }
    // The branch that is not taken does not matter.
    assert_eq!(value("if(x > 0, x, 0/0)", &[1.0]), 1.0);
}

#[test]
fn faults_are_named_with_their_place() {
    let cases = [
        ("", ""),
        ("  ", "  "),
        ("a*z", "z"),
        ("a*sinn(x)", "sinn"),
        ("sin", "sin"),
        ("sin x", "sin"),
        ("sin(x, y)", "sin(x, y)"),
        ("sin()", "sin()"),
        ("max(x)", "max(x)"),
        ("log(x)", "log"),
        ("a(x)", "a"),
        ("2x", "x"),
        ("x +", ""),
        ("(x + 1", ""),
        ("x + 1)", ")"),
        ("sin(x", ""),
        ("x * / y", "/"),
        ("x; y", ";"),
        ("y = x", "="),
        ("1 < x < 2", "<"),
        ("1.2.3*x", "1.2.3"),
        ("1e999", "1e999"),
    ];
    insta::assert_snapshot!(cases.map(|(text, place)| refused(text, place)).join("\n"));
    let deep = format!("{}x{}", "(".repeat(100_000), ")".repeat(100_000));
    assert_eq!(Expression::parse(&deep, &symbol).expect_err("deep").problem, ExpressionProblem::TooDeep);
    let signs = "-".repeat(100_000) + "x";
    assert_eq!(Expression::parse(&signs, &symbol).expect_err("deep").problem, ExpressionProblem::TooDeep);
}

proptest! {
    #[test]
    fn no_text_panics(text in any::<String>(), near in "[xyab0-9.e+*/^(),<>= -]{0,30}", calls in "(sin|max|if|x|np\\.|math\\.|\\.|\\(|\\)|,|2|\\^|-){0,20}") {
        for text in [text, near, calls] {
            match Expression::parse(&text, &symbol) {
                Ok(formula) => { formula.value(&[0.5, 2.0, 1.0]); }
                Err(error) => prop_assert!(text.get(error.place).is_some()),
            }
        }
    }
}
