//! The indicator of a simplex.

use super::function::unit_cube;
use super::parameters::Range;
use super::{Exact, KnownAnswer, Made, ParameterInfo};

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "simplex",
    description: "1 below a slanted plane, 0 above: discontinuous along no axis",
    formula: "1 if sum_i x_i <= 1, else 0",
    source: "this program; the integrals are Dirichlet's",
    parameters: &[ParameterInfo { name: "dimension", description: "number of inputs d, 2 to 12 [3]" }],
    build: |given| {
        let d = given.dimension(3, DIMENSIONS)?;
        Ok(Made::new(unit_cube(d), exact(d), value))
    },
};

/// Above 12 the simplex is too small for any sample to hit it.
const DIMENSIONS: Range = (|d| (2.0..=12.0).contains(&d), "a whole number from 2 to 12");

fn value(x: &[f64]) -> f64 {
    f64::from(u8::from(x.iter().sum::<f64>() <= 1.0))
}

/// 1 where sum x_i <= 1, else 0; x uniform on (0, 1)^d.
///
/// Mean 1/d!, variance (d! - 1)/d!^2, and with n = d! - 1
///
/// S_i = (d - 1)^2 / ((2d - 1) n), ST_i = (d - 1) d! / ((d + 1) n),
/// S_ij = (d^2 (d - 1) / (2 (2d - 3)) - 1) / n - S_i - S_j,
///
/// from E(f | x_i) = (1 - x_i)^(d-1) / (d - 1)! and its like for pairs. For d = 3: S_i = 0.16, ST_i = 0.6, S_ij = 0.08.
fn exact(inputs: usize) -> Exact {
    let d = inputs as f64;
    let factorial: f64 = (1..=inputs).map(|k| k as f64).product();
    let n = factorial - 1.0;
    let first = (d - 1.0).powi(2) / ((2.0 * d - 1.0) * n);
    let total = (d - 1.0) * factorial / ((d + 1.0) * n);
    Exact::closed(1.0 / factorial, n / (factorial * factorial), vec![first; inputs], vec![total; inputs])
}
