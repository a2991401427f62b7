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
mod tests {
    use crate::given::{Column, InputIndices, analyse};

    /// Tables of each kind.
    const TABLES: u64 = 40;

    /// Uniform numbers in columns, by the generator of Knuth's MMIX.
    fn uniform(rows: usize, columns: usize, mut state: u64) -> Vec<Column> {
        let mut all: Vec<Column> = (0..columns).map(|k| Column { name: format!("x{k}"), values: Vec::new() }).collect();
        for _ in 0..rows + 20 {
            for column in &mut all {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                column.values.push((state >> 11) as f64 / (1u64 << 53) as f64);
            }
        }
        // The first numbers of neighbouring seeds are alike.
        all.iter_mut().for_each(|column| drop(column.values.drain(..20)));
        all
    }

    fn indices(rows: usize, seed: u64, of: fn(&[f64]) -> f64) -> Option<Vec<InputIndices>> {
        let inputs = uniform(rows, 3, seed);
        let row = |row: usize| of(&inputs.iter().map(|input| input.values[row]).collect::<Vec<f64>>());
        let output = Column { name: "y".into(), values: (0..rows).map(row).collect() };
        analyse(&inputs, &[output], seed).unwrap().outputs.remove(0).indices.ok()
    }

    fn above(x: f64, edge: f64) -> f64 {
        f64::from(u8::from(x > edge))
    }

    /// Rare regions, steps, centred products, heavy tails: the third input is idle.
    #[test]
    fn the_interval_that_is_shown_holds() {
        type Case = (&'static str, fn(&[f64]) -> f64, [f64; 2]);
        let product = |share: f64| libm::expm1(9.0 * share) / libm::expm1(9.0);
        let cases: [Case; 5] = [
            ("a rare corner", |x| above(x[0], 0.9) * above(x[1], 0.9), [1.0 / 11.0; 2]),
            ("a step", |x| 10.0 * above(x[0], 0.5) + x[1], [300.0 / 301.0, 1.0 / 301.0]),
            (
                "a step inside of a bin",
                |x| 2.0 * above(x[0], 0.7) + x[1],
                [0.84 / (0.84 + 1.0 / 12.0), 1.0 / (12.0 * 0.84 + 1.0)],
            ),
            ("a centred product", |x| (x[0] - 0.5) * (x[1] - 0.5), [0.0; 2]),
            (
                "a log-normal product",
                |x| {
                    let [a, b] = [x[0], x[1]].map(apportion_base::special::normal_quantile);
                    libm::exp(3.0 * (0.8 * a + 0.6 * b))
                },
                [product(0.64), product(0.36)],
            ),
        ];
        for (name, of, [a, b]) in cases {
            for rows in [100, 400, 1000] {
                let tables = (0..TABLES).filter_map(|seed| indices(rows, 7 * seed, of));
                let (mut held, mut count) = ([0; 3], 0);
                for indices in tables {
                    count += 1;
                    for ((held, index), exact) in held.iter_mut().zip(&indices).zip([a, b, 0.0]) {
                        let shown = index.leading().interval.unwrap();
                        let of_both = [index.rank.unwrap().interval.unwrap(), index.binned.estimate.interval.unwrap()];
                        assert_eq!(shown.width(), of_both[0].width().max(of_both[1].width()));
                        *held += usize::from(shown.low <= exact && exact <= shown.high);
                    }
                }
                // Of 40 tables at .95, fewer than 34 hold once in 300 times.
                assert!(held.iter().all(|held| 100 * held >= 85 * count), "{name}, {rows} rows: {held:?} of {count}");
            }
        }
    }
}
