//! Four ways to the coefficients of the leading terms, each from the one before it.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::basis::Inner;
use super::linear::{Cholesky, LANES, Panels, Symmetric};
use super::prior::Prior;
use super::squares::Squares;
use crate::surrogate::Term;

/// How coefficients are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// Posterior means under the prior.
    Prior,
    /// The same with variances of subsets of factors learnt (MacKay 1992).
    Subsets,
    /// The same with the variance of each term learnt.
    Terms,
    /// Least squares on the largest coefficients.
    LeastSquares,
}

impl Way {
    pub const ALL: [Self; 4] = [Self::Prior, Self::Subsets, Self::Terms, Self::LeastSquares];
}

/// Rows up to which the covariance of the outputs is used; above it the Gram matrix of the terms.
const MAX_ROWS_OF_COVARIANCE: usize = 600;

/// Terms of a table of few rows, for each row and at most; the same of many rows.
const TERMS_OF_ROW: usize = 4;
const MAX_TERMS: usize = 500;
const ROWS_OF_TERM: usize = 2;
const MAX_TERMS_OF_GRAM: usize = 600;

/// Standard errors of a mean over the rows that are chance.
const CHANCE: f64 = 1.0;

/// The way of every update of the variances.
const PLAN: [Way; 6] = [Way::Prior, Way::Subsets, Way::Subsets, Way::Subsets, Way::Terms, Way::Terms];

/// The same for many rows, which determine more: the noise is learnt first.
const PLAN_OF_GRAM: [Way; 5] = [Way::Prior, Way::Prior, Way::Subsets, Way::Terms, Way::Terms];

/// The variances of an expansion.
#[derive(Debug, Clone)]
pub struct EffectVariances {
    /// V S of every factor.
    pub first_order: Vec<f64>,
    /// V ST of every factor.
    pub total: Vec<f64>,
    /// V.
    pub all: f64,
}

impl EffectVariances {
    fn zeros(factors: usize) -> Self {
        Self { first_order: vec![0.0; factors], total: vec![0.0; factors], all: 0.0 }
    }

    /// Adds a part of the variance of a set of factors.
    pub fn add(&mut self, set: &[usize], variance: f64) {
        self.all += variance;
        set.iter().for_each(|factor| self.total[*factor] += variance);
        if let [factor] = set {
            self.first_order[*factor] += variance;
        }
    }
}

/// The leading terms of a prior at the rows.
#[derive(Debug)]
pub struct Listed {
    pub prior: Prior,
    pub terms: Vec<Term>,
    variances: Vec<f64>,
    /// A column for each term.
    columns: Panels,
    /// For few rows the covariance of what is not listed, and noise; for many the inner products of the columns in
    /// each part of the rows.
    matrices: Vec<Symmetric>,
    /// The number of the set of factors of each term.
    subsets: Vec<usize>,
    /// The sets.
    pub sets: Vec<Vec<usize>>,
    inner: Vec<Inner>,
}

/// The coefficients of one way.
#[derive(Debug, Clone)]
pub struct Fit {
    pub coefficients: Vec<f64>,
    /// What is left of the rows that were left out.
    pub left: Vec<f64>,
}

impl Fit {
    fn new(coefficients: Vec<f64>, predictions: &[f64], held: &[f64]) -> Self {
        Self { coefficients, left: held.iter().zip(predictions).map(|(y, g)| y - g).collect() }
    }

    /// Returns the sum of squares of what is left.
    pub fn square(&self) -> f64 {
        self.left.iter().map(|e| e * e).sum()
    }
}

/// The rows without one part, and the outputs.
struct Training {
    columns: Panels,
    rows: Vec<usize>,
    y: Vec<f64>,
    part: usize,
    out: Vec<usize>,
    held: Vec<f64>,
}

/// The fits of all ways.
pub struct Fits {
    pub of_ways: Vec<Fit>,
    /// Mean square of the rows left out one by one by least squares.
    pub left: f64,
}

/// What the rows say about the coefficients under some variances.
struct Posterior {
    coefficients: Vec<f64>,
    /// The share of each coefficient that the rows determine.
    learnt: Vec<f64>,
}

