//! The functions of every factor at the rows: orthonormal polynomials, then steps.

use std::ops::Range;

use super::kernel::Kernel;
use super::linear::{LANES, Panels};
use crate::space::Distribution;
use crate::surrogate::family::{Family, polynomials};
use crate::surrogate::orthogonal::rule;
use crate::surrogate::stepped::{Step, Stepped};
use apportion_base::sum::product;

/// One factor.
#[derive(Debug, Clone)]
pub struct Factor {
    family: Family,
    /// The place of every row in the distribution of the factor, between 0 and 1.
    pub places: Vec<f64>,
    /// The polynomials of degree 1, 2, ... at the rows.
    polynomials: Vec<Vec<f64>>,
    /// The places of steps.
    steps: Vec<f64>,
    /// The steps at the rows.
    step_values: Vec<Vec<f64>>,
}

impl Factor {
    /// Creates a factor with at most `degree` polynomials of `family`: of quantiles, or of the values of a column.
    pub fn new(family: &Family, values: &[f64], degree: usize) -> Self {
        let degree = degree.min(family.degree());
        let mut polynomials = if degree > 0 { polynomials(family, values, degree) } else { Vec::new() };
        polynomials.truncate(degree);
        let places = if matches!(family, Family::Column(_)) { centred_ranks(values) } else { values.to_vec() };
        Self { family: family.clone(), places, polynomials, steps: Vec::new(), step_values: Vec::new() }
    }

    /// Returns the factor without its steps.
    pub fn without_steps(&self) -> Self {
        Self { steps: Vec::new(), step_values: Vec::new(), ..self.clone() }
    }

    /// Returns its polynomials with its steps, of which each lies somewhere between two neighbouring rows.
    pub fn with_steps(&self) -> Family {
        if self.steps.is_empty() {
            return self.family.clone();
        }
        let steps = self.steps.iter().map(|at| Step { u: *at, width: self.gap(*at) });
        Family::Stepped(Box::new(Stepped::new(&self.family, self.degree(), steps.collect())))
    }

    /// Returns the distance of the rows on either side of a place.
    pub fn gap(&self, at: f64) -> f64 {
        let above = self.places.iter().copied().filter(|u| *u > at).fold(1.0, f64::min);
        above - self.places.iter().copied().filter(|u| *u < at).fold(0.0, f64::max)
    }

    /// Returns the number of polynomials.
    pub fn degree(&self) -> usize {
        self.polynomials.len()
    }

    /// Returns whether an output may have steps in it: few levels have as many polynomials.
    pub fn may_have_steps(&self) -> bool {
        self.degree() > 0 && !matches!(&self.family, Family::Orthogonal(polynomials) if polynomials.has_levels())
    }

    /// Returns the places of its steps.
    pub fn steps(&self) -> &[f64] {
        &self.steps
    }

    /// Adds a step.
    pub fn add_step(&mut self, at: f64) {
        self.steps.push(at);
        self.step_values.push(self.step(at, &self.places));
    }

    /// Moves a step.
    pub fn move_step(&mut self, number: usize, at: f64) {
        self.steps[number] = at;
        self.step_values[number] = self.step(at, &self.places);
    }

    /// Returns 1(u > at) at some places, with mean 0 and variance 1 in the distribution.
    pub fn step(&self, at: f64, places: &[f64]) -> Vec<f64> {
        let above = match self.family {
            Family::Column(_) => self.places.iter().filter(|u| **u > at).count() as f64 / self.places.len() as f64,
            _ => 1.0 - at,
        };
        let scale = (above * (1.0 - above)).sqrt();
        places.iter().map(|u| (f64::from(u8::from(*u > at)) - above) / scale).collect()
    }

    /// Returns the values of the function with this index, from 1: of a polynomial, or of a step after them.
    fn function(&self, index: usize) -> &[f64] {
        let polynomials = self.polynomials.len();
        if index <= polynomials { &self.polynomials[index - 1] } else { &self.step_values[index - polynomials - 1] }
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
    /// Returns the polynomials up to `degree` and the steps of every factor at the first `rows` rows.
    pub fn kernel(&self, rows: usize, degree: usize) -> Kernel {
        let functions = self.factors.iter().map(|factor| {
            let columns = factor.polynomials.iter().take(degree).chain(&factor.step_values);
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
/// that end at the steps and become narrow towards the ends, or the rows of a column.
pub fn integration(factor: &Factor) -> (Vec<Vec<f64>>, Vec<f64>) {
    if matches!(factor.family, Family::Column(_)) {
        let functions = factor.polynomials.iter().chain(&factor.step_values).cloned().collect();
        return (functions, vec![1.0 / factor.places.len() as f64; factor.places.len()]);
    }
    let mut ends = vec![0.0, 1.0];
    ends.extend((2..53).flat_map(|k| [0.5f64.powi(k), 1.0 - 0.5f64.powi(k)]));
    ends.extend(&factor.steps);
    ends.sort_by(f64::total_cmp);
    let nodes = ends.windows(2).flat_map(|pair| rule(pair[0], pair[1]));
    let (u, weights): (Vec<f64>, Vec<f64>) = nodes.map(|(u, weight)| (u.min(Distribution::LARGEST_U), weight)).unzip();
    let mut functions = if factor.degree() > 0 { polynomials(&factor.family, &u, factor.degree()) } else { Vec::new() };
    functions.truncate(factor.degree());
    functions.extend(factor.steps.iter().map(|at| factor.step(*at, &u)));
    (functions, weights)
}

/// Inner products of the functions of a factor, which are the identity but for the steps.
#[derive(Debug, Clone)]
pub struct Inner {
    degree: usize,
    /// For each step its products with the polynomials, then with the steps.
    steps: Vec<Vec<f64>>,
}

impl Inner {
    /// Computes those of a factor.
    pub fn new(factor: &Factor) -> Self {
        let degree = factor.degree();
        if factor.steps.is_empty() {
            return Self { degree, steps: Vec::new() };
        }
        let (functions, weights) = integration(factor);
        let steps = functions[degree..].iter().map(|step| {
            let weighted: Vec<f64> = step.iter().zip(&weights).map(|(s, w)| s * w).collect();
            functions.iter().map(|f| product(f, &weighted)).collect()
        });
        Self { degree, steps: steps.collect() }
    }

    /// Returns the inner product of two functions.
    pub fn at(&self, a: usize, b: usize) -> f64 {
        let (a, b) = (a.max(b), a.min(b));
        if a > self.degree { self.steps[a - self.degree - 1][b - 1] } else { f64::from(u8::from(a == b)) }
    }
}

#[cfg(test)]
mod tests;
