//! The prior of the coefficients, and its hyperparameters by marginal likelihood.
//!
//! c_a has variance s_|a| times the product over its factors of w_i l_ik, with l_ik proportional to
//! exp(-alpha_i (k - 1) + gamma_i [k even]) k^-beta and of sum 1. A step or a hinge has its own l.

use super::basis::Basis;
use super::kernel::{Kernel, Likelihood, Variances};
use super::linear::Symmetric;
use super::optimise::{Bounds, minimise};
use crate::surrogate::Term;
use crate::surrogate::stepped::Knot;

/// Maximum number of rows to which coefficients are fitted: more hardly change some hundred of them, and the others
/// correct their error.
pub const MAX_ROWS: usize = 1 << 12;

/// Degree at which the hyperparameters are fitted.
pub const FITTED_DEGREE: usize = 14;

/// Rows that determine them first, of up to so many factors: above it fewer, since each factor costs the square of the rows.
/// Twice as many improve them.
const FITTED_ROWS: usize = 200;
const MAX_FACTORS: usize = 64;

/// Steps of the optimiser for them.
const ITERATIONS: usize = 60;
const MORE_ITERATIONS: usize = 12;

/// Mean square of the rows left out one by one above which the optimum may be a wrong one.
const POOR: f64 = 0.25;

/// The prior of an output, or of several. The logarithms of the hyperparameters, and gamma itself, are in this order: w of each
/// factor, alpha of each, beta, s of each order, noise, gamma of each factor, l of each knot.
#[derive(Debug, Clone)]
pub struct Prior {
    pub basis: Basis,
    /// The outputs, of mean 0 and variance 1.
    pub outputs: Vec<Vec<f64>>,
    /// The first rows, to which coefficients are fitted.
    pub rows: usize,
    order: usize,
    /// Degree of the polynomials by which the hyperparameters are fitted.
    degree: usize,
    theta: Vec<f64>,
    /// The factor of each knot and its number there, in the order in which they came.
    pub knots: Vec<(usize, usize)>,
}

impl Prior {
    /// Fits the hyperparameters of terms of at most `order` factors.
    pub fn new(basis: Basis, outputs: Vec<Vec<f64>>, order: usize) -> Self {
        let order = order.min(basis.factors.len());
        let rows = basis.rows.min(MAX_ROWS);
        let mut prior =
            Self { basis, outputs, rows, order, degree: FITTED_DEGREE, theta: Vec::new(), knots: Vec::new() };
        let fitted = prior.fitted_rows();
        let kernel = prior.basis.kernel(fitted, prior.degree);
        prior.theta = prior.descend(&kernel, prior.start(&kernel), ITERATIONS);
        let left = prior.left_one_out(&kernel, &prior.theta);
        // All may count as noise there: once more from rough interactions.
        if left > POOR {
            let other = prior.descend(&kernel, prior.rough_start(), ITERATIONS);
            if prior.left_one_out(&kernel, &other) < left {
                prior.theta = other;
            }
        }
        if rows > fitted {
            prior.refine();
        }
        prior
    }

    /// Returns the number of rows that determine the hyperparameters first.
    pub fn fitted_rows(&self) -> usize {
        let many = (self.basis.factors.len() as f64 / MAX_FACTORS as f64).max(1.0);
        self.rows.min((FITTED_ROWS as f64 / many.sqrt()) as usize)
    }

    /// Improves the hyperparameters by more rows. The noise of the first ones may be far too small, so that a line
    /// search in it comes first.
    fn refine(&mut self) {
        let kernel = self.basis.kernel(self.rows.min(2 * self.fitted_rows()), self.degree);
        let mut best = (f64::INFINITY, self.theta.clone());
        for k in 0..6 {
            let mut theta = self.theta.clone();
            theta[self.noise()] += 2.3 * f64::from(k);
            let value = self.value(&kernel, &theta);
            if value < best.0 {
                best = (value, theta);
            }
        }
        self.theta = self.descend(&kernel, best.1, MORE_ITERATIONS);
    }

    fn beta(&self) -> usize {
        2 * self.basis.factors.len()
    }

