//! A function of huge dynamic range.

use std::f64::consts::LN_10;

use super::exact::{mean_of_exponential, relative_variance_of_exponential};
use super::function::{sum, unit_cube, written, xs};
use super::parameters::{DIMENSION, Given, Range};
use super::{Entry, Exact, Function, KnownInput, ParameterError, ParameterInfo, ParameterValue};

pub(super) const ENTRY: Entry = Entry {
    name: "decades",
    summary: "huge dynamic range: ten decades as it stands, placed anywhere between 1e-150 and 1e150",
    formula: "10^(offset + sum_i k_i x_i)",
    source: "this program, for the extremes; a product of exponentials as Sobol' and Levitan 1999",
    parameters: &[
        ParameterInfo { name: "k", description: "decades, one number or one per input [6, 3, 1, 0 ...]" },
        ParameterInfo { name: "offset", description: "logarithm of the value at x = 0 [0]" },
        DIMENSION,
    ],
    build: |given| Ok(Box::new(Decades::new(given)?)),
};

/// The value and its square have to fit into `f64`.
const DECADES: Range = (|k| k.abs() <= 150.0, "between -150 and 150, the sum of all too");

/// 10^(offset + sum k_i x_i), x uniform on (0, 1)^d.
///
/// With b_i = k_i ln 10: mean 10^offset prod (e^b_i - 1)/b_i, a product with r_i = (b_i/2) coth(b_i/2) - 1: S_i = r_i / D,
/// S_ij = r_i r_j / D, ST_i = r_i prod_{j != i} (1 + r_j) / D, D = prod (1 + r_i) - 1. For k = (6, 3, 1, 0):
/// S = (0.1744, 0.0724, 0.0120, 0), ST = (0.8778, 0.7275, 0.3000, 0): most of it is interaction.
struct Decades {
    k: Vec<f64>,
    offset: f64,
}

impl Decades {
    fn new(given: &Given<'_>) -> Result<Self, ParameterError> {
        let [k] = given.per_input([("k", &[6.0, 3.0, 1.0, 0.0][..], DECADES)])?;
        let offset = given.number("offset", 0.0, DECADES)?;
        let largest = offset.abs() + k.iter().map(|k| k.abs()).sum::<f64>();
        if !DECADES.0(largest) {
            return Err(ParameterError::OutOfRange { parameter: "k", value: largest, must: DECADES.1 });
        }
        Ok(Self { k, offset })
    }
}

impl Function for Decades {
    fn inputs(&self) -> Vec<KnownInput> {
        unit_cube(self.k.len())
    }

    fn parameters(&self) -> Vec<(&'static str, ParameterValue)> {
        vec![("k", ParameterValue::List(self.k.clone())), ("offset", ParameterValue::Number(self.offset))]
    }

    fn value(&self, x: &[f64]) -> f64 {
        let decades: f64 = x.iter().zip(&self.k).map(|(x, k)| k * x).sum();
        libm::pow(10f64, self.offset + decades)
    }

    fn expression(&self) -> String {
        let decades = xs(self.k.len()).zip(&self.k).map(|(x, &k)| format!("{}*{x}", written(k)));
        format!("10^({} + {})", written(self.offset), sum(decades))
    }

    fn exact(&self) -> Exact {
        let b: Vec<f64> = self.k.iter().map(|k| k * LN_10).collect();
        let mean = libm::pow(10f64, self.offset) * b.iter().map(|&b| mean_of_exponential(b)).product::<f64>();
        Exact::of_product(mean, &b.into_iter().map(relative_variance_of_exponential).collect::<Vec<_>>())
    }
}
