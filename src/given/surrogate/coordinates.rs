//! The variable of every input in which an expansion is a polynomial.

use rayon::prelude::*;

use super::SurrogateRefusal;
use crate::given::Column;
use crate::given::order::Order;
use crate::space::Distribution;
use crate::surrogate::choices;
use crate::surrogate::family::Family;
use apportion_base::sum::{range, rescaled};

/// A positive or negative column whose largest value is this many times its smallest may be smooth in its logarithm.
const WIDE: f64 = 3.0;

/// Share of tables with a column that is farther from its stated distribution by chance than is accepted.
const REFUSED_BY_CHANCE: f64 = 1e-4;

/// Share of the support by which values may be outside, because of rounding.
const MARGIN: f64 = 1e-9;

/// Steps of the search for a probability: each halves the interval.
const HALVINGS: usize = 64;

/// Minimum probability of a single value that is an atom.
const STEP: f64 = 1e-9;

/// A set of variables, and the polynomials of every input in these.
pub(super) struct Coordinates {
    /// The polynomials.
    pub families: Vec<Family>,
    /// The variable of every input at every row.
    pub values: Vec<Vec<f64>>,
    /// A name of the variables.
    pub name: &'static str,
}

/// Returns the trials without given distributions: the values, the logarithms of wide and skewed columns, the ranks.
pub(super) fn of_columns(inputs: &[Column], orders: &[Order]) -> Vec<Coordinates> {
    let values: Vec<Vec<f64>> = inputs.iter().map(|input| rescaled(&input.values).0).collect();
    let logarithms: Vec<Option<Vec<f64>>> = values.iter().map(|x| logarithm(x)).collect();
    let mixed: Vec<Vec<f64>> =
        logarithms.iter().zip(&values).map(|(log, x)| log.as_ref().unwrap_or(x).clone()).collect();
    let ranks = orders.iter().map(|order| {
        let ranks = order.centred_ranks();
        let half = ranks.len() as f64 / 2.0;
        ranks.into_iter().map(|rank| rank / half).collect()
    });
    let has_logarithms = logarithms.iter().any(Option::is_some);
    let mut all = vec![Coordinates::new("values", values)];
    all.extend(has_logarithms.then(|| Coordinates::new("values and logarithms", mixed)));
    all.push(Coordinates::new("ranks", ranks.collect()));
    all
}

impl Coordinates {
    /// Creates those whose distributions are those of their `values`.
    fn new(name: &'static str, values: Vec<Vec<f64>>) -> Self {
        let families = values.iter().map(|x| Family::of_column(x)).collect();
        Self { families, values, name }
    }
}

/// Returns the logarithm of the absolute values of a wide column of one sign, if it is less skewed than they are.
fn logarithm(x: &[f64]) -> Option<Vec<f64>> {
    let sizes: Vec<f64> = x.iter().map(|x| x.abs()).collect();
    let (smallest, largest) = range(&sizes);
    let one_sign = x.iter().all(|x| *x > 0.0) || x.iter().all(|x| *x < 0.0);
    if !one_sign || largest < WIDE * smallest {
        return None;
    }
    let logarithms: Vec<f64> = sizes.into_iter().map(libm::log).collect();
    (skewness(&logarithms).abs() < skewness(x).abs()).then_some(logarithms)
}

fn skewness(x: &[f64]) -> f64 {
    let mean = apportion_base::sum::mean(x);
    let [second, third] = [2, 3].map(|power| x.iter().map(|x| (x - mean).powi(power)).sum::<f64>() / x.len() as f64);
    third / libm::pow(second, 1.5)
}

/// Returns the trials with given distributions.
///
/// # Errors
/// [`SurrogateRefusal::OtherDistribution`] if a column has not been drawn from its distribution.
pub(super) fn of_distributions(
    inputs: &[Column],
    orders: &[Order],
    distributions: &[Distribution],
) -> Result<Vec<Coordinates>, SurrogateRefusal> {
    // The tail of the distribution of Kolmogorov (1933) is 2 exp(-2 x^2), of the largest distance times the root of the rows.
    let far = (libm::log(2.0 * inputs.len() as f64 / REFUSED_BY_CHANCE) / 2.0).sqrt();
    let columns = inputs.par_iter().zip(orders).zip(distributions);
    let quantiles: Vec<Option<Vec<f64>>> =
        columns.map(|((input, order), distribution)| quantiles(&input.values, order, distribution, far)).collect();
    if let Some(refused) = quantiles.iter().position(Option::is_none) {
        return Err(SurrogateRefusal::OtherDistribution { input: inputs[refused].name.clone() });
    }
    let values: Vec<Vec<f64>> = quantiles.into_iter().flatten().collect();
    let families: Vec<Family> = distributions.iter().map(Family::new).collect();
    let all = choices(&families).into_iter();
    Ok(all.map(|families| Coordinates { families, values: values.clone(), name: "the given distributions" }).collect())
}

/// Returns the probability of values below each of `values`, plus half of that of the value itself; `None` if they do
/// not follow the distribution.
fn quantiles(values: &[f64], order: &Order, distribution: &Distribution, far: f64) -> Option<Vec<f64>> {
    let (low, high) = distribution.support();
    let margin = MARGIN * (high - low);
    if margin.is_finite() && values.iter().any(|x| *x < low - margin || *x > high + margin) {
        return None;
    }
    let count = values.len() as f64;
    let mut u = vec![0.0; values.len()];
    let (mut before, mut distance) = (0, 0.0_f64);
    for group in order.iter() {
        let (low, high) = probabilities(distribution, values[group[0]]);
        group.iter().for_each(|&row| u[row] = low + (high - low) / 2.0);
        let after = before + group.len();
        distance = distance.max((low - before as f64 / count).abs()).max((high - after as f64 / count).abs());
        before = after;
    }
    (distance * count.sqrt() <= far).then_some(u)
}

/// Returns the probabilities of values below `x`, and of values up to `x`.
fn probabilities(distribution: &Distribution, x: f64) -> (f64, f64) {
    let low = search(Distribution::SMALLEST_U, Distribution::LARGEST_U, |u| distribution.quantile(u) < x);
    let is_step = low + STEP < Distribution::LARGEST_U && distribution.quantile(low + STEP) <= x;
    (low, if is_step { search(low, Distribution::LARGEST_U, |u| distribution.quantile(u) <= x) } else { low })
}

/// Returns the probability up to which `is_below` holds.
fn search(mut low: f64, mut high: f64, is_below: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = low + (high - low) / 2.0;
        if is_below(middle) { low = middle } else { high = middle }
    }
    low + (high - low) / 2.0
}
