//! Held-out rows choose the way, and whether steps and kinks stay.

use rayon::prelude::*;

use super::basis::{Basis, Factor};
use super::kernel::MAX_ORDER;
use super::knots::with_knots;
use super::prior::{MAX_ROWS, Prior};
use super::product::Product;
use super::ways::{EffectVariances, Fit, Fits, Listed, Way};
use crate::surrogate::Term;
use apportion_base::sum::add_scaled;
use apportion_base::sum::product;

/// Parts of which each is left out once, and of larger tables.
const FOLDS: usize = 8;
const FOLDS_ABOVE: usize = 5;
const MAX_ROWS_OF_FOLDS: usize = 200;

/// Share of the variance left on held-out rows above which steps and kinks are tried.
pub(super) const EXACT: f64 = 1e-5;

/// The ratio of what a product leaves alone to what the best fit without it leaves, up to which it is tried as one term.
const TRIED: f64 = 10.0;

/// The ratio of what is left that counts as clearly less.
const CLEARLY_LESS: f64 = 0.5;

/// Share of the variance that no rows show that counts as unknown, for each unit of the residual's standard deviation.
const CLOSE: f64 = 10.0;

/// Share of the mean square of a step at which a row shows it.
const SHOWN: f64 = 0.05;

/// Part of a gap by which a step may be misplaced. Measured on steps in a part of the rows: a quarter covers .82, a half
/// everything, with one and a half times the runs.
const OPEN: f64 = 0.35;

/// Errors of indices by rounding.
const ROUNDING: f64 = 1e-12;

/// Variance of a fit by dependent columns.
const UNBOUNDED: f64 = 10.0;

/// A fitted expansion of an output of variance 1.
#[derive(Debug)]
pub(crate) struct Chaos {
    listed: Listed,
    coefficients: Vec<f64>,
    /// Its variances, corrected by the rows to which it is not fitted.
    pub variances: EffectVariances,
    /// What these rows add to the variance of each set; none if it is fitted to all.
    moves: Vec<f64>,
    /// For each part of the rows that are fitted the same without it.
    of_parts: Vec<FittedPart>,
    /// What is left of every row by the fit without its part.
    pub left: Vec<f64>,
    /// Share of the variance left on held-out rows.
    pub rest: f64,
    /// Whether it has a product as one term.
    has_product: bool,
    /// The unit of what the product leaves, to which the other terms are fitted.
    scale: f64,
}

/// A fit without one part of the rows.
#[derive(Debug)]
struct FittedPart {
    coefficients: Vec<f64>,
    variances: EffectVariances,
}

impl Chaos {
    /// Fits `y`, of mean 0 and variance 1, by `factors` at the same rows, and with a product if the sum of `y` and `offset`
    /// has one sign.
    pub fn new(factors: Vec<Factor>, y: &[f64], offset: Option<f64>) -> Self {
        let parts = parts_of_rows(y.len().min(MAX_ROWS));
        let best = Self::chosen(Prior::new(Basis { factors, rows: y.len(), parts }, vec![y.to_vec()], MAX_ORDER), None);
        let mut chosen = if best.rest > EXACT { best.or_with_knots() } else { best };
        if let Some(offset) = offset.filter(|_| chosen.rest > EXACT) {
            chosen = chosen.or_with_product(y, offset);
        }
        chosen.correct(y);
        chosen
    }

    /// Returns the fit with a product as one term, if it leaves less.
    fn or_with_product(self, y: &[f64], offset: f64) -> Self {
        let factors = self.basis().factors.iter().map(Factor::without_knots).collect();
        let basis = Basis { factors, ..self.basis().clone() };
        let rows = self.listed.prior.rows;
        let Some(product) = Product::new(&basis, &y[..rows], offset, |prior| {
            let listed = Listed::new(prior);
            let way = Held::new(&listed, None).way;
            (listed, way)
        }) else {
            return self;
        };
        if product.scale() * product.scale() > TRIED * self.rest {
            return self;
        }
        let mut left = product.left(basis.count_parts());
        left.resize(y.len(), 0.0);
        let other = Self::chosen(Prior::new(basis, vec![left], MAX_ORDER), Some(&product));
        if other.rest < CLEARLY_LESS * self.rest && other.variances.all.is_finite() { other } else { self }
    }

    /// Returns the fit with steps and kinks, if there are any and they leave less open.
    fn or_with_knots(self) -> Self {
        let Some(prior) = with_knots(&self.listed.prior) else { return self };
        let other = Self::chosen(prior, None);
        if other.half_width() < self.half_width() { other } else { self }
    }

