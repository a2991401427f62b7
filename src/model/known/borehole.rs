//! The flow through a borehole.

use super::function::{constant, positive, uniform};
use super::{Exact, KnownAnswer, KnownInput, Made};
use crate::space::Distribution;

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "borehole",
    description: "flow of water through a borehole between two aquifers (m3/yr)",
    formula: "2 pi Tu (Hu - Hl) / (g (1 + 2 L Tu / (g rw^2 Kw) + Tu/Tl)), g = ln(r/rw)",
    source: "Harper and Gupta 1983 (BMI/ONWI-516); Morris, Mitchell and Ylvisaker 1993, Technometrics 35, 243-255; \
             distributions as collected by Surjanovic and Bingham, rw truncated to its range",
    parameters: &[],
    build: |_| Ok(Made { inputs: inputs(), exact: exact(), value: Box::new(value) }),
};

fn inputs() -> Vec<KnownInput> {
    let rw = constant(Distribution::truncated_normal(0.1, 0.016_181_2, 0.05, 0.15));
    let r = constant(Distribution::log_normal_of_logs(7.71, 1.0056));
    vec![
        positive("rw", "radius of the borehole, m", rw),
        positive("r", "radius of influence, m", r),
        positive("Tu", "transmissivity of the upper aquifer, m2/yr", uniform(63_070.0, 115_600.0)),
        positive("Hu", "potentiometric head of the upper aquifer, m", uniform(990.0, 1110.0)),
        positive("Tl", "transmissivity of the lower aquifer, m2/yr", uniform(63.1, 116.0)),
        positive("Hl", "potentiometric head of the lower aquifer, m", uniform(700.0, 820.0)),
        positive("L", "length of the borehole, m", uniform(1120.0, 1680.0)),
        positive("Kw", "hydraulic conductivity of the borehole, m/yr", uniform(9855.0, 12_045.0)),
    ]
}

fn value(x: &[f64]) -> Result<f64, &'static str> {
    let &[rw, r, tu, hu, tl, hl, l, kw] = x else { return Ok(f64::NAN) };
    if r <= rw {
        return Err("the radius of influence does not exceed that of the borehole: r <= rw");
    }
    let g = libm::log(r / rw);
    Ok(2.0 * std::f64::consts::PI * tu * (hu - hl) / (g * (1.0 + 2.0 * l * tu / (g * rw * rw * kw) + tu / tl)))
}

/// The flow 2 pi Tu (Hu - Hl) / (ln(r/rw) (1 + 2 L Tu / (ln(r/rw) rw^2 Kw) + Tu/Tl)) in cubic metres a year.
///
/// By tensor quadrature: mean 73.7005, variance 805.037. The radius rw is a normal truncated to the published range 0.05
/// to 0.15 (3.1 standard deviations), so that it cannot be negative.
fn exact() -> Exact {
    // S_i and ST_i.
    let indices = [
        [0.6594033590162246, 0.6896299348673347],
        [1.8452834410189019e-06, 2.893408985859754e-06],
        [5.589581669682095e-12, 8.471785825029443e-12],
        [0.0962743643893352, 0.10747600052188548],
        [5.6166991939675995e-06, 8.51150833763442e-06],
        [0.09627436438933552, 0.10747600052188583],
        [0.09198335447676283, 0.10410672530697872],
        [0.022260577436458973, 0.025451166766643767],
    ];
    Exact::by_quadrature(73.70054444125132, 805.0372615696715, &indices, 1e-8)
}
