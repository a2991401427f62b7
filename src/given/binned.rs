//! The binned estimator: variance of lines in bins of the input.

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::order::{Order, Partition};
use crate::uncertainty::{Estimate, Interval};
use apportion_base::sum::rescaled;

/// Minimum number of rows of a bin with a slope.
const MIN_ROWS_OF_LINE: f64 = 4.0;

/// Variance around the line of a bin, relative to both neighbours, that noise alone seldom has.
const OUTSTANDING: f64 = 3.0;

/// Relative variation of an input that counts as rounding.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A binned estimate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Binned {
    /// The estimate; without interval if rows are not independent.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// Number of bins with rows.
    pub bins: usize,
}

/// Returns the number of bins for `rows` rows: the integer part of 0.6 sqrt(rows), at least 6 (or rows/6, if less).
pub fn bins_for(rows: usize) -> usize {
    (rows * 9 / 25).isqrt().max((rows / 6).min(6)).max(2)
}

/// Estimates the first-order index of centred outputs with respect to an input by lines in bins of equal probability:
///
/// S = (sum of g^2 - noise) / SST,
///
/// where g is the least-squares line of y on x in the bin of the row, its values minus the mean of y, one line for each
/// of M = [`bins_for`]`(N)` bins, and the noise is the contribution of v_b, the variance around the line of bin b, to
/// its mean and its slope: the sum of 2 v_b, minus their mean for that of y. Equal values of x stay in one bin; a bin
/// of one value has only a mean. (With means only this is epsilon squared of the analysis of variance, Kelley 1935,
/// which misses the effect inside a bin: nearly all of the tail of a skewed input.)
///
/// The interval is asymptotic, from the variance over the rows of the influence g^2 + 2 g e - S z^2 (e: the residual, z
/// = g + e), corrected for the noise in g, with as many degrees of freedom as the effective number of rows, (sum of
/// squares)^2 over the sum of fourth powers; it includes the estimate of half as many bins, which shows the error
/// of the lines, and its upper end what a step inside of a bin leaves. Its coverage: `docs/guide/existing-runs.md` (`cargo bench --bench given`).
///
/// A constant input has index 0 without an interval. `order` is that of the input `x`, and `z` are the outputs. Without `independent` rows, as on quasi-random points, lines contain little noise: none is subtracted. There is no
/// interval.
pub(super) fn of_order(order: &Order, x: &[f64], z: &[f64], independent: bool) -> Binned {
    let wanted = bins_for(z.len());
    let x = rescaled(x).0;
    let lines = Lines::new(order.classes(wanted), &x, z);
    let bins = lines.bins.len();
    if bins < 2 {
        return Binned { estimate: Estimate::alone(0.0), bins };
    }
    if !independent {
        let all: f64 = z.iter().map(|z| z * z).sum();
        return Binned { estimate: Estimate::alone(lines.squares / all), bins };
    }
    let estimate = lines.first_order(z);
    let coarser = Lines::new(order.classes(wanted / 2), &x, z).first_order(z);
    let interval = lines.half_width(z, estimate).map(|half_width| {
        let half_width = libm::hypot(half_width, estimate - coarser);
        Interval { low: estimate - half_width, high: estimate + half_width + lines.missed(z) }
    });
    Binned { estimate: Estimate { estimate, interval }, bins }
}

/// The line of the outputs on the input in each of some bins.
struct Lines {
    bins: Vec<Bin>,
    /// The value of the line at every row.
    fitted: Vec<f64>,
    /// Sum of their squares.
    squares: f64,
}

#[derive(Clone, Default)]
struct Bin {
    rows: f64,
    mean_x: f64,
    mean_z: f64,
    xx: f64,
    xz: f64,
    /// 2 of a line, 1 of a mean alone.
    parameters: f64,
    /// Sum of the squared residuals of the line.
    rest: f64,
}

impl Bin {
    /// Returns the variance around the line; 0 if there are too few rows.
    fn noise(&self) -> f64 {
        if self.rows > self.parameters { self.rest / (self.rows - self.parameters) } else { 0.0 }
    }
}

