//! The indices of one output.

use serde::{Deserialize, Serialize};

use super::column::{Column, NoVariance};
use super::order::Order;
use super::{Binned, Rows, binned, centred, rank};
use crate::uncertainty::{Estimate, Interval};

/// The results for one output.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputIndices {
    /// The output.
    pub name: String,
    /// One entry per input, in their order, or why there is none.
    pub indices: Result<Vec<InputIndices>, NoVariance>,
}

impl OutputIndices {
    /// Returns whether the first-order indices sum to clearly more than those of independent inputs.
    pub(super) fn sums_above_one(&self) -> bool {
        self.indices.iter().flatten().map(|of| of.leading().estimate).sum::<f64>() > 1.05
    }
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
    /// Returns the estimate that reports show: of the two, the one with the wider interval.
    pub fn leading(&self) -> Estimate {
        let binned = self.binned.estimate;
        let [by_rank, by_bins] = [self.rank, Some(binned)].map(|of| of.and_then(|of| of.interval).map(Interval::width));
        self.rank.filter(|_| by_rank > by_bins).unwrap_or(binned)
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
    (orders, is_even): (&[Order], &[bool]),
    Rows { is_random, has_intervals }: Rows,
    seed: u64,
) -> OutputIndices {
    let indices = centred(&output.values).map(|z| {
        let few = Estimate { estimate: 0.0, interval: Some(Interval::about(0.0, one_over_carrying_rows(&z))) };
        let inputs = inputs.iter().zip(orders).enumerate().map(|(j, (input, order))| {
            let Binned { estimate, bins } = binned::of_order(order, &input.values, &z, !is_even[j]);
            let rank = is_random.then(|| rank::of_order(order, &z, seed, j as u64));
            let [rank, binned] =
                [rank.map(|rank| Estimate::difference(few, rank)), Some(Estimate::difference(few, estimate))]
                    .map(|of| of.map(|of| if is_random && has_intervals { of } else { Estimate::alone(of.estimate) }));
            InputIndices {
                input: input.name.clone(),
                constant: order.groups() < 2,
                rank,
                binned: Binned { estimate: binned.unwrap_or(estimate), bins },
            }
        });
        inputs.collect()
    });
    OutputIndices { name: output.name.clone(), indices }
}

/// Returns one over the number of rows that have the variance of the centred outputs `z` if they have equal parts of it:
/// what further rows of the kind of one of them would change.
fn one_over_carrying_rows(z: &[f64]) -> f64 {
    z.iter().map(|z| z.powi(4)).sum::<f64>() / z.iter().map(|z| z * z).sum::<f64>().powi(2)
}

#[cfg(test)]
#[path = "tests/outcome.rs"]
mod tests;
