//! Sample quantiles.

/// The percentages at which quantiles are reported.
pub const PERCENTS: [f64; 11] = [0.1, 1.0, 2.5, 5.0, 25.0, 50.0, 75.0, 95.0, 97.5, 99.0, 99.9];

/// Returns the quantile of probability `p`, 0 to 1, of ascending values: type 8 of Hyndman and Fan (1996, Am. Stat. 50,
/// 361-365), approximately median-unbiased for any distribution. It interpolates between the order statistics at (n +
/// 1/3) p + 1/3; beyond the first and the last it returns these. NaN for no values.
pub fn quantile(sorted: &[f64], p: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let n = sorted.len() as f64;
    let place = ((n + 1.0 / 3.0) * p + 1.0 / 3.0 - 1.0).clamp(0.0, last as f64);
    let lower = place.floor() as usize;
    let (a, b) = (sorted[lower], sorted[(lower + 1).min(last)]);
    let part = place - lower as f64;
    // The difference of two large numbers of different sign could overflow; equal ones are returned unchanged.
    if a == b { a } else { a * (1.0 - part) + b * part }
}

#[cfg(test)]
#[path = "tests/quantile.rs"]
mod tests;
