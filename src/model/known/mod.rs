//! Functions with exact indices, to try the engine on and to test it with.

use std::f64::consts::PI;

use super::{Batch, Model, Output, Worker};
use crate::quantity::Unit;

/// A function whose mean, variance and indices are known in closed form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KnownAnswer {
    /// sin x1 + a sin^2 x2 + b x3^4 sin x1 on (-pi, pi)^3, a = 7, b = 0.1 (Ishigami and Homma 1990).
    Ishigami,
    /// prod (|4 x_i - 2| + a_i)/(1 + a_i) on (0, 1)^8, a = (0, 1, 4.5, 9, 99, 99, 99, 99) (Saltelli and Sobol' 1995).
    SobolG,
}

/// An input of a known-answer function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownInput {
    /// Its name in study files.
    pub name: &'static str,
    /// Lower end of its uniform range.
    pub min: f64,
    /// Upper end of its uniform range.
    pub max: f64,
}

const SOBOL_G_A: [f64; 8] = [0.0, 1.0, 4.5, 9.0, 99.0, 99.0, 99.0, 99.0];
const X: [&str; 8] = ["x1", "x2", "x3", "x4", "x5", "x6", "x7", "x8"];

impl KnownAnswer {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Ishigami, Self::SobolG];

    /// The name in study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ishigami => "ishigami",
            Self::SobolG => "sobol-g",
        }
    }

    /// One line for people.
    pub fn description(self) -> &'static str {
        match self {
            Self::Ishigami => "Ishigami function, sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1: exact indices known",
            Self::SobolG => {
                "Sobol' G function, prod (|4 x - 2| + a)/(1 + a), a = 0, 1, 4.5, 9, 99 x 4: exact indices known"
            }
        }
    }

    /// The inputs, with the ranges for which the exact indices hold.
    pub fn inputs(self) -> Vec<KnownInput> {
        let (count, min, max) = match self {
            Self::Ishigami => (3, -PI, PI),
            Self::SobolG => (8, 0.0, 1.0),
        };
        X[..count].iter().map(|name| KnownInput { name, min, max }).collect()
    }

    /// The function. `x` has one entry per input.
    pub fn value(self, x: &[f64]) -> f64 {
        match self {
            Self::Ishigami => x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin(),
            Self::SobolG => x.iter().zip(SOBOL_G_A).map(|(x, a)| ((4.0 * x - 2.0).abs() + a) / (1.0 + a)).product(),
        }
    }

    /// Exact first-order and total indices for independent inputs on their own ranges.
    ///
    /// Ishigami: V1 = (1 + b pi^4/5)^2/2, V2 = a^2/8, V13 = b^2 pi^8 (1/18 - 1/50). Sobol' G: V_i = 1/(3 (1 + a_i)^2),
    /// S_i = V_i/D, ST_i = V_i prod_{j != i}(1 + V_j)/D, D = prod(1 + V_j) - 1.
    pub fn exact_indices(self) -> (Vec<f64>, Vec<f64>) {
        match self {
            Self::Ishigami => {
                let (v1, v2) = ((1.0 + 0.1 * PI.powi(4) / 5.0).powi(2) / 2.0, 49.0 / 8.0);
                let v13 = 0.01 * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
                let v = v1 + v2 + v13;
                (vec![v1 / v, v2 / v, 0.0], vec![(v1 + v13) / v, v2 / v, v13 / v])
            }
            Self::SobolG => {
                let v = SOBOL_G_A.map(|a| 1.0 / (3.0 * (1.0 + a) * (1.0 + a)));
                let all: f64 = v.iter().map(|v| 1.0 + v).product();
                let first = v.iter().map(|v| v / (all - 1.0)).collect();
                let total = v.iter().map(|v| v * all / (1.0 + v) / (all - 1.0)).collect();
                (first, total)
            }
        }
    }
}

/// A [`KnownAnswer`] as a model. Inputs without a factor stand at fixed values.
#[derive(Debug, Clone)]
pub struct KnownModel {
    function: KnownAnswer,
    /// The values of all inputs, where the factors have not overwritten them.
    base: Vec<f64>,
    /// For each factor of the space: the input it drives.
    factors: Vec<usize>,
    outputs: [Output; 1],
}

impl KnownModel {
    /// `base` holds a value for every input, `factors` the number of the input that each factor of the space drives.
    pub fn new(function: KnownAnswer, base: Vec<f64>, factors: Vec<usize>) -> Self {
        debug_assert_eq!(base.len(), function.inputs().len());
        debug_assert!(factors.iter().all(|&input| input < base.len()));
        let unit = Unit::dimensionless();
        Self { function, base, factors, outputs: [Output { name: "y", unit, description: "value of the function" }] }
    }
}

impl Model for KnownModel {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn worker(&self) -> Box<dyn Worker + '_> {
        Box::new(KnownWorker { model: self, x: self.base.clone() })
    }
}

struct KnownWorker<'a> {
    model: &'a KnownModel,
    x: Vec<f64>,
}

impl Worker for KnownWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        for (row, y) in batch.column_mut(0).iter_mut().enumerate() {
            for (&input, column) in self.model.factors.iter().zip(inputs) {
                self.x[input] = column[row];
            }
            *y = self.model.function.value(&self.x);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_indices_are_the_published_ones() {
        let (first, total) = KnownAnswer::Ishigami.exact_indices();
        for (got, expected) in first.iter().zip([0.31390519114781146, 0.4424111447900409, 0.0]) {
            assert!((got - expected).abs() < 1e-15);
        }
        for (got, expected) in total.iter().zip([0.5575888552099592, 0.4424111447900409, 0.2436836640621477]) {
            assert!((got - expected).abs() < 1e-15);
        }
        let (first, total) = KnownAnswer::SobolG.exact_indices();
        assert!((first[0] - 0.7161921688790331).abs() < 1e-15);
        assert!((total[0] - 0.7871441266592749).abs() < 1e-15);
    }

    #[test]
    fn values_by_hand() {
        assert!((KnownAnswer::Ishigami.value(&[PI / 2.0, PI / 2.0, 1.0]) - 8.1).abs() < 1e-14);
        assert_eq!(KnownAnswer::SobolG.value(&[0.5; 8]), 0.0);
        assert_eq!(KnownAnswer::SobolG.value(&[0.75; 8]), 1.0);
    }
}
