//! Influences of the rows on indices through the distributions of the inputs, if these are those of the columns.
//!
//! The polynomials of a column are orthonormal in its distribution, so that the variances of an expansion are those
//! under the distributions of the table. Other rows would give others. With g = sum b_a phi_a minus its constant, V_u =
//! E g_u^2 the variance of its conditional mean given the inputs u, and the inputs independent, a row x moves V_u by
//! the n-th part of
//!
//! - sum over j in u of E\[g_u^2 | x_j\] - V_u, and
//! - sum over j not in u of 2 (E\[g_u g | x_j\] - V_u),
//!
//! the derivative of V_u by the distribution of each input (von Mises 1947). Both conditional means consist of terms
//! that differ only in the degree of one input.

use crate::surrogate::Expansion;
use crate::surrogate::chaos::Basis;
use crate::surrogate::extrapolation::groups;
use apportion_base::sum::add_scaled;

/// The influence of every row on the variances of an expansion.
pub(super) struct Influences {
    pub variance: Vec<f64>,
    /// Those on V S of each input.
    pub first_order: Vec<Vec<f64>>,
    /// Those on V ST of each input.
    pub total: Vec<Vec<f64>>,
}

impl Influences {
    fn zeros(inputs: usize, rows: usize) -> Self {
        let none = vec![0.0; rows];
        Self { variance: none.clone(), first_order: vec![none.clone(); inputs], total: vec![none; inputs] }
    }

    /// Computes them for an expansion in the functions of `basis`.
    pub fn new(basis: &Basis, expansion: &Expansion) -> Self {
        let mut all = Self::zeros(basis.factors.len(), basis.rows);
        for ((input, others), group) in groups(expansion) {
            let mut sums = vec![0.0; basis.rows];
            for &(degree, b) in &group.coefficients {
                add_scaled(&mut sums, b, &basis.values(&[(input, degree)], 0..basis.rows));
            }
            let variance: f64 = group.coefficients.iter().map(|(_, b)| b * b).sum();
            let squares: Vec<f64> = sums.iter().map(|h| h * h - variance).collect();
            let products: Vec<f64> = sums.iter().map(|h| 2.0 * group.offset * h).collect();
            for more in [&squares, &products] {
                add_scaled(&mut all.variance, 1.0, more);
                for (other, _) in &others {
                    add_scaled(&mut all.total[*other], 1.0, more);
                }
            }
            add_scaled(&mut all.total[input], 1.0, &squares);
            match others[..] {
                [] => add_scaled(&mut all.first_order[input], 1.0, &squares),
                [(other, _)] => add_scaled(&mut all.first_order[other], 1.0, &products),
                _ => {}
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surrogate::Term;
    use crate::surrogate::chaos::Factor;
    use crate::surrogate::family::{Family, polynomials};

    const X: [[f64; 8]; 2] =
        [[0.1, 0.9, 0.35, 0.7, 0.2, 0.55, 0.8, 0.05], [-1.0, 0.5, 0.0, 2.0, 1.5, -0.5, 0.25, 0.75]];

    fn model(a: f64, b: f64) -> f64 {
        a + b * b - 2.0 * a * b
    }

    /// Returns V, V_1, V_2, VT_1, VT_2 if the rows have these weights in the distribution of each input.
    fn variances(weights: &[f64]) -> [f64; 5] {
        let mean = |of: &dyn Fn(usize) -> f64| -> f64 { (0..8).map(|i| weights[i] * of(i)).sum() };
        let all = mean(&|i| mean(&|j| model(X[0][i], X[1][j])));
        let one = mean(&|i| mean(&|j| model(X[0][i], X[1][j])).powi(2)) - all * all;
        let two = mean(&|j| mean(&|i| model(X[0][i], X[1][j])).powi(2)) - all * all;
        let both = mean(&|i| mean(&|j| model(X[0][i], X[1][j]).powi(2))) - all * all;
        [both, one, two, both - two, both - one]
    }

    #[test]
    fn influences_are_derivatives_by_the_weights_of_rows() {
        let columns: Vec<Vec<Vec<f64>>> = X.iter().map(|x| polynomials(&Family::of_column(x), x, 2)).collect();
        let terms: Vec<Term> = vec![vec![], vec![(0, 1)], vec![(1, 1)], vec![(1, 2)], vec![(0, 1), (1, 1)]];
        let value = |term: &Term, rows: [usize; 2]| -> f64 {
            term.iter().map(|&(input, degree)| columns[input][degree - 1][rows[input]]).product()
        };
        let coefficient = |term: &Term| -> f64 {
            let all = (0..8).flat_map(|i| (0..8).map(move |j| [i, j]));
            all.map(|[i, j]| model(X[0][i], X[1][j]) * value(term, [i, j])).sum::<f64>() / 64.0
        };
        let expansion = Expansion { coefficients: terms.iter().map(coefficient).collect(), terms: terms.into() };
        let factors = X.iter().map(|x| Factor::new(&Family::of_column(x), x, 2)).collect();
        let Influences { variance, first_order, total } =
            Influences::new(&Basis { factors, rows: 8, parts: Vec::new() }, &expansion);
        let influences: Vec<Vec<f64>> = [vec![variance], first_order, total].concat();
        for row in 0..8 {
            let step = 1e-4;
            let moved = |step: f64| -> Vec<f64> {
                (0..8).map(|i| (1.0 - step) / 8.0 + if i == row { step } else { 0.0 }).collect()
            };
            let (up, down) = (variances(&moved(step)), variances(&moved(-step)));
            for (number, influences) in influences.iter().enumerate() {
                let derivative = (up[number] - down[number]) / (2.0 * step);
                assert!(
                    (influences[row] - derivative).abs() < 1e-6,
                    "{number} {row}: {} {derivative}",
                    influences[row]
                );
            }
        }
    }
}
