//! Surrogates of many outputs of one run. Neighbours whose runs failed at the same points share the polynomials of the
//! points and the terms, which are chosen for all of them; each output has separate coefficients, and a number
//! of terms by cross-validation over the nets. A thousand outputs then cost about fifty times as much as one.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::contributions::Contributions;
use super::estimates::SurrogateEstimates;
use super::nets::{Corrected, estimates, in_chunks};
use crate::design::Design;
use crate::effect::Layout;
use crate::estimate::PointOutputs;
use crate::surrogate::basis::Caps;
use crate::surrogate::family::Family;
use crate::surrogate::fit::{Expansion, Training};
use crate::surrogate::net::Net;
use crate::surrogate::outputs::ScaledOutput;
use crate::surrogate::{
    CrossFitted, Effects, Trial, fewest_points, fitted_by_chaos, fitted_design, fitted_to_others, takes_surrogates,
    trials,
};

/// Maximum number of outputs that are fitted one by one: separate terms gain more than they cost.
const MAX_ALONE: usize = 32;

/// Approximate number of neighbours that share their terms. Outputs of a series change slowly along it.
const NEIGHBOURS: usize = 64;

/// Estimates the indices of `layout` from the outputs of every run of `design`, corrected by surrogates: those that are
/// `known` if there are any; `None` if there are too few nets or points, the points are not Sobol' nets, or an output
/// has no variance.
fn surrogate_estimates(
    design: &Design,
    families: &[Family],
    layout: &Layout,
    replicates: &[&PointOutputs],
    known: Option<&CrossFitted>,
) -> Option<SurrogateEstimates> {
    if !takes_surrogates(design, replicates.len()) {
        return None;
    }
    let output = ScaledOutput::new(replicates, design.runs().len(), known.map(|known| known.scale))?;
    fit_outputs(design, families, layout, &output.complete_points(), &[&output], known).pop().flatten()
}

/// Returns the estimates of [`surrogate_estimates`] for each of `outputs`, which have the outputs of every replicate,
/// by the surrogates that are `known` of it, from more or fewer of the same points, if any are of outputs; above 32
/// outputs by shared terms.
pub(crate) fn surrogates_together(
    design: &Design,
    families: &[Family],
    layout: &Layout,
    outputs: &[Vec<&PointOutputs>],
    known: &[Option<&CrossFitted>],
) -> Vec<Option<SurrogateEstimates>> {
    let alone = |number: usize| surrogate_estimates(design, families, layout, &outputs[number], known[number]);
    if outputs.len() <= MAX_ALONE || !takes_surrogates(design, outputs[0].len()) {
        return (0..outputs.len()).into_par_iter().map(alone).collect();
    }
    let runs = design.runs().len();
    let scaled: Vec<Option<ScaledOutput>> =
        outputs.par_iter().map(|replicates| ScaledOutput::new(replicates, runs, None)).collect();
    // Grouped by the points at which all runs have a value.
    let mut groups: BTreeMap<Vec<Vec<usize>>, Vec<(usize, &ScaledOutput)>> = BTreeMap::new();
    for (number, output) in scaled.iter().enumerate() {
        if let Some(output) = output {
            groups.entry(output.complete_points()).or_default().push((number, output));
        }
    }
    let mut all: Vec<Option<SurrogateEstimates>> = vec![None; outputs.len()];
    for (complete, members) in groups {
        // Lists of nearly equal length.
        let length = members.len().div_ceil(members.len().div_ceil(NEIGHBOURS));
        for members in members.chunks(length) {
            let (numbers, scaled): (Vec<usize>, Vec<&ScaledOutput>) = members.iter().copied().unzip();
            let estimates: Vec<Option<SurrogateEstimates>> = if members.len() <= MAX_ALONE {
                numbers.par_iter().map(|number| alone(*number)).collect()
            } else {
                fit_outputs(design, families, layout, &complete, &scaled, None)
            };
            for (number, estimates) in numbers.into_iter().zip(estimates) {
                all[number] = estimates;
            }
        }
    }
    all
}

/// Fits `outputs` with values at the `complete` points of every replicate, with terms chosen together, unless the
/// surrogates of the only one are `known`.
pub(super) fn fit_outputs(
    design: &Design,
    families: &[Family],
    layout: &Layout,
    complete: &[Vec<usize>],
    outputs: &[&ScaledOutput],
    known: Option<&CrossFitted>,
) -> Vec<Option<SurrogateEstimates>> {
    let fitted = fitted_design(design);
    let points = fitted.points_per_replicate() as usize;
    let complete = complete.iter().map(|of_net| &of_net[..of_net.partition_point(|point| *point < points)]);
    let complete: Vec<&[usize]> = complete.collect();
    if complete.iter().any(|points| points.len() < fewest_points(design)) {
        return vec![None; outputs.len()];
    }
    let complete = outputs.par_iter().map(|output| output.at(&complete)).collect();
    let together = Together { design, fitted, families, effects: Effects::new(design, layout), outputs, complete };
    let fits = known.map_or_else(|| together.fit_trials(), |known| vec![together.known(known)]);
    (0..outputs.len()).into_par_iter().map(|output| together.correct_output(&fits, output)).collect()
}

