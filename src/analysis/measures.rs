//! Measures of influence other than Sobol' indices, from rows A and B of a run.
//!
//! The rows A and B are draws from the distributions of the factors, like those of a table of given data. A run keeps
//! the outputs of the first of them; inputs follow from row numbers, so memory does not grow with size.

use super::first_rows::FirstRows;
use crate::design::{Design, DesignSettings, Sampler};
use crate::given::{Column, MIN_ROWS, Measure, measures_of_rows};
use crate::result::RunMeasures;
use crate::space::{Factor, Space};

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
        let known = space.factors().iter().enumerate().filter(|(_, factor)| !factor.distribution().is_noise());
        let column = |(number, factor): (usize, &Factor)| {
            let values = rows.coordinates(number).map(|u| factor.distribution().quantile(u));
            Column { name: factor.name.clone(), values: values.collect() }
        };
        let factors = known.map(column).collect();
        let DesignSettings { seed, sampler, .. } = *design.settings();
        Self { rows, factors, seed, independent: sampler == Sampler::Random }
    }

    /// Computes the measures `wanted` of output number `number`, of which every replicate has kept these rows; `None`
    /// if too few have a value, or all the same.
    ///
    /// Points of nets and Latin hypercubes are more even than independent draws: permutations overestimate the effect
    /// of chance, so that only rows of random points have p-values. Intervals are a little wide on nets, but valid.
    pub fn measures(&self, wanted: &[Measure], number: usize, samples: &[Vec<f64>]) -> Option<RunMeasures> {
        let outputs = self.rows.outputs(samples);
        let has_value: Vec<bool> = outputs.iter().map(|y| y.is_finite()).collect();
        let kept = |values: &[f64]| -> Vec<f64> {
            values.iter().zip(&has_value).filter(|(_, has_value)| **has_value).map(|(value, _)| *value).collect()
        };
        let outputs = kept(&outputs);
        if outputs.len() < MIN_ROWS {
            return None;
        }
        let of_factor = |column: &Column| Column { name: column.name.clone(), values: kept(&column.values) };
        let inputs: Vec<Column> = self.factors.iter().map(of_factor).collect();
        let factors = measures_of_rows(&inputs, &outputs, wanted, self.seed, number as u64, self.independent).ok()?;
        Some(RunMeasures { rows: outputs.len(), factors })
    }
}
