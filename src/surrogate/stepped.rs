//! Polynomials of a factor with steps and kinks, all orthonormalised in their order, steps and kinks first: most of what has
//! them is a sum of few of the functions then.

use super::family::{Family, polynomials};
use super::orthogonal::rule;
use apportion_base::sum::{add_scaled, product};

/// Panels of the quadrature, each half as wide as the one before it, towards either end.
const PANELS: i32 = 50;

/// A step or a kink of an output in a factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knot {
    /// The quantile.
    pub u: f64,
    pub is_kink: bool,
}

impl Knot {
    /// Returns a step, or a hinge, at some quantiles.
    fn raw(self, u: f64) -> f64 {
        match (u > self.u, self.is_kink) {
            (false, _) => 0.0,
            (true, false) => 1.0,
            (true, true) => u - self.u,
        }
    }

    /// Returns the same with mean 0 and variance 1 over quantiles.
    pub fn standard(self, u: &[f64]) -> Vec<f64> {
        let above = 1.0 - self.u;
        let (mean, square) = if self.is_kink { (above * above / 2.0, above.powi(3) / 3.0) } else { (above, above) };
        let sd = (square - mean * mean).sqrt();
        u.iter().map(|u| (self.raw(*u) - mean) / sd).collect()
    }

    /// Returns the same with mean 0 and variance 1 over the places `all`.
    pub fn standard_over(self, all: &[f64], u: &[f64]) -> Vec<f64> {
        let values: Vec<f64> = all.iter().map(|u| self.raw(*u)).collect();
        let mean = apportion_base::sum::mean(&values);
        let sd = (values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / values.len() as f64).sqrt();
        u.iter().map(|u| (self.raw(*u) - mean) / sd).collect()
    }
}

/// The polynomials of a factor up to a degree, and functions of its knots with the indices after it.
#[derive(Debug, Clone, PartialEq)]
pub struct Stepped {
    /// The polynomials.
    pub base: Family,
    polynomials: usize,
    pub knots: Vec<Knot>,
    /// The width of the range of quantiles that contains each.
    pub widths: Vec<f64>,
    /// For each [`Knot::standard`], then each polynomial, its products with the functions up to it.
    rows: Vec<Vec<f64>>,
}

impl Stepped {
    /// Orthonormalises `knots`, and after them the polynomials of `base` up to a degree, by quadrature.
    pub fn new(base: &Family, degree: usize, knots: Vec<Knot>, widths: Vec<f64>) -> Self {
        let halves = (1..=PANELS).map(|k| 0.5f64.powi(k));
        let mut ends: Vec<f64> = halves.flat_map(|h| [h, 1.0 - h]).chain(knots.iter().map(|knot| knot.u)).collect();
        ends.sort_by(f64::total_cmp);
        let (u, weights): (Vec<f64>, Vec<f64>) = ends.windows(2).flat_map(|pair| rule(pair[0], pair[1])).unzip();
        let mut columns: Vec<Vec<f64>> = knots.iter().map(|knot| knot.standard(&u)).collect();
        columns.extend(polynomials(base, &u, degree));
        for column in &mut columns {
            column.iter_mut().zip(&weights).for_each(|(value, weight)| *value *= weight.sqrt());
        }
        Self { base: base.clone(), polynomials: degree, knots, widths, rows: lower_factor(&columns) }
    }

    /// Returns the same with another place and width of its only knot.
    pub fn with_knot(&self, knot: Knot, width: f64) -> Self {
        Self::new(&self.base, self.polynomials, vec![knot], vec![width])
    }

    /// Returns the largest index of a function.
    pub fn degree(&self) -> usize {
        self.polynomials + self.knots.len()
    }

    /// Returns the functions at the quantiles `u`: what is new in each polynomial, then in each knot. `polynomials`
    /// returns those of the base up to a degree there.
    pub fn columns(&self, polynomials: impl Fn(&Family, usize) -> Vec<Vec<f64>>, u: &[f64]) -> Vec<Vec<f64>> {
        let mut columns: Vec<Vec<f64>> = self.knots.iter().map(|knot| knot.standard(u)).collect();
        columns.extend(polynomials(&self.base, self.polynomials));
        for (k, row) in self.rows.iter().enumerate() {
            let (before, own) = columns.split_at_mut(k);
            for (weight, earlier) in row.iter().zip(before) {
                add_scaled(&mut own[0], -weight, earlier);
            }
            own[0].iter_mut().for_each(|value| *value /= row[k]);
        }
        columns.rotate_left(self.knots.len());
        columns
    }

    /// Returns the parts of a polynomial, a step or a hinge along the functions.
    pub fn parts(&self, index: usize) -> Vec<(usize, f64)> {
        let (knots, all) = (self.knots.len(), self.degree());
        let row = &self.rows[(index - 1 + knots) % all];
        row.iter().enumerate().map(|(k, part)| ((k + all - knots) % all + 1, *part)).collect()
    }
}

/// Returns the lower triangular factor of the inner products of `columns`, with a ridge at the size of rounding.
fn lower_factor(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let trace: f64 = columns.iter().map(|column| product(column, column)).sum();
    let ridge = 1e-12 * trace / columns.len().max(1) as f64;
    let mut lower: Vec<Vec<f64>> = Vec::with_capacity(columns.len());
    for (i, column) in columns.iter().enumerate() {
        let mut row: Vec<f64> = columns[..=i].iter().map(|other| product(column, other)).collect();
        row[i] += ridge;
        for j in 0..i {
            row[j] = (row[j] - product(&row[..j], &lower[j])) / lower[j][j];
        }
        row[i] = (row[i] - product(&row[..i], &row[..i])).max(f64::MIN_POSITIVE).sqrt();
        lower.push(row);
    }
    lower
}

#[cfg(test)]
#[path = "tests/stepped.rs"]
mod tests;
