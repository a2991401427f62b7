//! What a model counts over its rows, by name.

use std::borrow::Cow;

use crate::binary::{Binary, Reader, binary_fields};

/// Beginning of the names of counters of rows that a rung of the ladder of fidelities answered.
pub const RUNGS: &str = "rungs.";
/// Name of the counter of evaluations of the right-hand side.
pub const EVALUATIONS: &str = "evaluations";
/// Name of the counter of the largest relative error estimate of any row.
pub const LARGEST_ERROR: &str = "largest_error_estimate";

/// A number that a model counts over the rows of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Counter {
    /// The name.
    pub name: Cow<'static, str>,
    /// What the counts of two rows make together.
    pub kind: CounterKind,
}

/// How counts are put together. Neither depends on their order, in any bit: sums are of whole numbers, and exact up to
/// 2^53.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CounterKind {
    /// They are added.
    Sum,
    /// The largest counts.
    Maximum,
}

/// The counts of some rows, in the order of the model's [counters](super::Model::counters).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Counts {
    entries: Vec<Count>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Count {
    kind: CounterKind,
    value: f64,
}

binary_fields!(Counts { entries });
binary_fields!(Count { kind, value });

impl Binary for CounterKind {
    fn write(&self, out: &mut Vec<u8>) {
        (*self == Self::Maximum).write(out);
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        Some(if bool::read(from)? { Self::Maximum } else { Self::Sum })
    }
}

impl Counts {
    /// Nothing counted by `counters`.
    pub fn new(counters: &[Counter]) -> Self {
        Self::from_values(counters.iter().map(|counter| (counter.kind, 0.0)))
    }

    /// Counts of these kinds and values.
    pub(crate) fn from_values(values: impl IntoIterator<Item = (CounterKind, f64)>) -> Self {
        Self { entries: values.into_iter().map(|(kind, value)| Count { kind, value }).collect() }
    }

    /// The values, in order.
    pub fn values(&self) -> impl ExactSizeIterator<Item = f64> {
        self.entries.iter().map(|count| count.value)
    }

    /// Whether nothing was counted.
    pub fn is_zero(&self) -> bool {
        self.entries.iter().all(|count| count.value == 0.0)
    }

    /// Adds `amount` to the counter of that number, or takes the larger of both.
    pub fn add(&mut self, counter: usize, amount: f64) {
        self.entries[counter].add(amount);
    }

    /// Adds the counts of other rows.
    pub fn merge(&mut self, other: &Self) {
        self.entries.iter_mut().zip(&other.entries).for_each(|(mine, theirs)| mine.add(theirs.value));
    }

    pub(super) fn clear(&mut self) {
        self.entries.iter_mut().for_each(|count| count.value = 0.0);
    }
}

impl Count {
    fn add(&mut self, amount: f64) {
        match self.kind {
            CounterKind::Sum => self.value += amount,
            CounterKind::Maximum => self.value = self.value.max(amount),
        }
    }
}
