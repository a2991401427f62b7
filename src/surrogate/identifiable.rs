//! Selection of the terms that the rows of the nets can determine.
//!
//! Polynomials are orthonormal in the distribution of their factor, and over the rows only as far as these represent
//! it. For a rare level that no row has, or a thin tail, one of them is constant over the rows, or two are the same
//! column; a fit accepts either, and the variance that it claims is that of the distribution, (1 - p)/p times too large
//! for a level of probability p. A term with levels in it is therefore a candidate only if its mean square over the
//! rows of every net is close to 1, and a factor with a thin tail has polynomials only if that of degree 1 has this
//! over all nets together.

use super::basis::{Caps, Term};
use super::family::Family;
use super::net::{Net, Spread};

/// Allowed range of the mean square of a term over the rows of a net. If half as many rows as expected have a level,
/// the mean square of its polynomial is a half.
const MIN_MEAN_SQUARE: f64 = 0.5;
const MAX_MEAN_SQUARE: f64 = 2.0;

/// Maximum number of rows of a net by which products of polynomials are judged.
const ROWS: usize = 2000;

/// The candidates that the rows of some nets can determine.
pub struct IdentifiableTerms<'a> {
    nets: &'a [Net],
    /// The other limits on the terms.
    pub(crate) caps: Caps<'a>,
    /// For each factor, the highest degree up to which the rows of every net can determine all polynomials.
    degrees: Vec<usize>,
    /// For each net, the rows by which products are judged.
    rows: Vec<Vec<(usize, usize)>>,
}

impl<'a> IdentifiableTerms<'a> {
    /// Computes the limits from the rows of `nets`.
    pub fn new(nets: &'a [Net], caps: Caps<'a>) -> Self {
        let mut degrees = Vec::with_capacity(caps.families.len());
        for (factor, family) in caps.families.iter().enumerate() {
            let spreads: Vec<Vec<Spread>> = nets.iter().map(|net| net.spreads(factor)).collect();
            degrees.push(match family.smooth() {
                Family::Orthogonal(polynomials) if polynomials.has_levels() => {
                    spreads.iter().map(|net| identifiable_degrees(net)).min().unwrap_or(0)
                }
                // What no row of a tail shows is a part of the error of polynomials without bounds, and of high degree.
                _ if family.is_unbounded() => usize::MAX,
                Family::Orthogonal(_) if identifiable_degrees(&[mean_of_first(&spreads)]) == 0 => 0,
                _ => usize::MAX,
            });
        }
        let rows = nets.iter().map(|net| net.spaced_rows(ROWS)).collect();
        Self { nets, caps, degrees, rows }
    }

    /// Returns those of `terms` that the rows can determine.
    pub fn retain(&self, terms: Vec<Term>) -> Vec<Term> {
        terms.into_iter().filter(|term| self.is_identifiable(term)).collect()
    }

    fn is_identifiable(&self, term: &Term) -> bool {
        if !term.iter().all(|(factor, degree)| *degree <= self.degrees[*factor]) {
            return false;
        }
        if term.len() < 2 || !term.iter().any(|(factor, _)| has_levels(&self.caps.families[*factor])) {
            return true;
        }
        self.nets.iter().zip(&self.rows).all(|(net, rows)| {
            let square = net.at(term, rows).iter().map(|value| value * value).sum::<f64>() / rows.len() as f64;
            (MIN_MEAN_SQUARE..=MAX_MEAN_SQUARE).contains(&square)
        })
    }
}

fn has_levels(family: &Family) -> bool {
    matches!(family, Family::Orthogonal(polynomials) if polynomials.has_levels())
}

/// Returns how many of the first degrees have a mean square close to 1, given the spread of every degree over some
/// rows: 0 for a constant column.
fn identifiable_degrees(spreads: &[Spread]) -> usize {
    spreads
        .iter()
        .take_while(|of| of.square - of.mean * of.mean >= MIN_MEAN_SQUARE && of.square <= MAX_MEAN_SQUARE)
        .count()
}

/// Returns the spread of the polynomial of degree 1 over all nets.
fn mean_of_first(spreads: &[Vec<Spread>]) -> Spread {
    let mut sum = Spread::default();
    for first in spreads.iter().filter_map(|net| net.first()) {
        sum.mean += first.mean;
        sum.square += first.square;
    }
    let nets = spreads.len() as f64;
    Spread { mean: sum.mean / nets, square: sum.square / nets }
}

#[cfg(test)]
mod tests;
