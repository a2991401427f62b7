//! The influence of every single base point on an estimate: the delta method.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::net_decay::StandardError;
use super::points::KeptPoints;
use crate::estimate::{Moments, Products};

/// Returns the standard errors sqrt(sum (U - mean)^2/(n (n - 1))) of the results of `quantities`, with n - 1 degrees of
/// freedom (van der Vaart 1998, Asymptotic Statistics, chapter 3, with the variance of the sample), U the influences of
/// the n points; `None` if they are undefined on all points.
///
/// The influence function of a function of sums over points is n times its gradient in the sums times the products of
/// the point. The gradient is computed numerically.
pub(super) fn delta_errors(
    points: KeptPoints<'_>,
    products: &Products,
    quantities: &(dyn Fn(&Moments) -> Option<Vec<f64>> + Sync),
) -> Option<Vec<StandardError>> {
    let chunks = points.chunks();
    let sums_of = |matrix: &DMatrix<f64>| -> Vec<(f64, f64)> {
        matrix.column_iter().map(|column| (column.sum(), column.lp_norm(1))).collect()
    };
    let sums: Vec<Vec<(f64, f64)>> =
        chunks.par_iter().map(|chunk| sums_of(&chunk.products(points.design, products))).collect();
    let total = |c: usize| sums.iter().fold((0.0, 0.0), |(sum, size), chunk| (sum + chunk[c].0, size + chunk[c].1));
    let total: Vec<(f64, f64)> = (0..products.columns()).map(total).collect();
    let gradient = gradient(products, &total, quantities)?;
    // In units of the joint size of the products, so that no sum underflows or overflows; 0 without any influence.
    let n = points.count() as f64;
    let unit =
        |g: nalgebra::DVectorView<'_, f64>| g.iter().zip(&total).map(|(g, (_, size))| g.abs() * size).sum::<f64>();
    let units: Vec<f64> = gradient.column_iter().map(unit).collect();
    let mut scaled = gradient;
    for (mut column, unit) in scaled.column_iter_mut().zip(&units) {
        column.iter_mut().for_each(|g| *g = if *unit > 0.0 { *g * n / unit } else { *g });
    }
    let powers_of = |matrix: &DMatrix<f64>| -> Vec<[f64; 2]> {
        let influences = matrix * &scaled;
        let powers = |column: nalgebra::DVectorView<'_, f64>| {
            column.iter().fold([0.0; 2], |[sum, squares], u| [sum + u, squares + u * u])
        };
        influences.column_iter().map(powers).collect()
    };
    let powers: Vec<Vec<[f64; 2]>> =
        chunks.par_iter().map(|chunk| powers_of(&chunk.products(points.design, products))).collect();
    let of_quantity = |(q, unit): (usize, &f64)| {
        let sum = |power: usize| powers.iter().map(|chunk| chunk[q][power]).sum::<f64>();
        let (sum, squares) = (sum(0), sum(1));
        if n < 2.0 || !squares.is_finite() {
            return StandardError { error: f64::NAN, freedom: 0.0 };
        }
        let squares = (squares - sum * sum / n).max(0.0);
        StandardError { error: unit * (squares / (n * (n - 1.0))).sqrt(), freedom: n - 1.0 }
    };
    Some(units.iter().enumerate().map(of_quantity).collect())
}

/// Computes the gradient of the quantities (columns) in the sums of the products (rows) about `total`, the sums and the
/// sums of absolute values.
fn gradient(
    products: &Products,
    total: &[(f64, f64)],
    quantities: &(dyn Fn(&Moments) -> Option<Vec<f64>> + Sync),
) -> Option<DMatrix<f64>> {
    /// Step in units of the sum of absolute values: the error of the difference formula of fourth order is about its
    /// fourth power, that of rounding eps over it, and both are far below the noise of a standard error.
    const STEP: f64 = 1e-3;
    let sums: Vec<f64> = total.iter().map(|(sum, _)| *sum).collect();
    let length = quantities(&products.moments(&sums))?.len();
    let counts = products.counts();
    let row = |c: usize| -> Vec<f64> {
        let size = total[c].1;
        if counts[c] == c || size == 0.0 {
            return vec![0.0; length];
        }
        let at = |steps: f64| {
            let mut sums = sums.clone();
            sums[c] += steps * STEP * size;
            quantities(&products.moments(&sums)).unwrap_or_else(|| vec![f64::NAN; length])
        };
        let [far_below, below, above, far_above] = [-2.0, -1.0, 1.0, 2.0].map(at);
        let difference = |q: usize| 8.0 * (above[q] - below[q]) - (far_above[q] - far_below[q]);
        (0..length).map(|q| difference(q) / (12.0 * STEP) / size).collect()
    };
    let mut rows: Vec<Vec<f64>> = (0..sums.len()).into_par_iter().map(row).collect();
    // A quantity does not change if the points that count and all sums over them double: this gives its derivative by
    // the number of points.
    for c in 0..sums.len() {
        if counts[c] != c {
            let weight = sums[c] / sums[counts[c]];
            let change: Vec<f64> = rows[c].iter().map(|slope| slope * weight).collect();
            rows[counts[c]].iter_mut().zip(change).for_each(|(slope, change)| *slope -= change);
        }
    }
    Some(DMatrix::from_row_iterator(sums.len(), length, rows.into_iter().flatten()))
}