    /// Returns the variance of the noise.
    pub fn noise_variance(&self) -> f64 {
        libm::exp(self.theta[self.noise()])
    }

    fn noise(&self) -> usize {
        self.beta() + 1 + self.order
    }

    /// Returns the index of the first gamma.
    fn gamma(&self) -> usize {
        self.noise() + 1
    }

    fn start(&self, kernel: &Kernel) -> Vec<f64> {
        let n = kernel.rows as f64;
        // Effects of degree 1 to 3, less what noise would give.
        let effects = kernel.functions.iter().map(|functions| {
            let of_outputs = self.outputs.iter().map(|y| {
                let sums = (0..functions.rows.min(3)).map(|k| {
                    let column = (0..functions.panels()).flat_map(|p| functions.panel(p)[k]);
                    column.zip(y).map(|(f, y)| f * y).sum::<f64>() / n
                });
                sums.map(|mean| mean * mean).sum::<f64>() - 3.0 / n
            });
            (of_outputs.sum::<f64>() / self.outputs.len() as f64).max(0.02)
        });
        let orders = (0..self.order).map(|q| if q == 0 { 0.0 } else { -1.0 });
        self.assembled(effects.map(libm::log).collect(), 0.7, 1.5, orders.collect())
    }

    fn rough_start(&self) -> Vec<f64> {
        let strongest = 1.min(self.order - 1);
        let orders = (0..self.order).map(|q| if q == strongest { 0.0 } else { -4.0 });
        self.assembled(vec![0.0; self.basis.factors.len()], 0.1, 0.5, orders.collect())
    }

    fn assembled(&self, mut theta: Vec<f64>, alpha: f64, beta: f64, orders: Vec<f64>) -> Vec<f64> {
        let factors = self.basis.factors.len();
        theta.extend(vec![libm::log(alpha); factors]);
        theta.push(libm::log(beta));
        theta.extend(orders);
        theta.push(libm::log(1e-4));
        theta.extend(vec![0.0; factors]);
        theta
    }

    fn bounds(&self) -> Vec<Bounds> {
        let factors = self.basis.factors.len();
        let mut bounds = vec![(-18.0, 2.0); factors];
        bounds.extend(vec![(-3.0, 2.3); factors]);
        bounds.push((-3.0, 2.1));
        bounds.push((-18.0, 1.0));
        bounds.extend(vec![(-18.0, 8.0); self.order - 1]);
        bounds.push((libm::log(1e-10), 0.0));
        bounds.extend(vec![(-8.0, 8.0); factors]);
        bounds.extend(vec![(-18.0, 6.0); self.knots.len()]);
        bounds
    }

    pub fn descend(&self, kernel: &Kernel, start: Vec<f64>, iterations: usize) -> Vec<f64> {
        minimise(&mut |theta| self.objective(kernel, theta), &start, &self.bounds(), iterations)
    }

    /// Returns the variances of the functions, for polynomials up to `degree`.
    fn variances(&self, theta: &[f64], degree: usize) -> Variances {
        let (factors, order) = (self.basis.factors.len(), self.order);
        let exp = |place: usize| libm::exp(theta[place]);
        let functions = (0..factors).map(|i| {
            let w = exp(i);
            let count = self.basis.factors[i].degree().min(degree);
            let mut shares = decay(exp(factors + i), exp(2 * factors), theta[self.gamma() + i], count);
            let own = self.knots.iter().enumerate().filter(|(_, (factor, _))| *factor == i);
            shares.extend(own.map(|(m, _)| exp(self.gamma() + factors + m)));
            shares.iter().map(|share| w * share).collect()
        });
        Variances {
            functions: functions.collect(),
            orders: (0..order).map(|q| exp(2 * factors + 1 + q)).collect(),
            noise: exp(self.noise()),
        }
    }

    fn likelihood(&self, kernel: &Kernel, theta: &[f64]) -> Option<Likelihood> {
        let outputs = self.outputs.iter().map(|y| &y[..kernel.rows]);
        kernel.likelihood(&self.variances(theta, self.degree), outputs)
    }

