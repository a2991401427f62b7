//! Polynomials of a factor with steps: what the polynomials leave of each step, orthonormalised in their order.

use super::family::{Family, polynomials};
use super::gram::{Square, add_scaled, lower_factor};
use super::orthogonal::rule;

/// Panels of the quadrature, each half as wide as the one before it, towards either end.
const PANELS: i32 = 50;

/// A step of an output in a factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// The quantile.
    pub u: f64,
    /// Width of the range of quantiles that contains it.
    pub width: f64,
}

/// The polynomials of a factor up to a degree, and functions of its steps with the indices after it.
#[derive(Debug, Clone, PartialEq)]
pub struct Stepped {
    /// The polynomials.
    pub base: Family,
    polynomials: usize,
    pub steps: Vec<Step>,
    /// For each step, of mean 0 and variance 1, its products with the polynomials and the functions of the steps up to it.
    rows: Vec<Vec<f64>>,
}

impl Stepped {
    /// Orthonormalises `steps` after the polynomials of `base` up to a degree, by quadrature.
    pub fn new(base: &Family, degree: usize, steps: Vec<Step>) -> Self {
        let halves = (1..=PANELS).map(|k| 0.5f64.powi(k));
        let mut ends: Vec<f64> = halves.flat_map(|h| [h, 1.0 - h]).chain(steps.iter().map(|step| step.u)).collect();
        ends.sort_by(f64::total_cmp);
        let (u, weights): (Vec<f64>, Vec<f64>) = ends.windows(2).flat_map(|pair| rule(pair[0], pair[1])).unzip();
        let mut columns = polynomials(base, &u, degree);
        columns.extend(steps.iter().map(|step| standard(step.u, &u.iter().map(|u| *u > step.u).collect::<Vec<bool>>())));
        for column in &mut columns {
            column.iter_mut().zip(&weights).for_each(|(value, weight)| *value *= weight.sqrt());
        }
        let mut gram = Square::zeros(columns.len());
        gram.add_products(&columns);
        Self { base: base.clone(), polynomials: degree, steps, rows: lower_factor(&gram).split_off(degree) }
    }

    /// Returns the largest index of a function.
    pub fn degree(&self) -> usize {
        self.polynomials + self.steps.len()
    }

    /// Returns the functions, given the polynomials, and whether the rows are above a place.
    pub fn columns(&self, mut polynomials: Vec<Vec<f64>>, is_above: impl Fn(f64) -> Vec<bool>) -> Vec<Vec<f64>> {
        polynomials.truncate(self.polynomials);
        let mut columns = polynomials;
        for (step, row) in self.steps.iter().zip(&self.rows) {
            let mut column = standard(step.u, &is_above(step.u));
            for (weight, earlier) in row.iter().zip(&columns) {
                add_scaled(&mut column, -weight, earlier);
            }
            column.iter_mut().for_each(|value| *value /= row[columns.len()]);
            columns.push(column);
        }
        columns
    }

    /// Returns the parts of a polynomial or a step along the functions.
    pub fn parts(&self, index: usize) -> Vec<(usize, f64)> {
        match index.checked_sub(self.polynomials + 1) {
            None => vec![(index, 1.0)],
            Some(step) => self.rows[step].iter().enumerate().map(|(k, part)| (k + 1, *part)).collect(),
        }
    }
}

/// Returns a step of mean 0 and variance 1.
fn standard(at: f64, is_above: &[bool]) -> Vec<f64> {
    let scale = (at * (1.0 - at)).sqrt();
    is_above.iter().map(|above| (f64::from(u8::from(*above)) - (1.0 - at)) / scale).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_polynomials_are_orthonormal_and_span_the_step() {
        let steps = [0.3, 0.8].map(|u| Step { u, width: 0.01 });
        let family = Family::Stepped(Box::new(Stepped::new(&Family::Legendre, 5, steps.into())));
        let n = 100_000;
        let u: Vec<f64> = (0..n).map(|k| (f64::from(k) + 0.5) / f64::from(n)).collect();
        let columns = polynomials(&family, &u, 5);
        assert_eq!(columns.len(), 7);
        for (i, a) in columns.iter().enumerate() {
            for (j, b) in columns.iter().enumerate() {
                let product = a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / f64::from(n);
                assert!((product - f64::from(u8::from(i == j))).abs() < 1e-6, "{i} {j} {product}");
            }
        }
        let Family::Stepped(stepped) = &family else { unreachable!() };
        let mut sum = vec![0.0; u.len()];
        stepped.parts(7).iter().for_each(|(index, part)| add_scaled(&mut sum, *part, &columns[index - 1]));
        let step = standard(0.8, &u.iter().map(|u| *u > 0.8).collect::<Vec<bool>>());
        assert!(sum.iter().zip(step).all(|(a, b)| (a - b).abs() < 1e-9));
    }
}
