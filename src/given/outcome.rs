//! The indices of one output.

use serde::{Deserialize, Serialize};

use super::column::{Column, NoVariance};
use super::order::Order;
use super::{Binned, binned, centred, rank};
use crate::uncertainty::Estimate;

/// The results for one output.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputIndices {
    /// The output.
    pub name: String,
    /// One entry per input, in their order, or why there is none.
    pub indices: Result<Vec<InputIndices>, NoVariance>,
}

/// The first-order index of one input.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InputIndices {
    /// The input.
    pub input: String,
    /// Whether it has one value only; its index is then 0 by definition.
    pub constant: bool,
    /// The estimate by ranks, for independent rows.
    pub rank: Option<Estimate>,
    /// The estimate by bins.
    pub binned: Binned,
}

impl InputIndices {
    /// Returns the estimate that reports show first: by ranks if there is one, otherwise by bins.
    pub fn leading(&self) -> Estimate {
        self.rank.unwrap_or(self.binned.estimate)
    }

    /// Returns whether the two methods disagree by more than both intervals allow, on the facing sides.
    pub fn disagree(&self) -> bool {
        let intervals = self.rank.and_then(|rank| rank.interval).zip(self.binned.estimate.interval);
        intervals.is_some_and(|(a, b)| a.high < b.low || b.high < a.low)
    }
}

pub(super) fn of_output(
    output: &Column,
    inputs: &[Column],
    orders: &[Order],
    is_random: bool,
    seed: u64,
) -> OutputIndices {
    let indices = centred(&output.values).map(|z| {
        let inputs = inputs.iter().zip(orders).enumerate().map(|(j, (input, order))| InputIndices {
            input: input.name.clone(),
            constant: order.groups() < 2,
            rank: is_random.then(|| rank::of_order(order, &z, seed, j as u64)),
            binned: binned::of_order(order, &input.values, &z, is_random),
        });
        inputs.collect()
    });
    OutputIndices { name: output.name.clone(), indices }
}
