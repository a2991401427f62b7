//! The modified Sobol' G.

use super::function::unit_cube;
use super::parameters::{DIMENSION, NOT_NEGATIVE, PORTION, POSITIVE};
use super::{Exact, KnownAnswer, Made, ParameterInfo};

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "g-star",
    description: "Sobol' G shifted by delta and bent by alpha",
    formula: "prod_i ((1 + alpha_i) |2 frac(x_i + delta_i) - 1|^alpha_i + a_i) / (1 + a_i)",
    source: "Saltelli et al. 2010, Comput. Phys. Commun. 181, 259-270",
    parameters: &[
        ParameterInfo { name: "a", description: "one number or one per input, 0 or greater [0, 0, 9, 9 ...]" },
        ParameterInfo {
            name: "delta",
            description: "shifts, one number or one per input, between 0 and 1 [ten, then 0]",
        },
        ParameterInfo { name: "alpha", description: "powers, one number or one per input, greater than 0 [1]" },
        DIMENSION,
    ],
    build: |given| {
        let a = [0.0, 0.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0];
        let all = [("a", &a[..], NOT_NEGATIVE), ("delta", &DELTA, PORTION), ("alpha", &[1.0], POSITIVE)];
        let [a, delta, alpha] = given.per_input(all)?;
        Ok(Made::new(unit_cube(a.len()), exact(&a, &alpha), move |x| value(&a, &delta, &alpha, x)))
    },
};

/// The default shifts: drawn once, since the paper draws its own at random and they do not change the indices.
const DELTA: [f64; 11] = [0.637, 0.27, 0.041, 0.017, 0.813, 0.913, 0.607, 0.729, 0.544, 0.935, 0.0];

fn value(a: &[f64], delta: &[f64], alpha: &[f64], x: &[f64]) -> f64 {
    let mut product = 1.0;
    for (((&x, &delta), &alpha), &a) in x.iter().zip(delta).zip(alpha).zip(a) {
        let shifted = x + delta;
        let tent = (2.0 * (shifted - shifted.floor()) - 1.0).abs();
        let bent = if alpha == 1.0 { tent } else { libm::pow(tent, alpha) };
        product *= ((1.0 + alpha) * bent + a) / (1.0 + a);
    }
    product
}

/// prod ((1 + alpha_i) |2 frac(x_i + delta_i) - 1|^alpha_i + a_i) / (1 + a_i), x uniform on (0, 1)^d.
///
/// Mean 1, r_i = alpha_i^2 / ((1 + 2 alpha_i) (1 + a_i)^2), then as for Sobol' G; delta changes none of it. For the
/// defaults (a = 0, 0, 9 x 8; alpha = 1): variance 0.8257, S_1 = S_2 = 0.4037, ST_1 = ST_2 = 0.5528.
fn exact(a: &[f64], alpha: &[f64]) -> Exact {
    let r = a.iter().zip(alpha).map(|(a, alpha)| (alpha / (1.0 + a)).powi(2) / (1.0 + 2.0 * alpha));
    Exact::of_product(1.0, &r.collect::<Vec<_>>())
}
