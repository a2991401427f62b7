//! The indices of one output.

use serde::{Deserialize, Serialize};

use super::column::{Column, NoVariance};
use super::order::Order;
use super::{Binned, binned, centred, rank};
use crate::uncertainty::Estimate;

/// What came out for one output.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputIndices {
    /// The output.
    pub name: String,
    /// One entry per input, in their order, or why there is none.
    pub indices: Result<Vec<InputIndices>, NoVariance>,
}

/// The first-order index of one input, by each method that was used.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InputIndices {
    /// The input.
    pub input: String,
    /// Whether it has one value only; its index is then 0 by definition.
    pub constant: bool,
    /// By ranks.
    pub rank: Option<Estimate>,
    /// By bins.
    pub binned: Option<Binned>,
}

impl InputIndices {
    /// The estimate that stands first in reports: by ranks if there is one, else by bins.
    pub fn leading(&self) -> Option<Estimate> {
        self.rank.or(self.binned.map(|binned| binned.estimate))
    }

    /// Whether the two methods disagree by more than both intervals allow: their half widths on the facing sides do not
    /// meet.
    pub fn disagree(&self) -> bool {
        let intervals = self.rank.and_then(|rank| rank.interval).zip(self.binned.and_then(|b| b.estimate.interval));
        intervals.is_some_and(|(a, b)| a.high < b.low || b.high < a.low)
    }
}

/// What is estimated.
#[derive(Debug, Clone, Copy)]
pub(super) struct Settings {
    pub rank: bool,
    pub binned: bool,
    pub independent: bool,
    pub seed: u64,
}

pub(super) fn of_output(output: &Column, inputs: &[Column], orders: &[Order], settings: Settings) -> OutputIndices {
    let indices = centred(&output.values).map(|z| {
        let each = inputs.iter().zip(orders).enumerate();
        each.map(|(j, (input, order))| InputIndices {
            input: input.name.clone(),
            constant: order.groups() < 2,
            rank: settings.rank.then(|| rank::of_order(order, &z, (settings.seed, j as u64))),
            binned: settings.binned.then(|| binned::of_order(order, &input.values, &z, settings.independent)),
        })
        .collect()
    });
    OutputIndices { name: output.name.clone(), indices }
}
