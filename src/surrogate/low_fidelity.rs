//! Indices of an expensive model with the help of a low-fidelity model.
//!
//! The low-fidelity model g approximates f together with a surrogate P of the remainder: h = alpha g + P. Its indices
//! come from many runs of g at points of their own, and those of f follow from the rows at which both were evaluated:
//! any number Q that is a mean over base points has Q(f) = Q(h) + mean\[q(f) - q(h)\], the control variates of Qian,
//! Peherstorfer, O'Malley, Vesselinov and Willcox (2018), "Multifidelity Monte Carlo estimation of variance and
//! sensitivity indices", SIAM/ASA J. Uncertain. Quantif. 6, 683-706, with the model and not its estimates as the
//! variate. With orthonormal terms phi_a of P, coefficients b_a, and r_a = E\[phi_a g\],
//!
//! - V S_s(h) = alpha^2 V S_s(g) + sum over a within s of (b_a^2 + 2 alpha b_a r_a),
//!
//! and similarly for total indices and the variance. alpha and P of a net are fitted to the others, and the runs at
//! points of their own are independent of both: a poor low-fidelity model costs accuracy, but intervals stay valid.

use std::ops::Range;

use rayon::prelude::*;

use super::basis::{Caps, Family, Term, add_to};
use super::fit::Expansion;
use super::net::Net;
use super::{
    Corrected, MAX_FITTED_ROWS, SAFE_HERMITE_DEGREES, cross_fitted, estimates, expansion_without, fewest_points,
    in_chunks, scaled, takes_surrogates,
};
use crate::correction::{
    Contributions, Effects, LowFidelityUse, SurrogateEstimates, interaction, mean_power, values_and_rest,
};
use crate::design::Design;
use crate::effect::Layout;
use crate::estimate::PointOutputs;

/// One output of a low-fidelity model.
#[derive(Clone)]
pub struct LowOutputs<'a> {
    /// The name of the low-fidelity model.
    pub name: &'a str,
    /// Its outputs at the rows of the expensive model, of every replicate.
    pub shared: Vec<&'a PointOutputs>,
    /// Its outputs at points of its own.
    pub own: &'a OwnOutputs,
}

/// One output of a low-fidelity model at the rows of its own design, independent of the expensive model's.
pub struct OwnOutputs {
    design: Design,
    /// Mean and standard deviation by which the outputs are scaled.
    scale: (f64, f64),
    nets: OwnNets,
}

enum OwnNets {
    /// Every net and an expansion fitted to the others.
    Fitted(Vec<(Net, Expansion)>),
    /// Scaled outputs of every net and run, if there are too many or too few for a fit.
    Kept(Vec<Vec<Vec<f64>>>),
}

impl OwnOutputs {
    /// Creates them from every run of `design`; `None` if [`low_fidelity_estimates`] cannot use them.
    pub fn new(design: &Design, families: &[Family], replicates: &[&PointOutputs]) -> Option<Self> {
        if !takes_surrogates(design, replicates.len()) {
            return None;
        }
        let (outputs, scale) = scaled(replicates, design.runs().len(), None)?;
        let caps = Caps::new(families, SAFE_HERMITE_DEGREES);
        let net = |(number, outputs): (usize, &Vec<Vec<f64>>)| {
            Net::new(design, number as u64, points_of(outputs), families, caps.degree, outputs)
        };
        let is_small = design.rows() <= MAX_FITTED_ROWS;
        let nets: Vec<Net> = if is_small { outputs.par_iter().enumerate().map(net).collect() } else { Vec::new() };
        let is_fitted = !nets.is_empty() && nets.iter().all(|net| net.points() >= fewest_points(design));
        let nets = if is_fitted {
            let expansions = cross_fitted(&nets, caps);
            OwnNets::Fitted(nets.into_iter().zip(expansions).collect())
        } else {
            OwnNets::Kept(outputs)
        };
        Some(Self { design: design.clone(), scale, nets })
    }
}

/// An approximation of the expensive model on one net: slope and constant of the other, expansion of the rest.
struct StandIn {
    slope: f64,
    offset: f64,
    rest: Expansion,
}

