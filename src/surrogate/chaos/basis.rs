//! The functions of every factor at the rows: orthonormal polynomials, then steps and hinges.

use std::ops::Range;

use super::kernel::Kernel;
use super::linear::{LANES, Panels};
use crate::space::Distribution;
use crate::surrogate::family::{Family, polynomials};
use crate::surrogate::orthogonal::rule;
use crate::surrogate::stepped::{Knot, Stepped};
use apportion_base::sum::product;

/// One factor.
#[derive(Debug, Clone)]
pub struct Factor {
    family: Family,
    /// The place of every row in the distribution of the factor, between 0 and 1.
    pub places: Vec<f64>,
    /// The polynomials of degree 1, 2, ... at the rows.
    polynomials: Vec<Vec<f64>>,
    knots: Vec<Knot>,
    /// The steps and hinges at the rows.
    knot_values: Vec<Vec<f64>>,
}

impl Factor {
    /// Creates a factor with at most `degree` polynomials of `family`: of quantiles, or of the values of a column.
    pub fn new(family: &Family, values: &[f64], degree: usize) -> Self {
        let degree = degree.min(family.degree());
        let mut polynomials = if degree > 0 { polynomials(family, values, degree) } else { Vec::new() };
        polynomials.truncate(degree);
        let places = if matches!(family, Family::Column(_)) { centred_ranks(values) } else { values.to_vec() };
        Self { family: family.clone(), places, polynomials, knots: Vec::new(), knot_values: Vec::new() }
    }

    pub fn family(&self) -> &Family {
        &self.family
    }

    /// Returns the factor without its knots.
    pub fn without_knots(&self) -> Self {
        Self { knots: Vec::new(), knot_values: Vec::new(), ..self.clone() }
    }

    /// Returns its polynomials with its steps and hinges, of which each lies somewhere between two neighbouring rows.
    pub fn with_knots(&self) -> Family {
        if self.knots.is_empty() {
            return self.family.clone();
        }
        let widths = self.knots.iter().map(|knot| self.gap(knot.u, |_| true)).collect();
        Family::Stepped(Box::new(Stepped::new(&self.family, self.degree(), self.knots.clone(), widths)))
    }

    /// Returns the distance of the rows on either side of a place, of those that are `shown`.
    pub fn gap(&self, at: f64, shown: impl Fn(usize) -> bool) -> f64 {
        let places = self.places.iter().enumerate().filter(|(row, _)| shown(*row)).map(|(_, u)| *u);
        let above = places.clone().filter(|u| *u > at).fold(1.0, f64::min);
        above - places.filter(|u| *u < at).fold(0.0, f64::max)
    }

    /// Returns the number of polynomials.
    pub fn degree(&self) -> usize {
        self.polynomials.len()
    }

    /// Returns whether an output may have knots in it: few levels have as many polynomials.
    pub fn may_have_knots(&self) -> bool {
        self.degree() > 0 && !self.family.has_levels()
    }

    pub fn knots(&self) -> &[Knot] {
        &self.knots
    }

    pub fn add_knot(&mut self, knot: Knot) {
        self.knots.push(knot);
        self.knot_values.push(self.at_knot(knot, &self.places));
    }

    pub fn move_knot(&mut self, number: usize, u: f64) {
        self.knots[number].u = u;
        self.knot_values[number] = self.at_knot(self.knots[number], &self.places);
    }

    /// Returns the step or the hinge at some places, with mean 0 and variance 1 in the distribution.
    pub fn at_knot(&self, knot: Knot, places: &[f64]) -> Vec<f64> {
        match self.family {
            Family::Column(_) => knot.standard_over(&self.places, places),
            _ => knot.standard(places),
        }
    }

    /// Returns the values of the function with this index, from 1: of a polynomial, or of a knot after them.
    pub fn function(&self, index: usize) -> &[f64] {
        let polynomials = self.polynomials.len();
        if index <= polynomials { &self.polynomials[index - 1] } else { &self.knot_values[index - polynomials - 1] }
    }
}

/// Returns for every value the share of smaller values, and half that of equal ones.
fn centred_ranks(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let ranks = values.iter().map(|value| {
        let below = sorted.partition_point(|other| other < value);
        let up_to = sorted.partition_point(|other| other <= value);
        (below + up_to) as f64 / (2 * values.len()) as f64
    });
    ranks.collect()
}

