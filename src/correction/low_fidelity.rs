//! Indices of an expensive model with the help of a low-fidelity model.
//!
//! The low-fidelity model g approximates f together with a surrogate P of the remainder: h = alpha g + P. Its indices
//! come from many runs of g at separate points, and those of f follow from the rows at which both were evaluated:
//! any number Q that is a mean over base points has Q(f) = Q(h) + mean\[q(f) - q(h)\], the control variates of Qian,
//! Peherstorfer, O'Malley, Vesselinov and Willcox (2018), "Multifidelity Monte Carlo estimation of variance and
//! sensitivity indices", SIAM/ASA J. Uncertain. Quantif. 6, 683-706, with the model and not its estimates as the
//! variate. With orthonormal terms phi_a of P, coefficients b_a, and r_a = E\[phi_a g\],
//!
//! - V S_s(h) = alpha^2 V S_s(g) + sum over a within s of (b_a^2 + 2 alpha b_a r_a),
//!
//! and similarly for total indices and the variance. P of a net is fitted to the others, and the runs at separate
//! points are independent of it: a poor low-fidelity model costs accuracy, but intervals stay valid, if the
//! shared rows show how poor it is. They show nothing of values of g beyond theirs ([`IndependentOutputs::unmet_share`]).

use std::collections::BTreeMap;
use std::ops::Range;

use rayon::prelude::*;

use super::contributions::{Contributions, interaction, mean_power};
use super::estimates::SurrogateEstimates;
use super::nets::{Corrected, estimates, in_chunks};
use super::surrogate_use::LowFidelityUse;
use crate::design::Design;
use crate::effect::Layout;
use crate::estimate::PointOutputs;
use crate::surrogate::expansion::{degree, values_and_rest};
use crate::surrogate::family::Family;
use crate::surrogate::net::Net;
use crate::surrogate::outputs::{OutputTable, Scale, ScaledOutput};
use crate::surrogate::{Effects, Expansion, FittedRows, MIN_POINTS, Term, fitted_design, takes_surrogates};

/// Part of the range of the shared rows by which other values may lie outside it: those of a few hundred draws of a
/// normal distribution leave 4e-4 of its variance beyond.
const ROOM: f64 = 0.2;

/// One output of a low-fidelity model.
#[derive(Clone)]
pub(crate) struct LowFidelityOutputs<'a> {
    /// The name of the low-fidelity model.
    pub name: &'a str,
    /// Its outputs at the rows of the expensive model, of every replicate.
    pub shared: Vec<&'a PointOutputs>,
    /// Its outputs at separate points.
    pub independent: &'a IndependentOutputs,
}

/// One output of a low-fidelity model at the rows of a separate design, independent of the expensive model's.
pub(crate) struct IndependentOutputs {
    design: Design,
    scale: Scale,
    nets: Vec<OutputTable>,
    /// For every net an expansion fitted to the others; empty ones for too few points.
    expansions: Vec<Expansion>,
}

impl IndependentOutputs {
    /// Maximum [`unmet_share`](Self::unmet_share) of outputs that are used.
    pub const MAX_UNMET_SHARE: f64 = 0.002;

    /// Creates them from every run of `design`; `None` if [`low_fidelity_estimates`] cannot use them.
    pub fn new(design: &Design, families: &[Family], replicates: &[&PointOutputs]) -> Option<Self> {
        if !takes_surrogates(design, replicates.len()) {
            return None;
        }
        let ScaledOutput { nets, scale } = ScaledOutput::new(replicates, design.runs().len(), None)?;
        let enough = nets.iter().all(|net| net.complete_points().len() >= MIN_POINTS);
        let expansions = if enough {
            let first = fitted_design(design).points_per_replicate() as usize;
            let some: Vec<Net> =
                nets.iter().enumerate().map(|(k, table)| net(design, k, 0..first, families, 0, table)).collect();
            let outputs = some.iter().map(|net| &net.outputs[..]).collect();
            FittedRows::new(&some, families).smooth(&[outputs]).into_iter().flatten().collect()
        } else {
            vec![Expansion::default(); nets.len()]
        };
        Some(Self { design: design.clone(), scale, nets, expansions })
    }

