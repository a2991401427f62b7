//! Models: a shared description that creates workers.
//!
//! A [`Model`] declares its outputs and creates [`Worker`]s; each thread owns one worker, which turns a block of rows
//! (one slice of SI values per factor) into a [`Batch`] of outputs. A row may fail, wholly or in one output, with a
//! [`RowFailure`]; it must not panic, and must not return an invalid number as a result.

mod batch;
mod context;
mod counter;
pub mod expression;
mod function;
mod known;
mod repeated;
mod series;

use std::borrow::Cow;

pub use batch::{Batch, GiveUp, RowFailure};
pub use context::{Messages, RunContext};
pub use counter::{Counter, CounterKind, Counts};
pub use expression::{Expression, ExpressionError, ExpressionModel, ExpressionProblem, Symbol};
pub use function::{FunctionModel, function_model};
pub use known::{Basis, Exact, KnownAnswer, KnownFunction, KnownInput, ParameterError, ParameterInfo, ParameterValue};
pub use repeated::RepeatedModel;
pub use series::{OutputSeries, SeriesAxis, SeriesError};

use crate::space::Distribution;
use apportion_base::quantity::{Domain, Unit};

/// One output of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// The name in study files and results.
    pub name: Cow<'static, str>,
    /// The unit in which values are reported; workers deliver SI values.
    pub unit: Unit,
    /// One line for people.
    pub description: Cow<'static, str>,
}

impl Output {
    /// Creates an output with that name, reported in `unit`.
    pub fn new(name: impl Into<Cow<'static, str>>, unit: Unit, description: impl Into<Cow<'static, str>>) -> Self {
        Self { name: name.into(), unit, description: description.into() }
    }
}

/// A choice of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The key in study files.
    pub key: &'static str,
    /// Where it applies; empty if everywhere.
    pub scope: &'static str,
    /// The names, or the kind of value.
    pub values: Vec<&'static str>,
}

/// An input of a model, which a study can make a factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// The name in study files.
    pub name: String,
    /// The symbol in the papers.
    pub symbol: String,
    /// The unit in which users give it.
    pub unit: Unit,
    /// The default value, in `unit`.
    pub nominal: f64,
    /// Its physical range (of its SI value); `None` for any finite number.
    pub domain: Option<Domain>,
    /// The default distribution, in `unit`; `None` if a study must give one.
    pub distribution: Option<Distribution>,
    /// A few words for people.
    pub description: String,
}

/// A flag that a model may raise on a row: its result is valid, but outside the theory's range; or a warning.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Flag {
    /// The name in results, in kebab-case.
    pub name: Cow<'static, str>,
    /// Its meaning, in one line.
    pub description: Cow<'static, str>,
    /// Whether it is unrelated to the theory's range: results mention it only if it was raised, and as a warning.
    pub warns: bool,
}

/// A model: shared between threads, immutable during a run.
pub trait Model: Send + Sync {
    /// Returns the outputs, in the order of the columns of a [`Batch`].
    fn outputs(&self) -> &[Output];

    /// Returns those of the outputs that are the values of one quantity along an axis; no two share an output.
    fn series(&self) -> &[OutputSeries] {
        &[]
    }

    /// Returns the validity flags it may raise, in the order of their indices in a [`Batch`].
    fn flags(&self) -> &[Flag] {
        &[]
    }

    /// Returns its counters, in the order of their indices in a [`Batch`].
    fn counters(&self) -> &[Counter] {
        &[]
    }

    /// Returns the best number of simultaneous workers, if it is not one for each thread. A model that returns a number
    /// is slow: its rows are distributed in batches that grow only as fast as they are evaluated.
    fn concurrency(&self) -> Option<usize> {
        None
    }

    /// Returns whether the same row may give another output when it is run again, as far as is known: a run then
    /// repeats a few rows at its end to check.
    fn may_be_random(&self) -> bool {
        false
    }

    /// Returns whether a row takes long enough for its outputs to be recorded row by row; if not, rows are evaluated in
    /// blocks.
    fn is_slow(&self) -> bool {
        self.concurrency().is_some()
    }

    /// Returns how many rows a call of a worker should have at least, if there are as many, because a call costs as much
    /// as many rows.
    fn rows_per_call(&self) -> usize {
        1
    }

    /// Returns whether an output may depend on a factor, both by index; `false` only if it certainly does not. Runs alone
    /// cannot show that an input has no effect.
    fn reads(&self, _output: usize, _factor: usize) -> bool {
        true
    }

    /// Creates a worker for one thread of the run of `context`.
    fn worker<'a>(&'a self, context: &'a RunContext<'a>) -> Box<dyn Worker + 'a>;
}

/// The part of a model that one thread owns.
pub trait Worker: Send {
    /// Evaluates a block of rows. `inputs` has one slice of SI values per factor, in the order of the space, all of the
    /// length [`Batch::rows`]; every output of every row must be set or failed in `batch`.
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch);
}
