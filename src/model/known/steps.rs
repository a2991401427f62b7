//! A product of steps.

use super::function::unit_cube;
use super::parameters::{DIMENSION, FINITE, PORTION};
use super::{Exact, KnownAnswer, Made, ParameterInfo};

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "steps",
    description: "product of steps: discontinuous along every axis",
    formula: "prod_i (1 + c_i (H(x_i - t_i) - 1 + t_i)), H(z) = 1 if z > 0, else 0",
    source: "this program; the rules of a product (Sobol' 1993)",
    parameters: &[
        ParameterInfo { name: "c", description: "heights, one number or one per input [2, 1, 1, 0.5 ...]" },
        ParameterInfo {
            name: "t",
            description: "places of the steps, between 0 and 1, likewise [0.4, 0.3, 0.85, 0.1 ...]",
        },
        DIMENSION,
    ],
    build: |given| {
        let (c, t) = ([2.0, 1.0, 1.0, 0.5], [0.4, 0.3, 0.85, 0.1]);
        let [c, t] = given.per_input([("c", &c[..], FINITE), ("t", &t, PORTION)])?;
        Ok(Made::new(unit_cube(c.len()), exact(&c, &t), move |x| value(&c, &t, x)))
    },
};

fn value(c: &[f64], t: &[f64], x: &[f64]) -> f64 {
    x.iter().zip(c).zip(t).map(|((x, c), t)| 1.0 + if x > t { c * t } else { c * (t - 1.0) }).product()
}

/// prod (1 + c_i (H(x_i - t_i) - 1 + t_i)), x uniform on (0, 1)^d.
///
/// Mean 1; a product with r_i = c_i^2 t_i (1 - t_i): S_i = r_i / D, S_ij = r_i r_j / D,
/// ST_i = r_i prod_{j != i} (1 + r_j) / D, D = prod (1 + r_i) - 1. For the defaults: D = 1.7343, S = (0.5535, 0.1211,
/// 0.0735, 0.0130), ST = (0.7723, 0.2736, 0.1783, 0.0347).
fn exact(c: &[f64], t: &[f64]) -> Exact {
    let r: Vec<f64> = c.iter().zip(t).map(|(c, t)| c * c * t * (1.0 - t)).collect();
    Exact::of_product(1.0, &r)
}
