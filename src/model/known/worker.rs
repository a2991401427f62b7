//! A function with known indices as a model.

use super::KnownFunction;
use crate::model::{Batch, Model, Output, RowFailure, RunContext, Worker};

/// Rows gathered at a time: as many as there are numbers in a cache line.
const TILE: usize = 8;

/// A [`KnownFunction`] as a model. Inputs without a factor stand at fixed values.
#[derive(Debug, Clone)]
pub struct KnownModel {
    function: KnownFunction,
    /// The values of all inputs, where the factors have not overwritten them.
    base: Vec<f64>,
    /// For each factor of the space: the input it drives.
    factors: Vec<usize>,
    outputs: [Output; 1],
}

impl KnownModel {
    /// `base` holds a value for every input, `factors` the number of the input that each factor of the space drives.
    pub fn new(function: KnownFunction, base: Vec<f64>, factors: Vec<usize>) -> Self {
        debug_assert_eq!(base.len(), function.inputs().len());
        debug_assert!(factors.iter().all(|&input| input < base.len()));
        Self { function, base, factors, outputs: [Self::output()] }
    }

    /// The one output, y.
    pub fn output() -> Output {
        Output::new("y", crate::quantity::Unit::dimensionless(), "value of the function")
    }
}

impl Model for KnownModel {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn worker<'a>(&'a self, _: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        Box::new(KnownWorker { model: self, rows: self.base.repeat(TILE), reasons: Vec::new() })
    }
}

struct KnownWorker<'a> {
    model: &'a KnownModel,
    /// The inputs of a few rows, row by row.
    rows: Vec<f64>,
    /// The reasons met so far: there are few, and each is put into words once.
    reasons: Vec<(&'static str, RowFailure)>,
}

impl Worker for KnownWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        let (function, width) = (&self.model.function, self.model.base.len());
        for first in (0..batch.rows()).step_by(TILE) {
            let count = TILE.min(batch.rows() - first);
            for (&input, column) in self.model.factors.iter().zip(inputs) {
                for (row, &value) in column[first..first + count].iter().enumerate() {
                    self.rows[row * width + input] = value;
                }
            }
            for (row, x) in self.rows.chunks_exact(width).take(count).enumerate() {
                let y = function.value(x);
                batch.set(first + row, 0, y);
                if y.is_nan()
                    && let Some(reason) = function.reason(x)
                {
                    batch.fail(first + row, 0, in_words(&mut self.reasons, reason));
                }
            }
        }
    }
}

fn in_words(reasons: &mut Vec<(&'static str, RowFailure)>, reason: &'static str) -> RowFailure {
    if let Some((_, words)) = reasons.iter().find(|(known, _)| *known == reason) {
        return words.clone();
    }
    reasons.push((reason, RowFailure::new(reason)));
    RowFailure::new(reason)
}
