//! Repeated runs of a stochastic model at every row: mean and variance over its noise.

use std::sync::Arc;

use super::{Batch, Counter, Flag, Model, Output, RunContext, Worker};
use crate::space::distribution::{mixed, seed_of};
use apportion_base::quantity::Unit;

/// The mean and the variance of the outputs of a stochastic model over several runs of each row, with different seeds.
///
/// Every output `y` is replaced by `y_mean` and `y_variance` (with the divisor n - 1, hence unbiased), in this order.
/// Both still vary with the noise, less with more runs; the noise is a factor, and its indices measure this.
///
/// ```
/// use std::sync::Arc;
/// use apportion::{Distribution, Model, RepeatedModel, Study, function_model};
///
/// let die = |seed: f64| (seed % 6.0) + 1.0;
/// let model = Arc::new(function_model("y", move |x| x[0] + die(x[1])));
/// let study = Study::builder("dice", RepeatedModel::new(model, 1, 8))
///     .factor("x", Distribution::uniform(0.0, 1.0)?)
///     .factor("seed", Distribution::seed())
///     .base_samples(256)
///     .build()?;
/// assert_eq!(study.model().outputs()[1].name, "y_variance");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct RepeatedModel {
    model: Arc<dyn Model>,
    outputs: Vec<Output>,
    seed: usize,
    repetitions: usize,
}

impl RepeatedModel {
    /// Repeats `model`, whose input number `seed` is its seed, `repetitions` times for each row, at least twice.
    pub fn new(model: Arc<dyn Model>, seed: usize, repetitions: usize) -> Self {
        let mut outputs = Vec::with_capacity(2 * model.outputs().len());
        for Output { name, unit, .. } in model.outputs() {
            outputs.push(Output::new(format!("{name}_mean"), unit.clone(), "mean over the noise"));
            outputs.push(Output::new(format!("{name}_variance"), square(unit), "variance over the noise"));
        }
        Self { model, outputs, seed, repetitions: repetitions.max(2) }
    }
}

/// Returns the square of a unit, for variances; the square of a label is a label.
fn square(unit: &Unit) -> Unit {
    let symbol = unit.symbol();
    match symbol {
        "1" => Unit::dimensionless(),
        _ if unit.has_offset() => Unit::label("K^2"),
        _ => {
            let one = symbol.chars().all(char::is_alphabetic).then(|| format!("{symbol}^2"));
            // The syntax has no product after "/".
            let mut parts = symbol.split('/').map(str::trim);
            let above = parts.next().map(|part| format!("{part}*{part}"));
            let below: String = parts.map(|part| format!("/{part}/{part}")).collect();
            let texts = one.into_iter().chain(above.map(|above| above + &below));
            let (zero, step) = (unit.to_si(0.0), unit.to_si(1.0));
            let mut units = texts.filter_map(|text| Unit::known(&text));
            let square = units.find(|unit| unit.to_si(0.0) == zero && same(unit.to_si(1.0), step * step));
            square.unwrap_or_else(|| Unit::label(&format!("({symbol})^2")))
        }
    }
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * b.abs()
}

/// Returns the seed of repetition `number` of a row with this seed: the first is that of the row.
fn seed_of_repetition(seed: f64, number: u64) -> f64 {
    const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
    if number == 0 { seed } else { seed_of(mixed((seed as u64).wrapping_add(number.wrapping_mul(GOLDEN)))) }
}

impl Model for RepeatedModel {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn flags(&self) -> &[Flag] {
        self.model.flags()
    }

    fn counters(&self) -> &[Counter] {
        self.model.counters()
    }

    fn reads(&self, output: usize, factor: usize) -> bool {
        self.model.reads(output / 2, factor)
    }

    fn concurrency(&self) -> Option<usize> {
        self.model.concurrency()
    }

    fn may_be_random(&self) -> bool {
        self.model.may_be_random()
    }

    fn worker<'a>(&'a self, context: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        let batch = Batch::new(&*self.model);
        Box::new(RepeatedWorker { of: self, worker: self.model.worker(context), batch, columns: Vec::new() })
    }
}

struct RepeatedWorker<'a> {
    of: &'a RepeatedModel,
    worker: Box<dyn Worker + 'a>,
    /// The outputs of all repetitions of a block: its rows, then its rows again, and so on.
    batch: Batch,
    columns: Vec<Vec<f64>>,
}

impl RepeatedWorker<'_> {
    fn gather(&self, batch: &mut Batch) {
        let (rows, repetitions) = (batch.rows(), self.of.repetitions);
        let outputs = self.batch.outputs();
        for output in 0..outputs {
            let values = self.batch.column(output);
            for row in 0..rows {
                // One by one (Welford 1962, Technometrics 4, 419-420), so that large values lose no digits.
                let (mut mean, mut squares) = (0.0, 0.0);
                for repetition in 0..repetitions {
                    let off = values[repetition * rows + row] - mean;
                    mean += off / (repetition + 1) as f64;
                    squares += off * (values[repetition * rows + row] - mean);
                }
                batch.set(row, 2 * output, mean);
                batch.set(row, 2 * output + 1, squares / (repetitions - 1) as f64);
            }
        }
        // A row without one of its repetitions has no mean.
        let mut named = vec![false; outputs * rows];
        for (output, place, reason) in self.batch.failures() {
            let row = place % rows;
            if !std::mem::replace(&mut named[output * rows + row], true) {
                batch.fail(row, 2 * output, reason.clone());
                batch.fail(row, 2 * output + 1, reason.clone());
            }
        }
        batch.add_counts(self.batch.flags(), self.batch.counts());
        if let Some(reason) = self.batch.given_up() {
            batch.give_up(reason.clone());
        }
    }
}

impl Worker for RepeatedWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        let repetitions = self.of.repetitions;
        self.columns.resize_with(inputs.len(), Vec::new);
        for (number, (column, input)) in self.columns.iter_mut().zip(inputs).enumerate() {
            column.clear();
            for repetition in 0..repetitions as u64 {
                if number == self.of.seed {
                    column.extend(input.iter().map(|seed| seed_of_repetition(*seed, repetition)));
                } else {
                    column.extend_from_slice(input);
                }
            }
        }
        let columns: Vec<&[f64]> = self.columns.iter().map(Vec::as_slice).collect();
        self.batch.reset(batch.rows() * repetitions);
        self.worker.run(&columns, &mut self.batch);
        self.gather(batch);
    }
}

#[cfg(test)]
#[path = "tests/repeated.rs"]
mod tests;
