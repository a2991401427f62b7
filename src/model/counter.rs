//! Named counters of a model over its rows.

use std::borrow::Cow;

use crate::binary::{Binary, Reader, binary_fields};

/// Prefix of the names of counters of rows evaluated by a rung of the ladder of fidelities.
pub const RUNGS: &str = "rungs.";
/// Name of the counter of evaluations of the right-hand side.
pub const EVALUATIONS: &str = "evaluations";
/// Name of the counter of the largest relative error estimate of any row.
pub const LARGEST_ERROR: &str = "largest_error_estimate";

/// A quantity that a model counts over the rows of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Counter {
    /// The name.
    pub name: Cow<'static, str>,
    /// How the counts of two rows are combined.
    pub kind: CounterKind,
}

/// How counts are combined. No bit depends on their order: sums are of whole numbers, and exact up to 2^53.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CounterKind {
    /// They are added.
    Sum,
    /// The maximum is taken.
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
    /// Returns zero counts for `counters`.
    pub fn new(counters: &[Counter]) -> Self {
        Self::from_values(counters.iter().map(|counter| (counter.kind, 0.0)))
    }

    /// Creates counts of these kinds and values.
    pub(crate) fn from_values(values: impl IntoIterator<Item = (CounterKind, f64)>) -> Self {
        Self { entries: values.into_iter().map(|(kind, value)| Count { kind, value }).collect() }
    }

    /// Iterates over the values, in order.
    pub fn values(&self) -> impl ExactSizeIterator<Item = f64> {
        self.entries.iter().map(|count| count.value)
    }

    /// Returns whether nothing was counted.
    pub fn is_zero(&self) -> bool {
        self.entries.iter().all(|count| count.value == 0.0)
    }

    /// Adds `amount` to the counter with that index, or takes the maximum of both.
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
