//! A piston on a spring of gas.

use std::f64::consts::PI;

use super::function::{positive, uniform};
use super::{Exact, KnownAnswer, KnownInput, Made};

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "piston",
    description: "time of one cycle of a piston in a cylinder (s)",
    formula: "2 pi sqrt(M / (k + S^2 P0 V0 Ta / (T0 V^2))), V = S/(2k) (sqrt(A^2 + 4 k P0 V0 Ta/T0) - A), \
              A = P0 S + 19.62 M - k V0/S",
    source: "Kenett and Zacks 1998, Modern Industrial Statistics; Ben-Ari and Steinberg 2007, Qual. Eng. 19, 327-338",
    parameters: &[],
    build: |_| Ok(Made::new(inputs(), exact(), value)),
};

fn inputs() -> Vec<KnownInput> {
    vec![
        positive("M", "weight of the piston, kg", uniform(30.0, 60.0)),
        positive("S", "surface of the piston, m2", uniform(0.005, 0.02)),
        positive("V0", "initial volume of the gas, m3", uniform(0.002, 0.01)),
        positive("k", "spring coefficient, N/m", uniform(1000.0, 5000.0)),
        positive("P0", "atmospheric pressure, N/m2", uniform(90_000.0, 110_000.0)),
        positive("Ta", "ambient temperature, K", uniform(290.0, 296.0)),
        positive("T0", "temperature of the filling gas, K", uniform(340.0, 360.0)),
    ]
}

fn value(x: &[f64]) -> f64 {
    let &[m, s, v0, k, p0, ta, t0] = x else { return f64::NAN };
    let a = p0 * s + 19.62 * m - k * v0 / s;
    let gas = p0 * v0 * ta / t0;
    let v = s / (2.0 * k) * ((a * a + 4.0 * k * gas).sqrt() - a);
    2.0 * PI * (m / (k + s * s * gas / (v * v))).sqrt()
}

/// The time of one cycle in seconds. By tensor quadrature: mean 0.462496, variance 0.0194604.
fn exact() -> Exact {
    // S_i and ST_i.
    let indices = [
        [0.03910624291670726, 0.050879587822658494],
        [0.5571272143826871, 0.5993637601639669],
        [0.32106263659158546, 0.35278640686885715],
        [0.02060837508803521, 0.06694418455867866],
        [0.0012369777286273113, 0.001347299862050499],
        [3.361463337009253e-06, 9.017608134882111e-06],
        [2.6182453687571064e-05, 7.023943426173617e-05],
    ];
    Exact::by_quadrature(0.4624962362054973, 0.019460402502078138, &indices, 1e-8)
}
