//! A model outside this program, whose outputs come from a file.

use super::{Batch, Model, Output, OutputSeries, RowFailure, RunContext, Worker};

/// A model that runs elsewhere: it has outputs with names and units, but every row evaluated by it fails. Its outputs
/// are read from a file, into a [`Store`](crate::run::Store).
#[derive(Debug, Clone, PartialEq)]
pub struct ExternalModel {
    outputs: Vec<Output>,
    series: Vec<OutputSeries>,
}

impl ExternalModel {
    /// Creates a model of these outputs.
    pub fn new(outputs: Vec<Output>) -> Self {
        Self { outputs, series: Vec::new() }
    }

    /// Sets those of its outputs that are series.
    #[must_use]
    pub fn with_series(self, series: Vec<OutputSeries>) -> Self {
        Self { series, ..self }
    }

    /// Returns why its rows have no values here.
    pub fn elsewhere() -> RowFailure {
        RowFailure::new("the model runs outside of this program, and the row's outputs have not been read")
    }
}

impl Model for ExternalModel {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn series(&self) -> &[OutputSeries] {
        &self.series
    }

    fn worker<'a>(&'a self, _: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        Box::new(Elsewhere)
    }
}

struct Elsewhere;

impl Worker for Elsewhere {
    fn run(&mut self, _inputs: &[&[f64]], batch: &mut Batch) {
        for row in 0..batch.rows() {
            batch.fail_row(row, &ExternalModel::elsewhere());
        }
    }
}
