//! A weighted sum.

use super::function::unit_cube;
use super::parameters::{DIMENSION, FINITE};
use super::{Exact, KnownAnswer, Made, ParameterInfo};

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "linear",
    description: "weighted sum: no interactions",
    formula: "sum_i c_i x_i",
    source: "textbook: S_i = c_i^2 Var x_i / sum_j c_j^2 Var x_j",
    parameters: &[
        ParameterInfo { name: "c", description: "weights, one number or one per input [4, 2, 1, 0.5, 0 ...]" },
        DIMENSION,
    ],
    build: |given| {
        let [c] = given.per_input([("c", &[4.0, 2.0, 1.0, 0.5, 0.0][..], FINITE)])?;
        Ok(Made::new(unit_cube(c.len()), exact(&c), move |x| value(&c, x)))
    },
};

fn value(c: &[f64], x: &[f64]) -> f64 {
    x.iter().zip(c).map(|(x, c)| c * x).sum()
}

/// sum c_i x_i, x uniform on (0, 1)^d.
///
/// Mean sum c_i / 2, V_i = c_i^2 / 12, S_i = ST_i = V_i / sum V_j, S_ij = 0. For c = (4, 2, 1, 0.5, 0): variance 1.7708,
/// S = (0.7529, 0.1882, 0.0471, 0.0118, 0).
fn exact(c: &[f64]) -> Exact {
    let parts = c.iter().map(|c| c * c / 12.0);
    let variance: f64 = parts.clone().sum();
    let indices: Vec<f64> = parts.map(|part| part / variance).collect();
    Exact::closed(c.iter().sum::<f64>() / 2.0, variance, indices.clone(), indices)
}
