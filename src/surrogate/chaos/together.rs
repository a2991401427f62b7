//! Many outputs by the same terms, those of the directions in which they differ.
//!
//! Bayesian chaos is fitted to each direction: its terms and their variances are those of all outputs. An output is the sum
//! of its directions, and ridge regression on the terms adds what they leave of it.

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;

use super::basis::{Basis, Factor};
use super::cross_fits::CrossFits;
use super::directions::{Directions, Output};
use super::linear::{Cholesky, Panels, Symmetric};
use crate::surrogate::expansion::Expansion;
use crate::surrogate::terms::Term;
use apportion_base::sum::{add_scaled, product};

/// Maximum number of terms of all outputs together.
const MAX_TERMS: usize = 150;

/// Variances of the noise that are tried, as shares of the variance of the terms.
const NOISES: [f64; 5] = [1e-12, 1e-9, 1e-6, 1e-4, 1e-2];

/// Terms at the rows of each part.
struct Shared {
    rows: Vec<Vec<usize>>,
    terms: Arc<[Term]>,
    /// Standard deviations of their coefficients.
    sizes: Vec<f64>,
    columns: Vec<Panels>,
    /// For each part the inner products of the scaled columns.
    grams: Vec<Symmetric>,
    /// For each part, the factor by the rows of the others with each noise.
    factors: Vec<Vec<Option<Cholesky>>>,
}

/// Returns for each part of the rows the expansion of every output, in the polynomials of `factors` at these rows,
/// that is fitted to the others.
pub(crate) fn expansions_together(factors: &[Factor], outputs: Vec<Vec<f64>>, parts: &[usize]) -> Vec<Vec<Expansion>> {
    let count = parts.iter().max().map_or(0, |last| last + 1);
    let directions = Directions::new(outputs.clone());
    let of_directions = CrossFits::smooth(factors.to_vec(), directions.values, parts.to_vec()).expansions();
    let (terms, variances) = leading_terms(&directions.outputs, &of_directions);
    let basis = Basis { factors: factors.to_vec(), rows: parts.len(), parts: parts.to_vec() };
    let shared = Shared::new(terms, &variances, &basis, count);
    let columns = (0..count).map(|k| of_directions.iter().map(|of| coefficients(&of[k], &shared.terms)).collect());
    let columns: Vec<Vec<Vec<f64>>> = columns.collect();
    let pairs = directions.outputs.par_iter().zip(outputs);
    let of_outputs: Vec<Vec<Expansion>> = pairs.map(|(output, y)| shared.expansions(output, &y, &columns)).collect();
    (0..count).map(|k| of_outputs.iter().map(|of| of[k].clone()).collect()).collect()
}

/// Returns the constant and the terms that contribute most to all outputs together, each with its mean square
/// coefficient.
fn leading_terms(outputs: &[Output], of_directions: &[Vec<Expansion>]) -> (Vec<Term>, Vec<f64>) {
    let mut squares: BTreeMap<&Term, f64> = BTreeMap::new();
    for (direction, of_parts) in of_directions.iter().enumerate() {
        let weight = outputs.iter().map(|output| output.weights[direction].powi(2)).sum::<f64>();
        let weight = weight / (outputs.len() * of_parts.len()) as f64;
        for (term, c) in of_parts.iter().flat_map(Expansion::varying) {
            *squares.entry(term).or_default() += weight * c * c;
        }
    }
    let mut squares: Vec<(&Term, f64)> = squares.into_iter().collect();
    squares.sort_by(|a, b| b.1.total_cmp(&a.1).then_with(|| a.0.cmp(b.0)));
    squares.truncate(MAX_TERMS);
    let all = squares.iter().map(|of| of.1).sum();
    std::iter::once((Term::new(), all)).chain(squares.into_iter().map(|(term, v)| (term.clone(), v))).unzip()
}

/// Returns the coefficient of each of `terms`.
fn coefficients(expansion: &Expansion, terms: &[Term]) -> Vec<f64> {
    let all: BTreeMap<&Term, f64> = expansion.iter().collect();
    terms.iter().map(|term| all.get(term).copied().unwrap_or(0.0)).collect()
}

