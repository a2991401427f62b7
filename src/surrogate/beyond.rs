//! The error of expansions in the tails of their factors, where there are no runs.
//!
//! The indices of an expansion are computed exactly, which includes regions where no run shows whether it is right. A
//! polynomial of high degree in an unbounded variable has most of its variance there. Its departure in the tails from
//! its own tangents at their edges is therefore counted as a part of the error of every number to which it contributes;
//! less of it if the expansion fits well or its degree is low, since a function close to a polynomial of low degree
//! continues like one.
//!
//! Runs also do not show where a step lies between two sampled values. The departure of the two sides of a knot from
//! one another counts as if the step were uniform over the width of the knot, of standard deviation width/sqrt(12).

use std::collections::BTreeMap;

use super::basis::{Family, Term, polynomials};
use super::fit::Expansion;
use crate::correction::{Effects, Knot, is_interaction, touches, within};

/// Width of the panels of the midpoint rule in ln u, and their number, down to 1e-17 of the edge.
const STEP: f64 = 0.25;
const PANELS: usize = 160;

/// Relative distance from the edge of the two values of u used for slopes.
const NEAR: f64 = 1e-5;

/// Distance in u to either side of a knot.
const KNOT_SIDE: f64 = 1e-9;

/// Multiple of the root mean square residual that counts for every degree of a polynomial, times its departure; limited
/// to the whole departure. Polynomials that are small at the runs grow this fast beyond them, as those of Chebyshev do.
/// Measured on sines, exponentials and powers of normal factors.
const GROWTH: f64 = 3.2;

/// One tail of a factor, from its edge outwards; or a knot, with its two sides instead of the tail and its tangents.
struct Tail {
    /// Whether it is a knot, which a close fit does not determine.
    is_knot: bool,
    /// Probabilities of the nodes.
    weights: Vec<f64>,
    /// The polynomials of degree 1, 2, ... at the nodes.
    values: Vec<Vec<f64>>,
    /// Their tangents at the edge, at the nodes.
    tangents: Vec<Vec<f64>>,
}

impl Tail {
    /// Returns both tails of a factor with polynomials of `family`, each of probability `mass`; none without tails.
    fn both(family: &Family, mass: f64, degree: usize) -> Vec<Self> {
        let (with_knots, family) = (family, family.smooth());
        let degree = if let Family::Knotted(own) = with_knots { own.degree() } else { degree };
        let is_upper: &[bool] = match family {
            Family::Hermite | Family::Own(_) => &[false, true],
            Family::Legendre | Family::Column(_) | Family::Knotted(_) => &[],
        };
        let logarithms = (0..PANELS).map(|k| STEP * (k as f64 + 0.5));
        let nodes: Vec<f64> = logarithms.map(|s| mass * libm::exp(-s)).collect();
        let weights: Vec<f64> = nodes.iter().map(|u| u * STEP).collect();
        let points: Vec<f64> = nodes.into_iter().chain([mass, mass * (1.0 + NEAR)]).collect();
        let tail = |&upper: &bool| {
            let mut values = match family {
                // Hermite polynomials are even or odd, and 1 - u has no digits far out.
                Family::Hermite => polynomials(family, &points, degree),
                _ if upper => polynomials(family, &points.iter().map(|u| 1.0 - u).collect::<Vec<_>>(), degree),
                _ => polynomials(family, &points, degree),
            };
            if upper && *family == Family::Hermite {
                values.iter_mut().step_by(2).flatten().for_each(|value| *value = -*value);
            }
            let x = values.first().cloned().unwrap_or_default();
            if let Family::Knotted(own) = with_knots {
                values = own.columns(values, degree);
            }
            let [edge, near] = [PANELS, PANELS + 1];
            let tangent = |of: &Vec<f64>| -> Vec<f64> {
                let slope = (of[edge] - of[near]) / (x[edge] - x[near]);
                // The slope is undefined between two levels of a discrete distribution.
                let slope = if slope.is_finite() { slope } else { 0.0 };
                x[..PANELS].iter().map(|x_node| of[edge] + slope * (x_node - x[edge])).collect()
            };
            let tangents = values.iter().map(tangent).collect();
            values.iter_mut().for_each(|of| of.truncate(PANELS));
            Self { is_knot: false, weights: weights.clone(), values, tangents }
        };
        is_upper.iter().map(tail).collect()
    }

    /// Returns the steps and kinks of a factor with functions of `family`.
    fn knots(family: &Family) -> Vec<Self> {
        let Family::Knotted(own) = family else { return Vec::new() };
        let of_knot = |knot: &Knot| {
            let [before, after] = [-KNOT_SIDE, KNOT_SIDE].map(|by| polynomials(family, &[knot.u + by], own.degree()));
            let weights = vec![knot.width / 12.0f64.sqrt()];
            Self { is_knot: true, weights, values: before, tangents: after }
        };
        own.knots().iter().map(of_knot).collect()
    }

