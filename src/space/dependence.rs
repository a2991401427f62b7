//! Dependent factors as they are stated: correlations by one of several measures, and how they become those of normal scores.

use std::f64::consts::PI;

use nalgebra::DMatrix;
use thiserror::Error;

use super::copula::{GaussianCopula, from_score};
use super::distribution::Distribution;
use super::{Factor, Space};
use crate::special::normal_quantile;

/// What a correlation is a correlation of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CorrelationMeasure {
    /// Of the values themselves: Pearson's. The normal scores get the correlation that brings it about (Nataf's model, Liu and Der
    /// Kiureghian 1986, Probab. Eng. Mech. 1, 105-112), found by quadrature to some 1e-6 for continuous distributions.
    #[default]
    Pearson,
    /// Of the ranks: Spearman's rho = 6/pi arcsin(r/2) of normal scores with correlation r.
    Spearman,
    /// Kendall's tau = 2/pi arcsin(r).
    Kendall,
    /// Of the normal scores Phi^-1(u) themselves: the parameter of the copula.
    Normal,
}

impl CorrelationMeasure {
    /// All measures, the default first.
    pub const ALL: [Self; 4] = [Self::Pearson, Self::Spearman, Self::Kendall, Self::Normal];

    /// The name in study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pearson => "pearson",
            Self::Spearman => "spearman",
            Self::Kendall => "kendall",
            Self::Normal => "normal",
        }
    }
}

/// Factors that depend on each other, by a Gaussian copula with these correlations.
///
/// ```
/// use apportion::{CorrelationMeasure, Dependence};
///
/// let pair = Dependence::pair("length", "width", 0.6).measure(CorrelationMeasure::Spearman);
/// let three = Dependence::new(&["a", "b", "c"], vec![vec![1.0, 0.5, 0.2], vec![0.5, 1.0, 0.0], vec![0.2, 0.0, 1.0]]);
/// # let _ = (pair, three);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Dependence {
    factors: Vec<String>,
    correlation: Vec<Vec<f64>>,
    measure: CorrelationMeasure,
}

/// Why factors cannot depend on each other as stated.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DependenceError {
    /// A name that is no factor.
    #[error("dependence of `{0}`, which is no factor of the study")]
    UnknownFactor(String),
    /// A factor twice, or fewer than two.
    #[error("a dependence is one of two factors or more, each named once")]
    Factors,
    /// Two factors in more than one dependence.
    #[error("the correlation of `{0}` and `{1}` is stated twice")]
    Repeated(String, String),
    /// Rows and columns of another number than the factors.
    #[error("the correlations of {factors} factors are a matrix of {factors} rows with {factors} numbers each")]
    Shape {
        /// Factors of the dependence.
        factors: usize,
    },
    /// Not what a correlation matrix looks like.
    #[error("the correlation of `{a}` and `{b}` is {found}: expected {expected}")]
    Entry {
        /// The factor of the row.
        a: String,
        /// The factor of the column.
        b: String,
        /// The number there.
        found: f64,
        /// What would be right.
        expected: &'static str,
    },
    /// A factor that has no correlation.
    #[error("`{factor}` is {kind}, which has no correlation with another factor")]
    Uncorrelated {
        /// The factor.
        factor: String,
        /// What it is.
        kind: &'static str,
    },
    /// A Pearson correlation that the distributions do not allow.
    #[error(
        "`{a}` and `{b}` cannot have a Pearson correlation of {found}: their distributions allow {low:.4} to {high:.4}"
    )]
    Unattainable {
        /// One factor.
        a: String,
        /// The other one.
        b: String,
        /// The correlation that was stated.
        found: f64,
        /// The least correlation of any joint distribution of these two.
        low: f64,
        /// The largest one.
        high: f64,
    },
    /// Correlations that cannot all be.
    #[error(
        "the correlations are not positive definite, so that no factors can have them all. The nearest that can be, of normal \
         scores (measure = \"normal\"): factors = {factors:?}, correlation = {nearest:?}"
    )]
    NotPositiveDefinite {
        /// The factors that depend on others.
        factors: Vec<String>,
        /// The nearest valid matrix, of their normal scores.
        nearest: Vec<Vec<f64>>,
    },
}

impl Dependence {
    /// The factors of these names with this matrix of correlations: symmetric, with ones on its diagonal. Pearson's, unless a
    /// [`measure`](Self::measure) is set.
    pub fn new(factors: &[&str], correlation: Vec<Vec<f64>>) -> Self {
        let factors = factors.iter().map(|&factor| factor.to_owned()).collect();
        Self { factors, correlation, measure: CorrelationMeasure::default() }
    }

    /// Two factors with this correlation.
    pub fn pair(a: &str, b: &str, correlation: f64) -> Self {
        Self::new(&[a, b], vec![vec![1.0, correlation], vec![correlation, 1.0]])
    }

