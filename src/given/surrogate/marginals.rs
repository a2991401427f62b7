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

use super::contributions::{Contributions, To};
use crate::surrogate::extrapolation::groups;
use crate::surrogate::fit::Expansion;
use crate::surrogate::gram::add_scaled;
use crate::surrogate::net::Net;

/// Adds these influences of the rows of a fold to those of its contributions.
pub(super) fn add(net: &Net, expansion: &Expansion, contributions: &mut Contributions) {
    let mut values = Vec::new();
    for ((input, others), group) in groups(expansion) {
        let mut sums = vec![0.0; net.points()];
        for &(degree, b) in &group.coefficients {
            net.fill(&vec![(input, degree)], 0, &mut values);
            add_scaled(&mut sums, b, &values);
        }
        let variance: f64 = group.coefficients.iter().map(|(_, b)| b * b).sum();
        let squares: Vec<f64> = sums.iter().map(|h| h * h - variance).collect();
        let products: Vec<f64> = sums.iter().map(|h| 2.0 * group.offset * h).collect();
        let both: Vec<f64> = squares.iter().zip(&products).map(|(a, b)| a + b).collect();
        contributions.to(To::Variance).move_by(&both);
        contributions.to(To::Total(input)).move_by(&squares);
        for (other, _) in &others {
            contributions.to(To::Total(*other)).move_by(&both);
        }
        match others[..] {
            [] => contributions.to(To::FirstOrder(input)).move_by(&squares),
            [(other, _)] => contributions.to(To::FirstOrder(other)).move_by(&products),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests;
