//! Surrogates of many outputs of one run. Neighbours whose runs failed at the same points share the polynomials of the
//! points and the terms, which are chosen for all of them; each has its own coefficients, and its own number of terms
//! by cross-validation over the nets. A thousand outputs then cost about fifty times as much as one.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::basis::{Caps, Family, Term};
use super::fit::{Expansion, Expansions, Training};
use super::knots::{Knotted, MAX_MOVED, knots};
use super::net::Net;
use super::{
    Corrected, MAX_HERMITE_DEGREES, Scaled, Trial, estimates, fewest_points, fitted_design, fitted_to_others,
    in_chunks, scaled, surrogate_estimates, takes_surrogates, trials,
};
use crate::correction::{ChosenTerms, Contributions, Effects, Knot, SurrogateEstimates, values_and_rest};
use crate::design::Design;
use crate::effect::Layout;
use crate::estimate::PointOutputs;

/// Number of outputs up to which each has its own terms: the gain is worth the time.
const MAX_ALONE: usize = 32;

/// Approximate number of neighbours that share their terms. Outputs of a series change slowly along it.
const NEIGHBOURS: usize = 64;

/// Residual share of the variance of an output above which it may have steps and kinks.
const ROUGH: f64 = 1e-4;

/// Maximum ratio of the residual with knots to that of polynomials for which knots are used.
const KNOTS_RATIO: f64 = 0.9;

/// Returns the estimates of [`surrogate_estimates`] for each of `outputs`, which have the outputs of every replicate,
/// by the terms of the same output in `longer`, those of a longer run, if known; above 32 outputs by shared terms.
pub fn surrogates_together(
    design: &Design,
    families: &[Family],
    layout: &Layout,
    outputs: &[Vec<&PointOutputs>],
    longer: &[Option<SurrogateEstimates>],
) -> Vec<Option<SurrogateEstimates>> {
    let alone = |(number, replicates): (usize, &Vec<&PointOutputs>)| {
        let chosen = longer.get(number).and_then(|of| of.as_ref()?.chosen.as_ref());
        surrogate_estimates(design, families, layout, replicates, chosen)
    };
    let replicates = outputs.first().map_or(0, Vec::len);
    if outputs.len() <= MAX_ALONE || !takes_surrogates(design, replicates) {
        return outputs.iter().enumerate().map(alone).collect();
    }
    let all: Vec<Option<Scaled>> =
        outputs.par_iter().map(|replicates| scaled(replicates, design.runs().len(), None)).collect();
    // Grouped by the points at which all runs have a value.
    let mut groups: BTreeMap<Vec<Vec<usize>>, Vec<usize>> = BTreeMap::new();
    for (number, scaled) in all.iter().enumerate().filter_map(|(number, all)| Some((number, all.as_ref()?))) {
        groups.entry(good_points(scaled)).or_default().push(number);
    }
    let mut found: Vec<Option<SurrogateEstimates>> = vec![None; outputs.len()];
    for (good, members) in groups {
        // Lists of nearly equal length.
        let length = members.len().div_ceil(members.len().div_ceil(NEIGHBOURS));
        for members in members.chunks(length) {
            let of_members: Vec<Option<SurrogateEstimates>> = if members.len() <= MAX_ALONE {
                members.par_iter().map(|&number| alone((number, &outputs[number]))).collect()
            } else {
                let scaled: Vec<&Scaled> = members.iter().filter_map(|&number| all[number].as_ref()).collect();
                of_neighbours(design, families, layout, &good, &scaled, None)
            };
            members.iter().zip(of_members).for_each(|(number, of)| found[*number] = of);
        }
    }
    found
}

/// Returns the base points of every replicate at which all runs have a value.
pub(super) fn good_points((replicates, _): &Scaled) -> Vec<Vec<usize>> {
    let of_replicate = |runs: &Vec<Vec<f64>>| {
        let points = runs.first().map_or(0, Vec::len);
        (0..points).filter(|&point| runs.iter().all(|run| run[point].is_finite())).collect()
    };
    replicates.iter().map(of_replicate).collect()
}

