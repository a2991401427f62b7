//! Sobol' G.

use super::function::unit_cube;
use super::parameters::{DIMENSION, NOT_NEGATIVE};
use super::{Exact, KnownAnswer, Made, ParameterInfo};

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "sobol-g",
    description: "kinked product; input i matters the less the larger a_i is",
    formula: "prod_i (|4 x_i - 2| + a_i) / (1 + a_i)",
    source: "Saltelli and Sobol' 1995, Reliab. Eng. Syst. Saf. 50, 225-239",
    parameters: &[
        ParameterInfo {
            name: "a",
            description: "one number or one per input, 0 or greater [0, 1, 4.5, 9, 99, 99 ...]",
        },
        DIMENSION,
    ],
    build: |given| {
        let default = [0.0, 1.0, 4.5, 9.0, 99.0, 99.0, 99.0, 99.0];
        let [a] = given.per_input([("a", &default, NOT_NEGATIVE)])?;
        Ok(Made::new(unit_cube(a.len()), exact(&a), move |x| value(&a, x)))
    },
};

fn value(a: &[f64], x: &[f64]) -> f64 {
    x.iter().zip(a).map(|(x, a)| ((4.0 * x - 2.0).abs() + a) / (1.0 + a)).product()
}

/// prod (|4 x_i - 2| + a_i) / (1 + a_i), x uniform on (0, 1)^d.
///
/// Mean 1, r_i = 1 / (3 (1 + a_i)^2), D = prod (1 + r_i) - 1, S_i = r_i / D, S_ij = r_i r_j / D,
/// ST_i = r_i prod_{j != i} (1 + r_j) / D. For the default a: variance 0.4654, S_1 = 0.7162, ST_1 = 0.7871.
fn exact(a: &[f64]) -> Exact {
    let r: Vec<f64> = a.iter().map(|a| 1.0 / (3.0 * (1.0 + a) * (1.0 + a))).collect();
    Exact::of_product(1.0, &r)
}