impl Shared {
    fn new(terms: Vec<Term>, variances: &[f64], basis: &Basis, parts: usize) -> Self {
        let sizes: Vec<f64> = variances.iter().map(|v| v.sqrt()).collect();
        let rows: Vec<Vec<usize>> = (0..parts).map(|part| basis.without(part).1).collect();
        let columns = rows.par_iter().map(|rows| {
            let mut columns = Panels::zeros(rows.len(), terms.len());
            for (j, (term, size)) in terms.iter().zip(&sizes).enumerate() {
                let values = basis.values(term, 0..basis.rows);
                columns.set_column(j, rows.iter().map(|row| size * values[*row]));
            }
            columns
        });
        let columns: Vec<Panels> = columns.collect();
        let grams: Vec<Symmetric> = columns.par_iter().map(|columns| Symmetric::products(columns, columns)).collect();
        let all: f64 = variances.iter().sum();
        let factors = (0..parts).into_par_iter().map(|part| {
            let mut gram = Symmetric::zeros(terms.len());
            grams.iter().enumerate().filter(|(k, _)| *k != part).for_each(|(_, other)| gram.add(1.0, other));
            let of_noises = NOISES.map(|noise| {
                let mut matrix = gram.clone();
                matrix.add_to_diagonal(noise * all);
                Cholesky::new(matrix)
            });
            of_noises.into()
        });
        let factors = factors.collect();
        Self { rows, terms: terms.into(), sizes, columns, grams, factors }
    }

    /// Returns for each part the expansion of an output with the values `y`, given the coefficients of every direction:
    /// what the sum of its directions leaves is regressed with the noise that leaves least of all parts.
    fn expansions(&self, output: &Output, y: &[f64], directions: &[Vec<Vec<f64>>]) -> Vec<Expansion> {
        let sums = directions.iter().map(|columns| {
            let mut sum = vec![0.0; self.terms.len()];
            sum[0] = output.mean;
            output.weights.iter().zip(columns).for_each(|(w, column)| add_scaled(&mut sum, *w, column));
            sum
        });
        let mut sums: Vec<Vec<f64>> = sums.collect();
        let more = sums.iter().enumerate().map(|(part, sum)| self.regressed(part, sum, y));
        let more: Vec<Vec<(Vec<f64>, f64)>> = more.collect();
        let squares = (0..=NOISES.len()).map(|way| more.iter().map(|of_part| of_part[way].1).sum::<f64>());
        let best = squares.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(way, _)| way);
        for (sum, of_part) in sums.iter_mut().zip(&more) {
            sum.iter_mut().zip(&self.sizes).zip(&of_part[best].0).for_each(|((c, size), b)| *c += size * b);
        }
        sums.into_iter().map(|coefficients| Expansion { terms: Arc::clone(&self.terms), coefficients }).collect()
    }

    /// Returns for none and each noise the coefficients of the scaled terms by the rows of the other parts, of what an
    /// expansion leaves of `y`, and what is left of this `part`.
    fn regressed(&self, part: usize, expansion: &[f64], y: &[f64]) -> Vec<(Vec<f64>, f64)> {
        let scaled = expansion.iter().zip(&self.sizes).map(|(c, size)| if *size > 0.0 { c / size } else { 0.0 });
        let scaled: Vec<f64> = scaled.collect();
        let (mut right, mut held, mut square) = (vec![0.0; self.terms.len()], Vec::new(), 0.0);
        for (k, (columns, rows)) in self.columns.iter().zip(&self.rows).enumerate() {
            let left = rows.iter().zip(columns.combined(&scaled)).map(|(row, g)| y[*row] - g);
            let left: Vec<f64> = left.collect();
            let products = columns.weighted_sums(&left);
            if k == part {
                (square, held) = (product(&left, &left), products);
            } else {
                add_scaled(&mut right, 1.0, &products);
            }
        }
        let none = (vec![0.0; self.terms.len()], square);
        let of_noises = self.factors[part].iter().map(|factor| {
            let Some(factor) = factor else { return (none.0.clone(), f64::INFINITY) };
            let b = factor.solve(&right);
            let left = square - 2.0 * product(&b, &held) + product(&b, &self.grams[part].times(&b));
            (b, left)
        });
        std::iter::once(none.clone()).chain(of_noises).collect()
    }
}