/// Fits outputs with values at the `good` points of every replicate, with terms chosen together, or already `chosen`.
pub(super) fn of_neighbours(
    design: &Design,
    families: &[Family],
    layout: &Layout,
    good: &[Vec<usize>],
    outputs: &[&Scaled],
    chosen: Option<&ChosenTerms>,
) -> Vec<Option<SurrogateEstimates>> {
    let fitted = fitted_design(design);
    let (points, all) = (fitted.points_per_replicate() as usize, design.points_per_replicate() as usize);
    let good: Vec<&[usize]> = good.iter().map(|good| &good[..good.partition_point(|&point| point < points)]).collect();
    if good.iter().any(|points| points.len() < fewest_points(design)) {
        return vec![None; outputs.len()];
    }
    let at_good = |output: &&Scaled| -> Vec<Vec<Vec<f64>>> {
        let of_replicate = |(runs, good): (&Vec<Vec<f64>>, &&[usize])| {
            runs.iter().map(|run| good.iter().map(|&point| run[point]).collect()).collect()
        };
        output.0.iter().zip(&good).map(of_replicate).collect()
    };
    let runs: Vec<Vec<Vec<Vec<f64>>>> = outputs.par_iter().map(at_good).collect();
    let trials: Vec<(usize, Trial)> = match chosen {
        Some(chosen) if !chosen.knots.is_empty() => vec![(chosen.kind, with_knots(families, &chosen.knots))],
        _ => trials(families).into_iter().enumerate().collect(),
    };
    let trials = trials.into_iter().filter(|(kind, _)| chosen.is_none_or(|of| of.kind == *kind));
    let of_nets = chosen.map(|chosen| chosen.of_nets.as_slice());
    let fits: Vec<(usize, Fit)> =
        trials.map(|(kind, trial)| (kind, Fit::new(&fitted, trial, outputs[0], &runs, of_nets))).collect();
    let effects = Effects::new(design, layout);
    let of_output = |number: usize| {
        let corrected = |Fit { nets, families, degree, expansions, .. }: &Fit| {
            let expansions: Vec<_> = expansions.iter().map(|of_net| of_net.of_output(number)).collect();
            let of = |net: &Net, expansion: &Expansion| Contributions::new(design, net, expansion, &effects);
            let of_net = |k: usize| {
                if points == all {
                    return of(&nets[k].with_outputs(runs[number][k].clone()), &expansions[k]);
                }
                in_chunks(all, |chunk| {
                    of(&Net::new(design, k as u64, chunk, families, *degree, &outputs[number].0[k]), &expansions[k])
                })
            };
            let nets = (0..nets.len()).into_par_iter().map(of_net).collect();
            Corrected::new(&fitted, nets, expansions, families, &effects)
        };
        let mut best: Option<(usize, Corrected)> = None;
        for (kind, fit) in &fits {
            let next = corrected(fit);
            let is_better = best.as_ref().is_none_or(|(_, best)| next.unknown() < fit.ratio * best.unknown());
            best = if is_better { Some((*kind, next)) } else { best };
        }
        let (kind, mut best) = best?;
        let mut knots = chosen.map_or_else(Vec::new, |chosen| chosen.knots.clone());
        // If factors are unbounded, residuals in a few rows are a tail.
        let is_tail = families.contains(&Family::Hermite) && best.is_heavy_tailed();
        if chosen.is_none() && outputs.len() == 1 && best.residual() > ROUGH && !is_tail {
            let (mut next, mut terms) = (fits[kind].1.knots(families, &best.expansions), None);
            for (is_last, ratio) in [(false, KNOTS_RATIO), (true, 1.0)] {
                let fit = match next.iter().any(|of_factor| !of_factor.is_empty()) {
                    true => Fit::new(&fitted, with_knots(families, &next), outputs[0], &runs, terms.as_deref()),
                    false => break,
                };
                let found = corrected(&fit);
                if found.residual() > ratio * best.residual() {
                    break;
                }
                // The second time with the terms of the first, and with the knots where these place them.
                terms = Some(terms_of(&found.expansions));
                let placed = if is_last { Vec::new() } else { fit.placed(&fitted, outputs[0], &found.expansions) };
                if found.unknown() <= ratio * best.unknown() {
                    (knots, best) = (next, found);
                }
                next = placed;
            }
        }
        let chosen = (outputs.len() == 1).then(|| ChosenTerms { kind, knots, of_nets: terms_of(&best.expansions) });
        Some(SurrogateEstimates { chosen, ..estimates(&best, &[], outputs[number].1) })
    };
    (0..outputs.len()).into_par_iter().map(of_output).collect()
}

