//! In which variable of every input an expansion is a polynomial.

use super::super::order::Order;
use super::SurrogateRefusal;
use crate::given::Column;
use crate::space::{Distribution, LARGEST_U, SMALLEST_U};
use crate::sum::rescaled;
use crate::surrogate::basis::Family;
use crate::surrogate::{Trial, trials};

/// A positive or negative column whose largest value is this many times its smallest may be smooth in its logarithm.
const WIDE: f64 = 3.0;

/// How far the distribution of a column may be from the stated one, times the root of the number of rows (Kolmogorov 1933): by
/// chance, one column in 30 million is farther.
const FAR: f64 = 3.0;

/// Steps of the search for a quantile: each halves the interval.
const HALVINGS: usize = 64;

/// The polynomials of every input in one set of variables, and these.
pub(super) struct Coordinates {
    /// The polynomials.
    pub trial: Trial,
    /// The variable of every input at every row.
    pub values: Vec<Vec<f64>>,
    /// What the variables are.
    pub name: &'static str,
}

/// What is tried, without knowing the distributions: the values, the logarithms of wide and skewed columns, the ranks.
pub(super) fn of_columns(inputs: &[Column], orders: &[Order]) -> Vec<Coordinates> {
    let values: Vec<Vec<f64>> = inputs.iter().map(|input| rescaled(&input.values).0).collect();
    let logarithms: Vec<Option<Vec<f64>>> = values.iter().map(|x| logarithm(x)).collect();
    let mixed: Vec<Vec<f64>> = logarithms.iter().zip(&values).map(|(log, x)| log.as_ref().unwrap_or(x).clone()).collect();
    let ranks = orders.iter().map(|order| {
        let ranks = order.centred_ranks();
        let half = ranks.len() as f64 / 2.0;
        ranks.into_iter().map(|rank| rank / half).collect()
    });
    let of = |name: &'static str, values: Vec<Vec<f64>>| Coordinates {
        trial: Trial { families: values.iter().map(|x| Family::of_column(x)).collect(), hermite_degree: 0, ratio: 1.0 },
        values,
        name,
    };
    let has_logarithms = logarithms.iter().any(Option::is_some);
    let mut all = vec![of("values", values)];
    all.extend(has_logarithms.then(|| of("values and logarithms", mixed)));
    all.push(of("ranks", ranks.collect()));
    all
}

/// The logarithm of the absolute values of a wide column of one sign, if it is less skewed than they are.
fn logarithm(x: &[f64]) -> Option<Vec<f64>> {
    let size = |bound: fn(f64, f64) -> f64, from: f64| x.iter().map(|x| x.abs()).fold(from, bound);
    let one_sign = x.iter().all(|x| *x > 0.0) || x.iter().all(|x| *x < 0.0);
    if !one_sign || size(f64::max, 0.0) < WIDE * size(f64::min, f64::INFINITY) {
        return None;
    }
    let logarithms: Vec<f64> = x.iter().map(|x| x.abs().ln()).collect();
    (skewness(&logarithms).abs() < skewness(x).abs()).then_some(logarithms)
}

fn skewness(x: &[f64]) -> f64 {
    let mean = crate::sum::mean(x);
    let moment = |power: i32| x.iter().map(|x| (x - mean).powi(power)).sum::<f64>() / x.len() as f64;
    moment(3) / moment(2).powf(1.5)
}

/// What is tried where the distributions are known.
///
/// # Errors
/// [`SurrogateRefusal::OtherDistribution`] if a column has not been drawn from its distribution.
pub(super) fn of_distributions(
    inputs: &[Column],
    orders: &[Order],
    distributions: &[Distribution],
) -> Result<Vec<Coordinates>, SurrogateRefusal> {
    let quantiles = |((input, order), distribution): ((&Column, &Order), &Distribution)| {
        let u: Vec<f64> = input.values.iter().map(|x| probability(distribution, *x)).collect();
        let far = distance(order, distribution, &input.values) * (u.len() as f64).sqrt() > FAR;
        if far { Err(SurrogateRefusal::OtherDistribution { input: input.name.clone() }) } else { Ok(u) }
    };
    let values: Vec<Vec<f64>> =
        inputs.iter().zip(orders).zip(distributions).map(quantiles).collect::<Result<_, _>>()?;
    let families: Vec<Family> = distributions.iter().map(Family::new).collect();
    let of = |trial: Trial| Coordinates { trial, values: values.clone(), name: "the given distributions" };
    Ok(trials(&families).into_iter().map(of).collect())
}

/// The largest and the smallest probability at which the quantile is not above, or not below, `x`.
fn bounds(distribution: &Distribution, x: f64) -> (f64, f64) {
    let search = |below: &dyn Fn(f64) -> bool| {
        let (mut low, mut high) = (SMALLEST_U, LARGEST_U);
        for _ in 0..HALVINGS {
            let middle = low + (high - low) / 2.0;
            if below(distribution.quantile(middle)) { low = middle } else { high = middle }
        }
        low + (high - low) / 2.0
    };
    (search(&|q| q < x), search(&|q| q <= x))
}

/// The probability of values below `x`, with half of that of `x` itself.
fn probability(distribution: &Distribution, x: f64) -> f64 {
    let (low, high) = bounds(distribution, x);
    low + (high - low) / 2.0
}

/// The largest distance between the shares of rows and the probabilities up to any value, and the share of rows outside.
fn distance(order: &Order, distribution: &Distribution, values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mut before = 0;
    let mut largest: f64 = 0.0;
    for group in order.iter() {
        let (low, high) = bounds(distribution, values[group[0]]);
        let after = before + group.len();
        largest = largest.max((low - before as f64 / count).abs()).max((high - after as f64 / count).abs());
        before = after;
    }
    largest
}
