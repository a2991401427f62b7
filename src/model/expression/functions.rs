//! The functions of the formula language. None hides an argument that has no value: NaN in, NaN out.

use crate::extended::{Bounded, Extended};

/// A function of one argument.
#[derive(Clone, Copy, Debug)]
pub(super) struct OfOne {
    /// In doubles.
    pub plain: fn(f64) -> f64,
    /// In twice the precision, with a bound of rounding; `None` of the two that are not to be had there.
    pub bounded: Option<fn(Bounded) -> Bounded>,
}

/// A function of two arguments.
#[derive(Clone, Copy, Debug)]
pub(super) struct OfTwo {
    /// In doubles.
    pub plain: fn(f64, f64) -> f64,
    /// In twice the precision, with a bound of rounding.
    pub bounded: fn(Bounded, Bounded) -> Bounded,
}

/// What a function computes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Function {
    /// Of one argument.
    One(OfOne),
    /// Of two arguments.
    Two(OfTwo),
    /// Of two arguments or more, taken together from the left.
    Several(OfTwo),
    /// `if(condition, then, else)`.
    Select,
}

impl Function {
    /// How many arguments it takes, in words.
    pub fn arity(self) -> &'static str {
        match self {
            Self::One(_) => "one argument",
            Self::Two(_) => "two arguments",
            Self::Several(_) => "two arguments or more",
            Self::Select => "three arguments (condition, value if it is not 0, value if it is)",
        }
    }

    /// Its arguments, as they are written.
    pub fn arguments(self) -> &'static str {
        match self {
            Self::One(_) => "x",
            Self::Two(_) | Self::Several(_) => "x, y",
            Self::Select => "condition, x, y",
        }
    }

    pub fn takes(self, count: usize) -> bool {
        match self {
            Self::One(_) => count == 1,
            Self::Two(_) => count == 2,
            Self::Several(_) => count >= 2,
            Self::Select => count == 3,
        }
    }
}

const fn one(plain: fn(f64) -> f64, bounded: fn(Bounded) -> Bounded) -> Function {
    Function::One(OfOne { plain, bounded: Some(bounded) })
}

const fn none(plain: fn(f64) -> f64) -> Function {
    Function::One(OfOne { plain, bounded: None })
}

const fn two(plain: fn(f64, f64) -> f64, bounded: fn(Bounded, Bounded) -> Bounded) -> Function {
    Function::Two(OfTwo { plain, bounded })
}

const fn several(plain: fn(f64, f64) -> f64, bounded: fn(Bounded, Bounded) -> Bounded) -> Function {
    Function::Several(OfTwo { plain, bounded })
}

const FUNCTIONS: [(&str, Function); 28] = [
    ("sin", one(libm::sin, |x| x.map_wave(Extended::sin))),
    ("cos", one(libm::cos, |x| x.map_wave(Extended::cos))),
    ("tan", one(libm::tan, Bounded::tan)),
    ("asin", one(libm::asin, |x| x.map(Extended::asin))),
    ("acos", one(libm::acos, |x| x.map(Extended::acos))),
    ("atan", one(libm::atan, |x| x.map(Extended::atan))),
    ("sinh", one(libm::sinh, |x| x.map(Extended::sinh))),
    ("cosh", one(libm::cosh, |x| x.map(Extended::cosh))),
    ("tanh", one(libm::tanh, |x| x.map(Extended::tanh))),
    ("exp", one(libm::exp, |x| x.map(Extended::exp))),
    ("expm1", one(libm::expm1, |x| x.map(Extended::exp_m1))),
    ("ln", one(libm::log, |x| x.map(Extended::ln))),
    ("log1p", one(libm::log1p, |x| x.map(Extended::ln_1p))),
    ("log2", one(libm::log2, |x| x.map(Extended::log2))),
    ("log10", one(libm::log10, |x| x.map(Extended::log10))),
    ("sqrt", one(f64::sqrt, |x| x.map(Extended::sqrt))),
    ("cbrt", one(libm::cbrt, |x| x.map(Extended::cbrt))),
    ("abs", one(f64::abs, |x| x.map_exactly(Extended::abs))),
    ("floor", one(f64::floor, |x| x.map_exactly(Extended::floor))),
    ("ceil", one(f64::ceil, |x| x.map_exactly(Extended::ceil))),
    ("round", one(f64::round, |x| x.map_exactly(Extended::round))),
    ("erf", none(libm::erf)),
    ("gamma", none(libm::tgamma)),
    ("atan2", two(libm::atan2, Bounded::atan2)),
    ("hypot", two(libm::hypot, Bounded::hypot)),
    ("min", several(least, Bounded::min)),
    ("max", several(largest, Bounded::max)),
    ("if", Function::Select),
];

