//! Indices of the model as those of a surrogate, computed exactly, plus an estimate of the remainder from the runs.
//!
//! Net k is corrected by a surrogate g of the other nets, which is independent of it. With orthonormal terms phi_a of
//! coefficients b_a, e = f - g on net k, and r_a the mean of phi_a e over **all** of its rows,
//!
//! - V S_s = sum over a within s of (b_a^2 + 2 b_a r_a) + mean\[(e_B - mean e)(e_ABs - e_A)\],
//! - V ST_s = sum over a that touch s of (b_a^2 + 2 b_a r_a) + mean\[(e_A - e_ABs)^2\]/2,
//! - V = sum over a but the constant of (b_a^2 + 2 b_a r_a) + mean e^2 - (mean e)^2.
//!
//! This is because f = g + e. The terms linear in e have the exact value 2 sum b_a E\[phi_a e\], which all rows
//! estimate together; only the terms quadratic in e are left to pick-freeze rows. A second form of the total index,
//! that of g plus Jansen's estimate of f minus that of g, is better if g is poor; both are mixed by one weight. Every
//! number is a mean over base points, so that the contributions of the points give the error.

use crate::design::Design;
use crate::surrogate::expansion::values_and_rest;
use crate::surrogate::net::Net;
use crate::surrogate::{Effects, Expansion, is_interaction, touches, within};
use apportion_base::sum::add_scaled;

/// The contribution of every base point of a net to the numbers of an output; each number is the mean over the points.
pub struct Contributions {
    /// V S of every swap.
    pub first_order: Vec<Vec<f64>>,
    /// V ST of every swap, and the same by the second form.
    pub total: [Vec<Vec<f64>>; 2],
    /// V S_jk of the pairs of factors, in the order of the layout.
    pub pairs: Vec<Vec<f64>>,
    /// V.
    pub variance: Vec<f64>,
    /// The mean of the output.
    pub mean: Vec<f64>,
    /// Mean square and mean fourth power of e, the part not explained by the surrogate.
    pub residual: (f64, f64),
    /// For every swap, and for all factors last, the variance of the part of the surrogate that depends on them.
    pub claims: Vec<Claim>,
    /// Rows.
    pub rows: usize,
}

/// The variance of a part of a surrogate.
#[derive(Debug, Clone, Copy, Default)]
pub struct Claim {
    /// By its coefficients.
    pub claimed: f64,
    /// Over the rows.
    pub shown: f64,
}

/// Returns the mean of a power over all columns.
pub(crate) fn mean_power(columns: &[Vec<f64>], power: i32) -> f64 {
    let count: usize = columns.iter().map(Vec::len).sum();
    columns.iter().flatten().map(|e| e.powi(power)).sum::<f64>() / count.max(1) as f64
}

/// Returns the contribution of base point `p` to V S_jk by the outputs `y` of every run.
pub(crate) fn interaction(design: &Design, y: &[Vec<f64>], (j, k): (usize, usize), p: usize) -> f64 {
    let (ab, ba) = (design.ab_runs(), design.ba_runs());
    let of_jk = (y[ba[j]][p] - y[1][p]) * (y[ab[k]][p] - y[0][p]);
    let of_kj = (y[ba[k]][p] - y[1][p]) * (y[ab[j]][p] - y[0][p]);
    (of_jk + of_kj) / 2.0
}

/// Computes [`Contributions::claims`].
fn claims(net: &Net, expansion: &Expansion, swaps: &[Vec<usize>]) -> Vec<Claim> {
    let mut claims = vec![Claim::default(); swaps.len() + 1];
    let mut values = Vec::new();
    let mut sums = vec![0.0; claims.len()];
    let rows = (net.points() * net.runs()).max(1) as f64;
    for run in 0..net.runs() {
        let mut parts = vec![vec![0.0; net.points()]; claims.len()];
        for (term, b) in expansion.terms.iter().zip(&expansion.coefficients).filter(|(term, _)| !term.is_empty()) {
            net.fill(term, run, &mut values);
            for (at, part) in parts.iter_mut().enumerate() {
                if swaps.get(at).is_none_or(|swap| touches(term, swap)) {
                    add_scaled(part, *b, &values);
                    claims[at].claimed += if run == 0 { b * b } else { 0.0 };
                }
            }
        }
        for ((claim, sum), part) in claims.iter_mut().zip(&mut sums).zip(&parts) {
            for value in part {
                (*sum, claim.shown) = (*sum + value, claim.shown + value * value);
            }
        }
    }
    for (claim, sum) in claims.iter_mut().zip(sums) {
        claim.shown = claim.shown / rows - (sum / rows).powi(2);
    }
    claims
}

fn add(column: &mut [f64], value: &dyn Fn(usize) -> f64) {
    for (p, sum) in column.iter_mut().enumerate() {
        *sum += value(p);
    }
}

/// Returns half the square by which run number `run` of point `p` differs from its row of A.
pub(crate) fn half_square(y: &[Vec<f64>], run: usize, p: usize) -> f64 {
    (y[0][p] - y[run][p]).powi(2) / 2.0
}

