//! Ishigami and Homma's function.

use std::f64::consts::PI;

use super::function::{alike, uniform};
use super::parameters::FINITE;
use super::{Exact, KnownAnswer, Made, ParameterInfo};

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "ishigami",
    description: "smooth, not monotonic; x3 acts through its interaction with x1 alone",
    formula: "sin x1 + a sin^2 x2 + b x3^4 sin x1",
    source: "Ishigami and Homma 1990, Proc. ISUMA '90, 398-403; a = 7, b = 0.05 or 0.1 are usual",
    parameters: &[
        ParameterInfo { name: "a", description: "weight of the second term [7]" },
        ParameterInfo { name: "b", description: "weight of the interaction [0.1]" },
    ],
    build: |given| {
        let (a, b) = (given.number("a", 7.0, FINITE)?, given.number("b", 0.1, FINITE)?);
        Ok(Made::new(alike(3, "uniform on (-pi, pi)", &uniform(-PI, PI)), exact(a, b), move |x| value(a, b, x)))
    },
};

fn value(a: f64, b: f64, x: &[f64]) -> f64 {
    libm::sin(x[0]) + a * libm::sin(x[1]).powi(2) + b * x[2].powi(4) * libm::sin(x[0])
}

/// sin x1 + a sin^2 x2 + b x3^4 sin x1, x uniform on (-pi, pi)^3.
///
/// Mean a/2, V_1 = (1 + b pi^4/5)^2 / 2, V_2 = a^2/8, V_13 = b^2 pi^8 (1/18 - 1/50), all others 0. For a = 7, b = 0.1:
/// variance 13.8446, S = (0.3139, 0.4424, 0), ST = (0.5576, 0.4424, 0.2437), S_13 = 0.2437.
fn exact(a: f64, b: f64) -> Exact {
    let v1 = (1.0 + b * PI.powi(4) / 5.0).powi(2) / 2.0;
    let v13 = b * b * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
    let parts = [(vec![0], v1), (vec![1], a * a / 8.0), (vec![0, 2], v13)];
    Exact::of_parts(a / 2.0, 3, &parts)
}