    /// Computes the departure of the polynomial with `coefficients` (degree, coefficient) and the constant `offset`
    /// from its tangent: the means of the absolute differences, and of those of the squares.
    fn departure(&self, coefficients: &[(usize, f64)], offset: f64) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (node, weight) in self.weights.iter().enumerate() {
            let sum = |columns: &[Vec<f64>]| -> f64 {
                offset + coefficients.iter().map(|&(degree, b)| b * columns[degree - 1][node]).sum::<f64>()
            };
            let (p, q) = (sum(&self.values), sum(&self.tangents));
            sums[0] += weight * (p - q).abs();
            sums[1] += weight * (p * p - q * q).abs();
        }
        sums
    }
}

/// The errors due to the tails of expansions, of an output scaled to variance 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Beyond {
    /// Error of the mean.
    pub mean: f64,
    /// Error of the variance.
    pub variance: f64,
    /// Error of V S of every swap.
    pub first_order: Vec<f64>,
    /// Error of V ST of every swap.
    pub total: Vec<f64>,
    /// Error of V S_jk of the pairs of factors.
    pub pairs: Vec<f64>,
}

impl Beyond {
    /// Computes the errors of the mean of `expansions` in polynomials of `families`, fitted to runs at `points` points
    /// with a mean square residual of `rest`.
    pub fn new(expansions: &[Expansion], families: &[Family], points: u64, rest: f64, effects: &Effects) -> Self {
        let mut all = Self {
            mean: 0.0,
            variance: 0.0,
            first_order: vec![0.0; effects.swaps.len()],
            total: vec![0.0; effects.swaps.len()],
            pairs: vec![0.0; effects.pairs.len()],
        };
        let mass = 1.0 / points.max(2) as f64;
        let rest = rest.max(0.0).sqrt();
        for (factor, family) in families.iter().enumerate() {
            let degree_of = |expansion: &Expansion| degree(&expansion.terms, factor);
            let degree = expansions.iter().map(degree_of).max().unwrap_or(0);
            let mut tails = if degree > 1 { Tail::both(family, mass, degree) } else { Vec::new() };
            tails.extend(Tail::knots(family));
            for expansion in expansions.iter().filter(|_| !tails.is_empty()) {
                for (others, Group { coefficients, offset }) in groups(expansion, factor) {
                    let highest = coefficients.iter().map(|(degree, _)| *degree).max().unwrap_or(0);
                    let weight = (libm::pow(GROWTH, highest as f64) * rest).min(1.0) / expansions.len() as f64;
                    let sum_of = |is_knot: bool| {
                        let sum = |[a, b]: [f64; 2], tail: &Tail| {
                            let [more_a, more_b] = tail.departure(&coefficients, offset);
                            [a + more_a, b + more_b]
                        };
                        tails.iter().filter(|tail| tail.is_knot == is_knot).fold([0.0; 2], sum)
                    };
                    let [[tail_mean, tail_square], [knot_mean, knot_square]] = [false, true].map(sum_of);
                    let share = 1.0 / expansions.len() as f64;
                    let of_mean = weight * tail_mean + share * knot_mean;
                    let of_square = weight * tail_square + share * knot_square;
                    if others.is_empty() {
                        all.mean += of_mean;
                    }
                    all.add(&with(&others, factor), of_square, effects);
                }
            }
        }
        all
    }

    fn add(&mut self, term: &[(usize, usize)], error: f64, Effects { swaps, pairs }: &Effects) {
        self.variance += error;
        for (number, swap) in swaps.iter().enumerate() {
            self.first_order[number] += if within(term, swap) { error } else { 0.0 };
            self.total[number] += if touches(term, swap) { error } else { 0.0 };
        }
        for (of_pair, &(j, k)) in self.pairs.iter_mut().zip(pairs) {
            *of_pair += if is_interaction(term, &swaps[j], &swaps[k]) { error } else { 0.0 };
        }
    }
}

/// Returns the largest degree of a factor in `terms`.
fn degree(terms: &[Term], factor: usize) -> usize {
    terms.iter().flatten().filter(|(of, _)| *of == factor).map(|(_, degree)| *degree).max().unwrap_or(0)
}

/// Returns `rest` with the factor inserted; its degree is irrelevant.
fn with(rest: &[(usize, usize)], factor: usize) -> Term {
    let mut term = rest.to_vec();
    term.insert(term.partition_point(|(other, _)| *other < factor), (factor, 1));
    term
}

/// The polynomials of one factor that are multiplied by the same polynomials of the others.
#[derive(Default)]
struct Group {
    /// Degrees and coefficients.
    coefficients: Vec<(usize, f64)>,
    /// The coefficient of the term without the factor.
    offset: f64,
}

/// Returns the polynomials of `factor`, grouped by the polynomials that multiply them.
fn groups(expansion: &Expansion, factor: usize) -> BTreeMap<Term, Group> {
    let mut groups: BTreeMap<Term, Group> = BTreeMap::new();
    let terms = || expansion.terms.iter().zip(&expansion.coefficients);
    for (term, b) in terms() {
        if let Ok(place) = term.binary_search_by_key(&factor, |(factor, _)| *factor) {
            let mut rest = term.clone();
            let (_, degree) = rest.remove(place);
            groups.entry(rest).or_default().coefficients.push((degree, *b));
        }
    }
    // The mean does not contribute to the variance.
    for (term, b) in terms().filter(|(term, _)| !term.is_empty()) {
        if let Some(group) = groups.get_mut(term) {
            group.offset = *b;
        }
    }
    groups
}

#[cfg(test)]
mod tests;
