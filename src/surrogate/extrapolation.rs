//! The error of expansions in the tails of their factors, where there are no runs.
//!
//! The indices of an expansion are computed exactly, which includes regions where no run shows whether it is right. A
//! polynomial of high degree in an unbounded variable has most of its variance there. Its departure in the tails from
//! the tangents at their edges, straight in the values of the factor, is therefore counted as a part of the error of
//! every number to which it contributes; less of it if the expansion fits well or its degree is low, since a function
//! close to a polynomial of low degree continues like one. The rise of the tangents counts too, in proportion to the
//! residual: where a tail is heavy, it is most of the variance of a straight line.
//!
//! Runs also do not show where a step lies between two sampled values. The departure of the two sides of a step from
//! one another counts as if the step were uniform over the width of its range, of standard deviation width/sqrt(12).

use std::collections::BTreeMap;

use super::expansion::Expansion;
use super::family::{Family, polynomials, upper_polynomials};
use super::terms::{Effects, Term, is_interaction, touches, within};

/// Width of the panels of the midpoint rule in ln u, and their number, down to 1e-17 of the edge.
const STEP: f64 = 0.25;
const PANELS: usize = 160;

/// Relative distance from the edge of the two values of u used for slopes.
const NEAR: f64 = 1e-5;

/// Distance in u to either side of a step.
const STEP_SIDE: f64 = 1e-9;

/// Multiple of the root mean square residual that counts for every degree of a polynomial, times its departure; limited
/// to the whole departure. Polynomials that are small at the runs grow this fast beyond them, as those of Chebyshev do.
/// Measured on sines, exponentials and powers of normal factors.
const GROWTH: f64 = 3.2;

/// Probability of the counts that are not among the levels of a factor.
const RARE_COUNTS: f64 = 2e-3;

/// Share of the square of a group below which a coefficient is rounding or noise.
const NOTHING: f64 = 1e-10;

/// Multiple of the last level among the rows that an output may have at the levels beyond, if nothing determines them.
const OPEN: f64 = 2.0;

/// A function that returns the polynomials of a family at a distance in the quantile from one of its ends.
type Polynomials = fn(&Family, &[f64], usize) -> Vec<Vec<f64>>;

/// One tail of a factor, from its edge outwards; or a step, with its two sides instead of the tail and its tangents.
struct Tail {
    /// Probabilities of the nodes.
    weights: Vec<f64>,
    /// The polynomials of degree 1, 2, ... at the nodes.
    values: Vec<Vec<f64>>,
    /// Their tangents at the edge, at the nodes and, of a tail, at the edge itself.
    tangents: Vec<Vec<f64>>,
}

impl Tail {
    /// Returns both tails of a factor with polynomials of `family`, each of probability `mass`; none without tails.
    fn both(family: &Family, mass: f64, degree: usize) -> Vec<Self> {
        let has_tails = matches!(family.own(), Family::Hermite | Family::Orthogonal(_)) && family.own().degree() > 0;
        if !has_tails {
            return Vec::new();
        }
        [polynomials, upper_polynomials].map(|polynomials| Self::new(family, mass, degree, polynomials)).into()
    }

    /// Returns the lower or the upper one of them, given the function that returns its polynomials.
    fn new(family: &Family, mass: f64, degree: usize, polynomials: Polynomials) -> Self {
        let nodes: Vec<f64> = (0..PANELS).map(|k| mass * libm::exp(-(STEP * (k as f64 + 0.5)))).collect();
        let weights = nodes.iter().map(|u| u * STEP).collect();
        let points: Vec<f64> = nodes.into_iter().chain([mass, mass * (1.0 + NEAR)]).collect();
        let mut values = polynomials(family, &points, degree);
        let x = polynomials(family.own(), &points, 1).swap_remove(0);
        let tangents = values.iter().map(|of| tangent(&x, of)).collect();
        values.iter_mut().for_each(|of| of.truncate(PANELS));
        Self { weights, values, tangents }
    }

    /// Returns the steps of a factor with functions of `family`.
    fn steps(family: &Family, degree: usize) -> Vec<Self> {
        let Family::Stepped(stepped) = family else { return Vec::new() };
        let sides = stepped.knots.iter().zip(&stepped.widths).map(|(knot, width)| {
            let [before, after] = [-STEP_SIDE, STEP_SIDE].map(|by| polynomials(family, &[knot.u + by], degree));
            Self { weights: vec![width / 12.0f64.sqrt()], values: before, tangents: after }
        });
        sides.collect()
    }

