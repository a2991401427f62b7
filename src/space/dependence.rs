//! Dependent factors as stated: correlations by several measures, and their conversion to those of normal scores.

mod nataf;

use nalgebra::DMatrix;
use nataf::{Standardised, of_normal_scores};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::copula::GaussianCopula;
use super::distribution::Distribution;
use super::{Factor, Space};
use apportion_base::names::named;
use apportion_base::special::normal_quantile;

/// Why factors cannot depend on each other as stated, and what is allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct DependenceError(String);

fn refused<T>(reason: impl Into<String>) -> Result<T, DependenceError> {
    Err(DependenceError(reason.into()))
}

named! {
/// The kind of a correlation.
#[derive(Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum CorrelationMeasure {
    /// Of the values themselves: Pearson's. Normal scores get the correlation that leads to it (Nataf's model, Liu and
    /// Der Kiureghian 1986, Probab. Eng. Mech. 1, 105-112), computed by quadrature to about 1e-6 for continuous
    /// distributions.
    #[default]
    Pearson = "pearson",
    /// Of the ranks: Spearman's rho = 6/pi arcsin(r/2) of normal scores with correlation r.
    Spearman = "spearman",
    /// Kendall's tau = 2/pi arcsin(r).
    Kendall = "kendall",
    /// Of the normal scores Phi^-1(u) themselves: the parameter of the copula.
    Normal = "normal",
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
    /// Whether the correlations come from joint measurements; a column with one value then has NaN on the diagonal too.
    is_measured: bool,
}

impl Dependence {
    /// Creates a dependence of the factors with these names and this matrix of correlations: symmetric, with ones on
    /// its diagonal. They are Pearson's, unless a [`measure`](Self::measure) is set.
    pub fn new(factors: &[&str], correlation: Vec<Vec<f64>>) -> Self {
        let factors = factors.iter().map(|&factor| factor.to_owned()).collect();
        Self { factors, correlation, measure: CorrelationMeasure::default(), is_measured: false }
    }

    /// Creates a dependence of two factors with this correlation.
    pub fn pair(a: &str, b: &str, correlation: f64) -> Self {
        Self::new(&[a, b], vec![vec![1.0, correlation], vec![correlation, 1.0]])
    }

    /// Creates the dependence of factors that were measured together: `columns` are their values, of one length, a row
    /// for each joint measurement. The correlations are those of the normal scores of the ranks (van der Waerden
    /// scores, ranks of equal values being averaged); the distributions of the factors are stated separately.
    pub fn from_measurements(factors: &[&str], columns: &[Vec<f64>]) -> Self {
        let scores: Vec<Vec<f64>> = columns.iter().map(|column| rank_scores(column)).collect();
        let mut rows = vec![vec![1.0; scores.len()]; scores.len()];
        for (i, a) in scores.iter().enumerate() {
            for (j, b) in scores.iter().enumerate().filter(|(j, _)| *j != i || product(a, a) <= 0.0) {
                rows[i][j] = product(a, b) / (product(a, a) * product(b, b)).sqrt();
            }
        }
        Self { is_measured: true, ..Self::new(factors, rows).measure(CorrelationMeasure::Normal) }
    }

    /// Sets the kind of the correlations.
    #[must_use]
    pub fn measure(self, measure: CorrelationMeasure) -> Self {
        Self { measure, ..self }
    }

    /// Returns the names of the factors.
    pub fn factors(&self) -> &[String] {
        &self.factors
    }

    /// Returns the matrix of correlations.
    pub fn correlation(&self) -> &[Vec<f64>] {
        &self.correlation
    }

    /// Returns the kind of the correlations.
    pub fn measure_in_force(&self) -> CorrelationMeasure {
        self.measure
    }

