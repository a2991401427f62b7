//! The terms of surrogates: their effects, and the largest of them.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::expansion::Expansion;
use crate::design::Design;
use crate::effect::Layout;

/// A product of polynomials of different factors: (factor, degree) by rising factor, degrees from 1; the empty one is the
/// constant.
pub type Term = Vec<(usize, usize)>;

/// Number of terms that are reported.
const MAX_LEADING_TERMS: usize = 12;

/// A term of a surrogate.
#[derive(Debug, Clone, PartialEq)]
pub struct SurrogateTerm {
    /// The factors in it, by index, each with its degree.
    pub factors: Vec<(usize, usize)>,
    /// Its share of the variance.
    pub share: f64,
}

impl SurrogateTerm {
    /// Returns the term with these names of factors or inputs.
    pub fn named(&self, names: &[&str]) -> NamedTerm {
        let degrees = self.factors.iter().map(|&(number, degree)| (names[number].to_owned(), degree));
        NamedTerm { degrees: degrees.collect(), share: 100.0 * self.share }
    }
}

/// A term of the surrogates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NamedTerm {
    /// The degree of its polynomial of each factor in it.
    pub degrees: BTreeMap<String, usize>,
    /// Its share of the variance, in percent.
    pub share: f64,
}

/// The effects whose numbers are corrected.
pub struct Effects {
    /// The factors of every swap, in rising order.
    pub swaps: Vec<Vec<usize>>,
    /// The pairs of swaps with second-order indices, in the order of the layout.
    pub pairs: Vec<(usize, usize)>,
}

impl Effects {
    /// Returns those of the swaps of `design` in `layout`.
    pub fn new(design: &Design, layout: &Layout) -> Self {
        let mut swaps: Vec<Vec<usize>> = design.swaps().to_vec();
        swaps.iter_mut().for_each(|swap| swap.sort_unstable());
        Self { swaps, pairs: if layout.second_order { layout.pair_list() } else { Vec::new() } }
    }
}

/// A member of a term or of a set of factors.
pub(crate) trait Member {
    fn factor(&self) -> usize;
}

impl Member for usize {
    fn factor(&self) -> usize {
        *self
    }
}

impl Member for (usize, usize) {
    fn factor(&self) -> usize {
        self.0
    }
}

/// Returns whether all factors of a term or a set are in a swap, and there are some.
pub(crate) fn within(term: &[impl Member], swap: &[usize]) -> bool {
    !term.is_empty() && term.iter().all(|member| swap.binary_search(&member.factor()).is_ok())
}

pub(crate) fn touches(term: &[impl Member], swap: &[usize]) -> bool {
    term.iter().any(|member| swap.binary_search(&member.factor()).is_ok())
}

/// Returns whether a term or a set has factors of two swaps, and none of others.
pub(crate) fn is_interaction<M: Member>(term: &[M], first: &[usize], second: &[usize]) -> bool {
    let is_theirs = |member: &M| first.contains(&member.factor()) || second.contains(&member.factor());
    touches(term, first) && touches(term, second) && term.iter().all(is_theirs)
}

/// Returns the terms of all surrogates by their mean share of the variance.
pub(crate) fn leading_terms(expansions: &[Expansion], variance: f64) -> Vec<SurrogateTerm> {
    let mut terms: BTreeMap<&Term, f64> = BTreeMap::new();
    for expansion in expansions {
        for (term, b) in expansion.varying() {
            *terms.entry(term).or_default() += b * b / variance / expansions.len() as f64;
        }
    }
    let mut terms: Vec<(&Term, f64)> = terms.into_iter().collect();
    terms.sort_by(|a, b| b.1.total_cmp(&a.1).then_with(|| a.0.cmp(b.0)));
    terms.truncate(MAX_LEADING_TERMS);
    terms.into_iter().map(|(term, share)| SurrogateTerm { factors: term.clone(), share }).collect()
}