    /// Computes the departure of the polynomial of `group` from its tangent, at most to this multiple of it.
    fn departure(&self, group: &Group, most: f64) -> Departure {
        let mut departure = Departure::default();
        for (node, weight) in self.weights.iter().enumerate() {
            let (p, q) = (group.value(&self.values, node), group.value(&self.tangents, node));
            departure.add(*weight, if p.abs() > most * q.abs() { most * q } else { p }, q);
        }
        departure
    }

    /// Computes the mean square of the departure of the two sides of a step from each other.
    fn departure_squared(&self, group: &Group) -> f64 {
        let by = group.value(&self.values, 0) - group.value(&self.tangents, 0);
        self.weights[0] * by * by
    }

    /// Computes the departure of the tangent from its value at the edge.
    fn rise(&self, group: &Group) -> Departure {
        let mut departure = Departure::default();
        let edge = group.value(&self.tangents, PANELS);
        for (node, weight) in self.weights.iter().enumerate() {
            departure.add(*weight, group.value(&self.tangents, node), edge);
        }
        departure
    }
}

/// Returns the tangent at the edge of a polynomial with the values `of`, at the nodes and at the edge; `x` is that of degree 1.
fn tangent(x: &[f64], of: &[f64]) -> Vec<f64> {
    let [edge, near] = [PANELS, PANELS + 1];
    let slope = (of[edge] - of[near]) / (x[edge] - x[near]);
    // The slope is undefined between two levels of a discrete distribution.
    let slope = if slope.is_finite() { slope } else { 0.0 };
    x[..=PANELS].iter().map(|x_node| of[edge] + slope * (x_node - x[edge])).collect()
}

/// The departure of a polynomial from its tangents: the mean of the absolute differences, and of those of the squares.
#[derive(Default)]
struct Departure {
    mean: f64,
    square: f64,
}

impl Departure {
    /// Adds that of `p` from `q` at a node.
    fn add(&mut self, weight: f64, p: f64, q: f64) {
        self.mean += weight * (p - q).abs();
        self.square += weight * (p * p - q * q).abs();
    }

    /// Computes the sum over some tails.
    fn sum(tails: &[Tail], of: impl Fn(&Tail) -> Self) -> Self {
        let mut sum = Self::default();
        for Self { mean, square } in tails.iter().map(of) {
            sum.mean += mean;
            sum.square += square;
        }
        sum
    }
}

/// The errors due to the tails of expansions, of an output scaled to variance 1.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ExtrapolationError {
    /// Error of the mean.
    pub mean: f64,
    /// Error of the variance.
    pub variance: f64,
    /// What any effect may gain or lose: where the places of steps depend on other factors, within their widths, and at
    /// combinations of levels that no row has.
    pub of_any: f64,
    /// Error of V S of every swap.
    pub first_order: Vec<f64>,
    /// Error of V ST of every swap.
    pub total: Vec<f64>,
    /// Error of V S_jk of the pairs of factors.
    pub pairs: Vec<f64>,
}

impl ExtrapolationError {
    /// Computes the errors of the mean of `expansions` in polynomials of `families`, fitted to runs at `points` points
    /// with a mean square residual of `rest`.
    pub fn new(expansions: &[Expansion], families: &[Family], points: u64, rest: f64, effects: &Effects) -> Self {
        let mut all = Self {
            mean: 0.0,
            variance: 0.0,
            of_any: 0.0,
            first_order: vec![0.0; effects.swaps.len()],
            total: vec![0.0; effects.swaps.len()],
            pairs: vec![0.0; effects.pairs.len()],
        };
        let mass = 1.0 / points.max(2) as f64;
        let rest = rest.clamp(0.0, 1.0).sqrt();
        let share = 1.0 / expansions.len() as f64;
        let groups: Vec<BTreeMap<(usize, Term), Group>> = expansions.iter().map(groups).collect();
        for (factor, family) in families.iter().enumerate() {
            let degree = expansions.iter().map(|expansion| degree(&expansion.terms, factor)).max().unwrap_or(0);
            let tails = if degree > 0 { Tail::both(family, mass, degree) } else { Vec::new() };
            let levels = match family.own() {
                Family::Orthogonal(polynomials) => polynomials.levels_among(1.0 / mass),
                _ => None,
            };
            let steps = if degree > 0 { Tail::steps(family, degree) } else { Vec::new() };
            if tails.is_empty() && steps.is_empty() {
                continue;
            }
            let mut open = vec![0.0; steps.len()];
            let of_factor = (factor, Term::new())..(factor + 1, Term::new());
            for ((_, others), group) in groups.iter().flat_map(|groups| groups.range(of_factor.clone())) {
                let highest = group.highest(0.0);
                // A close fit determines tails, and no steps. One that passes through all levels shows nothing.
                let is_open = levels.is_some_and(|levels| group.highest(NOTHING) + 1 >= levels);
                let by_rest = (libm::pow(GROWTH, highest as f64) * rest).min(1.0);
                let (weight, most) = if is_open { (share, OPEN) } else { (share * by_rest, f64::INFINITY) };
                let tail = Departure::sum(&tails, |tail| tail.departure(group, most));
                let step = Departure::sum(&steps, |step| step.departure(group, f64::INFINITY));
                let rise = Departure::sum(&tails, |tail| tail.rise(group));
                let mean = weight * tail.mean + share * (step.mean + rest * rise.mean);
                if others.is_empty() {
                    all.mean += mean;
                } else {
                    // The mean over the factor is the coefficient of the others.
                    all.add_to_parts(others, 2.0 * group.offset.abs() * mean, effects);
                }
                let square = weight * tail.square + share * (step.square + rest * rise.square);
                all.add(&with(others, factor), square, effects);
                let of_steps = open.iter_mut().zip(&steps);
                of_steps.for_each(|(open, step)| *open += share * step.departure_squared(group));
            }
            all.of_any = open.into_iter().fold(all.of_any, libm::hypot);
        }
        all
    }

