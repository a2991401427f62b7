//! The weight of a light aircraft's wing.

use super::function::{positive, uniform};
use super::{Exact, KnownAnswer, KnownInput, Made};

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "wing-weight",
    description: "weight of a light aircraft's wing (lb), ten inputs",
    formula: "0.036 Sw^0.758 Wfw^0.0035 (A/cos^2 Lambda)^0.6 q^0.006 lambda^0.04 (100 tc/cos Lambda)^-0.3 (Nz Wdg)^0.49 \
              + Sw Wp",
    source: "Forrester, Sobester and Keane 2008, Engineering Design via Surrogate Modelling, section 1.4",
    parameters: &[],
    build: |_| Ok(Made { inputs: inputs(), exact: exact(), value: Box::new(value) }),
};

/// Index of the sweep, the only input that may be negative.
const SWEEP: usize = 3;

fn inputs() -> Vec<KnownInput> {
    let mut inputs = vec![
        positive("Sw", "wing area, ft2", uniform(150.0, 200.0)),
        positive("Wfw", "weight of the fuel in the wing, lb", uniform(220.0, 300.0)),
        positive("A", "aspect ratio", uniform(6.0, 10.0)),
        positive("Lambda", "quarter-chord sweep, degrees, between -90 and 90", uniform(-10.0, 10.0)),
        positive("q", "dynamic pressure at cruise, lb/ft2", uniform(16.0, 45.0)),
        positive("lambda", "taper ratio", uniform(0.5, 1.0)),
        positive("tc", "aerofoil thickness to chord ratio", uniform(0.08, 0.18)),
        positive("Nz", "ultimate load factor", uniform(2.5, 6.0)),
        positive("Wdg", "flight design gross weight, lb", uniform(1700.0, 2500.0)),
        positive("Wp", "weight of the paint, lb/ft2", uniform(0.025, 0.08)),
    ];
    inputs[SWEEP].domain = None;
    inputs
}

fn value(x: &[f64]) -> Result<f64, &'static str> {
    let &[sw, wfw, a, sweep, q, taper, tc, nz, wdg, wp] = x else { return Ok(f64::NAN) };
    let cos = libm::cos(sweep.to_radians());
    if sweep.abs() >= 90.0 {
        return Err("the sweep reaches 90 degrees");
    }
    let of_powers = 0.036
        * libm::pow(sw, 0.758)
        * libm::pow(wfw, 0.0035)
        * libm::pow(a / (cos * cos), 0.6)
        * libm::pow(q, 0.006)
        * libm::pow(taper, 0.04)
        * libm::pow(100.0 * tc / cos, -0.3)
        * libm::pow(nz * wdg, 0.49);
    Ok(of_powers + sw * wp)
}

/// The weight in pounds: a product of powers, plus Sw Wp.
///
/// The indices are integrals over one input: mean 268.075, variance 2311.93.
fn exact() -> Exact {
    // S_i and ST_i.
    let indices = [
        [0.1244730936028649, 0.12790016726970724],
        [2.8330920026709865e-06, 2.929427079361034e-06],
        [0.22024024782639653, 0.22601217532697682],
        [0.000489747699196892, 0.0005063923354277488],
        [8.817420700729611e-05, 9.117217128214217e-05],
        [0.0018098843489987005, 0.0018713101271058893],
        [0.14098263946331466, 0.14507105784026667],
        [0.4116096726928501, 0.41964760261898465],
        [0.08496757890688347, 0.08760003467329314],
        [0.0033392293571148494, 0.003361945203081618],
    ];
    Exact::by_quadrature(268.07523683174287, 2311.9262733134397, &indices, 1e-13)
}