    /// Returns the share of the variance that the gaps at steps of the rows that show them leave open: the steps are independent.
    fn open_at_steps(&self) -> f64 {
        let mut sum = 0.0;
        for (number, factor) in self.listed.prior.basis.factors.iter().enumerate() {
            for (k, knot) in factor.knots().iter().enumerate().filter(|(_, knot)| !knot.is_kink) {
                let jumps = self.listed.jumps(&self.coefficients, number, k);
                let square = product(&jumps, &jumps) / jumps.len() as f64;
                let gap = factor.gap(knot.u, |row| jumps.get(row).is_none_or(|jump| jump * jump > SHOWN * square));
                sum += (square / self.variances.all * gap * OPEN).powi(2);
            }
        }
        sum.sqrt()
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
    fn correct(&mut self, y: &[f64]) {
        let Prior { basis, rows, .. } = &self.listed.prior;
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
        let terms = (0..self.coefficients.len()).filter(|j| self.coefficients[*j] != 0.0);
        let moves: Vec<(usize, f64)> = terms
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(|j| {
                let (set, values) = (self.listed.set_of(j), basis.values(&self.listed.terms[j], others.clone()));
                (set, 2.0 * self.coefficients[j] * product(&values, &left) / others.len() as f64)
            })
            .collect();
        let mut of_sets = vec![0.0; self.listed.sets.len()];
        let mut variances = self.variances.clone();
        for (number, more) in moves {
            variances.add(&self.listed.sets[number], more);
            of_sets[number] += more;
        }
        (self.variances, self.moves) = (variances, of_sets);
    }

    fn chosen(prior: Prior, product: Option<&Product>) -> Self {
        let listed = Listed::new(prior);
        let Held { coefficients, of_parts, rest, .. } = Held::new(&listed, product);
        let joined = |part: usize, coefficients: Vec<f64>| match product {
            Some(product) => product.joined(&listed, part, &coefficients),
            None => (listed.variances(&coefficients), coefficients),
        };
        let scale = product.map_or(1.0, Product::scale);
        let mut left = vec![0.0; listed.prior.rows];
        for (part, fit) in of_parts.iter().enumerate() {
            let (_, out) = listed.prior.basis.without(part);
            out.iter().zip(&fit.left).for_each(|(row, e)| left[*row] = e * scale);
        }
        let (variances, coefficients) = joined(of_parts.len(), coefficients);
        let of_parts = of_parts.into_par_iter().enumerate().map(|(part, fit)| {
            let (variances, coefficients) = joined(part, fit.coefficients);
            FittedPart { coefficients, variances }
        });
        let of_parts = of_parts.collect();
        let (rest, has_product) = (rest * scale * scale, product.is_some());
        Self { listed, coefficients, variances, moves: Vec::new(), of_parts, left, rest, has_product, scale }
    }

    /// Returns a bound on the error of its indices that grows with what it leaves, without that by the places of steps.
    pub fn half_width(&self) -> f64 {
        self.rest + 4.0 * (self.rest / self.listed.prior.basis.rows as f64).sqrt() + self.unseen_by_terms()
    }

    /// Returns the share of the variance that no rows show, where it may be wrong.
    pub fn unseen(&self) -> f64 {
        self.unseen_by_terms() + self.open_at_steps()
    }

    fn unseen_by_terms(&self) -> f64 {
        // A close fit is right where there are no rows too, and a product has its variance from integrals.
        let share = (CLOSE * self.rest.sqrt()).min(1.0);
        ROUNDING + if self.has_product { 0.0 } else { self.listed.unseen(&self.coefficients, share) }
    }

    /// Returns the sets of factors that have terms.
    pub fn sets(&self) -> &[Vec<usize>] {
        &self.listed.sets
    }

    /// Returns the sum of the terms of each set at the rows that are fitted, by the fit without their part.
    pub fn values_of_sets(&self) -> Vec<Vec<f64>> {
        let of_parts: Vec<Vec<f64>> = self.of_parts.iter().map(|of| of.coefficients.clone()).collect();
        self.listed.values_of_sets(&of_parts)
    }

    /// Returns the outputs at these rows.
    pub fn fitted_outputs(&self) -> &[f64] {
        &self.listed.prior.y()[..self.listed.prior.rows]
    }

    /// Returns the mean of what the terms leave of the rows that are fitted.
    pub fn constant(&self) -> f64 {
        let g = self.listed.combined(&self.coefficients);
        let left = self.fitted_outputs().iter().zip(g).map(|(y, g)| y - g);
        apportion_base::sum::mean(&left.collect::<Vec<f64>>())
    }

    /// Returns the variance that the prior takes for noise.
    pub fn noise(&self) -> f64 {
        self.scale * self.scale * self.listed.prior.noise_variance()
    }

    /// Returns the variance of the terms of each set, and those by the fits without each part.
    pub fn variances_of_sets(&self) -> (Vec<f64>, Vec<Vec<f64>>) {
        let of_parts = self.of_parts.par_iter().map(|of| self.listed.variances_of_sets(&of.coefficients));
        let mut all = self.listed.variances_of_sets(&self.coefficients);
        all.iter_mut().zip(&self.moves).for_each(|(variance, more)| *variance += more);
        (all, of_parts.collect())
    }

    /// Returns the variances of the fits without each part; those of a product are integrals.
    pub fn variances_of_parts(&self) -> impl Iterator<Item = &EffectVariances> {
        self.of_parts.iter().map(|of| &of.variances)
    }
}

/// The way that leaves least of held-out rows.
struct Held {
    way: usize,
    coefficients: Vec<f64>,
    /// The fits without each part.
    of_parts: Vec<Fit>,
    /// Mean square that it leaves.
    rest: f64,
}

impl Held {
    /// Chooses among the ways to the coefficients of `listed`, of what a `product` fitted to the same rows leaves.
    fn new(listed: &Listed, product: Option<&Product>) -> Self {
        let parts = listed.prior.basis.count_parts();
        // The last one leaves out none.
        let (mut all, mut rests) = fits(listed, parts + 1, listed.prior.y(), product);
        let Fits { mut of_ways, left } = all.swap_remove(parts);
        let least = rests.iter().copied().fold(f64::INFINITY, f64::min);
        let (last, held) = (rests.len() - 1, best_way(&rests));
        if is_unbounded(listed, &of_ways[last]) {
            rests[last] = f64::INFINITY;
        } else if left < 0.01 * least {
            // Exact: all rows determine terms that those of the folds did not.
            rests[last] = least;
        }
        let way = best_way(&rests);
        let held = if way == last { held } else { way };
        let of_parts = all.into_iter().map(|mut fits| fits.of_ways.swap_remove(held)).collect();
        Self { way, coefficients: of_ways.swap_remove(way).coefficients, of_parts, rest: rests[way] }
    }
}
/// Returns the fits to `y` without each of the first `parts` parts of the rows, or to what a `product` fitted to the same
/// rows leaves, and the mean square that each way leaves of the rows that are left out.
pub(super) fn fits(listed: &Listed, parts: usize, y: &[f64], product: Option<&Product>) -> (Vec<Fits>, Vec<f64>) {
    let parts = (0..parts).into_par_iter().map(|part| {
        let left = product.map(|product| product.left(part));
        listed.fits(part, left.as_deref().unwrap_or(y))
    });
    let all: Vec<Fits> = parts.collect();
    let rest = |way: usize| all.iter().map(|fits| fits.of_ways[way].square()).sum::<f64>() / listed.prior.rows as f64;
    let rests = (0..Way::ALL.len()).map(rest).collect();
    (all, rests)
}

/// Returns whether the columns of a fit depend on each other.
pub(super) fn is_unbounded(listed: &Listed, fit: &Fit) -> bool {
    listed.variances(&fit.coefficients).all > UNBOUNDED
}

/// Returns the way that leaves least; of equal ones the last.
pub(super) fn best_way(rests: &[f64]) -> usize {
    let last = rests.len() - 1;
    (0..last).rev().fold(last, |best, way| if rests[way] < rests[best] { way } else { best })
}

/// Returns the number of parts of the rows, each of which is left out once.
pub(crate) fn folds_at(rows: usize) -> usize {
    if rows <= MAX_ROWS_OF_FOLDS { FOLDS } else { FOLDS_ABOVE }
}

/// Assigns rows to parts in pseudo-random order, always in the same way.
fn parts_of_rows(rows: usize) -> Vec<usize> {
    let mut order: Vec<(u64, usize)> = (0..rows).map(|row| (mixed(row as u64), row)).collect();
    order.sort_unstable();
    let mut parts = vec![0; rows];
    order.iter().enumerate().for_each(|(place, (_, row))| parts[*row] = place % folds_at(rows));
    parts
}

/// Mixes the bits of a number (Steele, Lea and Flood 2014).
pub(super) fn mixed(number: u64) -> u64 {
    let mut z = number.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
#[path = "tests/choice.rs"]
mod tests;