/// Outputs that share the points and the terms of their surrogates.
struct Together<'a> {
    design: &'a Design,
    /// The first points of the design, to which surrogates are fitted.
    fitted: Design,
    families: &'a [Family],
    effects: Effects,
    outputs: &'a [&'a ScaledOutput],
    /// The outputs at the fitted points that are complete.
    complete: Vec<ScaledOutput>,
}

/// A trial fitted to all outputs.
struct Fit {
    ratio: f64,
    families: Vec<Family>,
    degree: usize,
    nets: Vec<Net>,
    /// For every net the expansions of all outputs, fitted to the other nets.
    expansions: Vec<Vec<Expansion>>,
}

impl Together<'_> {
    /// Fits all trials.
    fn fit_trials(&self) -> Vec<Fit> {
        let trials = trials(self.families);
        if self.outputs.len() > 1 {
            return trials.into_iter().map(|trial| self.fit(trial)).collect();
        }
        let mut families: Vec<Vec<Family>> = Vec::new();
        for trial in trials {
            if !families.contains(&trial.families) {
                families.push(trial.families);
            }
        }
        families.into_iter().map(|families| self.known(&self.fit_alone(&families))).collect()
    }

    /// Returns the fit with surrogates of the only output.
    fn known(&self, CrossFitted { families, of_nets, .. }: &CrossFitted) -> Fit {
        let degree = of_nets.iter().flat_map(|of| &of.terms).flatten().map(|(_, degree)| *degree).max().unwrap_or(0);
        let numbers = (0..of_nets.len()).into_par_iter();
        Fit {
            ratio: 1.0,
            families: families.clone(),
            degree,
            nets: numbers.map(|k| self.net(k, families, degree)).collect(),
            expansions: of_nets.iter().map(|of_net| vec![of_net.clone()]).collect(),
        }
    }

    /// Fits the only output by Bayesian chaos in these polynomials.
    fn fit_alone(&self, families: &[Family]) -> CrossFitted {
        let numbers = 0..self.outputs[0].nets.len();
        let nets: Vec<Net> = numbers.map(|k| self.net(k, families, 0)).collect();
        fitted_by_chaos(&nets, families, self.outputs[0].scale)
    }

    /// Fits one trial to all outputs.
    fn fit(&self, trial: Trial) -> Fit {
        let Trial { families, unbounded_degree, ratio } = trial;
        let caps = Caps::new(&families, unbounded_degree);
        let numbers = (0..self.outputs[0].nets.len()).into_par_iter();
        let degree = caps.degree;
        let nets: Vec<Net> = numbers.map(|k| self.net(k, &families, degree)).collect();
        let training = nets.iter().enumerate().map(|(k, net)| {
            Training::of_outputs(net, self.complete.iter().map(|output| output.nets[k].runs.as_slice()).collect())
        });
        let expansions = fitted_to_others(&nets, &training.collect::<Vec<_>>(), caps);
        Fit { ratio, families, degree, nets, expansions }
    }

    /// Returns net number `k` with the first output, in polynomials of `families`.
    fn net(&self, k: usize, families: &[Family], degree: usize) -> Net {
        let points = self.fitted.points_per_replicate() as usize;
        Net::new(&self.fitted, k as u64, 0..points, families, degree, &self.outputs[0].nets[k].runs)
    }

    /// Estimates one output by the trial that leaves least unknown.
    fn correct_output(&self, fits: &[Fit], output: usize) -> Option<SurrogateEstimates> {
        let mut best: Option<(&Fit, Corrected)> = None;
        for fit in fits {
            let next = self.corrected(fit, output);
            if best.as_ref().is_none_or(|(_, best)| next.unknown() < fit.ratio * best.unknown()) {
                best = Some((fit, next));
            }
        }
        let (fit, best) = best?;
        let mut all = estimates(&best, &[], self.outputs[output].scale);
        if self.outputs.len() == 1 {
            let (scale, families) = (self.outputs[output].scale, fit.families.clone());
            all.fitted = Some(CrossFitted { scale, families, of_nets: best.expansions });
        }
        Some(all)
    }

    /// Corrects every net of one output by the expansion that was fitted to the others.
    fn corrected(&self, fit: &Fit, output: usize) -> Corrected {
        let expansions: Vec<Expansion> = fit.expansions.iter().map(|of_net| of_net[output].clone()).collect();
        let points = self.design.points_per_replicate() as usize;
        let is_fitted = self.fitted.points_per_replicate() as usize == points;
        let nets = expansions.par_iter().enumerate().map(|(k, expansion)| {
            if is_fitted {
                let net = fit.nets[k].with_outputs(self.complete[output].nets[k].runs.clone());
                return Contributions::new(self.design, &net, expansion, &self.effects);
            }
            let runs = &self.outputs[output].nets[k].runs;
            in_chunks(points, |chunk| {
                let net = Net::new(self.design, k as u64, chunk, &fit.families, fit.degree, runs);
                Contributions::new(self.design, &net, expansion, &self.effects)
            })
        });
        let nets = nets.collect();
        Corrected::new(&self.fitted, nets, expansions, &fit.families, &self.effects)
    }
}

#[cfg(test)]
mod tests;
