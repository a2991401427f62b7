//! Formulas in 320 bits, and the rounding of doubles: where numbers are right, and where they are flagged.

use std::path::Path;

use apportion::model::{Expression, Symbol};
use apportion_afm::{ContactTheory, FrictionLaw};

use proptest::prelude::*;

use super::map::{Extremes, Kind, Outcome, Reason};
use super::{assert_nothing_is_silently_wrong, map_of};

/// The map of formulas, by their names, of factors with bounds; as small as it can be.
fn map(formulas: &[(&str, &str)], factors: &[(&str, f64, f64)]) -> Extremes {
    map_of(&study(&source(formulas, factors)), 1, 0)
}

fn source(formulas: &[(&str, &str)], factors: &[(&str, f64, f64)]) -> String {
    let formulas: String = formulas.iter().map(|(name, formula)| format!("{name} = \"{formula}\"\n")).collect();
    let factors: String =
        factors.iter().map(|(name, min, max)| format!("{name} = {{ min = {min:e}, max = {max:e} }}\n")).collect();
    format!("model = \"expression\"\n[outputs]\n{formulas}[factors]\n{factors}")
}

fn study(source: &str) -> apportion::Study {
    apportion_files::parse_study(source, Path::new("formulas.toml"), &[]).unwrap()
}

/// The first reason of an output at the corners, of which the first has every factor at its lower bound.
fn at_bounds<'a>(map: &'a Extremes, output: &str) -> Option<&'a Reason> {
    map.reasons.iter().find(|reason| reason.kind == Kind::Corners && reason.output == output)
}

/// Every function by itself, and some together.
const FORMULAS: [&str; 30] = [
    "sin(x)",
    "cos(x)",
    "tan(x)",
    "asin(x/3)",
    "acos(x/3)",
    "atan(x)",
    "sinh(x)",
    "cosh(x)",
    "tanh(x)",
    "exp(x)",
    "expm1(x)",
    "log1p(y)",
    "ln(y)",
    "log2(y)",
    "log10(y)",
    "sqrt(y)",
    "cbrt(a)",
    "hypot(x, a)",
    "atan2(x, y)",
    "y^2.5",
    "x^3",
    "x*y",
    "x/y",
    "x + y - a",
    "x*y - y*x + a",
    "(x^3 - y^2)/(y + 4)",
    "sin(x)*exp(-y) + cos(a*x)",
    "max(x, y, a) - min(x, y)/3",
    "if(x < 0, log10(y), log2(y))",
    "abs(x) + floor(a) - round(y) + ceil(a)/7",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3))]

    /// A formula less its value in doubles keeps the rounding errors only: they are within their bound.
    #[test]
    fn rounding_stays_within_its_bound(x in -3.0..3.0_f64, y in 0.1..20.0_f64, a in -1e3..1e3_f64) {
        let input = |name: &str| ["x", "y", "a"].iter().position(|known| *known == name).map(Symbol::Input);
        let less_value = |formula: &&str| {
            let value = Expression::parse(formula, &input).unwrap().value(&[x, y, a]);
            format!("{formula} - ({value:e})")
        };
        let formulas: Vec<String> = FORMULAS.iter().map(less_value).collect();
        let names: Vec<String> = (0..formulas.len()).map(|number| format!("y{number}")).collect();
        let outputs: Vec<(&str, &str)> = names.iter().map(String::as_str).zip(formulas.iter().map(String::as_str)).collect();
        let map = map(&outputs, &[("x", x, 3.1), ("y", y, 20.1), ("a", a, 1001.0)]);
        assert_nothing_is_silently_wrong("formulas", &map);
        let corners = map.kinds.iter().find(|(kind, _)| *kind == Kind::Corners).unwrap().1;
        prop_assert!(corners.flagged > 20, "{corners:?}");
    }
}

/// Roundings that all go one way exceed the bound, which is one of roundings at random: it is not larger than useful.
#[test]
fn a_number_beyond_its_bound_is_wrong() {
    let formula = format!("x{} - x", " + 1.08e-16".repeat(4000));
    let map = map(&[("y", &formula)], &[("x", 1.0, 1.5)]);
    let wrong = at_bounds(&map, "y").unwrap();
    assert_eq!((wrong.outcome, wrong.value), (Outcome::Wrong, Some(0.0)));
    assert!((wrong.reference.unwrap() / 4.32e-13 - 1.0).abs() < 1e-12, "{wrong:?}");
}

#[test]
fn functions_that_have_no_more_digits_say_so() {
    let formulas = [("error", "erf(x)"), ("factorial", "gamma(x) + x"), ("exponential", "exp(x)")];
    let map = map(&formulas, &[("x", 0.5, 2.0)]);
    let corners = map.kinds.iter().find(|(kind, _)| *kind == Kind::Corners).unwrap().1;
    assert_eq!((corners.right, corners.flagged), (2, 4), "{corners:?}");
    for reason in map.reasons.iter().filter(|reason| reason.outcome == Outcome::Flagged) {
        assert!(
            reason.reason.contains("(erf, gamma, a huge angle or power) that is not computed in 320 bits"),
            "{reason:?}"
        );
        assert_ne!(reason.output, "exponential");
    }
}

