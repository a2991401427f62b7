//! The minimum of several inputs.

use super::function::unit_cube;
use super::parameters::Range;
use super::{Exact, KnownAnswer, Made, ParameterInfo};

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "minimum",
    description: "the smallest input: kinks across slanted planes",
    formula: "min_i x_i",
    source: "textbook: order statistics of uniform inputs",
    parameters: &[ParameterInfo { name: "dimension", description: "number of inputs d, at least 2 [2]" }],
    build: |given| {
        let d = given.dimension(2, TWO_OR_MORE)?;
        Ok(Made::new(unit_cube(d), exact(d), value))
    },
};

pub(super) const TWO_OR_MORE: Range = (|d| d >= 2.0, "a whole number from 2");

fn value(x: &[f64]) -> f64 {
    x.iter().copied().fold(f64::INFINITY, f64::min)
}

/// min x_i, x uniform on (0, 1)^d.
///
/// Mean 1/(d + 1), variance d / ((d + 1)^2 (d + 2)), S_i = (d + 2) / (d (2d + 1)), ST_i = 2 (d + 1) / (d (d + 3)),
/// S_ij = (d + 2) / (d^2 (2d + 1)). From E(min | x_i, x_j) = (1 - (1 - m)^(d-1)) / (d - 1) with m the smaller of the two,
/// and Var(min | the others) = m^3/3 - m^4/4 with m their smallest. For d = 2: S_i = 0.4, ST_i = 0.6, S_12 = 0.2.
fn exact(inputs: usize) -> Exact {
    let d = inputs as f64;
    let first = (d + 2.0) / (d * (2.0 * d + 1.0));
    let total = 2.0 * (d + 1.0) / (d * (d + 3.0));
    let variance = d / ((d + 1.0) * (d + 1.0) * (d + 2.0));
    Exact::closed(1.0 / (d + 1.0), variance, vec![first; inputs], vec![total; inputs])
}