/// Estimates the indices of `layout` from the outputs of every run of `design`, with `low` as a control variate; `None`
/// if there are too few nets or points, the points are not Sobol' nets, or an output has no variance.
pub fn low_fidelity_estimates(
    design: &Design,
    families: &[Family],
    layout: &Layout,
    replicates: &[&PointOutputs],
    low: &LowOutputs<'_>,
) -> Option<SurrogateEstimates> {
    if !takes_surrogates(design, replicates.len()) {
        return None;
    }
    let runs = design.runs().len();
    let (mut f, scale) = scaled(replicates, runs, None)?;
    let (g, _) = scaled(&low.shared, runs, Some(low.own.scale))?;
    leave_out_points_that_failed(&mut f, &g);
    let caps = Caps::new(families, SAFE_HERMITE_DEGREES);
    let net = |number: usize| {
        let (f, g) = (&f[number], &g[number]);
        let of_dear = Net::new(design, number as u64, points_of(f), families, caps.degree, f);
        let good = |run: usize| f[run].iter().zip(&g[run]).filter(|(f, _)| f.is_finite()).map(|(_, g)| *g).collect();
        let of_cheap = of_dear.with_outputs((0..runs).map(good).collect());
        (of_dear, of_cheap)
    };
    let (expensive, cheap): (Vec<Net>, Vec<Net>) = (0..f.len()).into_par_iter().map(net).unzip();
    if expensive.iter().any(|net| net.points() < fewest_points(design)) {
        return None;
    }
    let effects = Effects::new(design, layout);
    let stand_ins: Vec<StandIn> =
        (0..expensive.len()).into_par_iter().map(|k| stand_in(&expensive, &cheap, k, caps)).collect();
    let nets: Vec<Contributions> = (0..expensive.len())
        .into_par_iter()
        .map(|k| differences(design, &expensive[k], &cheap[k], &stand_ins[k], &effects))
        .collect();
    let of_low = own_contributions(low.own, families, &stand_ins, &effects);
    let slope = stand_ins.iter().map(|of| of.slope).sum::<f64>() / stand_ins.len() as f64;
    let used = LowFidelityUse {
        name: low.name.to_owned(),
        slope: slope * (scale.1 / low.own.scale.1),
        explained: 1.0 - alone(&expensive, &cheap, &stand_ins),
    };
    let expansions = stand_ins.into_iter().map(|of| of.rest).collect();
    let corrected = Corrected::new(design, nets, expansions, families, &effects);
    let mut all = estimates(&corrected, &of_low, scale);
    all.low = Some(used);
    Some(all)
}

/// Returns all base points of a replicate, given its outputs of every run.
fn points_of(outputs: &[Vec<f64>]) -> Range<usize> {
    0..outputs.first().map_or(0, Vec::len)
}

/// Sets those points of `f` to not finite at which a run of `g` failed.
fn leave_out_points_that_failed(f: &mut [Vec<Vec<f64>>], g: &[Vec<Vec<f64>>]) {
    for (f, g) in f.iter_mut().zip(g) {
        for p in points_of(f) {
            if !f.iter().chain(g).all(|run| run.get(p).is_some_and(|y| y.is_finite())) {
                f.iter_mut().for_each(|run| run[p] = f64::NAN);
            }
        }
    }
}

/// Fits to all nets except number `k`.
fn stand_in(expensive: &[Net], cheap: &[Net], k: usize, caps: Caps<'_>) -> StandIn {
    let others = |nets: &[Net]| -> Vec<f64> {
        let of_others = nets.iter().enumerate().filter(|(place, _)| *place != k);
        of_others.flat_map(|(_, net)| net.outputs.iter().flatten().copied()).collect()
    };
    let (f, g) = (others(expensive), others(cheap));
    let (mean_f, mean_g) = (apportion_base::sum::mean(&f), apportion_base::sum::mean(&g));
    let square: f64 = g.iter().map(|g| (g - mean_g).powi(2)).sum();
    let product: f64 = f.iter().zip(&g).map(|(f, g)| (f - mean_f) * (g - mean_g)).sum();
    let slope = if square > 0.0 { product / square } else { 0.0 };
    let offset = mean_f - slope * mean_g;
    let left = |(f, g): (&Net, &Net)| f.with_outputs(rest(f, g, slope, offset));
    let left: Vec<Net> = expensive.iter().zip(cheap).map(left).collect();
    StandIn { slope, offset, rest: expansion_without(&left, k, caps) }
}

/// Returns f - alpha g - offset at every run and point.
fn rest(expensive: &Net, cheap: &Net, slope: f64, offset: f64) -> Vec<Vec<f64>> {
    let of_run = |(f, g): (&Vec<f64>, &Vec<f64>)| f.iter().zip(g).map(|(f, g)| f - slope * g - offset).collect();
    expensive.outputs.iter().zip(&cheap.outputs).map(of_run).collect()
}

/// Returns the share of the variance of the expensive model, which is 1, that the low-fidelity model alone leaves.
fn alone(expensive: &[Net], cheap: &[Net], stand_ins: &[StandIn]) -> f64 {
    let of_net = |((f, g), of): ((&Net, &Net), &StandIn)| mean_power(&rest(f, g, of.slope, of.offset), 2);
    expensive.iter().zip(cheap).zip(stand_ins).map(of_net).sum::<f64>() / expensive.len() as f64
}

