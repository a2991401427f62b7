//! Oakley and O'Hagan's function of fifteen inputs.

use std::sync::LazyLock;

use serde::Deserialize;

use super::function::alike;
use super::{Exact, KnownAnswer, Made};
use crate::space::Distribution;

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "oakley-ohagan",
    description: "fifteen normal inputs: five of small, five of medium, five of large effect; many weak interactions",
    formula: "a1'x + a2' sin x + a3' cos x + x'M x, with the published vectors a1, a2, a3 and matrix M",
    source: "Oakley and O'Hagan 2004, J. R. Statist. Soc. B 66, 751-769",
    parameters: &[],
    build: |_| {
        let normal = Distribution::normal(0.0, 1.0).expect("the standard normal distribution");
        Ok(Made::new(alike(INPUTS, "standard normal", &normal), exact(), value))
    },
};

const INPUTS: usize = 15;

#[derive(Deserialize)]
struct Constants {
    a1: [f64; INPUTS],
    a2: [f64; INPUTS],
    a3: [f64; INPUTS],
    /// Row by row.
    #[serde(rename = "M")]
    m: Vec<f64>,
}

static CONSTANTS: LazyLock<Constants> = LazyLock::new(|| {
    let text = include_str!("../../../assets/oakley-ohagan.json");
    serde_json::from_str(text).expect("the embedded constants are complete")
});

fn value(x: &[f64]) -> f64 {
    let c = &*CONSTANTS;
    let mut sum = 0.0;
    for (i, row) in c.m.chunks_exact(INPUTS).enumerate() {
        let (sin, cos) = libm::sincos(x[i]);
        let quadratic: f64 = row.iter().zip(x).map(|(m, x)| m * x).sum();
        sum += c.a1[i] * x[i] + c.a2[i] * sin + c.a3[i] * cos + x[i] * quadratic;
    }
    sum
}

/// a1'x + a2' sin x + a3' cos x + x'M x, x independent standard normal.
///
/// With e = exp(-1/2) and M_ii the diagonal: mean e sum a3_i + tr M, V_ij = (M_ij + M_ji)^2, and
/// V_i = a1^2 + a2^2 (1 - e^4)/2 + a3^2 ((1 + e^4)/2 - e^2) + 2 M_ii^2 + 2 a1 a2 e - 2 a3 M_ii e, from the moments
/// E[x sin x] = e, Var sin x = (1 - e^4)/2, Var cos x = (1 + e^4)/2 - e^2, Cov(cos x, x^2) = -e. Mean 8.9852, variance 60.155.
fn exact() -> Exact {
    let c = &*CONSTANTS;
    let e = libm::exp(-0.5f64);
    let rows: Vec<&[f64]> = c.m.chunks_exact(INPUTS).collect();
    let mut parts = Vec::new();
    let mut mean = 0.0;
    for (i, row) in rows.iter().enumerate() {
        let (a1, a2, a3, mii) = (c.a1[i], c.a2[i], c.a3[i], row[i]);
        mean += e * a3 + mii;
        let squares = a1 * a1 + a2 * a2 * (1.0 - e.powi(4)) / 2.0 + a3 * a3 * ((1.0 + e.powi(4)) / 2.0 - e * e);
        parts.push((vec![i], squares + 2.0 * mii * mii + 2.0 * e * (a1 * a2 - a3 * mii)));
        parts.extend((i + 1..INPUTS).map(|j| (vec![i, j], (row[j] + rows[j][i]).powi(2))));
    }
    Exact::of_parts(mean, INPUTS, &parts)
}