    /// Returns the mean square of the rows left out one by one.
    fn left_one_out(&self, kernel: &Kernel, theta: &[f64]) -> f64 {
        self.likelihood(kernel, theta).map_or(f64::INFINITY, |likelihood| likelihood.left_one_out())
    }

    /// Returns the only output, or the first.
    pub fn y(&self) -> &[f64] {
        &self.outputs[0]
    }

    /// Returns the negative logarithm of the posterior of the hyperparameters.
    fn value(&self, kernel: &Kernel, theta: &[f64]) -> f64 {
        let penalty = self.penalty(theta, &mut vec![0.0; theta.len()]);
        self.likelihood(kernel, theta).map_or(f64::INFINITY, |likelihood| likelihood.value + penalty)
    }

    /// Returns the same with its gradient.
    fn objective(&self, kernel: &Kernel, theta: &[f64]) -> (f64, Vec<f64>) {
        let (factors, order) = (self.basis.factors.len(), self.order);
        let variances = self.variances(theta, self.degree);
        let mut gradient = vec![0.0; theta.len()];
        let Some(likelihood) = self.likelihood(kernel, theta) else { return (1e10, gradient) };
        let derivatives = likelihood.derivatives(kernel, &variances);
        let (beta, gamma) = (self.beta(), self.gamma());
        for i in 0..factors {
            // By the logarithm of each variance.
            let by_logs: Vec<f64> =
                derivatives.functions[i].iter().zip(&variances.functions[i]).map(|(g, v)| g * v).collect();
            gradient[i] = by_logs.iter().sum();
            let (polynomials, knots) = by_logs.split_at(self.basis.factors[i].degree().min(self.degree));
            let own = self.knots.iter().enumerate().filter(|(_, (factor, _))| *factor == i);
            for ((m, _), by_log) in own.zip(knots) {
                gradient[gamma + factors + m] = *by_log;
            }
            let (sum, all): (f64, f64) =
                (polynomials.iter().sum(), variances.functions[i][..polynomials.len()].iter().sum());
            for (k, by_log) in polynomials.iter().enumerate() {
                let by_share = by_log - sum * variances.functions[i][k] / all;
                gradient[factors + i] -= by_share * k as f64 * libm::exp(theta[factors + i]);
                gradient[beta] -= by_share * libm::log1p(k as f64) * libm::exp(theta[beta]);
                gradient[gamma + i] += if k % 2 == 1 { by_share } else { 0.0 };
            }
        }
        for q in 0..order {
            gradient[beta + 1 + q] = variances.orders[q] * derivatives.orders[q];
        }
        gradient[self.noise()] = variances.noise * derivatives.noise;
        let penalty = self.penalty(theta, &mut gradient);
        (likelihood.value + penalty, gradient)
    }

    /// Returns the negative logarithm of the priors of the hyperparameters, and adds its gradient: normal, of the w
    /// about their mean, and of their mean; none for the noise.
    fn penalty(&self, theta: &[f64], gradient: &mut [f64]) -> f64 {
        let factors = self.basis.factors.len();
        let mean = theta[..factors].iter().sum::<f64>() / factors as f64;
        let mut sum = 0.0;
        for (place, (value, gradient)) in theta.iter().zip(&mut *gradient).enumerate() {
            let (centre, sd) = match place {
                _ if place < factors => (mean, 2.0),
                _ if place < self.beta() => (0.0, 1.0),
                _ if place == self.beta() => (libm::log(1.5), 1.0),
                _ if place < self.noise() => (-1.0, 2.0),
                _ if place == self.noise() => continue,
                _ => (0.0, 3.0),
            };
            let z = (value - centre) / sd;
            sum += 0.5 * z * z;
            *gradient += z / sd;
        }
        let z = (mean + 1.0) / 3.0;
        gradient[..factors].iter_mut().for_each(|gradient| *gradient += z / 3.0 / factors as f64);
        sum + 0.5 * z * z
    }

    /// Returns the covariance of the output at the rows, for all functions.
    pub fn covariance(&self) -> Symmetric {
        self.basis.kernel(self.rows, usize::MAX).covariance(&self.variances(&self.theta, usize::MAX))
    }

