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
    let power = |base: f64, m: usize| base.powi(m as i32);
    let w = |m: usize| 1.0 - 2.0 / 3.0 * (1.0 - power(-0.5, d - m));
    // Entry i - 1 is the sum over m >= i.
    let tails = |base: f64| {
        let mut tails = vec![0.0; d];
        let mut sum = 0.0;
        for m in (1..=d).rev() {
            sum += w(m) * power(base, m);
            tails[m - 1] = sum;
        }
        tails
    };
    let (thirds, fourths) = (tails(1.0 / 3.0), tails(0.25));
    let variance: f64 = (1..=d).rev().map(|m| w(m) * (power(1.0 / 3.0, m) - power(0.25, m))).sum();
    let first = fourths.iter().map(|tail| tail / 3.0 / variance).collect();
    let total = thirds.iter().map(|tail| tail / 4.0 / variance).collect();
    let mean = (power(-0.5, d) - 1.0) / 3.0;
    Exact::closed(mean, variance, first, total)
}