/// Returns the contributions of every base point of a net to Q(f) - Q(h), and the exact part of Q(h).
fn differences(design: &Design, expensive: &Net, cheap: &Net, stand_in: &StandIn, effects: &Effects) -> Contributions {
    let StandIn { slope, offset, rest: expansion } = stand_in;
    let left = expensive.with_outputs(rest(expensive, cheap, *slope, *offset));
    let (_, e) = values_and_rest(&left, expansion);
    let f = &expensive.outputs;
    let h: Vec<Vec<f64>> = f.iter().zip(&e).map(|(f, e)| f.iter().zip(e).map(|(f, e)| f - e).collect()).collect();
    let (mean_f, mean_h) = (mean_power(f, 1), mean_power(&h, 1));
    let ([f_ab, h_ab], runs) = ([f, &h].map(|of| mean_power(&of[..2], 1)), f.len() as f64);
    let mut all = Contributions::zeros(effects, expensive);
    all.residual = (mean_power(&e, 2), mean_power(&e, 4));
    for p in 0..expensive.points() {
        let square = |(f, h): (&Vec<f64>, &Vec<f64>)| (f[p] - mean_f).powi(2) - (h[p] - mean_h).powi(2);
        all.variance[p] = f.iter().zip(&h).map(square).sum::<f64>() / runs;
        all.mean[p] = offset + e.iter().map(|e| e[p]).sum::<f64>() / runs;
    }
    for (swap, &ab) in design.ab_runs().iter().enumerate() {
        let half_square = |y: &[Vec<f64>], p: usize| (y[0][p] - y[ab][p]).powi(2) / 2.0;
        let product = |y: &[Vec<f64>], mean: f64, p: usize| (y[1][p] - mean) * (y[ab][p] - y[0][p]);
        for p in 0..expensive.points() {
            all.first_order[swap][p] = product(f, f_ab, p) - product(&h, h_ab, p);
            all.total[0][swap][p] = half_square(f, p) - half_square(&h, p);
        }
    }
    for (column, &pair) in all.pairs.iter_mut().zip(&effects.pairs) {
        let of_point = |p: usize| interaction(design, f, pair, p) - interaction(design, &h, pair, p);
        column.iter_mut().enumerate().for_each(|(p, sum)| *sum = of_point(p));
    }
    all.total[1] = all.total[0].clone();
    for (term, b) in expansion.terms.iter().zip(&expansion.coefficients) {
        if term.is_empty() {
            all.mean.iter_mut().for_each(|mean| *mean += b);
        } else {
            all.add_term(effects, term, [&|_| b * b; 2]);
        }
    }
    all
}

/// Returns the contributions of the low-fidelity model's own base points to Q(h), the mean over all stand-ins.
fn own_contributions(
    own: &OwnOutputs,
    families: &[Family],
    stand_ins: &[StandIn],
    effects: &Effects,
) -> Vec<Contributions> {
    let count = stand_ins.len() as f64;
    let square_of_slope = stand_ins.iter().map(|of| of.slope * of.slope).sum::<f64>() / count;
    let slope = stand_ins.iter().map(|of| of.slope).sum::<f64>() / count;
    // 2 alpha b_a of every term, the mean over the stand-ins.
    let mut crossed: Vec<(&Term, f64)> = Vec::new();
    for of in stand_ins {
        for (term, b) in of.rest.terms.iter().zip(&of.rest.coefficients).filter(|(term, _)| !term.is_empty()) {
            let weight = 2.0 * of.slope * b / count;
            add_to(&mut crossed, term, weight);
        }
    }
    let of_chunk = |net: &Net, expansion: &Expansion| {
        let mut all = Contributions::new(&own.design, net, expansion, effects);
        all.scale(square_of_slope);
        let (values, e) = values_and_rest(net, expansion);
        let runs = net.runs() as f64;
        for (p, mean) in all.mean.iter_mut().enumerate() {
            *mean = slope * (0..net.runs()).map(|run| values[run][p] + e[run][p]).sum::<f64>() / runs;
        }
        let mut column = Vec::new();
        for (term, weight) in &crossed {
            let known = expansion.terms.iter().position(|of| of == *term);
            let mut means = vec![known.map_or(0.0, |place| expansion.coefficients[place]); net.points()];
            for (run, e) in e.iter().enumerate() {
                net.fill(term, run, &mut column);
                means.iter_mut().zip(&column).zip(e).for_each(|((sum, phi), e)| *sum += phi * e / runs);
            }
            all.add_term(effects, term, [&|p| weight * means[p]; 2]);
        }
        all
    };
    let outputs = match &own.nets {
        OwnNets::Fitted(nets) => return nets.par_iter().map(|(net, expansion)| of_chunk(net, expansion)).collect(),
        OwnNets::Kept(outputs) => outputs,
    };
    let degree = crossed.iter().flat_map(|(term, _)| term.iter().map(|(_, degree)| *degree)).max().unwrap_or(1);
    let nothing = Expansion { terms: vec![Vec::new()], coefficients: vec![0.0] };
    let of_net = |(number, outputs): (usize, &Vec<Vec<f64>>)| {
        in_chunks(points_of(outputs).end, |points| {
            of_chunk(&Net::new(&own.design, number as u64, points, families, degree, outputs), &nothing)
        })
    };
    outputs.par_iter().enumerate().map(of_net).collect()
}
