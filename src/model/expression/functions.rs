//! The functions of the formula language. All return NaN if an argument is NaN.

use std::ops::RangeInclusive;

/// A function of one argument.
#[derive(Clone, Copy, Debug)]
pub struct OfOne {
    pub name: &'static str,
    pub value: fn(f64) -> f64,
}

/// A function of two arguments.
#[derive(Clone, Copy, Debug)]
pub struct OfTwo {
    pub name: &'static str,
    pub value: fn(f64, f64) -> f64,
}

/// The computation of a function.
#[derive(Clone, Copy, Debug)]
pub(super) enum Function {
    /// Of one argument.
    One(OfOne),
    /// Of two arguments.
    Two(OfTwo),
    /// Of two or more arguments, combined from left to right.
    Several(OfTwo),
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

type Named = (&'static str, Function);

const fn one(name: &'static str, value: fn(f64) -> f64) -> Named {
    (name, Function::One(OfOne { name, value }))
}

const fn two(name: &'static str, value: fn(f64, f64) -> f64) -> Named {
    (name, Function::Two(OfTwo { name, value }))
}

const fn several(name: &'static str, value: fn(f64, f64) -> f64) -> Named {
    (name, Function::Several(OfTwo { name, value }))
}

const FUNCTIONS: [Named; 28] = [
    one("sin", libm::sin),
    one("cos", libm::cos),
    one("tan", libm::tan),
    one("asin", libm::asin),
    one("acos", libm::acos),
    one("atan", libm::atan),
    one("sinh", libm::sinh),
    one("cosh", libm::cosh),
    one("tanh", libm::tanh),
    one("exp", libm::exp),
    one("expm1", libm::expm1),
    one("ln", libm::log),
    one("log1p", libm::log1p),
    one("log2", libm::log2),
    one("log10", libm::log10),
    one("sqrt", f64::sqrt),
    one("cbrt", libm::cbrt),
    one("abs", f64::abs),
    one("floor", f64::floor),
    one("ceil", f64::ceil),
    one("round", f64::round),
    one("erf", libm::erf),
    one("gamma", libm::tgamma),
    two("atan2", libm::atan2),
    two("hypot", libm::hypot),
    several("min", least),
    several("max", largest),
    ("if", Function::Select),
];

const NUMBERS: [(&str, f64); 1] = [("pi", std::f64::consts::PI)];

pub(super) fn named(name: &str) -> Option<Function> {
    FUNCTIONS.into_iter().find(|(other, _)| *other == name).map(|(_, function)| function)
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
