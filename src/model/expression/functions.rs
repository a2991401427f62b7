//! The functions of the formula language. All return NaN if an argument is NaN.

use std::ops::RangeInclusive;

/// The computation of a function.
#[derive(Clone, Copy, Debug)]
pub(super) enum Function {
    /// Of one argument.
    One(fn(f64) -> f64),
    /// Of two arguments.
    Two(fn(f64, f64) -> f64),
    /// Of two or more arguments, combined from left to right.
    Several(fn(f64, f64) -> f64),
    /// `if(condition, then, else)`.
    Select,
}

impl Function {
    /// Returns the numbers of arguments it takes, those numbers in words, and its arguments as they are written.
    pub fn arguments(self) -> (RangeInclusive<usize>, &'static str, &'static str) {
        match self {
            Self::One(_) => (1..=1, "one argument", "x"),
            Self::Two(_) => (2..=2, "two arguments", "x, y"),
            Self::Several(_) => (2..=usize::MAX, "two arguments or more", "x, y"),
            Self::Select => {
                let words = "three arguments (condition, value if it is not 0, value if it is)";
                (3..=3, words, "condition, x, y")
            }
        }
    }
}

/// A function with its name.
pub(super) type Named = (&'static str, Function);

const FUNCTIONS: [Named; 28] = [
    ("sin", Function::One(libm::sin)),
    ("cos", Function::One(libm::cos)),
    ("tan", Function::One(libm::tan)),
    ("asin", Function::One(libm::asin)),
    ("acos", Function::One(libm::acos)),
    ("atan", Function::One(libm::atan)),
    ("sinh", Function::One(libm::sinh)),
    ("cosh", Function::One(libm::cosh)),
    ("tanh", Function::One(libm::tanh)),
    ("exp", Function::One(libm::exp)),
    ("expm1", Function::One(libm::expm1)),
    ("ln", Function::One(libm::log)),
    ("log1p", Function::One(libm::log1p)),
    ("log2", Function::One(libm::log2)),
    ("log10", Function::One(libm::log10)),
    ("sqrt", Function::One(f64::sqrt)),
    ("cbrt", Function::One(libm::cbrt)),
    ("abs", Function::One(f64::abs)),
    ("floor", Function::One(f64::floor)),
    ("ceil", Function::One(f64::ceil)),
    ("round", Function::One(f64::round)),
    ("erf", Function::One(libm::erf)),
    ("gamma", Function::One(libm::tgamma)),
    ("atan2", Function::Two(libm::atan2)),
    ("hypot", Function::Two(libm::hypot)),
    ("min", Function::Several(least)),
    ("max", Function::Several(largest)),
    ("if", Function::Select),
];

const NUMBERS: [(&str, f64); 1] = [("pi", std::f64::consts::PI)];

pub(super) fn named(name: &str) -> Option<Named> {
    FUNCTIONS.into_iter().find(|(other, _)| *other == name)
}

pub(super) fn number(name: &str) -> Option<f64> {
    NUMBERS.into_iter().find(|(other, _)| *other == name).map(|(_, number)| number)
}

pub(super) fn vocabulary() -> Vec<&'static str> {
    FUNCTIONS.into_iter().map(|(name, _)| name).chain(NUMBERS.into_iter().map(|(name, _)| name)).collect()
}

/// Returns the minimum; unlike `f64::min`, it returns NaN if an argument is NaN.
fn least(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.min(b) }
}

fn largest(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}
