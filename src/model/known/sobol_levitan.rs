//! The exponential of Sobol' and Levitan.

use super::exact::{mean_of_exponential, relative_variance_of_exponential};
use super::function::unit_cube;
use super::parameters::{DIMENSION, FINITE, Range};
use super::{Exact, KnownAnswer, Made, ParameterError, ParameterInfo};

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "sobol-levitan",
    description: "exponential of a sum, with a chosen mean: a test of centring",
    formula: "exp(sum_i b_i x_i) - prod_i (e^b_i - 1)/b_i + c0",
    source: "Sobol' and Levitan 1999, Comput. Phys. Commun. 117, 52-61",
    parameters: &[
        ParameterInfo { name: "b", description: "one number or one per input, -350 to 350 in all [1.5, 0.9, 0.9 ...]" },
        ParameterInfo { name: "c0", description: "the mean [0]" },
        DIMENSION,
    ],
    build: |given| {
        let [b] = given.per_input([("b", &[1.5, 0.9, 0.9, 0.9, 0.9, 0.9, 0.9][..], EXPONENT)])?;
        let largest: f64 = b.iter().map(|b| b.abs()).sum();
        if !EXPONENT.0(largest) {
            return Err(ParameterError::out_of_range("b", largest, EXPONENT.1));
        }
        let mean = b.iter().map(|&b| mean_of_exponential(b)).product();
        let c0 = given.number("c0", 0.0, FINITE)?;
        Ok(Made::new(unit_cube(b.len()), exact(&b, c0, mean), move |x| value(&b, c0, mean, x)))
    },
};

/// The exponential and its square must fit into `f64`.
const EXPONENT: Range = (|b| b.abs() <= 350.0, "between -350 and 350, the sum of all too");

fn value(b: &[f64], c0: f64, mean: f64, x: &[f64]) -> f64 {
    let exponent: f64 = x.iter().zip(b).map(|(x, b)| b * x).sum();
    libm::exp(exponent) - mean + c0
}

/// exp(sum b_i x_i) - I + c0, x uniform on (0, 1)^d, I = prod (e^b_i - 1)/b_i.
///
/// Mean c0, variance I^2 D; a product with r_i = (b_i/2) coth(b_i/2) - 1, which is
/// ((e^2b - 1)/(2b)) / ((e^b - 1)/b)^2 - 1: S_i = r_i / D, S_ij = r_i r_j / D, D = prod (1 + r_i) - 1. For b = (1.5,
/// 0.9 x 6): variance 1317.46, S_1 = 0.2448, the others 0.0902; ST_1 = 0.3605, the others 0.1470.
fn exact(b: &[f64], c0: f64, mean: f64) -> Exact {
    let r: Vec<f64> = b.iter().map(|&b| relative_variance_of_exponential(b)).collect();
    Exact { mean: c0, ..Exact::of_product(mean, &r) }
}
