//! Errors in a formula, with their place.

use std::ops::Range;

/// The error for a text that is not a valid formula.
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
    /// The text is empty.
    #[error("the formula is empty")]
    Empty,
    /// A character that has no meaning.
    #[error("`{0}` has no meaning in a formula")]
    Character(char),
    /// A number that cannot be read, or is beyond double precision.
    #[error("`{0}` is not a number that double precision can hold")]
    Number(String),
    /// An unknown name.
    #[error("there is no `{0}`")]
    UnknownName(String),
    /// An unknown function.
    #[error("there is no function `{0}`")]
    UnknownFunction(String),
    /// `log`, which is ambiguous.
    #[error("`log` has two meanings: write `ln` for the natural logarithm or `log10` for the decimal one")]
    Log,
    /// A function without its arguments.
    #[error("`{name}` is a function: write {name}({arguments})")]
    NoArguments {
        /// The function.
        name: String,
        /// Its arguments, such as `x, y`.
        arguments: &'static str,
    },
    /// A call of a name that is not a function.
    #[error("`{0}` is not a function: write {0}*(...) to multiply")]
    NotAFunction(String),
    /// Too few or too many arguments.
    #[error("`{name}` takes {expected}, not {found}")]
    Arity {
        /// The function.
        name: String,
        /// The number of arguments it takes, in words.
        expected: &'static str,
        /// The number of arguments found.
        found: usize,
    },
    /// An unexpected token.
    #[error("expected {expected}, not {found}")]
    Expected {
        /// The expected token.
        expected: &'static str,
        /// The token found.
        found: String,
    },
    /// Two comparisons in a row.
    #[error("a second comparison has no meaning: write (a < b)*(b < c)")]
    SecondComparison,
    /// `=` alone.
    #[error("`=` has no meaning in a formula: `==` compares")]
    Assignment,
    /// Too many nested parentheses or operators.
    #[error("the formula is nested more than 200 deep")]
    TooDeep,
}
