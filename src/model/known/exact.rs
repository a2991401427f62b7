//! Exact mean, variance and indices, and the rules for families of functions.

use crate::effect::IndexPair;

/// Mean, variance and indices of a function of independent inputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Exact {
    /// The mean.
    pub mean: f64,
    /// The variance.
    pub variance: f64,
    /// The indices S_i and ST_i of the inputs; `None` if the variance is 0.
    pub indices: Option<IndexPair<Vec<f64>>>,
    /// How they were computed.
    pub basis: Basis,
}

/// How exact values were computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Basis {
    /// By a formula, to rounding: about 1e-15 of the variance.
    ClosedForm,
    /// By quadrature (`tests/oracle/known_reference.py`).
    Quadrature {
        /// Error of the indices, and relative error of mean and variance, as the difference of two orders of the rule.
        error: f64,
    },
}

impl Exact {
    /// Computes it from the parts V_u of the variance, each with its set of inputs u (ascending, each set once).
    pub(super) fn of_parts(mean: f64, inputs: usize, parts: &[(Vec<usize>, f64)]) -> Self {
        let variance: f64 = parts.iter().map(|(_, part)| part).sum();
        let (mut first, mut total) = (vec![0.0; inputs], vec![0.0; inputs]);
        for (set, part) in parts {
            let share = part / variance;
            if let [i] = set[..] {
                first[i] += share;
            }
            set.iter().for_each(|&i| total[i] += share);
        }
        Self::closed(mean, variance, first, total)
    }

    /// Computes it for a product of functions of one input each, with the variances `r` over their squared means;
    /// `mean` is the product of their means.
    ///
    /// S_i = r_i / D, S_ij = r_i r_j / D, ST_i = r_i prod_{j != i} (1 + r_j) / D and variance = mean^2 D, where
    /// D = prod (1 + r_j) - 1 (Sobol' 1993).
    pub(super) fn of_product(mean: f64, r: &[f64]) -> Self {
        let log: f64 = r.iter().map(|&r| libm::log1p(r)).sum();
        let d = libm::expm1(log);
        let first = r.iter().map(|r| r / d).collect();
        // (1 + D) / D, which is finite even where D is not.
        let total = r.iter().map(|r| r / (1.0 + r) / -libm::expm1(-log)).collect();
        Self::closed(mean, mean * mean * d, first, total)
    }

    /// Creates it from the indices themselves.
    pub(super) fn closed(mean: f64, variance: f64, first_order: Vec<f64>, total: Vec<f64>) -> Self {
        let indices = (variance > 0.0).then_some(IndexPair { first_order, total });
        Self { mean, variance, indices, basis: Basis::ClosedForm }
    }

    /// Creates it from a table of references: the first-order and the total index of each input.
    pub(super) fn by_quadrature(mean: f64, variance: f64, indices: &[[f64; 2]], error: f64) -> Self {
        let (first_order, total) = indices.iter().map(|[first, total]| (*first, *total)).unzip();
        let indices = IndexPair { first_order, total };
        Self { mean, variance, indices: Some(indices), basis: Basis::Quadrature { error } }
    }
}

/// Returns the variance over the squared mean of e^(b x), x uniform on (0, 1): (b/2) coth(b/2) - 1.
pub(super) fn relative_variance_of_exponential(b: f64) -> f64 {
    let x = b / 2.0;
    let s = x * x;
    if x.abs() < 0.3 {
        // The series of x coth x - 1, which loses no digits; the first omitted term is below 1e-16 of the sum.
        let terms = [
            1.0 / 3.0,
            -1.0 / 45.0,
            2.0 / 945.0,
            -1.0 / 4725.0,
            2.0 / 93_555.0,
            -1382.0 / 638_512_875.0,
            4.0 / 18_243_225.0,
            -3617.0 / 162_820_783_125.0,
            87_734.0 / 38_979_295_480_125.0,
        ];
        s * terms.iter().rev().fold(0.0, |sum, term| sum * s + term)
    } else {
        x / libm::tanh(x) - 1.0
    }
}

/// Returns the mean of e^(b x), x uniform on (0, 1): (e^b - 1) / b.
pub(super) fn mean_of_exponential(b: f64) -> f64 {
    if b == 0.0 { 1.0 } else { libm::expm1(b) / b }
}
