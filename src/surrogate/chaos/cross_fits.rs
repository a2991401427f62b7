//! Fits without each part of the rows, for which the others correct them.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::basis::{Basis, Factor};
use super::choice::{EXACT, best_way, fits, is_unbounded};
use super::kernel::MAX_ORDER;
use super::knots::with_knots;
use super::prior::Prior;
use super::ways::Listed;
use crate::surrogate::Expansion;
use crate::surrogate::Term;
use crate::surrogate::family::Family;

/// Share of what is left that the smallest coefficients may add to it.
const DROPPED: f64 = 0.01;

/// Expansions of one or more outputs in the same terms, each fitted without one part of the rows. All rows determine
/// their hyperparameters, steps and kinks.
pub(crate) struct CrossFits {
    listed: Listed,
    of_outputs: Vec<CrossFit>,
}

/// The fits to one output.
struct CrossFit {
    /// The coefficients without each part.
    coefficients: Vec<Vec<f64>>,
    /// Share of the variance left on the parts that are left out.
    rest: f64,
}

impl CrossFits {
    /// Fits `y`, of mean about 0 and variance about 1, by `factors` at the same rows, which belong to these `parts`.
    pub fn new(factors: Vec<Factor>, y: Vec<f64>, parts: Vec<usize>) -> Self {
        let first = Self::smooth(factors, vec![y], parts);
        let knots = if first.rest() > EXACT { with_knots(&first.listed.prior) } else { None };
        let other = knots.map(Self::fitted).filter(|other| other.rest() < first.rest());
        other.unwrap_or(first)
    }

    /// Fits such `outputs` by polynomials alone, with the same hyperparameters.
    pub fn smooth(factors: Vec<Factor>, outputs: Vec<Vec<f64>>, parts: Vec<usize>) -> Self {
        Self::fitted(Prior::new(Basis { factors, rows: parts.len(), parts }, outputs, MAX_ORDER))
    }

    fn fitted(prior: Prior) -> Self {
        let listed = Listed::new(prior);
        let of_outputs = listed.prior.outputs.par_iter().map(|y| CrossFit::new(&listed, y)).collect();
        Self { listed, of_outputs }
    }

    /// Returns the largest share that is left of an output.
    fn rest(&self) -> f64 {
        self.of_outputs.iter().map(|of| of.rest).fold(0.0, f64::max)
    }

    /// Returns the functions of every factor in the expansions: polynomials, with steps and kinks.
    pub fn families(&self) -> Vec<Family> {
        self.listed.prior.basis.factors.iter().map(Factor::with_knots).collect()
    }

    /// Returns for each output, and each part of the rows, the expansion that is fitted to the others.
    pub fn expansions(&self) -> Vec<Vec<Expansion>> {
        let families = self.families();
        let outputs = self.of_outputs.par_iter().zip(&self.listed.prior.outputs);
        let of_outputs = outputs.map(|(fit, y)| {
            let parts = fit.coefficients.par_iter().enumerate();
            parts.map(|(part, coefficients)| fit.expansion(&self.listed, y, part, coefficients, &families)).collect()
        });
        of_outputs.collect()
    }
}

impl CrossFit {
    fn new(listed: &Listed, y: &[f64]) -> Self {
        let (all, mut rests) = fits(listed, listed.prior.basis.count_parts(), y, None);
        let last = rests.len() - 1;
        if all.iter().any(|fits| is_unbounded(listed, &fits.of_ways[last])) {
            rests[last] = f64::INFINITY;
        }
        let way = best_way(&rests);
        let coefficients = all.into_iter().map(|mut fits| fits.of_ways.swap_remove(way).coefficients).collect();
        Self { coefficients, rest: rests[way] }
    }

    /// Returns the expansion of `y` with these coefficients, without the smallest ones, of which it shows no difference.
    fn expansion(
        &self,
        listed: &Listed,
        y: &[f64],
        part: usize,
        coefficients: &[f64],
        families: &[Family],
    ) -> Expansion {
        let mut sums: BTreeMap<Term, f64> = BTreeMap::new();
        for (term, c) in without_smallest(listed.terms.iter().zip(coefficients), DROPPED * self.rest) {
            for (term, part) in expanded(term, families) {
                *sums.entry(term).or_default() += part * c;
            }
        }
        let list = without_smallest(sums.iter(), DROPPED * self.rest);
        let mut sums: BTreeMap<Term, f64> = list.into_iter().map(|(term, c)| (term.clone(), c)).collect();
        let g = listed.combined(coefficients);
        let left = listed.prior.basis.without(part).0.into_iter().map(|row| y[row] - g[row]);
        sums.insert(Term::new(), apportion_base::sum::mean(&left.collect::<Vec<f64>>()));
        let (terms, coefficients): (Vec<Term>, Vec<f64>) = sums.into_iter().unzip();
        Expansion { terms: terms.into(), coefficients }
    }
}

/// Returns terms without those of the smallest coefficients, whose squares have at most this `sum`.
fn without_smallest<'a>(terms: impl Iterator<Item = (&'a Term, &'a f64)>, sum: f64) -> Vec<(&'a Term, f64)> {
    let mut list: Vec<(&Term, f64)> = terms.filter(|(_, c)| **c != 0.0).map(|(term, c)| (term, *c)).collect();
    list.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()).then(a.0.cmp(b.0)));
    let mut dropped = 0.0;
    while let Some((_, c)) = list.last() {
        dropped += c * c;
        if dropped > sum {
            break;
        }
        list.pop();
    }
    list
}

/// Returns the expansion in orthonormal functions of a term, which may have knots.
fn expanded(term: &Term, families: &[Family]) -> Vec<(Term, f64)> {
    let mut all = vec![(Term::new(), 1.0)];
    for (factor, index) in term {
        let parts = match &families[*factor] {
            Family::Stepped(stepped) => stepped.parts(*index),
            _ => vec![(*index, 1.0)],
        };
        let longer = all.iter().flat_map(|(before, c)| {
            parts.iter().map(move |(index, part)| {
                (before.iter().copied().chain([(*factor, *index)]).collect::<Term>(), c * part)
            })
        });
        all = longer.collect();
    }
    all
}
