//! Polynomials of a factor with steps and kinks: what the polynomials leave of each, orthonormalised in their order.

use super::family::{Family, polynomials};
use super::gram::{Square, add_scaled, lower_factor};
use super::orthogonal::rule;

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
    /// For each knot the products of its [`Knot::standard`] with the polynomials and the functions of the knots up to it.
    rows: Vec<Vec<f64>>,
}

impl Stepped {
    /// Orthonormalises `knots` after the polynomials of `base` up to a degree, by quadrature.
    pub fn new(base: &Family, degree: usize, knots: Vec<Knot>, widths: Vec<f64>) -> Self {
        let halves = (1..=PANELS).map(|k| 0.5f64.powi(k));
        let mut ends: Vec<f64> = halves.flat_map(|h| [h, 1.0 - h]).chain(knots.iter().map(|knot| knot.u)).collect();
        ends.sort_by(f64::total_cmp);
        let (u, weights): (Vec<f64>, Vec<f64>) = ends.windows(2).flat_map(|pair| rule(pair[0], pair[1])).unzip();
        let mut columns = polynomials(base, &u, degree);
        columns.extend(knots.iter().map(|knot| knot.standard(&u)));
        for column in &mut columns {
            column.iter_mut().zip(&weights).for_each(|(value, weight)| *value *= weight.sqrt());
        }
        let mut gram = Square::zeros(columns.len());
        gram.add_products(&columns);
        Self { base: base.clone(), polynomials: degree, knots, widths, rows: lower_factor(&gram).split_off(degree) }
    }

    /// Returns the largest index of a function.
    pub fn degree(&self) -> usize {
        self.polynomials + self.knots.len()
    }

    /// Returns the functions at the quantiles `u`, given the polynomials there.
    pub fn columns(&self, mut columns: Vec<Vec<f64>>, u: &[f64]) -> Vec<Vec<f64>> {
        columns.truncate(self.polynomials);
        for (knot, row) in self.knots.iter().zip(&self.rows) {
            let mut column = knot.standard(u);
            for (weight, earlier) in row.iter().zip(&columns) {
                add_scaled(&mut column, -weight, earlier);
            }
            column.iter_mut().for_each(|value| *value /= row[columns.len()]);
            columns.push(column);
        }
        columns
    }

    /// Returns the parts of a polynomial, a step or a hinge along the functions.
    pub fn parts(&self, index: usize) -> Vec<(usize, f64)> {
        match index.checked_sub(self.polynomials + 1) {
            None => vec![(index, 1.0)],
            Some(knot) => self.rows[knot].iter().enumerate().map(|(k, part)| (k + 1, *part)).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_hinges_and_polynomials_are_orthonormal_and_span_them() {
        let knots = [(0.3, false), (0.8, true)].map(|(u, is_kink)| Knot { u, is_kink });
        let stepped = Stepped::new(&Family::Legendre, 5, knots.into(), vec![0.0; 2]);
        let n = 100_000;
        let u: Vec<f64> = (0..n).map(|k| (f64::from(k) + 0.5) / f64::from(n)).collect();
        let columns = polynomials(&Family::Stepped(Box::new(stepped.clone())), &u, 5);
        assert_eq!(columns.len(), 7);
        for (i, a) in columns.iter().enumerate() {
            for (j, b) in columns.iter().enumerate() {
                let product = a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / f64::from(n);
                assert!((product - f64::from(u8::from(i == j))).abs() < 1e-6, "{i} {j} {product}");
            }
        }
        for (knot, index) in knots.into_iter().zip([6, 7]) {
            let mut sum = vec![0.0; u.len()];
            stepped.parts(index).iter().for_each(|(k, part)| add_scaled(&mut sum, *part, &columns[k - 1]));
            let (exact, over) = (knot.standard(&u), knot.standard_over(&u, &u));
            assert!(sum.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-8));
            assert!(over.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-8));
        }
    }
}