const NUMBERS: [(&str, f64); 1] = [("pi", std::f64::consts::PI)];

pub(super) fn named(name: &str) -> Option<Function> {
    FUNCTIONS.into_iter().find(|(other, _)| *other == name).map(|(_, function)| function)
}

pub(super) fn number(name: &str) -> Option<f64> {
    NUMBERS.into_iter().find(|(other, _)| *other == name).map(|(_, number)| number)
}

/// What a name of Python's modules stands for.
pub(super) enum Member {
    Function(Function),
    Number(f64),
}

/// Functions of NumPy and of Python's `math` that are called otherwise here, or not at all.
const PYTHON: [(&str, Function); 17] = [
    // There without doubt the natural one.
    ("log", one(libm::log, |x| x.map(Extended::ln))),
    ("arcsin", one(libm::asin, |x| x.map(Extended::asin))),
    ("arccos", one(libm::acos, |x| x.map(Extended::acos))),
    ("arctan", one(libm::atan, |x| x.map(Extended::atan))),
    ("arctan2", two(libm::atan2, Bounded::atan2)),
    ("absolute", one(f64::abs, |x| x.map_exactly(Extended::abs))),
    ("fabs", one(f64::abs, |x| x.map_exactly(Extended::abs))),
    ("square", one(square, |x| x * x)),
    ("power", two(libm::pow, Bounded::powf)),
    ("pow", two(libm::pow, Bounded::powf)),
    ("maximum", several(largest, Bounded::max)),
    ("minimum", several(least, Bounded::min)),
    ("where", Function::Select),
    // Python rounds halves to even numbers.
    ("round", one(f64::round_ties_even, |x| x.map_exactly(Extended::round_ties_even))),
    ("rint", one(f64::round_ties_even, |x| x.map_exactly(Extended::round_ties_even))),
    ("radians", one(f64::to_radians, |x| x.map(|x| x * Extended::PI / 180.0.into()))),
    ("degrees", one(f64::to_degrees, |x| x.map(|x| x * 180.0.into() / Extended::PI))),
];

/// What `name`, such as `np.sin` or `math.pi`, stands for.
pub(super) fn member(name: &str) -> Option<Member> {
    let (module, name) = name.split_once('.')?;
    if !matches!(module, "np" | "numpy" | "math") {
        return None;
    }
    let python = PYTHON.into_iter().find(|(other, _)| *other == name).map(|(_, function)| function);
    // No module has a function of these names that means the same: NumPy's min and max are of one array.
    let function = python.or_else(|| named(name).filter(|_| !matches!(name, "if" | "min" | "max" | "ln")));
    let number = || if name == "e" { Some(std::f64::consts::E) } else { number(name) };
    function.map(Member::Function).or_else(|| number().map(Member::Number))
}

fn square(x: f64) -> f64 {
    x * x
}

pub(super) fn vocabulary() -> Vec<&'static str> {
    FUNCTIONS.into_iter().map(|(name, _)| name).chain(NUMBERS.into_iter().map(|(name, _)| name)).collect()
}

/// The lesser one; `f64::min` would pass over NaN.
fn least(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.min(b) }
}

fn largest(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}
