//! Many outputs at the same rows as sums of few: a curve or a map has few directions in which it differs.

use rayon::prelude::*;

use super::choice::mixed;
use apportion_base::sum::{add_scaled, mean, product};

/// Maximum number of directions.
const MAX_DIRECTIONS: usize = 10;

/// Share of the variance of an output that may be left out of them.
const NOTHING: f64 = 1e-10;

/// Outputs by the directions in which they differ.
pub struct Directions {
    /// The directions at the rows, of mean 0 and mean square 1, orthogonal to each other.
    pub values: Vec<Vec<f64>>,
    pub outputs: Vec<Output>,
}

/// One output.
pub struct Output {
    pub mean: f64,
    /// The part along each direction.
    pub weights: Vec<f64>,
    /// What they leave at the rows.
    left: Vec<f64>,
}

impl Output {
    fn square(&self) -> f64 {
        product(&self.left, &self.left)
    }
}

impl Directions {
    /// Chooses one direction after another, by a step of the power method from a sum of what is left of all outputs with
    /// pseudo-random signs (Halko, Martinsson and Tropp 2011): all of them have a part in it.
    pub fn new(outputs: Vec<Vec<f64>>) -> Self {
        let rows = outputs.first().map_or(0, Vec::len);
        let outputs = outputs.into_iter().map(|mut left| {
            let mean = mean(&left);
            left.iter_mut().for_each(|y| *y -= mean);
            Output { mean, weights: Vec::new(), left }
        });
        let mut outputs: Vec<Output> = outputs.collect();
        let least: Vec<f64> = outputs.iter().map(|output| NOTHING * output.square()).collect();
        let mut values: Vec<Vec<f64>> = Vec::new();
        while values.len() < MAX_DIRECTIONS && outputs.iter().zip(&least).any(|(of, least)| of.square() > *least) {
            let first = values.len() * outputs.len();
            let signs =
                (first..first + outputs.len()).map(|k| if mixed(k as u64).is_multiple_of(2) { 1.0 } else { -1.0 });
            let start = sum(&outputs, signs);
            let weights: Vec<f64> = outputs.par_iter().map(|output| product(&output.left, &start)).collect();
            let mut direction = sum(&outputs, weights.into_iter());
            let size = (product(&direction, &direction) / rows as f64).sqrt();
            if size == 0.0 {
                break;
            }
            direction.iter_mut().for_each(|y| *y /= size);
            outputs.par_iter_mut().for_each(|output| {
                let weight = product(&output.left, &direction) / rows as f64;
                add_scaled(&mut output.left, -weight, &direction);
                output.weights.push(weight);
            });
            values.push(direction);
        }
        Self { values, outputs }
    }
}

/// Returns the weighted sum of what is left of the outputs.
fn sum(outputs: &[Output], weights: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sum = vec![0.0; outputs.first().map_or(0, |output| output.left.len())];
    outputs.iter().zip(weights).for_each(|(output, weight)| add_scaled(&mut sum, weight, &output.left));
    sum
}

#[cfg(test)]
#[path = "tests/directions.rs"]
mod tests;
