//! Measures of influence other than Sobol' indices, from rows A and B of a run.
//!
//! The rows A and B are draws from the distributions of the factors, like those of a table of given data. A run keeps
//! the outputs of the first of them; inputs follow from row numbers, so memory does not grow with size.

use super::first_rows::FirstRows;
use crate::design::{Design, DesignSettings, Sampler};
use crate::given::{Column, MIN_ROWS, Measure, measures_of_rows};
use crate::result::RunMeasures;
use crate::space::Space;

/// Maximum number of rows, over all replicates, used for other measures: the first of a run.
pub const MAX_ROWS_OF_MEASURES: u64 = 1 << 12;

/// The rows used for measures: the first rows A and B of every replicate, a column for each factor.
pub(super) struct MeasuredRows {
    rows: FirstRows,
    factors: Vec<Column>,
    seed: u64,
    /// Whether the rows are independent draws.
    independent: bool,
}

impl MeasuredRows {
    pub fn new(design: &Design, space: &Space) -> Self {
        let rows = FirstRows::new(design, MAX_ROWS_OF_MEASURES / 2);
        let mut factors = Vec::new();
        for (number, factor) in space.factors().iter().enumerate() {
            if !factor.distribution().is_noise() {
                let values = rows.coordinates(number).map(|u| factor.distribution().quantile(u));
                factors.push(Column { name: factor.name.clone(), values: values.collect() });
            }
        }
        let DesignSettings { seed, sampler, .. } = *design.settings();
        Self { rows, factors, seed, independent: sampler == Sampler::Random }
    }

    /// Computes the measures `wanted` of output number `number`, of which every replicate has kept these rows; `None`
    /// if too few have a value, or all the same.
    ///
    /// Points of nets and Latin hypercubes are more even than independent draws: permutations overestimate the effect
    /// of chance, so that only rows of random points have p-values. Intervals are a little wide on nets, but valid.
    pub fn measures(&self, wanted: &[Measure], number: usize, samples: &[&Vec<f64>]) -> Option<RunMeasures> {
        let all = self.rows.outputs(samples);
        let outputs = with_output(&all, &all);
        if outputs.len() < MIN_ROWS {
            return None;
        }
        let inputs = self.factors.iter();
        let inputs: Vec<Column> = inputs
            .map(|Column { name, values }| Column { name: name.clone(), values: with_output(values, &all) })
            .collect();
        let factors = measures_of_rows(&inputs, &outputs, wanted, self.seed, number as u64, self.independent).ok()?;
        Some(RunMeasures { rows: outputs.len(), factors })
    }
}

/// Returns the values of the rows whose output is a number.
fn with_output(values: &[f64], outputs: &[f64]) -> Vec<f64> {
    values.iter().zip(outputs).filter(|(_, y)| y.is_finite()).map(|(value, _)| *value).collect()
}