    /// The dependence of factors that were measured together: `columns` are their values, of one length, a row for each joint
    /// measurement. The correlations are those of the normal scores of the ranks (van der Waerden scores, ranks of equal values
    /// being averaged); the distributions of the factors are stated apart.
    pub fn from_measurements(factors: &[&str], columns: &[Vec<f64>]) -> Self {
        let scores: Vec<Vec<f64>> = columns.iter().map(|column| rank_scores(column)).collect();
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let correlation = |i: usize, j: usize| match i == j {
            true => 1.0,
            false => {
                product(&scores[i], &scores[j])
                    / (product(&scores[i], &scores[i]) * product(&scores[j], &scores[j])).sqrt()
            }
        };
        let rows = (0..scores.len()).map(|i| (0..scores.len()).map(|j| correlation(i, j)).collect()).collect();
        Self::new(factors, rows).measure(CorrelationMeasure::Normal)
    }

    /// What the numbers are correlations of.
    #[must_use]
    pub fn measure(self, measure: CorrelationMeasure) -> Self {
        Self { measure, ..self }
    }

    /// The names of the factors.
    pub fn factors(&self) -> &[String] {
        &self.factors
    }

    /// The matrix of correlations.
    pub fn correlation(&self) -> &[Vec<f64>] {
        &self.correlation
    }

    /// What its numbers are correlations of.
    pub fn measure_in_force(&self) -> CorrelationMeasure {
        self.measure
    }

    /// The numbers of its factors in `space`, once its matrix is seen to be one.
    fn checked(&self, space: &Space) -> Result<Vec<usize>, DependenceError> {
        let number = |name: &String| {
            let place = space.factors().iter().position(|factor| factor.name == *name);
            place.ok_or_else(|| DependenceError::UnknownFactor(name.clone()))
        };
        let numbers = self.factors.iter().map(number).collect::<Result<Vec<usize>, _>>()?;
        let n = numbers.len();
        let mut distinct = numbers.clone();
        distinct.sort_unstable();
        distinct.dedup();
        if n < 2 || distinct.len() < n {
            return Err(DependenceError::Factors);
        }
        if self.correlation.len() != n || self.correlation.iter().any(|row| row.len() != n) {
            return Err(DependenceError::Shape { factors: n });
        }
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let found = self.correlation[i][j];
            let expected = match i == j {
                true if found != 1.0 => "1, as on the whole diagonal",
                false if !(found > -1.0 && found < 1.0) => "a number between -1 and 1, both excluded",
                false if found != self.correlation[j][i] => "the same number as on the other side of the diagonal",
                _ => continue,
            };
            let [a, b] = [i, j].map(|k| self.factors[k].clone());
            return Err(DependenceError::Entry { a, b, found, expected });
        }
        Ok(numbers)
    }
}

/// The copula of `space` with these dependences; `None` without any.
pub(super) fn copula(space: &Space, dependences: &[Dependence]) -> Result<Option<GaussianCopula>, DependenceError> {
    let factors = space.factors();
    let mut scores = DMatrix::identity(factors.len(), factors.len());
    let mut stated = DMatrix::from_element(factors.len(), factors.len(), false);
    for dependence in dependences {
        let numbers = dependence.checked(space)?;
        for &number in &numbers {
            refuse_uncorrelated(&factors[number])?;
        }
        let pairs = (0..numbers.len()).flat_map(|i| (i + 1..numbers.len()).map(move |j| (i, j)));
        for (i, j) in pairs {
            let (a, b) = (numbers[i], numbers[j]);
            let [first, second] = [a, b].map(|number| &factors[number]);
            if stated[(a, b)] {
                return Err(DependenceError::Repeated(first.name.clone(), second.name.clone()));
            }
            (stated[(a, b)], stated[(b, a)]) = (true, true);
            let of_scores = of_normal_scores(dependence.measure, dependence.correlation[i][j], first, second)?;
            (scores[(a, b)], scores[(b, a)]) = (of_scores, of_scores);
        }
    }
    if dependences.is_empty() {
        return Ok(None);
    }
    GaussianCopula::new(scores.clone()).map(Some).map_err(|nearest| {
        let is_tied = |i: &usize| (0..factors.len()).any(|j| j != *i && stated[(*i, j)]);
        let tied: Vec<usize> = (0..factors.len()).filter(is_tied).collect();
        let row = |i: &usize| tied.iter().map(|j| nearest[(*i, *j)]).collect();
        DependenceError::NotPositiveDefinite {
            factors: tied.iter().map(|&i| factors[i].name.clone()).collect(),
            nearest: tied.iter().map(row).collect(),
        }
    })
}

