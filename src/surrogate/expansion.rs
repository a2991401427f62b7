//! Expansions in orthonormal terms.

use std::sync::Arc;

use super::net::Net;
use super::terms::Term;
use apportion_base::sum::add_scaled;

/// An expansion in orthonormal terms.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    /// The terms, which expansions of many outputs share.
    pub terms: Arc<[Term]>,
    /// Their coefficients.
    pub coefficients: Vec<f64>,
}

impl Default for Expansion {
    fn default() -> Self {
        Self { terms: [].into(), coefficients: Vec::new() }
    }
}

impl Expansion {
    /// Iterates over the terms and their coefficients.
    pub fn iter(&self) -> impl Iterator<Item = (&Term, f64)> {
        self.terms.iter().zip(self.coefficients.iter().copied())
    }

    /// Iterates over the terms that are not constant, and their coefficients.
    pub fn varying(&self) -> impl Iterator<Item = (&Term, f64)> {
        self.iter().filter(|(term, _)| !term.is_empty())
    }
}

/// Returns the largest degree of a factor in the terms of some expansions.
pub(crate) fn degree<'a>(expansions: impl IntoIterator<Item = &'a Expansion>) -> usize {
    let terms = expansions.into_iter().flat_map(|of| of.terms.iter());
    terms.flatten().map(|(_, degree)| *degree).max().unwrap_or(0)
}

/// Returns the values of `expansion` at every run and point of `net`, and the residuals of the outputs.
pub(crate) fn values_and_rest(net: &Net, expansion: &Expansion) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
    let mut values = Vec::new();
    let mut surrogate = vec![vec![0.0; net.points()]; net.runs()];
    for (run, sums) in surrogate.iter_mut().enumerate() {
        for (term, b) in expansion.iter() {
            net.fill(term, run, &mut values);
            add_scaled(sums, b, &values);
        }
    }
    let pairs = net.outputs.iter().zip(&surrogate);
    let e = pairs.map(|(f, g)| f.iter().zip(g).map(|(f, g)| f - g).collect()).collect();
    (surrogate, e)
}