    /// Returns the share of the variance that the outputs owe to values far outside the range of the `shared` ones, at
    /// every one of `runs` runs of the expensive model: at those rows nothing is known of the difference of the models.
    pub fn unmet_share(&self, shared: &[&PointOutputs], runs: usize) -> f64 {
        let shared = ScaledOutput::new(shared, runs, Some(self.scale));
        let shared = shared.iter().flat_map(|of| &of.nets).flat_map(|net| &net.runs).flatten();
        let finite = shared.filter(|y| y.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(*y), high.max(*y)));
        let room = ROOM * (high - low);
        let (mut all, mut beyond) = (0.0, 0.0);
        for y in self.nets.iter().flat_map(|net| &net.runs).flatten().filter(|y| y.is_finite()) {
            all += y * y;
            beyond += y * y - y.max(low - room).min(high + room).powi(2);
        }
        beyond / all
    }
}

/// Returns some base points of net number `k`.
fn net(
    design: &Design,
    k: usize,
    points: Range<usize>,
    families: &[Family],
    degree: usize,
    table: &OutputTable,
) -> Net {
    Net::new(design, k as u64, points.start..points.end.min(table.points()), families, degree, &table.runs)
}

/// The runs of one net by both models.
struct TwoModels {
    expensive: Net,
    cheap: Net,
}

/// An approximation of the expensive model: slope and constant of the other, and for every net an expansion of the rest.
struct Approximation {
    slope: f64,
    offset: f64,
    rests: Vec<Expansion>,
}

/// Estimates the indices of `layout` from the outputs of every run of `design`, with `low` as a control variate; `None`
/// if there are too few nets or points, the points are not Sobol' nets, or an output has no variance.
pub(crate) fn low_fidelity_estimates(
    design: &Design,
    families: &[Family],
    layout: &Layout,
    replicates: &[&PointOutputs],
    low: &LowFidelityOutputs<'_>,
) -> Option<SurrogateEstimates> {
    if !takes_surrogates(design, replicates.len()) {
        return None;
    }
    let runs = design.runs().len();
    let mut f = ScaledOutput::new(replicates, runs, None)?;
    let g = ScaledOutput::new(&low.shared, runs, Some(low.independent.scale))?;
    leave_out_points_that_failed(&mut f.nets, &g.nets);
    let nets = two_models(design, families, 0, &f.nets, &g.nets);
    if nets.iter().any(|net| net.expensive.points() < MIN_POINTS) {
        return None;
    }
    let effects = Effects::new(design, layout);
    let approximation = Approximation::new(&nets, families);
    let nets = two_models(design, families, degree(&approximation.rests), &f.nets, &g.nets);
    let pairs = nets.par_iter().zip(&approximation.rests);
    let contributions = pairs.map(|(net, rest)| differences(design, net, &approximation, rest, &effects)).collect();
    let of_low = independent_contributions(low.independent, families, &approximation, &effects);
    let low = LowFidelityUse {
        name: low.name.to_owned(),
        slope: approximation.slope * (f.scale.sd / low.independent.scale.sd),
        explained: 1.0 - approximation.unexplained(&nets),
    };
    let corrected = Corrected::new(design, contributions, approximation.rests, families, &effects);
    Some(SurrogateEstimates { low: Some(low), ..estimates(&corrected, &of_low, f.scale) })
}

/// Returns the runs of every net by the expensive model, `f`, and by the other.
fn two_models(
    design: &Design,
    families: &[Family],
    degree: usize,
    f: &[OutputTable],
    g: &[OutputTable],
) -> Vec<TwoModels> {
    let nets = f.par_iter().zip(g).enumerate().map(|(k, (f, g))| {
        let expensive = net(design, k, 0..f.points(), families, degree, f);
        let cheap = expensive.with_outputs(g.at(&f.complete_points()).runs);
        TwoModels { expensive, cheap }
    });
    nets.collect()
}

