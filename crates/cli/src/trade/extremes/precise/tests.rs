use apportion::model::{Expression, Symbol};
use proptest::prelude::*;

use super::*;

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

proptest! {
    /// A formula in doubles is within the bound of rounding errors, and the bound is useful: about a hundred units.
    #[test]
    fn rounding_stays_within_its_bound(x in -3.0..3.0_f64, y in 0.1..20.0_f64, a in -1e3..1e3_f64) {
        let formulas = [
            "x + y - x", "x*y - y*x + a", "(x^3 - y^2)/(y + 4)", "sin(x)*exp(-y) + cos(a*x)", "sqrt(y)*cbrt(a) - ln(y)",
            "y^x + tanh(a/100)", "atan2(x, y) + hypot(x, a)", "max(x, y, a) - min(x, y)", "if(x < 0, log10(y), log2(y))",
            "abs(x) + floor(a) - round(y)", "expm1(x) + log1p(y) + sinh(x) - cosh(x)", "asin(x/3) - acos(x/3) + tan(x/3)",
        ];
        for text in formulas {
            let formula = Expression::parse(text, &symbol).unwrap();
            let (value, precise) = (formula.value(&[x, y, a]), precise(&formula, &[x, y, a]).unwrap());
            let (off, rounding) = ((value - precise).abs(), rounding(&formula, &[x, y, a]));
            // The exact value is rounded to a double here.
            prop_assert!(off <= rounding + value.abs() * f64::EPSILON, "{text}: {value} is off by {off:e}, beyond {rounding:e}");
            prop_assert!(rounding < 1e-9 * (1.0 + precise.abs() + libm::pow(y, x.abs())), "{text}");
        }
    }
}

#[test]
fn functions_that_have_no_more_digits_say_so() {
    for (text, is_there) in [("erf(x)", false), ("gamma(y) + x", false), ("exp(x)", true)] {
        let formula = Expression::parse(text, &symbol).unwrap();
        assert_eq!(precise(&formula, &[0.5, 2.0, 1.0]).is_some(), is_there, "{text}");
    }
}

/// For any size of the argument, to a unit in the last place.
#[test]
fn precise_values_are_those_of_mathematics() {
    let cases = [
        ("sin(x)", 1e22, -0.852_200_849_767_188_8),
        ("cos(x)", 1e300, libm::cos(1e300)),
        ("expm1(x)", 1e-300, 1e-300),
        ("log1p(x)", 1e-20, 1e-20),
        ("(exp(x) - 1)/x", 1e-60, 1.0),
        ("sqrt(x^2)", 1e-300, 1e-300),
        ("sqrt(x^2)", 1e300, 1e300),
        ("x^2", 1e300, f64::INFINITY),
        ("atan2(x, -1)", 1e-300, std::f64::consts::PI),
        ("atan2(x, 0)", -2.0, -std::f64::consts::FRAC_PI_2),
        ("atan2(x, -1)", -1.0, -0.75 * std::f64::consts::PI),
        ("round(x)", -2.5, -3.0),
        ("floor(x) + ceil(x)", -0.5, -1.0),
        ("x^-3 + (-8)^(x + 1)", 2.0, 0.125 - 512.0),
        ("exp(x)", -1e300, 0.0),
        // Subnormal.
        ("x*1e300", 1e-310, 1e-310 * 1e300),
    ];
    for (text, x, expected) in cases {
        let formula = Expression::parse(text, &|name| (name == "x").then_some(Symbol::Input(0))).unwrap();
        let found = precise(&formula, &[x]).unwrap();
        assert!(found == expected || (found / expected - 1.0).abs() < 3e-16, "{text} at {x}: {found:e}");
    }
}
