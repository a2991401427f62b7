//! Fits to all nets but one.

use rayon::prelude::*;

use super::basis::{Caps, Term, first_terms};
use super::chaos::{CrossFits, Factor, degree_at};
use super::family::Family;
use super::fit::{Expansion, NetSums, Training, fit, selection_rows, without};
use super::identifiable::IdentifiableTerms;
use super::net::Net;
use super::outputs::Scale;

/// Returns for every net the expansion fitted to the others.
pub fn cross_fitted(nets: &[Net], caps: Caps<'_>) -> Vec<Expansion> {
    let training: Vec<Training<'_>> = nets.iter().map(Training::new).collect();
    fitted_to_others(nets, &training, caps).into_iter().flatten().collect()
}

/// The surrogates of all nets.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossFitted {
    /// The units of the output.
    pub(crate) scale: Scale,
    /// The functions of every factor.
    pub families: Vec<Family>,
    /// For every net the expansion fitted to the others.
    pub of_nets: Vec<Expansion>,
}

/// Maximum number of rows to which Bayesian chaos is fitted: the others correct its error.
const ROWS: usize = 1 << 11;

/// Returns for every net the expansion of its output, in units of `scale`, fitted to the others by Bayesian chaos, in
/// polynomials of `families`, with steps and kinks.
pub(crate) fn fitted_by_chaos(nets: &[Net], families: &[Family], scale: Scale) -> CrossFitted {
    let rows = rows_of_nets(nets);
    let y: Vec<f64> = rows.iter().map(|&(k, run, point)| nets[k].outputs[run][point]).collect();
    let degree = degree_at(rows.len());
    let factors = families.par_iter().enumerate().map(|(factor, family)| {
        let u: Vec<f64> = rows.iter().map(|&(k, run, point)| nets[k].quantiles(run, factor)[point]).collect();
        Factor::new(family, &u, degree)
    });
    let fits = CrossFits::new(factors.collect(), y, rows.iter().map(|(k, ..)| *k).collect());
    let families = fits.families();
    let of_nets = fits.expansions(&families);
    CrossFitted { scale, families, of_nets }
}

/// Returns the first rows (net, run, base point) of all nets in turn: those of A and of B, which tell most, then one of the
/// others at each point, another one at the next.
fn rows_of_nets(nets: &[Net]) -> Vec<(usize, usize, usize)> {
    let points = nets.iter().map(Net::points).max().unwrap_or(0);
    let runs = nets.iter().map(Net::runs).max().unwrap_or(0);
    let plain = (0..runs.min(2)).flat_map(|run| (0..points).map(move |point| (run, point)));
    let others = runs.saturating_sub(2);
    let swapped = (0..others).flat_map(|turn| (0..points).map(move |point| (2 + (point + turn) % others, point)));
    let rows = plain.chain(swapped).flat_map(|(run, point)| (0..nets.len()).map(move |k| (k, run, point)));
    rows.filter(|&(k, run, point)| run < nets[k].runs() && point < nets[k].points()).take(ROWS).collect()
}

/// Returns for every net the expansions of all outputs fitted to the `training` runs of the others.
pub(crate) fn fitted_to_others(nets: &[Net], training: &[Training<'_>], caps: Caps<'_>) -> Vec<Vec<Expansion>> {
    let identifiable = IdentifiableTerms::new(nets, caps);
    let (candidates, rows) = (first_round(nets, &identifiable), selection_rows(nets.len() - 1));
    let sums: Vec<NetSums> = training.par_iter().map(|net| NetSums::new(net, &candidates, rows)).collect();
    let fits = (0..nets.len()).into_par_iter();
    let fits = fits.map(|k| fit(&without(training, k), &candidates, &without(&sums, k), &identifiable));
    fits.collect()
}

/// Returns the expansion fitted to all nets except number `k`.
pub(crate) fn expansion_without(nets: &[Net], k: usize, caps: Caps<'_>) -> Expansion {
    let identifiable = IdentifiableTerms::new(nets, caps);
    let training: Vec<Training<'_>> = nets.iter().map(Training::new).collect();
    let (others, rows, candidates) =
        (without(&training, k), selection_rows(nets.len() - 1), first_round(nets, &identifiable));
    let sums: Vec<NetSums> = others.iter().map(|net| NetSums::new(net, &candidates, rows)).collect();
    fit(&others, &candidates, &sums.iter().collect::<Vec<_>>(), &identifiable).swap_remove(0)
}

/// Returns the candidates of the first round.
fn first_round(nets: &[Net], identifiable: &IdentifiableTerms<'_>) -> Vec<Term> {
    let training = nets.len() - 1;
    let rows = selection_rows(training);
    let all_rows = nets.iter().map(|net| rows.min(net.points() * net.runs())).sum::<usize>() * training / nets.len();
    let caps = identifiable.caps;
    identifiable.retain(first_terms(caps, caps.terms.min(20.max(2 * all_rows))))
}