/// Sets those points of `f` to not finite at which a run of `g` failed.
fn leave_out_points_that_failed(f: &mut [OutputTable], g: &[OutputTable]) {
    for (f, g) in f.iter_mut().zip(g) {
        for p in 0..f.points() {
            if !f.runs.iter().chain(&g.runs).all(|run| run.get(p).is_some_and(|y| y.is_finite())) {
                f.runs.iter_mut().for_each(|run| run[p] = f64::NAN);
            }
        }
    }
}

impl Approximation {
    /// Fits the slope to all nets, and to what it leaves of all nets but one an expansion.
    fn new(nets: &[TwoModels], families: &[Family]) -> Self {
        let f: Vec<f64> = nets.iter().flat_map(|net| &net.expensive.outputs).flatten().copied().collect();
        let g: Vec<f64> = nets.iter().flat_map(|net| &net.cheap.outputs).flatten().copied().collect();
        let (mean_f, mean_g) = (apportion_base::sum::mean(&f), apportion_base::sum::mean(&g));
        let square: f64 = g.iter().map(|g| (g - mean_g).powi(2)).sum();
        let product: f64 = f.iter().zip(&g).map(|(f, g)| (f - mean_f) * (g - mean_g)).sum();
        let slope = if square > 0.0 { product / square } else { 0.0 };
        let line = Self { slope, offset: mean_f - slope * mean_g, rests: Vec::new() };
        let left: Vec<Net> = nets.iter().map(|net| net.expensive.with_outputs(line.rest_of(net))).collect();
        let outputs = left.iter().map(|net| &net.outputs[..]).collect();
        let rests = FittedRows::new(&left, families).smooth(&[outputs]).into_iter().flatten().collect();
        Self { rests, ..line }
    }

    /// Returns f - alpha g - offset at every run and point.
    fn rest_of(&self, net: &TwoModels) -> Vec<Vec<f64>> {
        let mut rest = net.expensive.outputs.clone();
        for (f, g) in rest.iter_mut().flatten().zip(net.cheap.outputs.iter().flatten()) {
            *f = *f - self.slope * g - self.offset;
        }
        rest
    }

    /// Returns the share of the variance of the expensive model, which is 1, that the low-fidelity model alone leaves.
    fn unexplained(&self, nets: &[TwoModels]) -> f64 {
        nets.iter().map(|net| mean_power(&self.rest_of(net), 2)).sum::<f64>() / nets.len() as f64
    }

    /// Returns the mean over all nets of 2 alpha b_a of every term.
    fn crossed(&self) -> BTreeMap<&Term, f64> {
        let mut crossed: BTreeMap<&Term, f64> = BTreeMap::new();
        for (term, b) in self.rests.iter().flat_map(Expansion::varying) {
            *crossed.entry(term).or_default() += 2.0 * self.slope * b / self.rests.len() as f64;
        }
        crossed
    }
}