    /// Adds what the rarest counts, which have no terms of their own, may contribute to those of an expansion: counts of at
    /// most this probability.
    pub fn with_rare_counts<'a>(
        mut self,
        terms: impl Iterator<Item = (&'a Term, f64)>,
        most: f64,
        families: &[Family],
        effects: &Effects,
    ) -> Self {
        let of_counts = terms.filter(|(term, _)| term.iter().any(|(factor, _)| families[*factor].is_count()));
        of_counts.for_each(|(term, b)| self.add(term, most.min(RARE_COUNTS) * b * b, effects));
        self
    }

    /// Adds an error of any effect.
    pub fn with_any(self, error: f64) -> Self {
        Self { of_any: self.of_any + error, ..self }
    }

    fn add(&mut self, term: &[(usize, usize)], error: f64, effects: &Effects) {
        self.variance += error;
        for (total, swap) in self.total.iter_mut().zip(&effects.swaps) {
            *total += if touches(term, swap) { error } else { 0.0 };
        }
        self.add_to_parts(term, error, effects);
    }

    /// Adds an error to the effects of which `term` is the whole or a part, except the total ones.
    fn add_to_parts(&mut self, term: &[(usize, usize)], error: f64, Effects { swaps, pairs }: &Effects) {
        for (first_order, swap) in self.first_order.iter_mut().zip(swaps) {
            *first_order += if within(term, swap) { error } else { 0.0 };
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
pub(crate) struct Group {
    /// Degrees and coefficients.
    pub coefficients: Vec<(usize, f64)>,
    /// The coefficient of the term without the factor; 0 for the constant, which does not contribute to the variance.
    pub offset: f64,
}

impl Group {
    /// Returns the highest degree whose coefficient has more than this share of their square.
    fn highest(&self, share: f64) -> usize {
        let square: f64 = self.coefficients.iter().map(|(_, b)| b * b).sum();
        let large = self.coefficients.iter().filter(|(_, b)| b * b >= share * square);
        large.map(|(degree, _)| *degree).max().unwrap_or(0)
    }

    /// Returns their sum at a node, given the polynomials of degree 1, 2, ... at the nodes.
    fn value(&self, columns: &[Vec<f64>], node: usize) -> f64 {
        self.offset + self.coefficients.iter().map(|&(degree, b)| b * columns[degree - 1][node]).sum::<f64>()
    }
}

/// Returns the polynomials of every factor, grouped by the factor and the polynomials that multiply them.
pub(crate) fn groups(expansion: &Expansion) -> BTreeMap<(usize, Term), Group> {
    let mut groups: BTreeMap<(usize, Term), Group> = BTreeMap::new();
    for (term, b) in expansion.varying() {
        for (place, &(factor, degree)) in term.iter().enumerate() {
            let mut others = term.clone();
            others.remove(place);
            groups.entry((factor, others)).or_default().coefficients.push((degree, b));
        }
    }
    let coefficients: BTreeMap<&Term, f64> = expansion.varying().collect();
    for ((_, others), group) in &mut groups {
        group.offset = coefficients.get(others).copied().unwrap_or(0.0);
    }
    groups
}

#[cfg(test)]
#[path = "tests/extrapolation.rs"]
mod tests;