fn terms_of(expansions: &[Expansion]) -> Vec<Vec<Term>> {
    expansions.iter().map(|expansion| expansion.terms.clone()).collect()
}

/// Returns functions of all factors with these `knots`: the trial for an output with large residuals of polynomials.
fn with_knots(families: &[Family], knots: &[Vec<Knot>]) -> Trial {
    let degree = Caps::degree_of(families.len());
    let of_factor = |(family, knots): (&Family, &Vec<Knot>)| {
        if knots.is_empty() { family.clone() } else { Family::Knotted(Box::new(Knotted::new(family, knots, degree))) }
    };
    let families = families.iter().zip(knots).map(of_factor).collect();
    Trial { families, hermite_degree: MAX_HERMITE_DEGREES, ratio: 1.0 }
}

/// A trial fitted to all outputs: for every net the expansions of the others.
struct Fit {
    nets: Vec<Net>,
    families: Vec<Family>,
    degree: usize,
    expansions: Vec<Expansions>,
    ratio: f64,
}

impl Fit {
    /// Fits the trial: `first` is one of the outputs, all points included; `runs` has all of them at the good ones. The
    /// terms are those of each net in `chosen`, if any.
    fn new(
        design: &Design,
        trial: Trial,
        first: &Scaled,
        runs: &[Vec<Vec<Vec<f64>>>],
        chosen: Option<&[Vec<Term>]>,
    ) -> Self {
        let caps = Caps::new(&trial.families, trial.hermite_degree);
        let points = design.points_per_replicate() as usize;
        let net = |(number, outputs): (usize, &Vec<Vec<f64>>)| {
            Net::new(design, number as u64, 0..points, &trial.families, caps.degree, outputs)
        };
        let nets: Vec<Net> = first.0.par_iter().enumerate().map(net).collect();
        let of_net = |number: usize| runs.iter().map(|of_output| of_output[number].as_slice()).collect();
        let training = nets.iter().enumerate().map(|(number, net)| Training::of_outputs(net, of_net(number)));
        let training: Vec<Training<'_>> = training.collect();
        let expansions = fitted_to_others(&nets, &training, caps, chosen);
        drop(training);
        let degree = caps.degree;
        Self { nets, families: trial.families, degree, expansions, ratio: trial.ratio }
    }

    /// Finds the knots of every factor, with polynomials in `families`, in the residuals of these expansions.
    fn knots(&self, families: &[Family], expansions: &[Expansion]) -> Vec<Vec<Knot>> {
        let nets = self.nets.iter().zip(expansions);
        let rest: Vec<Vec<Vec<f64>>> = nets.map(|(net, expansion)| values_and_rest(net, expansion).1).collect();
        let of_factor = |factor: usize| knots(&self.nets, &rest, factor, &families[factor], self.degree);
        (0..families.len()).into_par_iter().map(of_factor).collect()
    }

    /// Places its knots by these expansions of its output.
    fn placed(&self, design: &Design, output: &Scaled, expansions: &[Expansion]) -> Vec<Vec<Knot>> {
        let points = design.points_per_replicate() as usize;
        let moved = |by: f64| -> Vec<Vec<Vec<f64>>> {
            let of_factor = |family: &Family| match family {
                Family::Knotted(own) => Family::Knotted(Box::new(Knotted::clone(own).moved(by))),
                smooth => smooth.clone(),
            };
            let families: Vec<Family> = self.families.iter().map(of_factor).collect();
            let of_net = |(k, expansion): (usize, &Expansion)| {
                let net = Net::new(design, k as u64, 0..points, &families, self.degree, &output.0[k]);
                values_and_rest(&net, expansion).0
            };
            expansions.par_iter().enumerate().map(of_net).collect()
        };
        let [left, right] = [-MAX_MOVED, MAX_MOVED].map(moved);
        let of_factor = |(factor, family): (usize, &Family)| {
            let Family::Knotted(own) = family else { return Vec::new() };
            let alone = |(term, b): (&Term, &f64)| match term[..] {
                [(other, degree)] if other == factor => Some((degree, *b)),
                _ => None,
            };
            let of = |of: &Expansion| of.terms.iter().zip(&of.coefficients).filter_map(alone).collect::<Vec<_>>();
            own.placed(&self.nets, [&left, &right], factor, &expansions.iter().flat_map(of).collect::<Vec<_>>())
        };
        self.families.iter().enumerate().map(of_factor).collect()
    }
}

#[cfg(test)]
mod tests;