/// Returns the contributions of every base point of a net to Q(f) - Q(h), and the exact part of Q(h).
fn differences(
    design: &Design,
    net: &TwoModels,
    approximation: &Approximation,
    expansion: &Expansion,
    effects: &Effects,
) -> Contributions {
    let offset = approximation.offset;
    let left = net.expensive.with_outputs(approximation.rest_of(net));
    let (_, e) = values_and_rest(&left, expansion);
    let f = &net.expensive.outputs;
    let mut h = f.clone();
    for (h, e) in h.iter_mut().flatten().zip(e.iter().flatten()) {
        *h -= e;
    }
    let (mean_f, mean_h, runs) = (mean_power(f, 1), mean_power(&h, 1), f.len() as f64);
    let (mean_f_ab, mean_h_ab) = (mean_power(&f[..2], 1), mean_power(&h[..2], 1));
    let mut all = Contributions::zeros(effects, &left);
    all.residual = (mean_power(&e, 2), mean_power(&e, 4));
    for p in 0..left.points() {
        let squares = f.iter().zip(&h).map(|(f, h)| (f[p] - mean_f).powi(2) - (h[p] - mean_h).powi(2));
        all.variance[p] = squares.sum::<f64>() / runs;
        all.mean[p] = offset + e.iter().map(|e| e[p]).sum::<f64>() / runs;
    }
    for (swap, &ab) in design.ab_runs().iter().enumerate() {
        for p in 0..left.points() {
            all.first_order[swap][p] = first_order(f, mean_f_ab, ab, p) - first_order(&h, mean_h_ab, ab, p);
            all.total[0][swap][p] = half_square(f, ab, p) - half_square(&h, ab, p);
        }
    }
    for (column, &pair) in all.pairs.iter_mut().zip(&effects.pairs) {
        for (p, contribution) in column.iter_mut().enumerate() {
            *contribution = interaction(design, f, pair, p) - interaction(design, &h, pair, p);
        }
    }
    all.total[1] = all.total[0].clone();
    for (term, b) in expansion.iter() {
        if term.is_empty() {
            all.mean.iter_mut().for_each(|mean| *mean += b);
        } else {
            all.add_term(effects, term, [&|_| b * b; 2]);
        }
    }
    all
}

/// Returns the contribution of base point `p` to V S of the swap with run `ab`, given the mean of A and B.
fn first_order(y: &[Vec<f64>], mean: f64, ab: usize, p: usize) -> f64 {
    (y[1][p] - mean) * (y[ab][p] - y[0][p])
}

/// Returns the contribution of base point `p` to V ST of the swap with run `ab`.
fn half_square(y: &[Vec<f64>], ab: usize, p: usize) -> f64 {
    (y[0][p] - y[ab][p]).powi(2) / 2.0
}

/// Returns the contributions of the independent base points of the low-fidelity model to Q(h).
fn independent_contributions(
    IndependentOutputs { design, nets, expansions, .. }: &IndependentOutputs,
    families: &[Family],
    approximation: &Approximation,
    effects: &Effects,
) -> Vec<Contributions> {
    let (slope, crossed) = (approximation.slope, approximation.crossed());
    let degree = degree(approximation.rests.iter().chain(expansions));
    let pairs = nets.par_iter().zip(expansions).enumerate();
    let all = pairs.map(|(k, (table, expansion))| {
        in_chunks(table.points(), |points| {
            let net = net(design, k, points, families, degree, table);
            let mut all = Contributions::new(design, &net, expansion, effects);
            all.scale(slope * slope);
            add_crossed(&mut all, &net, expansion, slope, &crossed, effects);
            all
        })
    });
    all.collect()
}

/// Adds the part linear in the slope: the mean of the output, and the products of the terms with it.
fn add_crossed(
    all: &mut Contributions,
    net: &Net,
    expansion: &Expansion,
    slope: f64,
    crossed: &BTreeMap<&Term, f64>,
    effects: &Effects,
) {
    let (values, e) = values_and_rest(net, expansion);
    let runs = net.runs() as f64;
    for (p, mean) in all.mean.iter_mut().enumerate() {
        *mean = slope * (0..net.runs()).map(|run| values[run][p] + e[run][p]).sum::<f64>() / runs;
    }
    let own: BTreeMap<&Term, f64> = expansion.iter().collect();
    let mut column = Vec::new();
    for (term, weight) in crossed {
        let mut means = vec![own.get(term).copied().unwrap_or(0.0); net.points()];
        for (run, e) in e.iter().enumerate() {
            net.fill(term, run, &mut column);
            for ((sum, phi), e) in means.iter_mut().zip(&column).zip(e) {
                *sum += phi * e / runs;
            }
        }
        all.add_term(effects, term, [&|p| weight * means[p]; 2]);
    }
}