impl Listed {
    pub fn new(prior: Prior) -> Self {
        let rows = prior.rows;
        let is_small = rows <= MAX_ROWS_OF_COVARIANCE;
        let count =
            if is_small { (TERMS_OF_ROW * rows).min(MAX_TERMS) } else { (rows / ROWS_OF_TERM).min(MAX_TERMS_OF_GRAM) };
        let (variances, terms): (Vec<f64>, Vec<Term>) = prior.leading_terms(count).into_iter().unzip();
        let values: Vec<Vec<f64>> = terms.par_iter().map(|term| prior.basis.values(term, 0..rows)).collect();
        let columns = Panels::from_columns(rows, values.iter().map(Vec::as_slice));
        let matrices = if is_small {
            let by_rows = Panels::from_rows(rows, values.iter().map(Vec::as_slice));
            let mut matrix = prior.covariance();
            matrix.add(-1.0, &covariance(&by_rows, &variances));
            vec![matrix]
        } else {
            let parts = (0..prior.basis.count_parts()).into_par_iter();
            let of_parts = parts.map(|part| at_rows(&columns, &prior.basis.without(part).1));
            of_parts.map(|columns| Symmetric::products(&columns, &columns)).collect()
        };
        let mut numbers: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
        let subsets = terms.iter().map(|term| {
            let next = numbers.len();
            *numbers.entry(term.iter().map(|(factor, _)| *factor).collect()).or_insert(next)
        });
        let subsets = subsets.collect();
        let mut sets = vec![Vec::new(); numbers.len()];
        numbers.into_iter().for_each(|(set, number)| sets[number] = set);
        let inner = prior.basis.factors.iter().map(Inner::new).collect();
        Self { prior, terms, variances, columns, matrices, subsets, sets, inner }
    }

    fn is_small(&self) -> bool {
        self.prior.rows <= MAX_ROWS_OF_COVARIANCE
    }

    /// Returns the fits to the outputs `y` at the rows without one `part`.
    pub fn fits(&self, part: usize, y: &[f64]) -> Fits {
        let (rows, out) = self.prior.basis.without(part);
        let [held, y] = [&out, &rows].map(|rows| rows.iter().map(|row| y[*row]).collect::<Vec<f64>>());
        let training = Training { columns: at_rows(&self.columns, &rows), rows, y, part, out, held };
        let mut fits = if self.is_small() { self.by_covariance(&training) } else { self.by_gram(&training) };
        let Training { columns, y, out, held, .. } = &training;
        // Digits lost: the ways that are left repeat the last one.
        let last = fits.last().cloned().unwrap_or_else(|| {
            let mean = y.iter().sum::<f64>() / y.len() as f64;
            Fit::new(vec![0.0; self.terms.len()], &vec![mean; out.len()], held)
        });
        fits.resize(Way::ALL.len() - 1, last);
        let Squares { coefficients, mean, left } = Squares::new(columns, y, &fits[2].coefficients, &self.variances);
        let predictions = self.predicted(&coefficients, mean, out);
        fits.push(Fit::new(coefficients, &predictions, held));
        Fits { of_ways: fits, left }
    }

    /// Returns the sum of the terms at the rows.
    pub fn combined(&self, coefficients: &[f64]) -> Vec<f64> {
        self.columns.combined(coefficients)
    }

