//! What can be wrong with a formula, and where.

use std::ops::Range;

/// A text that is no formula.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{problem}")]
pub struct ExpressionError {
    /// What is wrong.
    pub problem: ExpressionProblem,
    /// Where: a range of bytes of the text.
    pub place: Range<usize>,
}

/// What is wrong with a formula.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExpressionProblem {
    /// There is nothing.
    #[error("the formula is empty")]
    Empty,
    /// A character that has no meaning.
    #[error("`{0}` has no meaning in a formula")]
    Character(char),
    /// A number that cannot be read, or is beyond double precision.
    #[error("`{0}` is no number that double precision can hold")]
    Number(String),
    /// A name of nothing.
    #[error("there is no `{0}`")]
    UnknownName(String),
    /// A name of a function that does not exist.
    #[error("there is no function `{0}`")]
    UnknownFunction(String),
    /// `log`, which means one thing here and another there.
    #[error("`log` has two meanings: write `ln` for the natural logarithm or `log10` for the decimal one")]
    Log,
    /// A function without its arguments.
    #[error("`{name}` is a function: write {name}({arguments})")]
    NoArguments {
        /// The function.
        name: String,
        /// What it takes, such as `x, y`.
        arguments: &'static str,
    },
    /// Something called that is no function.
    #[error("`{0}` is no function: write {0}*(...) to multiply")]
    NotAFunction(String),
    /// Too few or too many arguments.
    #[error("`{name}` takes {expected}, not {found}")]
    Arity {
        /// The function.
        name: String,
        /// How many arguments it takes, in words.
        expected: &'static str,
        /// How many there are.
        found: usize,
    },
    /// Something else should stand here.
    #[error("expected {expected}, not {found}")]
    Expected {
        /// What should stand here.
        expected: &'static str,
        /// What does.
        found: String,
    },
    /// Two comparisons in a row.
    #[error("a second comparison has no meaning: write (a < b)*(b < c)")]
    SecondComparison,
    /// `=` alone.
    #[error("`=` has no meaning in a formula: `==` compares")]
    Assignment,
    /// Too many things inside each other.
    #[error("the formula is nested more than 200 deep")]
    TooDeep,
}
