//! Counts in equal bins.

use super::{Histogram, Sample};

/// Maximum number of bins.
const MAX_BINS: f64 = 100.0;

/// Returns the histogram of a sample, in the scale of its values.
pub(super) fn histogram(sample: &Sample<'_>) -> Histogram {
    let (low, high) = sample.reach;
    let root = libm::cbrt(sample.n());
    let width = if sample.iqr > 0.0 { 2.0 * sample.iqr / root } else { 3.49 * sample.sd / root };
    let bins = ((high - low) / width).ceil().clamp(1.0, MAX_BINS) as usize;
    let mut edges: Vec<f64> = (0..=bins).map(|k| low + (high - low) * k as f64 / bins as f64).collect();
    edges[bins] = high;
    let (values, below, above) = sample.within();
    // Values are sorted: each inner edge divides them, and equal values go up.
    let ends: Vec<usize> = edges[1..bins].iter().map(|edge| values.partition_point(|v| v < edge)).collect();
    let starts = std::iter::once(0).chain(ends.iter().copied());
    let counts = starts.zip(ends.iter().copied().chain([values.len()])).map(|(from, to)| (to - from) as u64).collect();
    Histogram { edges, counts, below: below as u64, above: above as u64 }
}
