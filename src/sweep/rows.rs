//! Runs of a model around the nominal point.

use super::{Gap, OutputCurve};
use crate::model::{Batch, Model, Output, RunContext};
use crate::run::{Executor, Halt};
use crate::space::Space;

/// A model with its factors at their nominal values.
pub(super) struct Bench<'a> {
    space: &'a Space,
    model: &'a dyn Model,
    executor: Executor<'a>,
    batch: Batch,
    /// Nominal values in SI units.
    nominal: Vec<f64>,
    /// Runs so far.
    pub runs: u64,
    /// For each validity flag: runs so far that raised it.
    pub flags: Vec<u64>,
}

impl<'a> Bench<'a> {
    pub fn new(space: &'a Space, model: &'a dyn Model, context: &'a RunContext<'a>) -> Self {
        let nominal = space.factors().iter().map(|factor| factor.unit().to_si(factor.nominal)).collect();
        let flags = vec![0; model.flags().len()];
        let (executor, batch) = (Executor::new(model, context, 0), Batch::new(model));
        Self { space, model, executor, batch, nominal, runs: 0, flags }
    }

    /// For each output: whether its unit has a zero of its own.
    pub fn offsets(&self) -> Vec<bool> {
        self.model.outputs().iter().map(|output| output.unit.has_offset()).collect()
    }

    /// Every output for each of `values` of one factor, in its unit, with one other factor perhaps moved from its
    /// nominal value.
    ///
    /// # Errors
    /// [`Halt`] if the model gives up or is stopped.
    pub fn curve(
        &mut self,
        factor: usize,
        values: &[f64],
        moved: Option<(usize, f64)>,
    ) -> Result<Vec<OutputCurve>, Halt> {
        let unit = self.space.factors()[factor].unit();
        let mut base = self.nominal.clone();
        if let Some((other, value)) = moved {
            base[other] = self.space.factors()[other].unit().to_si(value);
        }
        let empty = |output: &Output| OutputCurve {
            name: output.name.to_string(),
            unit: output.unit.to_string(),
            values: Vec::new(),
            gaps: Vec::new(),
        };
        let mut outputs: Vec<OutputCurve> = self.model.outputs().iter().map(empty).collect();
        let most = self.executor.rows_at_once();
        for (block, values) in values.chunks(most).enumerate() {
            let mut columns: Vec<Vec<f64>> = base.iter().map(|value| vec![*value; values.len()]).collect();
            columns[factor] = values.iter().map(|value| unit.to_si(*value)).collect();
            let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
            self.batch.reset(values.len());
            self.executor.run_table(&inputs, &mut self.batch)?;
            self.runs += values.len() as u64;
            for (sum, raised) in self.flags.iter_mut().zip(self.batch.flags()) {
                *sum += raised;
            }
            for (number, (output, curve)) in self.model.outputs().iter().zip(&mut outputs).enumerate() {
                let column = self.batch.column(number).iter();
                let values = column.map(|value| value.is_finite().then(|| output.unit.from_si(*value)));
                curve.values.extend(values);
            }
            for (output, row, reason) in self.batch.failures() {
                outputs[*output].gaps.push(Gap { place: block * most + row, reason: reason.to_string() });
            }
        }
        Ok(outputs)
    }
}