fn refuse_uncorrelated(factor: &Factor) -> Result<(), DependenceError> {
    let kind = match factor.distribution() {
        Distribution::Constant(_) => "a constant",
        law if law.labels().is_some() => "a category without an order",
        _ => return Ok(()),
    };
    Err(DependenceError::Uncorrelated { factor: factor.name.clone(), kind })
}

/// The correlation of normal scores that brings about the correlation `stated` by `measure`.
fn of_normal_scores(measure: CorrelationMeasure, stated: f64, a: &Factor, b: &Factor) -> Result<f64, DependenceError> {
    match measure {
        CorrelationMeasure::Normal => Ok(stated),
        CorrelationMeasure::Spearman => Ok(2.0 * libm::sin(PI / 6.0 * stated)),
        CorrelationMeasure::Kendall => Ok(libm::sin(PI / 2.0 * stated)),
        CorrelationMeasure::Pearson => pearson(stated, a, b),
    }
}

/// Nodes of the quadrature of a line of normal scores, and of the plane of two.
const LINE: usize = 4000;
const PLANE: usize = 240;

/// The quadrature leaves out scores beyond this.
const FARTHEST: f64 = 8.5;

/// Nodes of the midpoint rule over normal scores with their weights, which sum to 1: its error falls faster than any power of the
/// distance of nodes where the integrand is smooth.
fn nodes(count: usize) -> Vec<(f64, f64)> {
    let step = 2.0 * FARTHEST / count as f64;
    let place = |k: usize| -FARTHEST + step * (k as f64 + 0.5);
    let weights: Vec<f64> = (0..count).map(|k| libm::exp(-0.5 * place(k) * place(k))).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().enumerate().map(|(k, weight)| (place(k), weight / sum)).collect()
}

fn pearson(stated: f64, a: &Factor, b: &Factor) -> Result<f64, DependenceError> {
    let [x, y] = [a, b].map(Factor::distribution);
    if stated == 0.0 || matches!((x, y), (Distribution::Normal(_), Distribution::Normal(_))) {
        return Ok(stated);
    }
    let standard = |law: &Distribution, score: f64| (law.quantile(from_score(score)) - law.mean()) / law.sd();
    let line = nodes(LINE);
    let extreme = |sign: f64| line.iter().map(|(z, w)| w * standard(x, *z) * standard(y, sign * z)).sum::<f64>();
    let (low, high) = (extreme(-1.0), extreme(1.0));
    if !(low < stated && stated < high) {
        let [a, b] = [a, b].map(|factor| factor.name.clone());
        return Err(DependenceError::Unattainable { a, b, found: stated, low, high });
    }
    let plane = nodes(PLANE);
    let of_x: Vec<f64> = plane.iter().map(|(z, _)| standard(x, *z)).collect();
    let correlation = |r: f64| {
        let rest = (1.0 - r * r).sqrt();
        let inner = |z: f64| plane.iter().map(|(v, w)| w * standard(y, r * z + rest * v)).sum::<f64>();
        plane.iter().zip(&of_x).map(|((z, w), x)| w * x * inner(*z)).sum::<f64>()
    };
    // The correlation rises with r (Lancaster 1957): a secant that keeps its bracket, the end that stays twice counting half.
    let (mut left, mut right) = ((-1.0, low - stated), (1.0, high - stated));
    let mut last = 0.0;
    for _ in 0..60 {
        let r: f64 = (left.0 - left.1 * (right.0 - left.0) / (right.1 - left.1)).clamp(left.0, right.0);
        let gap = correlation(r) - stated;
        if gap.abs() < 1e-9 || right.0 - left.0 < 1e-9 {
            return Ok(r);
        }
        if gap < 0.0 {
            left = (r, gap);
            right.1 *= if last < 0.0 { 0.5 } else { 1.0 };
        } else {
            right = (r, gap);
            left.1 *= if last > 0.0 { 0.5 } else { 1.0 };
        }
        last = gap;
    }
    Ok(0.5 * (left.0 + right.0))
}

/// Phi^-1(rank / (n + 1)) of every value, the mean of all of them 0.
fn rank_scores(column: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..column.len()).collect();
    order.sort_by(|a, b| column[*a].total_cmp(&column[*b]));
    let mut scores = vec![0.0; column.len()];
    let mut first = 0;
    while first < order.len() {
        let equal = order[first..].iter().take_while(|row| column[**row] == column[order[first]]).count().max(1);
        let rank = first as f64 + (equal + 1) as f64 / 2.0;
        let score = normal_quantile(rank / (column.len() + 1) as f64);
        order[first..first + equal].iter().for_each(|row| scores[*row] = score);
        first += equal;
    }
    let mean = scores.iter().sum::<f64>() / scores.len().max(1) as f64;
    scores.iter_mut().for_each(|score| *score -= mean);
    scores
}

#[cfg(test)]
#[path = "dependence/tests.rs"]
mod tests;
