//! The functions of the formula language. None hides an argument that has no value: NaN in, NaN out.

/// What a function computes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Function {
    /// Of one argument.
    One(fn(f64) -> f64),
    /// Of two arguments.
    Two(fn(f64, f64) -> f64),
    /// Of two arguments or more, taken together from the left.
    Several(fn(f64, f64) -> f64),
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

const FUNCTIONS: [(&str, Function); 28] = [
    ("sin", Function::One(f64::sin)),
    ("cos", Function::One(f64::cos)),
    ("tan", Function::One(f64::tan)),
    ("asin", Function::One(f64::asin)),
    ("acos", Function::One(f64::acos)),
    ("atan", Function::One(f64::atan)),
    ("sinh", Function::One(f64::sinh)),
    ("cosh", Function::One(f64::cosh)),
    ("tanh", Function::One(f64::tanh)),
    ("exp", Function::One(f64::exp)),
    ("expm1", Function::One(f64::exp_m1)),
    ("ln", Function::One(f64::ln)),
    ("log1p", Function::One(f64::ln_1p)),
    ("log2", Function::One(f64::log2)),
    ("log10", Function::One(f64::log10)),
    ("sqrt", Function::One(f64::sqrt)),
    ("cbrt", Function::One(f64::cbrt)),
    ("abs", Function::One(f64::abs)),
    ("floor", Function::One(f64::floor)),
    ("ceil", Function::One(f64::ceil)),
    ("round", Function::One(f64::round)),
    ("erf", Function::One(libm::erf)),
    ("gamma", Function::One(libm::tgamma)),
    ("atan2", Function::Two(f64::atan2)),
    ("hypot", Function::Two(f64::hypot)),
    ("min", Function::Several(least)),
    ("max", Function::Several(largest)),
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

/// The lesser one; `f64::min` would pass over NaN.
fn least(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.min(b) }
}

fn largest(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}
