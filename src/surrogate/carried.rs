//! Selection of the terms that the rows of the nets can determine.
//!
//! Polynomials are orthonormal in the distribution of their factor, and over the rows only as far as these represent
//! it. For a rare level that no row has, or a thin tail, one of them is constant over the rows, or two are the same
//! column; a fit accepts either, and the variance that it claims is that of the distribution, (1 - p)/p times too large
//! for a level of probability p. A term with levels in it is therefore a candidate only if its mean square over the
//! rows of every net is close to 1, and a factor with a thin tail has polynomials only if that of degree 1 has this
//! over all nets together.

use super::basis::{Caps, Family, Term};
use super::net::Net;

/// Allowed range of the mean square of a term over the rows of a net. If half as many rows as expected have a level,
/// the mean square of its polynomial is a half.
const MIN_MEAN_SQUARE: f64 = 0.5;
const MAX_MEAN_SQUARE: f64 = 2.0;

/// Maximum number of rows of a net by which products of polynomials are judged.
const ROWS: usize = 2000;

/// The candidates that the rows of some nets can determine.
pub struct Carried<'a> {
    nets: &'a [Net],
    caps: Caps<'a>,
    /// For each factor, the highest degree up to which the rows of every net can determine all polynomials.
    degrees: Vec<usize>,
    /// For each net, the rows by which products are judged.
    rows: Vec<Vec<(usize, usize)>>,
}

impl<'a> Carried<'a> {
    /// Computes the limits from the rows of `nets`.
    pub fn new(nets: &'a [Net], caps: Caps<'a>) -> Self {
        let of_factor = |(factor, family): (usize, &Family)| {
            let spreads: Vec<_> = nets.iter().map(|net| net.spreads(factor)).collect();
            match family.smooth() {
                Family::Own(own) if own.has_levels() => {
                    spreads.iter().map(|net| carried_degrees(net)).min().unwrap_or(0)
                }
                // The behaviour of polynomials of high degree in thin tails is a part of their error.
                Family::Own(_) if carried_degrees(&[mean_of_first(&spreads)]) == 0 => 0,
                _ => usize::MAX,
            }
        };
        let degrees = caps.families.iter().enumerate().map(of_factor).collect();
        let rows = nets.iter().map(|net| net.spaced_rows(ROWS)).collect();
        Self { nets, caps, degrees, rows }
    }

    /// Returns the other limits on the terms.
    pub fn caps(&self) -> Caps<'a> {
        self.caps
    }

    /// Returns those of `terms` that the rows can determine.
    pub fn retain(&self, terms: Vec<Term>) -> Vec<Term> {
        terms.into_iter().filter(|term| self.carries(term)).collect()
    }

    fn carries(&self, term: &Term) -> bool {
        let has_levels =
            |(factor, _): &(usize, usize)| matches!(&self.caps.families[*factor], Family::Own(own) if own.has_levels());
        if !term.iter().all(|(factor, degree)| *degree <= self.degrees[*factor]) {
            return false;
        }
        if term.len() < 2 || !term.iter().any(has_levels) {
            return true;
        }
        self.nets.iter().zip(&self.rows).all(|(net, rows)| {
            let square = net.at(term, rows).iter().map(|value| value * value).sum::<f64>() / rows.len() as f64;
            (MIN_MEAN_SQUARE..=MAX_MEAN_SQUARE).contains(&square)
        })
    }
}

/// Returns how many of the first degrees have a mean square close to 1, given the mean squares of every degree and the
/// squares of the means over some rows: 0 for a constant column.
fn carried_degrees(spreads: &[(f64, f64)]) -> usize {
    spreads
        .iter()
        .take_while(|(mean, square)| square - mean * mean >= MIN_MEAN_SQUARE && *square <= MAX_MEAN_SQUARE)
        .count()
}

/// Returns the mean and mean square of the polynomial of degree 1 over all nets.
fn mean_of_first(spreads: &[Vec<(f64, f64)>]) -> (f64, f64) {
    let first = spreads.iter().filter_map(|net| net.first());
    let (mean, square) = first.fold((0.0, 0.0), |sum, of| (sum.0 + of.0, sum.1 + of.1));
    (mean / spreads.len() as f64, square / spreads.len() as f64)
}

#[cfg(test)]
mod tests;