    /// Checks the matrix, and returns the indices of its factors in `space`.
    fn checked(&self, space: &Space) -> Result<Vec<usize>, DependenceError> {
        let mut numbers = Vec::with_capacity(self.factors.len());
        for name in &self.factors {
            let Some(number) = space.factors().iter().position(|factor| factor.name == *name) else {
                return refused(format!("dependence of `{name}`, which is not a factor of the study"));
            };
            numbers.push(number);
        }
        let n = numbers.len();
        let mut distinct = numbers.clone();
        distinct.sort_unstable();
        distinct.dedup();
        if n < 2 || distinct.len() < n {
            return refused("a dependence needs two or more factors, each named once");
        }
        if self.correlation.len() != n || self.correlation.iter().any(|row| row.len() != n) {
            return refused(format!("the correlations of {n} factors are a matrix of {n} rows with {n} numbers each"));
        }
        if let Some(number) = (0..n).find(|&i| self.is_measured && self.correlation[i][i].is_nan()) {
            let factor = &self.factors[number];
            return refused(format!(
                "the joint measurements of `{factor}` are all the same, so they have no correlation with other \
                 factors: leave it out of the dependence"
            ));
        }
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let (a, b, correlation) = (&self.factors[i], &self.factors[j], self.correlation[i][j]);
            if self.is_measured && i != j && correlation.abs() > 1.0 - EQUAL_RANKS {
                let order = if correlation > 0.0 { "same" } else { "opposite" };
                return refused(format!(
                    "the joint measurements of `{a}` and `{b}` have the {order} order, so each is a function of the \
                     other, not a separate factor. Leave one of them out of the study, and let the model compute it from the \
                     other"
                ));
            }
            let expected = match i == j {
                true if correlation != 1.0 => "1, as on the whole diagonal",
                false if !(correlation > -1.0 && correlation < 1.0) => "a number between -1 and 1, both excluded",
                false if correlation != self.correlation[j][i] => {
                    "the same number as on the other side of the diagonal"
                }
                _ => continue,
            };
            return refused(format!("the correlation of `{a}` and `{b}` is {correlation}: expected {expected}"));
        }
        Ok(numbers)
    }
}

/// Distance of a correlation of measurements from 1 below which they have the same ranks, apart from rounding.
const EQUAL_RANKS: f64 = 1e-12;

/// Returns the copula of `space` with these dependences; `None` without any.
pub(super) fn copula(space: &Space, dependences: &[Dependence]) -> Result<Option<GaussianCopula>, DependenceError> {
    let factors = space.factors();
    let mut scores = DMatrix::identity(factors.len(), factors.len());
    let mut stated = DMatrix::from_element(factors.len(), factors.len(), false);
    for dependence in dependences {
        let numbers = dependence.checked(space)?;
        for &number in &numbers {
            refuse_uncorrelated(&factors[number])?;
        }
        let laws: Vec<Standardised<'_>> =
            numbers.par_iter().map(|number| Standardised::new(factors[*number].distribution())).collect();
        let mut pairs = Vec::new();
        for (i, j) in (0..numbers.len()).flat_map(|i| (i + 1..numbers.len()).map(move |j| (i, j))) {
            let (a, b) = (numbers[i], numbers[j]);
            let [first, second] = [a, b].map(|number| &factors[number]);
            if stated[(a, b)] {
                return refused(format!("the correlation of `{}` and `{}` is stated twice", first.name, second.name));
            }
            (stated[(a, b)], stated[(b, a)]) = (true, true);
            pairs.push((i, j));
        }
        let of_scores = pairs.par_iter().map(|&(i, j)| {
            let of_pair = [i, j].map(|place| &factors[numbers[place]]);
            of_normal_scores(dependence.measure, dependence.correlation[i][j], of_pair, [&laws[i], &laws[j]])
        });
        for ((i, j), of_scores) in pairs.iter().zip(of_scores.collect::<Vec<_>>()) {
            let (a, b, of_scores) = (numbers[*i], numbers[*j], of_scores?);
            (scores[(a, b)], scores[(b, a)]) = (of_scores, of_scores);
        }
    }
    let copula = (!dependences.is_empty()).then(|| GaussianCopula::new(scores));
    copula.transpose().map_err(|nearest| {
        let tied: Vec<usize> =
            (0..factors.len()).filter(|&i| (0..factors.len()).any(|j| j != i && stated[(i, j)])).collect();
        let names: Vec<&String> = tied.iter().map(|&i| &factors[i].name).collect();
        let nearest: Vec<Vec<f64>> =
            tied.iter().map(|&i| tied.iter().map(|&j| nearest[(i, j)]).collect()).collect();
        DependenceError(format!(
            "the correlations are not positive definite, so no factors can have all of them. The nearest possible ones, between \
             the normal scores of {names:?}, are {nearest:?}"
        ))
    })
}

fn refuse_uncorrelated(factor: &Factor) -> Result<(), DependenceError> {
    let kind = match factor.distribution() {
        Distribution::Constant(_) => "a constant",
        law if law.labels().is_some() => "a category without an order",
        law if law.sd() == 0.0 => "of one value",
        _ => return Ok(()),
    };
    refused(format!("`{}` is {kind}, which has no correlation with another factor", factor.name))
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns Phi^-1(rank / (n + 1)) of every value, with mean 0.
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
#[path = "tests/dependence.rs"]
mod tests;
