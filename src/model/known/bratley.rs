//! The alternating sum of products of Bratley, Fox and Niederreiter.

use super::function::unit_cube;
use super::parameters::FINITE;
use super::{Exact, KnownAnswer, Made, ParameterInfo};

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "bratley",
    description: "alternating sum of products; inputs matter in falling order",
    formula: "sum_i (-1)^i prod_{j <= i} x_j",
    source: "Bratley, Fox and Niederreiter 1992, ACM TOMACS 2, 195-213; function K of Kucherenko et al., 1A of later ones",
    parameters: &[ParameterInfo { name: "dimension", description: "number of inputs d [8]" }],
    build: |given| {
        let d = given.dimension(8, FINITE)?;
        Ok(Made::new(unit_cube(d), exact(d), value))
    },
};

fn value(x: &[f64]) -> f64 {
    let (mut product, mut sum) = (1.0, 0.0);
    for x in x {
        product *= -x;
        sum += product;
    }
    sum
}

/// sum_{i=1}^d (-1)^i prod_{j=1}^i x_j, x uniform on (0, 1)^d.
///
/// Mean -(1 - (-1/2)^d) / 3. With w_m = 1 - (2/3) (1 - (-1/2)^(d-m)), the sum over all pairs of terms of which the shorter
/// has m factors, V = sum_m w_m (3^-m - 4^-m), and
///
/// V_i = sum_{m >= i} w_m 4^-m / 3, V_ij = sum_{m >= max(i, j)} w_m 4^-m / 9, VT_i = sum_{m >= i} w_m 3^-m / 4:
///
/// each a sum of positive terms, from E x^2 = 1/3 and (E x)^2 = 1/4. For d = 8: variance 0.05540, S = (0.6634, 0.1698,
/// 0.0405, 0.0111, 0.0023, 0.0008, 0.0001, 0.0001), ST_1 = 0.7475.
fn exact(d: usize) -> Exact {
    // For m from d down to 1, so that the last sums are those over all m.
    let (mut thirds, mut fourths, mut variance) = (0.0, 0.0, 0.0);
    let (mut first, mut total) = (vec![0.0; d], vec![0.0; d]);
    for m in (1..=d).rev() {
        let power = m as i32;
        let w = 1.0 - 2.0 / 3.0 * (1.0 - (-0.5f64).powi((d - m) as i32));
        let (third, fourth) = ((1.0 / 3.0f64).powi(power), 0.25f64.powi(power));
        variance += w * (third - fourth);
        (thirds, fourths) = (thirds + w * third, fourths + w * fourth);
        (first[m - 1], total[m - 1]) = (fourths, thirds);
    }
    let first = first.iter().map(|tail| tail / 3.0 / variance).collect();
    let total = total.iter().map(|tail| tail / 4.0 / variance).collect();
    let mean = ((-0.5f64).powi(d as i32) - 1.0) / 3.0;
    Exact::closed(mean, variance, first, total)
}