/// The factors.
#[derive(Debug, Clone)]
pub struct Basis {
    pub factors: Vec<Factor>,
    pub rows: usize,
    /// The part to which each of the rows that are fitted belongs: each part is left out once.
    pub parts: Vec<usize>,
}

impl Basis {
    /// Returns the number of parts.
    pub fn count_parts(&self) -> usize {
        self.parts.iter().max().map_or(0, |last| last + 1)
    }

    /// Returns the rows that are fitted without one of the parts, and its own; without the number after the last one
    /// all.
    pub fn without(&self, part: usize) -> (Vec<usize>, Vec<usize>) {
        (0..self.parts.len()).partition(|row| self.parts[*row] != part)
    }

    /// Returns the polynomials up to `degree` and the steps and hinges of every factor at the first `rows` rows.
    pub fn kernel(&self, rows: usize, degree: usize) -> Kernel {
        let functions = self.factors.iter().map(|factor| {
            let columns = factor.polynomials.iter().take(degree).chain(&factor.knot_values);
            let columns: Vec<&[f64]> = columns.map(|column| &column[..rows]).collect();
            let mut panels = Panels::zeros(columns.len(), rows);
            for p in 0..panels.panels() {
                for (lane, column) in panels.panel_mut(p).iter_mut().zip(&columns) {
                    let part = &column[p * LANES..rows.min((p + 1) * LANES)];
                    lane[..part.len()].copy_from_slice(part);
                }
            }
            panels
        });
        Kernel { functions: functions.collect(), rows }
    }

    /// Returns the values of a term at some rows.
    pub fn values(&self, term: &[(usize, usize)], rows: Range<usize>) -> Vec<f64> {
        let mut values = vec![1.0; rows.len()];
        for (factor, index) in term {
            let function = &self.factors[*factor].function(*index)[rows.clone()];
            values.iter_mut().zip(function).for_each(|(value, f)| *value *= f);
        }
        values
    }
}

/// Returns the functions of a factor at nodes, and weights of these that integrate under its distribution: on panels
/// that end at the knots and become narrow towards the ends, or the rows of a column.
pub fn integration(factor: &Factor) -> (Vec<Vec<f64>>, Vec<f64>) {
    if matches!(factor.family, Family::Column(_)) {
        let functions = factor.polynomials.iter().chain(&factor.knot_values).cloned().collect();
        return (functions, vec![1.0 / factor.places.len() as f64; factor.places.len()]);
    }
    let mut ends = vec![0.0, 1.0];
    ends.extend((2..53).flat_map(|k| [0.5f64.powi(k), 1.0 - 0.5f64.powi(k)]));
    ends.extend(factor.knots.iter().map(|knot| knot.u));
    ends.sort_by(f64::total_cmp);
    let nodes = ends.windows(2).flat_map(|pair| rule(pair[0], pair[1]));
    let (u, weights): (Vec<f64>, Vec<f64>) = nodes.map(|(u, weight)| (u.min(Distribution::LARGEST_U), weight)).unzip();
    let mut functions = if factor.degree() > 0 { polynomials(&factor.family, &u, factor.degree()) } else { Vec::new() };
    functions.truncate(factor.degree());
    functions.extend(factor.knots.iter().map(|knot| factor.at_knot(*knot, &u)));
    (functions, weights)
}

/// Inner products of the functions of a factor, which are the identity but for the knots.
#[derive(Debug, Clone)]
pub struct Inner {
    degree: usize,
    /// For each knot its products with the polynomials, then with the knots.
    knots: Vec<Vec<f64>>,
}

impl Inner {
    /// Computes those of a factor.
    pub fn new(factor: &Factor) -> Self {
        let degree = factor.degree();
        if factor.knots.is_empty() {
            return Self { degree, knots: Vec::new() };
        }
        let (functions, weights) = integration(factor);
        let knots = functions[degree..].iter().map(|knot| {
            let weighted: Vec<f64> = knot.iter().zip(&weights).map(|(s, w)| s * w).collect();
            functions.iter().map(|f| product(f, &weighted)).collect()
        });
        Self { degree, knots: knots.collect() }
    }

    /// Returns the inner product of two functions.
    pub fn at(&self, a: usize, b: usize) -> f64 {
        let (a, b) = (a.max(b), a.min(b));
        if a > self.degree { self.knots[a - self.degree - 1][b - 1] } else { f64::from(u8::from(a == b)) }
    }
}

#[cfg(test)]
#[path = "tests/basis.rs"]
mod tests;