impl Lines {
    fn new(Partition { labels, count }: Partition, x: &[f64], z: &[f64]) -> Self {
        let mut bins = vec![Bin::default(); count];
        let rows = labels.iter().zip(x.iter().zip(z));
        for (&label, (x, z)) in rows.clone() {
            bins[label].rows += 1.0;
            bins[label].mean_x += x;
            bins[label].mean_z += z;
        }
        for bin in &mut bins {
            bin.mean_x /= bin.rows;
            bin.mean_z /= bin.rows;
        }
        for (&label, (x, z)) in rows.clone() {
            let bin = &mut bins[label];
            bin.xx += (x - bin.mean_x) * (x - bin.mean_x);
            bin.xz += (x - bin.mean_x) * (z - bin.mean_z);
        }
        for bin in &mut bins {
            // An input that varies only by its rounding has no slope.
            let has_slope = bin.rows >= MIN_ROWS_OF_LINE && bin.xx > (ROUNDING * bin.mean_x).powi(2) * bin.rows;
            bin.parameters = if has_slope { 2.0 } else { 1.0 };
        }
        let mut fitted = Vec::with_capacity(z.len());
        for (&label, (x, z)) in rows {
            let bin = &mut bins[label];
            let slope = if bin.parameters > 1.0 { bin.xz / bin.xx } else { 0.0 };
            let value = bin.mean_z + slope * (x - bin.mean_x);
            bin.rest += (z - value) * (z - value);
            fitted.push(value);
        }
        let squares = fitted.iter().map(|g| g * g).sum();
        Self { bins, fitted, squares }
    }

    fn first_order(&self, z: &[f64]) -> f64 {
        let noise: f64 = self.bins.iter().map(|bin| bin.parameters * bin.noise()).sum();
        let of_mean = self.bins.iter().map(Bin::noise).sum::<f64>() / self.bins.len() as f64;
        (self.squares - (noise - of_mean)) / z.iter().map(|z| z * z).sum::<f64>()
    }

    /// Returns the part of the variance around lines that stands out of both neighbours: a step inside of a bin.
    fn missed(&self, z: &[f64]) -> f64 {
        let missed = self.bins.iter().enumerate().map(|(number, bin)| {
            let beside =
                [number.wrapping_sub(1), number + 1].map(|number| self.bins.get(number).map_or(0.0, Bin::noise));
            let beside = beside[0].max(beside[1]);
            let stands_out = bin.parameters > 1.0 && bin.noise() > OUTSTANDING * beside;
            if stands_out { bin.rest - bin.rows * beside } else { 0.0 }
        });
        missed.sum::<f64>() / z.iter().map(|z| z * z).sum::<f64>()
    }

    /// Returns the half width of the interval of `estimate`, without the error of the lines.
    fn half_width(&self, z: &[f64], estimate: f64) -> Option<f64> {
        let rows = z.len() as f64;
        let influences = self.fitted.iter().zip(z).map(|(g, z)| g * (2.0 * z - g) - estimate * z * z);
        let mean = influences.clone().sum::<f64>() / rows;
        let (squares, fourth_powers) = influences.fold((0.0, 0.0), |(squares, fourth_powers), influence| {
            let square = (influence - mean) * (influence - mean);
            (squares + square, fourth_powers + square * square)
        });
        // Twice the squares of the noise, without the bias that normal noise would give them: its part of the variance
        // of the sum of squares of g, which has twice as much in the influences.
        let from_noise = self.bins.iter().map(|bin| {
            let left = bin.rows - bin.parameters;
            2.0 * bin.noise().powi(2) * bin.parameters * left / (left + 2.0)
        });
        let from_noise: f64 = from_noise.sum();
        let variance = (squares - from_noise).max(from_noise);
        let parameters: f64 = self.bins.iter().map(|bin| bin.parameters).sum();
        // A few rows of a thin tail may have all of the variance: only they count.
        let carrying = if fourth_powers > 0.0 { squares * squares / fourth_powers } else { rows };
        let t = StudentsT::new(0.0, 1.0, (rows - parameters).min(carrying).max(2.0)).ok()?;
        Some(t.inverse_cdf((1.0 + Interval::LEVEL) / 2.0) * variance.sqrt() / z.iter().map(|z| z * z).sum::<f64>())
    }
}

#[cfg(test)]
#[path = "tests/binned.rs"]
mod tests;