    /// Returns by how much the sum rises at a step of a factor, at the rows.
    pub fn jumps(&self, coefficients: &[f64], factor: usize, number: usize) -> Vec<f64> {
        let of = &self.prior.basis.factors[factor];
        let index = of.degree() + 1 + number;
        let own = self.terms.iter().zip(coefficients);
        let own: Vec<f64> = own.map(|(term, c)| if term.contains(&(factor, index)) { *c } else { 0.0 }).collect();
        let step = of.function(index);
        let ends = step.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], s| [low.min(*s), high.max(*s)]);
        self.combined(&own).iter().zip(step).map(|(value, s)| value / s * (ends[1] - ends[0])).collect()
    }

    /// Returns the same with a mean at some of them.
    fn predicted(&self, coefficients: &[f64], mean: f64, rows: &[usize]) -> Vec<f64> {
        let all = self.combined(coefficients);
        rows.iter().map(|row| all[*row] + mean).collect()
    }

    fn by_covariance(&self, Training { columns, rows, y, out, held, .. }: &Training) -> Vec<Fit> {
        let unlisted = &self.matrices[0];
        let rest = unlisted.at_rows(rows);
        let by_rows = transposed(columns);
        let (mut fits, mut learning) = (Vec::new(), Learning::new(self));
        for (step, way) in PLAN.iter().enumerate() {
            learning.update(*way, self);
            let mut matrix = covariance(&by_rows, &learning.variances);
            matrix.add(1.0, &rest);
            let Some(factor) = Cholesky::new(matrix) else { break };
            let weights = factor.solve(y);
            let products = columns.weighted_sums(&weights);
            let shares = factor.whitened_squares(columns);
            let variances = &learning.variances;
            learning.posterior = Posterior {
                coefficients: variances.iter().zip(&products).map(|(v, p)| v * p).collect(),
                learnt: variances.iter().zip(&shares).map(|(v, s)| (v * s).clamp(0.0, 1.0)).collect(),
            };
            if PLAN.get(step + 1) != Some(way) {
                learning.base.clone_from(&learning.variances);
                let mut predictions = self.predicted(&learning.posterior.coefficients, 0.0, out);
                for (prediction, row) in predictions.iter_mut().zip(out) {
                    *prediction +=
                        rows.iter().zip(&weights).map(|(other, w)| unlisted.at(*row, *other) * w).sum::<f64>();
                }
                fits.push(Fit::new(learning.posterior.coefficients.clone(), &predictions, held));
            }
        }
        fits
    }

    fn by_gram(&self, Training { columns, y, part, out, held, .. }: &Training) -> Vec<Fit> {
        let n = y.len() as f64;
        let mean = y.iter().sum::<f64>() / n;
        let means: Vec<f64> = columns.weighted_sums(&vec![1.0 / n; y.len()]);
        let centred: Vec<f64> = y.iter().map(|y| y - mean).collect();
        let right = columns.weighted_sums(&centred);
        let square: f64 = centred.iter().map(|y| y * y).sum();
        let mut gram = Symmetric::zeros(self.terms.len());
        self.matrices.iter().enumerate().filter(|(k, _)| k != part).for_each(|(_, of_part)| gram.add(1.0, of_part));
        gram.add_outer(-n, &means);
        let (mut fits, mut learning) = (Vec::new(), Learning::new(self));
        let mut noise: f64 = 1e-4;
        for (step, way) in PLAN_OF_GRAM.iter().enumerate() {
            learning.update(*way, self);
            let roots: Vec<f64> = learning.variances.iter().map(|v| v.sqrt()).collect();
            let mut matrix = gram.clone();
            matrix.scale(&roots);
            matrix.add_to_diagonal(noise);
            let Some(factor) = Cholesky::new(matrix) else { break };
            let scaled: Vec<f64> = right.iter().zip(&roots).map(|(b, s)| b * s).collect();
            let c: Vec<f64> = factor.solve(&scaled).iter().zip(&roots).map(|(x, s)| x * s).collect();
            let learnt: Vec<f64> =
                factor.inverse_diagonal().iter().map(|v| (1.0 - noise * v).clamp(0.0, 1.0)).collect();
            let fitted: f64 = gram.times(&c).iter().zip(&c).zip(&right).map(|((a, c), b)| c * (a - 2.0 * b)).sum();
            let size: f64 = learning.variances.iter().enumerate().map(|(j, v)| v * gram.at(j, j)).sum();
            noise = ((square + fitted) / (n - learnt.iter().sum::<f64>()).max(1.0)).max(1e-14 * size);
            learning.posterior = Posterior { coefficients: c, learnt };
            if PLAN_OF_GRAM.get(step + 1) != Some(way) {
                learning.base.clone_from(&learning.variances);
                let c = &learning.posterior.coefficients;
                let mean = mean - c.iter().zip(&means).map(|(c, m)| c * m).sum::<f64>();
                fits.push(Fit::new(c.clone(), &self.predicted(c, mean, out), held));
            }
        }
        fits
    }

    /// Returns the variances of the expansion with these coefficients.
    pub fn variances(&self, coefficients: &[f64]) -> EffectVariances {
        let mut variances = EffectVariances::zeros(self.prior.basis.factors.len());
        self.sets.iter().zip(self.variances_of_sets(coefficients)).for_each(|(set, v)| variances.add(set, v));
        variances
    }

    /// Returns the number of the set of factors of a term.
    pub fn set_of(&self, term: usize) -> usize {
        self.subsets[term]
    }

    /// Returns the variance of the terms of each set of factors.
    pub fn variances_of_sets(&self, coefficients: &[f64]) -> Vec<f64> {
        self.members(coefficients).iter().map(|members| self.variance(members, coefficients)).collect()
    }

    /// Returns the sum of the terms of each set of factors at the rows, each with the coefficients of its part of them.
    pub fn values_of_sets(&self, of_parts: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let parts = &self.prior.basis.parts;
        let mut values = vec![vec![0.0; parts.len()]; self.sets.len()];
        for (j, set) in self.subsets.iter().enumerate() {
            let rows = values[*set].iter_mut().zip(parts).zip(self.columns.column(j));
            rows.for_each(|((value, part), phi)| *value += of_parts[*part][j] * phi);
        }
        values
    }

    /// Returns for every set of factors its terms that have coefficients.
    fn members(&self, coefficients: &[f64]) -> Vec<Vec<usize>> {
        let mut of_sets = vec![Vec::new(); self.sets.len()];
        for (j, set) in self.subsets.iter().enumerate().filter(|(j, _)| coefficients[*j] != 0.0) {
            of_sets[*set].push(j);
        }
        of_sets
    }

    /// Returns the variance of some terms of one subset.
    fn variance(&self, members: &[usize], coefficients: &[f64]) -> f64 {
        let mut variance = 0.0;
        for (place, &a) in members.iter().enumerate() {
            variance += coefficients[a] * coefficients[a] * self.inner(a, a);
            for &b in &members[..place] {
                variance += 2.0 * coefficients[a] * coefficients[b] * self.inner(a, b);
            }
        }
        variance
    }

    /// Returns the variance that no rows show: of each subset of factors what exceeds the mean square of its terms at
    /// the rows by more than chance. It comes from where there are none. A `share` of it counts, and all of what is due to
    /// counts and levels, where polynomials continue nothing.
    pub fn unseen(&self, coefficients: &[f64], share: f64) -> f64 {
        let (rows, factors) = (self.prior.rows as f64, &self.prior.basis.factors);
        let of_subsets = self.members(coefficients).into_par_iter().map(|members| {
            let mut of_subset = vec![0.0; coefficients.len()];
            members.iter().for_each(|j| of_subset[*j] = coefficients[*j]);
            let squares: Vec<f64> = self.combined(&of_subset).iter().map(|g| g * g).collect();
            let mean = squares.iter().sum::<f64>() / rows;
            let spread = squares.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / rows;
            let excess = self.variance(&members, coefficients) - mean - CHANCE * (spread / rows).sqrt();
            let set = members.first().map_or(&[][..], |j| &self.sets[self.subsets[*j]]);
            // What rows at other levels show tells nothing of a level.
            let is_open = set.iter().any(|factor| factors[*factor].family().has_levels());
            if is_open { excess.max(0.0) } else { share * excess.max(0.0) }
        });
        of_subsets.collect::<Vec<f64>>().iter().sum()
    }

    /// Returns the inner product of two terms of the same factors.
    fn inner(&self, a: usize, b: usize) -> f64 {
        let pairs = self.terms[a].iter().zip(&self.terms[b]);
        pairs.map(|((factor, k), (_, l))| self.inner[*factor].at(*k, *l)).product()
    }
}

