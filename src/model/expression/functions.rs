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

/// What a name of Python's modules stands for.
pub(super) enum Member {
    Function(Function),
    Number(f64),
}

/// Functions of NumPy and of Python's `math` that are called otherwise here, or not at all.
const PYTHON: [(&str, Function); 17] = [
    // There without doubt the natural one.
    ("log", Function::One(f64::ln)),
    ("arcsin", Function::One(f64::asin)),
    ("arccos", Function::One(f64::acos)),
    ("arctan", Function::One(f64::atan)),
    ("arctan2", Function::Two(f64::atan2)),
    ("absolute", Function::One(f64::abs)),
    ("fabs", Function::One(f64::abs)),
    ("square", Function::One(square)),
    ("power", Function::Two(f64::powf)),
    ("pow", Function::Two(f64::powf)),
    ("maximum", Function::Several(largest)),
    ("minimum", Function::Several(least)),
    ("where", Function::Select),
    // Python rounds halves to even numbers.
    ("round", Function::One(f64::round_ties_even)),
    ("rint", Function::One(f64::round_ties_even)),
    ("radians", Function::One(f64::to_radians)),
    ("degrees", Function::One(f64::to_degrees)),
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
