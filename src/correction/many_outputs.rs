//! Surrogates of the outputs of one run: of each output alone, or of many, whose runs failed at the same points, by the
//! directions in which they differ.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::contributions::Contributions;
use super::estimates::SurrogateEstimates;
use super::nets::{Corrected, estimates, in_chunks};
use crate::design::Design;
use crate::effect::Layout;
use crate::estimate::PointOutputs;
use crate::surrogate::expansion::degree;
use crate::surrogate::family::Family;
use crate::surrogate::net::Net;
use crate::surrogate::outputs::ScaledOutput;
use crate::surrogate::{
    CrossFitted, Effects, Expansion, FittedRows, MIN_POINTS, choices, fitted_design, placed, takes_surrogates,
};

/// Maximum number of outputs that are fitted one by one, with steps and kinks.
const MAX_ALONE: usize = 32;

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
    if outputs.len() <= MAX_ALONE || known.iter().any(Option::is_some) || !takes_surrogates(design, outputs[0].len()) {
        let alone = outputs.par_iter().zip(known);
        return alone.map(|(of, known)| surrogate_estimates(design, families, layout, of, *known)).collect();
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
        let (numbers, scaled): (Vec<usize>, Vec<&ScaledOutput>) = members.into_iter().unzip();
        let estimates = fit_outputs(design, families, layout, &complete, &scaled, None);
        numbers.into_iter().zip(estimates).for_each(|(number, of)| all[number] = of);
    }
    all
}

/// Fits `outputs` with values at the `complete` points of every replicate together, unless the surrogates of the only
/// one are `known`.
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
    if complete.iter().any(|points| points.len() < MIN_POINTS) {
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

/// All outputs fitted in some polynomials.
struct Fit {
    families: Vec<Family>,
    degree: usize,
    nets: Vec<Net>,
    /// For every net the expansions of all outputs, fitted to the other nets.
    expansions: Vec<Vec<Expansion>>,
}

impl Together<'_> {
    /// Fits all polynomials that come into question.
    fn fit_trials(&self) -> Vec<Fit> {
        choices(self.families).into_iter().map(|families| self.fit(families)).collect()
    }

    /// Fits all outputs in polynomials of `families`.
    fn fit(&self, families: Vec<Family>) -> Fit {
        let nets: Vec<Net> = (0..self.outputs[0].nets.len()).map(|k| self.net(k, &families, 0)).collect();
        let rows = FittedRows::new(&nets, &families);
        if let [output] = self.outputs {
            let of_nets: Vec<&[Vec<f64>]> = nets.iter().map(|net| &net.outputs[..]).collect();
            return self.known(&rows.fitted(&of_nets, output.scale));
        }
        let outputs = self.complete.iter().map(|output| output.nets.iter().map(|net| &net.runs[..]).collect());
        self.with_nets(families, rows.smooth(&outputs.collect::<Vec<_>>()))
    }

    /// Returns the fit with surrogates of the only output, its steps placed by all rows: they move by so little that the
    /// coefficients stay.
    fn known(&self, known: &CrossFitted) -> Fit {
        let nets: Vec<Net> = (0..known.of_nets.len()).map(|k| self.net(k, &known.families, 0)).collect();
        self.with_nets(placed(&nets, known), known.of_nets.iter().map(|of_net| vec![of_net.clone()]).collect())
    }

    fn with_nets(&self, families: Vec<Family>, expansions: Vec<Vec<Expansion>>) -> Fit {
        let degree = degree(expansions.iter().flatten());
        let numbers = (0..expansions.len()).into_par_iter();
        Fit { nets: numbers.map(|k| self.net(k, &families, degree)).collect(), families, degree, expansions }
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
            if best.as_ref().is_none_or(|(_, best)| next.unknown() < best.unknown()) {
                best = Some((fit, next));
            }
        }
        let (fit, best) = best?;
        let scale = self.outputs[output].scale;
        let best = best.with_unseen_levels(&fit.nets, &self.complete[output], &fit.families);
        let all = estimates(&best, &[], scale);
        let fitted = CrossFitted { scale, families: fit.families.clone(), of_nets: best.expansions };
        Some(SurrogateEstimates { fitted: Some(fitted), ..all })
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
#[path = "tests/many_outputs.rs"]
mod tests;
