//! Formulas as a model: checked when they are read, computed column by column, without execution of other code.
//!
//! The grammar is that of mathematics and of most languages: `^` (or `**`) binds tightest and to the right, so that
//! `-x^2` is -(x^2) and `2^3^2` is 2^9; then the sign; `*` and `/`; `+` and `-`; and one comparison. No crate fits:
//! exmex 0.21 reads `-x^2` as (-x)^2 and `2^3^2` as (2^3)^2, does not support `1e-3`, and its errors have no position.

mod error;
mod functions;
mod parse;
mod program;
mod token;

pub use error::{ExpressionError, ExpressionProblem};
pub use program::{Comparison, Step};
use program::{Program, Stack, TILE};

use super::{Batch, Model, Output, RowFailure, RunContext, Worker};

/// The meaning of a name in a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Symbol {
    /// The input with that index.
    Input(usize),
    /// A number.
    Number(f64),
}

/// A checked formula of some inputs.
///
/// ```
/// use apportion::model::Symbol;
/// use apportion::Expression;
///
/// let symbol = |name: &str| match name {
///     "x" => Some(Symbol::Input(0)),
///     "a" => Some(Symbol::Number(7.0)),
///     _ => None,
/// };
/// let formula = Expression::parse("a*sin(x)^2 - 1", &symbol)?;
/// assert_eq!(formula.value(&[0.5]), 7.0 * 0.5f64.sin().powi(2) - 1.0);
/// let error = Expression::parse("a*sin(y)", &symbol).unwrap_err();
/// assert_eq!((error.to_string(), error.place), ("there is no `y`".to_owned(), 6..7));
/// # Ok::<(), apportion::ExpressionError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Expression {
    text: String,
    program: Program,
}

impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text && self.program.numbers() == other.program.numbers()
    }
}

impl Expression {
    /// Parses a formula, whose inputs and constants `symbol` looks up. Functions and `pi` are built in.
    ///
    /// # Errors
    /// [`ExpressionError`] with the place in the text, for anything that is not a valid formula: unknown names, a wrong
    /// number of arguments, unbalanced parentheses, more than 200 nested ones.
    pub fn parse(text: &str, symbol: &dyn Fn(&str) -> Option<Symbol>) -> Result<Self, ExpressionError> {
        let program = parse::parse(text, symbol)?;
        Ok(Self { text: text.to_owned(), program })
    }

    /// Returns the formula as written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the formula as steps on a stack of columns.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Returns whether the formula contains the input with that index.
    pub fn uses(&self, input: usize) -> bool {
        self.program.uses(input)
    }

    /// Computes the value at one point, which has an entry for every input; not finite if there is no value.
    ///
    /// # Panics
    /// If an input of the formula is missing.
    pub fn value(&self, x: &[f64]) -> f64 {
        let columns: Vec<&[f64]> = x.iter().map(std::slice::from_ref).collect();
        let mut value = [f64::NAN];
        self.program.run(&columns, 0, &mut value, &mut Stack::default());
        value[0]
    }

    /// Returns whether `name` is a function or a number of the formula language, and so not allowed for an input.
    pub fn is_reserved(name: &str) -> bool {
        functions::named(name).is_some() || functions::number(name).is_some()
    }

    /// Returns whether `name` is a valid name: a letter or `_`, then letters, digits and `_`.
    pub fn is_name(name: &str) -> bool {
        name.chars().next().is_some_and(token::begins_name) && name.chars().all(token::in_name)
    }

    /// Returns the names of the functions, and of the one number.
    pub fn vocabulary() -> Vec<&'static str> {
        functions::vocabulary()
    }
}

/// Formulas as a model: one output each.
#[derive(Clone, Debug)]
pub struct ExpressionModel {
    formulas: Vec<Expression>,
    outputs: Vec<Output>,
}

impl ExpressionModel {
    /// Creates a model of these outputs, each with its formula of the SI values of the factors, in the order of the
    /// space; the value is also in SI.
    pub fn new(formulas: Vec<(Output, Expression)>) -> Self {
        let (outputs, formulas) = formulas.into_iter().unzip();
        Self { formulas, outputs }
    }
}

impl Model for ExpressionModel {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn reads(&self, output: usize, factor: usize) -> bool {
        self.formulas[output].program.reads(factor)
    }

    fn worker<'a>(&'a self, _: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        let failures = [
            RowFailure::new("the formula has no value (it is NaN, as 0/0 and ln(-1) are)"),
            RowFailure::new("the formula is infinite"),
        ];
        Box::new(ExpressionWorker { model: self, stack: Stack::default(), failures })
    }
}

struct ExpressionWorker<'a> {
    model: &'a ExpressionModel,
    stack: Stack,
    /// The reasons for NaN and for an infinite value.
    failures: [RowFailure; 2],
}

impl Worker for ExpressionWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        for (output, formula) in self.model.formulas.iter().enumerate() {
            let column = batch.column_mut(output);
            for (tile, values) in column.chunks_mut(TILE).enumerate() {
                formula.program.run(inputs, tile * TILE, values, &mut self.stack);
            }
            for row in 0..batch.rows() {
                let value = batch.column(output)[row];
                if !value.is_finite() {
                    batch.fail(row, output, self.failures[usize::from(!value.is_nan())].clone());
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