/// At inputs of 1e300 powers would take minutes, and the third of an angle has no digit of its turn left.
#[test]
fn what_320_bits_do_not_reach_is_flagged() {
    let formulas = [("power", "y^x*y^(-x) - 1"), ("angle", "tan(x/3)"), ("log", "2^log2(y)")];
    let study = study(&source(&formulas, &[("x", 1.0, 2.0), ("y", 0.0, 2.0)]));
    let map = map_of(&study, 30, 0);
    assert_nothing_is_silently_wrong("out of reach", &map);
    assert!(map.counts.right > 50 && map.counts.flagged > 0, "{:?}", map.counts);
}

/// For any size of the argument, to a unit in the last place. In doubles the second factor is 0, in 320 bits 1.
#[test]
fn precise_values_are_those_of_mathematics() {
    let cases = [
        ("sin(x)", 1e22, -0.852_200_849_767_188_8),
        ("cos(x)", 1e60, libm::cos(1e60)),
        ("expm1(x)", 1e-300, 1e-300),
        ("log1p(x)", 1e-20, 1e-20),
        ("(exp(x) - 1)/x", 1e-60, 1.0),
        ("sqrt(x^2)", 1e-300, 1e-300),
        ("hypot(x, 0)", 1e300, 1e300),
        ("atan2(x, -1)", 1e-300, std::f64::consts::PI),
        ("atan2(x, 0)", -2.0, -std::f64::consts::FRAC_PI_2),
        ("atan2(x, -1)", -1.0, -0.75 * std::f64::consts::PI),
        ("round(x)", -2.5, -3.0),
        ("floor(x) + ceil(x)", -0.5, -1.0),
        ("x^-3 + (-8)^(x + 1)", 2.0, 0.125 - 512.0),
        // Subnormal.
        ("x*1e300", 1e-310, 1e-310 * 1e300),
    ];
    for (formula, x, expected) in cases {
        let shown = format!("({formula})*((one + 1e40) - 1e40)");
        let map = map(&[("y", &shown)], &[("x", x, x + x.abs()), ("one", 1.0, 1.5)]);
        let found = at_bounds(&map, "y").unwrap_or_else(|| panic!("{formula} at {x}: {:?}", map.reasons));
        assert_eq!((found.inputs["x"].as_f64(), found.value), (Some(x), Some(0.0)), "{formula}");
        let found = found.reference.unwrap();
        assert!(found == expected || (found / expected - 1.0).abs() < 3e-16, "{formula} at {x}: {found:e}");
    }
    // Zero, since exponents have no limit there.
    assert_eq!(at_bounds(&map(&[("y", "exp(x)")], &[("x", -1e300, -1e299)]), "y"), None);
}

/// The formulas of the closed form of the nanoparticle, in every law, theory and load, have the numbers of the model.
#[test]
fn every_formula_can_be_read_and_is_that_of_the_closed_form() {
    // No step is left for the other rungs: the formulas come first.
    let of = |friction: FrictionLaw, contact: ContactTheory, adhesion_in_load: bool, output: &str| {
        let (friction, contact) = (friction.name(), contact.name());
        let source = format!(
            "model = \"afm\"\noutputs = [{output:?}]\n[afm]\nfriction = \"{friction}\"\ncontact = \"{contact}\"\n\
             adhesion_in_load = {adhesion_in_load}\nstep_budget = 1\n\
             [factors]\nheight = {{ min = 12, max = 12.5, unit = \"um\" }}\n"
        );
        let map = map_of(&study(&source), 1, 0);
        assert_nothing_is_silently_wrong(&format!("{friction} {contact}"), &map);
        let corners = map.kinds.iter().find(|(kind, _)| *kind == Kind::Corners).unwrap().1;
        assert_eq!(corners.refused, 0, "{friction} {contact}: {:?}", map.reasons);
        map.second_calculation.unwrap().contains("its formula in 320 bits")
    };
    let all = [
        "critical_force",
        "log_critical_force",
        "normal_force",
        "lateral_force",
        "force_angle",
        "contact_radius",
        "critical_time",
    ];
    let laws = [FrictionLaw::Coulomb, FrictionLaw::HurtadoKim, FrictionLaw::LuGre];
    for friction in laws {
        for contact in [ContactTheory::Hertz, ContactTheory::Jkr, ContactTheory::Dmt] {
            for adhesion_in_load in [false, true] {
                // The force has the parts of all others.
                assert!(of(friction, contact, adhesion_in_load, "critical_force"));
            }
        }
        for output in all {
            // Under LuGre friction bristles creep in the time before.
            let is_there = output != "critical_time" || friction != FrictionLaw::LuGre;
            assert_eq!(of(friction, ContactTheory::Jkr, false, output), is_there, "{output} {friction:?}");
        }
    }
}