    /// Returns the covariance at the first rows by the polynomials to which the hyperparameters are fitted.
    pub fn fitted_covariance(&self, rows: usize) -> Symmetric {
        self.basis.kernel(rows, self.degree).covariance(&self.variances(&self.theta, self.degree))
    }

    /// Returns the logarithms of the w of `factor` and of the weight of single factors.
    pub fn scale_of(&self, factor: usize) -> f64 {
        self.theta[factor] + self.theta[self.beta() + 1]
    }

    /// Adds a knot whose l has this logarithm.
    pub fn add_knot(&mut self, factor: usize, knot: Knot, log_share: f64) {
        self.knots.push((factor, self.basis.factors[factor].knots().len()));
        self.basis.factors[factor].add_knot(knot);
        self.theta.push(log_share);
    }

    /// Fits the hyperparameters by polynomials up to `degree` from now on.
    pub fn with_degree(self, degree: usize) -> Self {
        Self { degree, ..self }
    }

    /// Improves the hyperparameters in some steps.
    pub fn improve(&mut self, rows: usize, iterations: usize) {
        let kernel = self.basis.kernel(rows, self.degree);
        self.theta = self.descend(&kernel, self.theta.clone(), iterations);
    }

    /// Returns the `count` terms of largest variance, in falling order, each with its variance.
    pub fn leading_terms(&self, count: usize) -> Vec<(f64, Term)> {
        let variances = self.variances(&self.theta, usize::MAX);
        let mut single: Vec<(f64, (usize, usize))> = Vec::new();
        for (i, of) in variances.functions.iter().enumerate() {
            single.extend(of.iter().enumerate().map(|(k, v)| (*v, (i, k + 1))));
        }
        single.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut level: Vec<(f64, Term)> = single.iter().map(|(v, of)| (*v, vec![*of])).collect();
        let mut all: Vec<(f64, Term)> = Vec::new();
        for (q, weight) in variances.orders.iter().enumerate() {
            all.extend(level.iter().map(|(v, term)| (weight * v, term.clone())));
            keep_largest(&mut all, count);
            let Some(next_weight) = variances.orders.get(q + 1) else { break };
            let least = if all.len() == count { all[count - 1].0 } else { 0.0 };
            let mut next: Vec<(f64, usize, usize)> = Vec::new();
            for (parent, (v, term)) in level.iter().enumerate() {
                let large = single.iter().enumerate().take_while(|(_, (x, _))| next_weight * v * x > least);
                let later = large.filter(|(_, (_, of))| of.0 > term[q].0);
                next.extend(later.map(|(child, (x, _))| (v * x, parent, child)));
            }
            let rising = |a: &(f64, usize, usize), b: &(f64, usize, usize)| {
                b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2))
            };
            if next.len() > 4 * count {
                next.select_nth_unstable_by(4 * count, rising);
                next.truncate(4 * count);
            }
            next.sort_unstable_by(rising);
            let longer = next.into_iter().map(|(v, parent, child)| {
                let term = level[parent].1.iter().copied().chain([single[child].1]);
                (v, term.collect())
            });
            level = longer.collect();
        }
        all
    }
}

/// Keeps the largest `count` of some terms, in falling order.
fn keep_largest(terms: &mut Vec<(f64, Term)>, count: usize) {
    terms.sort_by(|a, b| b.0.total_cmp(&a.0).then_with(|| a.1.cmp(&b.1)));
    terms.truncate(count);
}

/// Returns the shares of `count` polynomials.
fn decay(alpha: f64, beta: f64, gamma: f64, count: usize) -> Vec<f64> {
    let logs = (0..count).map(|k| {
        let even = if k % 2 == 1 { gamma } else { 0.0 };
        -alpha * k as f64 - beta * libm::log1p(k as f64) + even
    });
    let logs: Vec<f64> = logs.collect();
    let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let sizes: Vec<f64> = logs.iter().map(|log| libm::exp(log - largest)).collect();
    let sum: f64 = sizes.iter().sum();
    sizes.iter().map(|size| size / sum).collect()
}