/// The variances that the ways learn.
struct Learning {
    variances: Vec<f64>,
    base: Vec<f64>,
    posterior: Posterior,
}

impl Learning {
    fn new(listed: &Listed) -> Self {
        let posterior = Posterior { coefficients: Vec::new(), learnt: Vec::new() };
        Self { variances: listed.variances.clone(), base: listed.variances.clone(), posterior }
    }

    fn update(&mut self, way: Way, listed: &Listed) {
        let Posterior { coefficients, learnt } = &self.posterior;
        match way {
            Way::Subsets => {
                let count = listed.subsets.iter().max().map_or(0, |most| most + 1);
                let (mut squares, mut shares) = (vec![0.05; count], vec![0.05; count]);
                for (j, subset) in listed.subsets.iter().enumerate() {
                    squares[*subset] += coefficients[j] * coefficients[j] / listed.variances[j];
                    shares[*subset] += learnt[j];
                }
                for (j, subset) in listed.subsets.iter().enumerate() {
                    self.variances[j] = listed.variances[j] * (squares[*subset] / shares[*subset]);
                }
            }
            Way::Terms => {
                for (j, variance) in self.variances.iter_mut().enumerate() {
                    let c = coefficients[j];
                    *variance = (0.1 * self.base[j] + c * c + *variance * (1.0 - learnt[j])) / 1.1;
                }
            }
            Way::Prior | Way::LeastSquares => {}
        }
    }
}

/// Returns the covariance of rows by terms with these variances.
fn covariance(by_rows: &Panels, variances: &[f64]) -> Symmetric {
    let mut scaled = by_rows.clone();
    scaled.scale_rows(variances);
    Symmetric::products(&scaled, by_rows)
}

fn at_rows(columns: &Panels, rows: &[usize]) -> Panels {
    let mut chosen = Panels::zeros(rows.len(), columns.columns);
    for p in 0..columns.panels() {
        let from = columns.panel(p);
        chosen.panel_mut(p).iter_mut().zip(rows).for_each(|(to, row)| *to = from[*row]);
    }
    chosen
}

fn transposed(matrix: &Panels) -> Panels {
    let mut other = Panels::zeros(matrix.columns, matrix.rows);
    for p in 0..matrix.panels() {
        for (i, row) in matrix.panel(p).iter().enumerate() {
            let count = matrix.columns - p * LANES;
            let to = &mut other.panel_mut(i / LANES)[p * LANES..];
            to.iter_mut().zip(row).take(count).for_each(|(to, value)| to[i % LANES] = *value);
        }
    }
    other
}
