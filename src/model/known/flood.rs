//! A river that overflows its dyke.

use super::function::{constant, positive, triangular, uniform};
use super::{Exact, KnownAnswer, KnownInput, Made};
use crate::space::Distribution;

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "flood",
    description: "highest yearly level of a river over its dyke (m), eight inputs of several distributions",
    formula: "Zv + (Q / (B Ks sqrt((Zm - Zv)/L)))^0.6 - Hd - Cb",
    source: "Iooss and Lemaitre 2015, in: Uncertainty Management in Simulation-Optimization of Complex Systems, 101-122",
    parameters: &[],
    build: |_| Ok(Made { inputs: inputs(), exact: exact(), value: Box::new(value) }),
};

fn inputs() -> Vec<KnownInput> {
    let flow = constant(Distribution::truncated_gumbel(1013.0, 558.0, 500.0, 3000.0));
    let strength = constant(Distribution::truncated_normal(30.0, 8.0, 15.0, 110.0));
    vec![
        positive("Q", "highest flow rate of the year, m3/s", flow),
        positive("Ks", "Strickler's coefficient of the bed, m^(1/3)/s", strength),
        positive("Zv", "level of the bed downstream, m", triangular(49.0, 50.0, 51.0)),
        positive("Zm", "level of the bed upstream, m", triangular(54.0, 55.0, 56.0)),
        positive("Hd", "height of the dyke, m", uniform(7.0, 9.0)),
        positive("Cb", "level of the bank, m", triangular(55.0, 55.5, 56.0)),
        positive("L", "length of the stretch, m", triangular(4990.0, 5000.0, 5010.0)),
        positive("B", "width of the river, m", triangular(295.0, 300.0, 305.0)),
    ]
}

fn value(x: &[f64]) -> Result<f64, &'static str> {
    let &[q, ks, zv, zm, hd, cb, l, b] = x else { return Ok(f64::NAN) };
    if zm <= zv {
        return Err("the bed of the river does not fall: Zm <= Zv");
    }
    Ok(zv + libm::pow(q / (b * ks * ((zm - zv) / l).sqrt()), 0.6) - hd - cb)
}

/// The overflow S = Zv + H - Hd - Cb in metres, H = (Q / (B Ks sqrt((Zm - Zv)/L)))^0.6 the depth of the river.
///
/// The strength Ks is normal above 15 without an upper end; it is truncated at 110, ten standard deviations above its
/// mean, where the remaining probability is 1e-23. The indices are integrals over one or two inputs, since H is a
/// product: mean -10.9445, variance 1.17447.
fn exact() -> Exact {
    // S_i and ST_i.
    let indices = [
        [0.34484776605287953, 0.3535919500090886],
        [0.13377449984526493, 0.14225103588016494],
        [0.1895781735609111, 0.18992645588252133],
        [0.003457986851845906, 0.0038062691735180404],
        [0.2838158814778911, 0.2838158814778911],
        [0.03547698518473634, 0.03547698518473634],
        [3.3362875079346094e-07, 3.63303972174208e-07],
        [9.268857729293293e-05, 0.00010093125647921547],
    ];
    Exact::by_quadrature(-10.944493780444837, 1.174470334773354, &indices, 1e-13)
}
