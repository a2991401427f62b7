//! Named counters of a model over its rows.

use std::borrow::Cow;

/// A quantity that a model counts over the rows of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Counter {
    /// The name.
    pub name: Cow<'static, str>,
    /// How the counts of two rows are combined.
    pub kind: CounterKind,
}

impl Counter {
    /// Prefix of the names of counters of rows evaluated by a rung of the ladder of fidelities.
    pub const RUNGS: &str = "rungs.";

    /// Name of the counter of evaluations of the right-hand side.
    pub const EVALUATIONS: &str = "evaluations";

    /// Name of the counter of the largest relative error estimate of any row.
    pub const LARGEST_ERROR: &str = "largest_error_estimate";
}

/// How counts are combined. No bit depends on their order: sums are of whole numbers, and exact up to 2^53.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CounterKind {
    /// They are added.
    Sum,
    /// The maximum is taken.
    Maximum,
}

/// The counts of some rows, in the order of the model's [counters](super::Model::counters), each with its kind.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Counts(pub(crate) Vec<(CounterKind, f64)>);

impl Counts {
    /// Returns zero counts for `counters`.
    pub fn new(counters: &[Counter]) -> Self {
        Self(counters.iter().map(|counter| (counter.kind, 0.0)).collect())
    }

    /// Iterates over the values, in order.
    pub fn values(&self) -> impl ExactSizeIterator<Item = f64> {
        self.0.iter().map(|(_, value)| *value)
    }

    /// Returns whether nothing was counted.
    pub fn is_zero(&self) -> bool {
        self.values().all(|value| value == 0.0)
    }

    /// Adds `amount` to the counter with that index, or takes the maximum of both.
    pub fn add(&mut self, counter: usize, amount: f64) {
        let (kind, value) = &mut self.0[counter];
        *value = match kind {
            CounterKind::Sum => *value + amount,
            CounterKind::Maximum => value.max(amount),
        };
    }

    /// Adds the counts of other rows; no counts are as many zeros as the others.
    pub fn merge(&mut self, other: &Self) {
        let zeros = other.0.iter().skip(self.0.len()).map(|(kind, _)| (*kind, 0.0));
        self.0.extend(zeros);
        (0..self.0.len()).zip(other.values()).for_each(|(counter, amount)| self.add(counter, amount));
    }

    pub(super) fn clear(&mut self) {
        self.0.iter_mut().for_each(|(_, value)| *value = 0.0);
    }
}