impl Contributions {
    /// Returns zero contributions to `effects` at the points of `net`.
    pub(crate) fn zeros(effects: &Effects, net: &Net) -> Self {
        let (swaps, pairs) = (effects.swaps.len(), effects.pairs.len());
        let points = net.points();
        let zeros = vec![0.0; points];
        let of_swaps = vec![zeros.clone(); swaps];
        Self {
            first_order: of_swaps.clone(),
            total: [of_swaps.clone(), of_swaps],
            pairs: vec![zeros.clone(); pairs],
            variance: zeros.clone(),
            mean: zeros,
            residual: (0.0, 0.0),
            claims: Vec::new(),
            rows: points * net.runs(),
        }
    }

    /// Corrects `net` by the surrogate `expansion` of other nets.
    pub fn new(design: &Design, net: &Net, expansion: &Expansion, effects: &Effects) -> Self {
        let (surrogate, e) = values_and_rest(net, expansion);
        let mut all = Self::zeros(effects, net);
        all.residual = (mean_power(&e, 2), mean_power(&e, 4));
        all.claims = claims(net, expansion, &effects.swaps);
        all.add_surrogate(net, expansion, &e, effects);
        all.add_residual(design, net, &surrogate, &e, effects);
        all
    }

    /// Adds the terms that are constant or linear in `e`.
    fn add_surrogate(&mut self, net: &Net, expansion: &Expansion, e: &[Vec<f64>], effects: &Effects) {
        let runs = net.runs() as f64;
        let mut values = Vec::new();
        for (term, &b) in expansion.terms.iter().zip(&expansion.coefficients) {
            let mut products = vec![0.0; net.points()];
            for (run, e) in e.iter().enumerate() {
                net.fill(term, run, &mut values);
                for ((sum, value), e) in products.iter_mut().zip(&values).zip(e) {
                    *sum += value * e;
                }
            }
            if term.is_empty() {
                for (mean, e) in self.mean.iter_mut().zip(&products) {
                    *mean += b + e / runs;
                }
                continue;
            }
            let contributions: Vec<f64> = products.iter().map(|sum| b * b + 2.0 * b * sum / runs).collect();
            self.add_term(effects, term, [&|p| contributions[p], &|_| b * b]);
        }
    }

    /// Adds the contributions of a non-constant term at every point to the numbers to which it belongs, and to the
    /// second form of the total indices.
    pub(crate) fn add_term(
        &mut self,
        Effects { swaps, pairs }: &Effects,
        term: &[(usize, usize)],
        [first, second]: [&dyn Fn(usize) -> f64; 2],
    ) {
        add(&mut self.variance, first);
        for (number, swap) in swaps.iter().enumerate() {
            if within(term, swap) {
                add(&mut self.first_order[number], first);
            }
            if touches(term, swap) {
                add(&mut self.total[0][number], first);
                add(&mut self.total[1][number], second);
            }
        }
        for (column, &(j, k)) in self.pairs.iter_mut().zip(pairs) {
            if is_interaction(term, &swaps[j], &swaps[k]) {
                add(column, first);
            }
        }
    }

    /// Iterates over all columns of numbers.
    fn columns_mut(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        let [total, second] = &mut self.total;
        let lists = self.first_order.iter_mut().chain(total).chain(second).chain(&mut self.pairs);
        lists.chain([&mut self.variance, &mut self.mean])
    }

    /// Multiplies all numbers.
    pub(crate) fn scale(&mut self, factor: f64) {
        self.columns_mut().flatten().for_each(|value| *value *= factor);
    }

    /// Appends the points that follow.
    pub(crate) fn append(&mut self, mut following: Self) {
        let (mine, theirs) = (self.rows as f64, following.rows as f64);
        let mean = |a: f64, b: f64| (mine * a + theirs * b) / (mine + theirs).max(1.0);
        let (two, four) = following.residual;
        self.residual = (mean(self.residual.0, two), mean(self.residual.1, four));
        for (claim, more) in self.claims.iter_mut().zip(&following.claims) {
            claim.shown = mean(claim.shown, more.shown);
        }
        self.rows += following.rows;
        for (column, more) in self.columns_mut().zip(following.columns_mut()) {
            column.append(more);
        }
    }

    /// Adds the terms that are quadratic in `e`, by pick-freeze.
    fn add_residual(
        &mut self,
        design: &Design,
        net: &Net,
        surrogate: &[Vec<f64>],
        e: &[Vec<f64>],
        Effects { swaps, pairs }: &Effects,
    ) {
        let points = net.points();
        let (of_all, of_a_b) = (mean_power(e, 1), mean_power(&e[..2], 1));
        for (p, variance) in self.variance.iter_mut().enumerate() {
            *variance += e.iter().map(|run| (run[p] - of_all).powi(2)).sum::<f64>() / e.len() as f64;
        }
        for swap in 0..swaps.len() {
            let ab = design.ab_runs()[swap];
            for p in 0..points {
                self.first_order[swap][p] += (e[1][p] - of_a_b) * (e[ab][p] - e[0][p]);
                self.total[0][swap][p] += half_square(e, ab, p);
                self.total[1][swap][p] += half_square(&net.outputs, ab, p) - half_square(surrogate, ab, p);
            }
        }
        // The swaps with pairs come first.
        for (column, &pair) in self.pairs.iter_mut().zip(pairs) {
            add(column, &|p| interaction(design, e, pair, p));
        }
    }
}

#[cfg(test)]
#[path = "tests/contributions.rs"]
mod tests;
