//! Held-out rows choose the way, and whether steps stay.

use rayon::prelude::*;

use super::basis::{Basis, Factor};
use super::prior::Prior;
use super::steps::add_steps;
use super::ways::{EffectVariances, Fits, Listed, Way};
use crate::surrogate::basis::Term;
use crate::surrogate::gram::add_scaled;
use apportion_base::sum::product;

/// Parts of which each is left out once, and of larger tables.
const FOLDS: usize = 8;
const FOLDS_ABOVE: usize = 5;
const MAX_ROWS_OF_FOLDS: usize = 200;

/// Share of the variance left on held-out rows above which steps are tried.
const EXACT: f64 = 1e-5;

/// Variance of a fit by dependent columns.
const UNBOUNDED: f64 = 10.0;

/// A fitted expansion of an output of variance 1.
pub(crate) struct Chaos {
    listed: Listed,
    coefficients: Vec<f64>,
    /// Its variances, corrected by the rows to which it is not fitted.
    pub variances: EffectVariances,
    /// Share of the variance left on held-out rows.
    pub rest: f64,
    /// Half width of the intervals of its indices.
    pub half_width: f64,
}

impl Chaos {
    /// Fits `y`, of mean 0 and variance 1, by `factors` at the same rows.
    pub fn new(factors: Vec<Factor>, y: &[f64]) -> Self {
        let best = Self::chosen(Prior::new(Basis { factors, rows: y.len() }, y.to_vec()));
        let mut chosen = if best.rest > EXACT { best.or_with_steps() } else { best };
        chosen.correct();
        chosen
    }

    /// Returns the fit with steps, if there are any and they leave less.
    fn or_with_steps(self) -> Self {
        let mut prior = self.listed.prior.clone();
        add_steps(&mut prior);
        if prior.steps.is_empty() {
            return self;
        }
        let mut other = Self::chosen(prior);
        other.half_width += other.open_at_steps();
        if other.half_width < self.half_width { other } else { self }
    }

    /// Returns the share of the variance that the gaps of the rows at steps leave open.
    fn open_at_steps(&self) -> f64 {
        let mut sum = 0.0;
        for (factor, total) in self.listed.prior.basis.factors.iter().zip(&self.variances.total) {
            for at in factor.steps() {
                let above = factor.places.iter().copied().filter(|u| u > at).fold(1.0, f64::min);
                let below = factor.places.iter().copied().filter(|u| u < at).fold(0.0, f64::max);
                sum += total / self.variances.all * (above - below) / (2.0 * at * (1.0 - at));
            }
        }
        sum
    }

    /// Returns the factors at the rows.
    pub fn basis(&self) -> &Basis {
        &self.listed.prior.basis
    }

    /// Iterates over the terms and their coefficients, without the constant.
    pub fn terms(&self) -> impl Iterator<Item = (&Term, f64)> {
        self.listed.terms.iter().zip(self.coefficients.iter().copied()).filter(|(_, c)| *c != 0.0)
    }

    /// Corrects the variances by the rows to which the expansion g is not fitted: the part 2 Cov(g_u, f - g) of each.
    fn correct(&mut self) {
        let Prior { basis, y, rows, .. } = &self.listed.prior;
        let others = *rows..basis.rows;
        if others.is_empty() {
            return;
        }
        let mut left = y[others.clone()].to_vec();
        for (term, c) in self.terms() {
            add_scaled(&mut left, -c, &basis.values(term, others.clone()));
        }
        let mean = apportion_base::sum::mean(&left);
        left.iter_mut().for_each(|e| *e -= mean);
        let terms: Vec<(&Term, f64)> = self.terms().collect();
        let moves: Vec<f64> = terms
            .par_iter()
            .map(|(term, c)| 2.0 * c * product(&basis.values(term, others.clone()), &left) / others.len() as f64)
            .collect();
        let mut variances = self.variances.clone();
        terms.iter().zip(moves).for_each(|((term, _), more)| variances.add(term, more));
        self.variances = variances;
    }

    fn chosen(prior: Prior) -> Self {
        let listed = Listed::new(prior);
        let rows = listed.prior.rows;
        let folds = folds_at(rows);
        let fold_of = folds_of_rows(rows, folds);
        // The last one leaves out none.
        let mut all: Vec<(Vec<usize>, Fits)> = (0..=folds)
            .into_par_iter()
            .map(|fold| {
                let (out, fitted): (Vec<usize>, Vec<usize>) = (0..rows).partition(|row| fold_of[*row] == fold);
                let fits = listed.fits(&fitted, &out);
                (out, fits)
            })
            .collect();
        let mut rests = [0.0; Way::ALL.len()];
        for (out, fits) in &all {
            for (rest, fit) in rests.iter_mut().zip(&fits.of_ways) {
                let squares = out.iter().zip(&fit.predictions).map(|(row, g)| (listed.prior.y[*row] - g).powi(2));
                *rest += squares.sum::<f64>() / rows as f64;
            }
        }
        let (_, Fits { mut of_ways, left }) = all.swap_remove(folds);
        let least = rests.iter().copied().fold(f64::INFINITY, f64::min);
        if listed.variances(&of_ways[3].coefficients).all > UNBOUNDED {
            rests[3] = f64::INFINITY;
        } else if left < 0.01 * least {
            // Exact: all rows determine terms that those of the folds did not.
            rests[3] = least;
        }
        let mut way = 3;
        for k in (0..3).rev() {
            way = if rests[k] < rests[way] { k } else { way };
        }
        let coefficients = of_ways.swap_remove(way).coefficients;
        let (rest, variances) = (rests[way], listed.variances(&coefficients));
        let half_width = rest + 4.0 * (rest / listed.prior.basis.rows as f64).sqrt();
        Self { listed, coefficients, variances, rest, half_width }
    }

    /// Returns first-order and total indices. What is left is rather an interaction than a part of one factor alone,
    /// and the more it is, the rather noise.
    pub fn indices(&self) -> (Vec<f64>, Vec<f64>) {
        let EffectVariances { first_order, total, all } = &self.variances;
        let first_order = first_order.iter().map(|v| v / (all + self.rest)).collect();
        (first_order, total.iter().map(|v| v / (all + self.rest * self.rest)).collect())
    }
}

/// Returns the number of parts of the rows, each of which is left out once.
pub(crate) fn folds_at(rows: usize) -> usize {
    if rows <= MAX_ROWS_OF_FOLDS { FOLDS } else { FOLDS_ABOVE }
}

/// Assigns rows to folds in pseudo-random order, always in the same way.
fn folds_of_rows(rows: usize, folds: usize) -> Vec<usize> {
    let mut order: Vec<(u64, usize)> = (0..rows).map(|row| (mixed(row as u64), row)).collect();
    order.sort_unstable();
    let mut fold_of = vec![0; rows];
    order.iter().enumerate().for_each(|(place, (_, row))| fold_of[*row] = place % folds);
    fold_of
}

/// Mixes the bits of a number (Steele, Lea and Flood 2014).
fn mixed(number: u64) -> u64 {
    let mut z = number.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests;
