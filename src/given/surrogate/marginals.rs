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
#[path = "tests/marginals.rs"]
mod tests;
