//! Outputs of one sign that are nearly a product of functions of single factors: exp of an additive expansion of the
//! logarithm. All its coefficients are products of integrals over one factor, so that it is one term of an expansion
//! whose other terms fit the rest.

use super::basis::{Basis, integration};
use super::prior::Prior;
use super::ways::{EffectVariances, Listed};
use apportion_base::sum::{mean, product};

/// Residuals in units of the output that are rounding.
const ROUNDING: f64 = 1e-13;

/// A product that is one term of an expansion.
pub struct Product {
    /// The terms of the logarithm, of mean 0 and standard deviation 1, and which way leads to their coefficients.
    logarithm: Listed,
    way: usize,
    sd: f64,
    /// The output and what is added for values of one sign.
    y: Vec<f64>,
    offset: f64,
    /// Mean and standard deviation of what is left.
    shift: f64,
    scale: f64,
}

/// The integrals of one factor of the product.
struct Integrals {
    mean: f64,
    square: f64,
    /// Those with the functions of the factor, over the mean.
    ratios: Vec<f64>,
}

impl Product {
    /// Fits one to the outputs `y` + `offset`, if they have one sign. `chosen` returns the terms of a prior with their
    /// best way.
    pub fn new(basis: &Basis, y: &[f64], offset: f64, chosen: impl Fn(Prior) -> (Listed, usize)) -> Option<Self> {
        let raw: Vec<f64> = y.iter().map(|y| y + offset).collect();
        if !(raw.iter().all(|y| *y > 0.0) || raw.iter().all(|y| *y < 0.0)) {
            return None;
        }
        let logs: Vec<f64> = raw.iter().map(|y| libm::log(y.abs())).collect();
        let centre = mean(&logs);
        let centred: Vec<f64> = logs.iter().map(|log| log - centre).collect();
        let sd = (product(&centred, &centred) / y.len() as f64).sqrt();
        let standard = centred.iter().map(|log| log / sd).collect();
        let (logarithm, way) = chosen(Prior::new(basis.clone(), vec![standard], 1));
        let mut fitted = Self { logarithm, way, sd, y: y.to_vec(), offset, shift: 0.0, scale: 1.0 };
        let left = fitted.left(basis.count_parts());
        let shift = mean(&left);
        let square = left.iter().map(|e| (e - shift) * (e - shift)).sum::<f64>() / left.len() as f64;
        (fitted.shift, fitted.scale) = (shift, square.sqrt().max(ROUNDING));
        square.is_finite().then_some(fitted)
    }

    /// Returns the standard deviation of what it leaves.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Returns what is left of the outputs if it is fitted without one `part`, in units of its standard deviation.
    pub fn left(&self, part: usize) -> Vec<f64> {
        let logs = self.logs(part).1;
        let factor = self.factor(part, &logs);
        let pairs = self.y.iter().zip(&logs);
        pairs.map(|(y, log)| (y + self.offset - factor * libm::exp(*log) - self.shift) / self.scale).collect()
    }

    /// Returns the coefficients of the logarithm without one `part`, and its values at all rows.
    fn logs(&self, part: usize) -> (Vec<f64>, Vec<f64>) {
        let mut fits = self.logarithm.fits(part, self.logarithm.prior.y());
        let coefficients: Vec<f64> =
            fits.of_ways.swap_remove(self.way).coefficients.iter().map(|c| c * self.sd).collect();
        let logs = self.logarithm.combined(&coefficients);
        (coefficients, logs)
    }

    /// Returns by what the exponentials must be multiplied, by least squares without one `part`.
    fn factor(&self, part: usize, logs: &[f64]) -> f64 {
        let (rows, _) = self.logarithm.prior.basis.without(part);
        let sums = rows.iter().map(|row| (libm::exp(logs[*row]), self.y[*row] + self.offset));
        let (square, cross) = sums.fold((0.0, 0.0), |(a, b), (g, y)| (a + g * g, b + g * y));
        cross / square
    }

    /// Returns the variances of its sum with an expansion of what is left in the terms of `listed`, both fitted without
    /// one `part`, and the coefficients of the sum in these terms.
    pub fn joined(&self, listed: &Listed, part: usize, coefficients: &[f64]) -> (EffectVariances, Vec<f64>) {
        let basis = &listed.prior.basis;
        let (of_logarithm, logs) = self.logs(part);
        let factor = self.factor(part, &logs);
        let mut of_factors = vec![Vec::new(); basis.factors.len()];
        for (term, c) in self.logarithm.terms.iter().zip(of_logarithm) {
            of_factors[term[0].0].push((term[0].1, c));
        }
        let integrals: Vec<Integrals> = basis
            .factors
            .iter()
            .zip(&of_factors)
            .map(|(factor, of)| {
                let (functions, weights) = integration(factor);
                let mut log = vec![0.0; weights.len()];
                for (k, c) in of {
                    log.iter_mut().zip(&functions[k - 1]).for_each(|(log, f)| *log += c * f);
                }
                let h: Vec<f64> = log.into_iter().map(libm::exp).collect();
                let weighted: Vec<f64> = h.iter().zip(&weights).map(|(h, w)| h * w).collect();
                let mean: f64 = weighted.iter().sum();
                let ratios = functions.iter().map(|f| product(f, &weighted) / mean).collect();
                Integrals { mean, square: product(&h, &weighted), ratios }
            })
            .collect();
        let centre = factor * integrals.iter().map(|of| of.mean).product::<f64>();
        // Relative variances.
        let shares: Vec<f64> = integrals.iter().map(|of| of.square / (of.mean * of.mean) - 1.0).collect();
        let all: f64 = shares.iter().map(|share| 1.0 + share).product();
        let mut variances = listed.variances(&coefficients.iter().map(|c| c * self.scale).collect::<Vec<f64>>());
        variances.all += centre * centre * (all - 1.0);
        for (i, share) in shares.iter().enumerate() {
            variances.first_order[i] += centre * centre * share;
            variances.total[i] += centre * centre * share * all / (1.0 + share);
        }
        let mut sums = Vec::with_capacity(coefficients.len());
        for (term, c) in listed.terms.iter().zip(coefficients) {
            let own = centre * term.iter().map(|(i, k)| integrals[*i].ratios[k - 1]).product::<f64>();
            let set: Vec<usize> = term.iter().map(|(factor, _)| *factor).collect();
            variances.add(&set, 2.0 * own * c * self.scale);
            sums.push(own + c * self.scale);
        }
        (variances, sums)
    }
}
