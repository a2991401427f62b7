//! The influence of every single base point on an estimate: the delta method.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::points::KeptPoints;
use super::standard_error::StandardError;
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
    let of_chunks: Vec<Vec<Sums>> =
        chunks.par_iter().map(|chunk| sums(&chunk.products(points.design, products))).collect();
    let total = added(&of_chunks, products.columns());
    let mut scaled = gradient(products, &total, quantities)?;
    // In units of the joint size of the products, so that no sum underflows or overflows; 0 without any influence.
    let n = points.count() as f64;
    let mut units = Vec::with_capacity(scaled.ncols());
    for mut column in scaled.column_iter_mut() {
        let unit: f64 = column.iter().zip(&total).map(|(slope, sums)| slope.abs() * sums.size).sum();
        if unit > 0.0 {
            column.iter_mut().for_each(|slope| *slope = *slope * n / unit);
        }
        units.push(unit);
    }
    let of_chunks: Vec<Vec<Sums>> =
        chunks.par_iter().map(|chunk| squares(&(chunk.products(points.design, products) * &scaled))).collect();
    let influences = added(&of_chunks, units.len());
    Some(influences.iter().zip(units).map(|(influences, unit)| standard_error(influences, unit, n)).collect())
}

/// The sum of numbers, and the sum of their sizes: of their absolute values, or of their squares.
#[derive(Clone, Copy, Default)]
struct Sums {
    sum: f64,
    size: f64,
}

/// Returns the sums of every column, with those of absolute values.
fn sums(matrix: &DMatrix<f64>) -> Vec<Sums> {
    matrix.column_iter().map(|column| Sums { sum: column.sum(), size: column.lp_norm(1) }).collect()
}

/// Returns the sums of every column, with those of squares.
fn squares(matrix: &DMatrix<f64>) -> Vec<Sums> {
    let mut all = Vec::with_capacity(matrix.ncols());
    for column in matrix.column_iter() {
        all.push(
            column.iter().fold(Sums::default(), |Sums { sum, size }, u| Sums { sum: sum + u, size: size + u * u }),
        );
    }
    all
}

/// Adds the sums of all chunks, column by column.
fn added(chunks: &[Vec<Sums>], columns: usize) -> Vec<Sums> {
    let mut total = vec![Sums::default(); columns];
    for chunk in chunks {
        for (total, more) in total.iter_mut().zip(chunk) {
            *total = Sums { sum: total.sum + more.sum, size: total.size + more.size };
        }
    }
    total
}

/// Returns the error of the mean of `n` influences, in units of `unit`.
fn standard_error(influences: &Sums, unit: f64, n: f64) -> StandardError {
    if n < 2.0 || !influences.size.is_finite() {
        return StandardError { error: f64::NAN, freedom: 0.0 };
    }
    let squares = (influences.size - influences.sum * influences.sum / n).max(0.0);
    StandardError { error: unit * (squares / (n * (n - 1.0))).sqrt(), freedom: n - 1.0 }
}

/// Computes the gradient of the quantities (columns) in the sums of the products (rows) about `total`, the sums and the
/// sums of absolute values.
fn gradient(
    products: &Products,
    total: &[Sums],
    quantities: &(dyn Fn(&Moments) -> Option<Vec<f64>> + Sync),
) -> Option<DMatrix<f64>> {
    /// Step in units of the sum of absolute values: the error of the difference formula of fourth order is about its
    /// fourth power, that of rounding eps over it, and both are far below the noise of a standard error.
    const STEP: f64 = 1e-3;
    let sums: Vec<f64> = total.iter().map(|total| total.sum).collect();
    let length = quantities(&products.moments(&sums))?.len();
    let counts = products.counts();
    let row = |c: usize| -> Vec<f64> {
        let size = total[c].size;
        if counts[c] == c || size == 0.0 {
            return vec![0.0; length];
        }
        let [far_below, below, above, far_above] = [-2.0, -1.0, 1.0, 2.0].map(|steps| {
            let mut sums = sums.clone();
            sums[c] += steps * STEP * size;
            quantities(&products.moments(&sums)).unwrap_or_else(|| vec![f64::NAN; length])
        });
        let differences = (0..length).map(|q| 8.0 * (above[q] - below[q]) - (far_above[q] - far_below[q]));
        differences.map(|difference| difference / (12.0 * STEP) / size).collect()
    };
    let mut rows: Vec<Vec<f64>> = (0..sums.len()).into_par_iter().map(row).collect();
    // A quantity does not change if the points that count and all sums over them double: this gives its derivative by
    // the number of points.
    for c in (0..sums.len()).filter(|&c| counts[c] != c) {
        let weight = sums[c] / sums[counts[c]];
        let change: Vec<f64> = rows[c].iter().map(|slope| slope * weight).collect();
        for (slope, change) in rows[counts[c]].iter_mut().zip(change) {
            *slope -= change;
        }
    }
    Some(DMatrix::from_row_iterator(sums.len(), length, rows.into_iter().flatten()))
}
