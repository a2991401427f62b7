//! The distribution of an output: moments, quantiles, histogram, and their chart.

mod quantile;

pub use quantile::{PERCENTS, quantile};
use serde::{Deserialize, Serialize};

use apportion_base::quantity::Unit;
use apportion_base::sum::{mean, rescaled};

/// The distribution of one output over a sample, as in result files. Numbers are in `unit`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OutputDistribution {
    /// The unit of the numbers.
    #[cfg_attr(feature = "schema", schemars(with = "String"))]
    pub unit: Unit,
    /// Number of values n of mean, standard deviation, skewness, kurtosis and range.
    pub values: u64,
    /// Number of values of quantiles and histogram: those that were kept, the first of every replicate of a run.
    pub count: u64,
    /// Arithmetic mean.
    pub mean: f64,
    /// Standard deviation, with n - 1; `null` for a single value, and beyond double precision.
    pub sd: Option<f64>,
    /// Skewness m3/m2^(3/2) with the central moments m_k = 1/n sum (y - mean)^k; `null` without variance.
    pub skewness: Option<f64>,
    /// Excess kurtosis m4/m2^2 - 3; `null` without variance.
    pub excess_kurtosis: Option<f64>,
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
    /// Quantiles from 0.1 to 99.9 %, of type 8 of Hyndman and Fan (1996).
    pub quantiles: Vec<QuantileRecord>,
    /// Histogram; `null` without variance.
    pub histogram: Option<Histogram>,
}

/// A quantile.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct QuantileRecord {
    /// Its probability in percent.
    pub percent: f64,
    /// Its value.
    pub value: f64,
}

/// A histogram of equal bins.
///
/// It covers the range from the smallest to the largest value, but at most 6 interquartile ranges beyond the quartiles:
/// otherwise a few far values would leave all others in one bin. They are counted in `below` and `above`. The width is
/// that of Freedman and Diaconis (1981), 2 IQR n^(-1/3), or if the IQR is 0 that of Scott (1979), 3.49 sd n^(-1/3), and
/// at least a hundredth of that range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Histogram {
    /// Edges of the bins, ascending, one more than bins. A value on an inner edge belongs to the bin above it.
    pub edges: Vec<f64>,
    /// Values in each bin.
    pub counts: Vec<u64>,
    /// Values below the first edge.
    pub below: u64,
    /// Values above the last edge.
    pub above: u64,
}

impl OutputDistribution {
    /// Computes the distribution of `values`, which are in SI; the record is in `unit`. Allows any finite values,
    /// however large, small or equal; `None` if there are none, or one is not finite. Costs O(n log n) time and a copy
    /// of the values.
    ///
    /// # Example
    /// ```
    /// use apportion::Unit;
    /// use apportion::result::OutputDistribution;
    ///
    /// let forces: Vec<f64> = (0..=100).map(|k| f64::from(k) / 1e9).collect();
    /// let distribution = OutputDistribution::from_values(&forces, &Unit::parse("nN")?).expect("finite values");
    /// assert!((distribution.mean - 50.0).abs() < 1e-12);
    /// assert_eq!(distribution.max, 100.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_values(values: &[f64], unit: &Unit) -> Option<Self> {
        if !values.iter().all(|value| value.is_finite()) {
            return None;
        }
        let (mut sorted, exponent) = rescaled(values);
        sorted.sort_unstable_by(f64::total_cmp);
        let (min, max) = (*sorted.first()?, *sorted.last()?);
        let value = |x: f64| unit.from_si(libm::scalbn(x, exponent));
        let [mean, sd, skewness, excess_kurtosis] = moments(&sorted);
        let varied = max - min > ROUNDING;
        Some(Self {
            unit: unit.clone(),
            values: sorted.len() as u64,
            count: sorted.len() as u64,
            mean: value(mean.clamp(min, max)),
            sd: (sorted.len() > 1).then(|| unit.span_from_si(libm::scalbn(sd, exponent))).filter(|sd| sd.is_finite()),
            skewness: varied.then_some(skewness),
            excess_kurtosis: varied.then_some(excess_kurtosis),
            min: value(min),
            max: value(max),
            quantiles: PERCENTS
                .iter()
                .map(|&percent| QuantileRecord { percent, value: value(quantile(&sorted, percent / 100.0)) })
                .collect(),
            histogram: varied
                .then(|| histogram(&sorted, sd))
                .map(|histogram| Histogram { edges: histogram.edges.iter().map(|&x| value(x)).collect(), ..histogram }),
        })
    }

    /// Returns the quantiles at 2.5 % from either end; `None` if there are so few values that these are the extremes.
    pub fn central(&self) -> Option<(f64, f64)> {
        self.tells(2.5).then(|| self.quantile(2.5).zip(self.quantile(97.5))).flatten()
    }

    /// Returns the typical distance of values: the width of the central 95 %, or of all if that is 0 or unknown.
    pub fn spread(&self) -> f64 {
        let central = self.central().map(|(low, high)| high - low);
        central.filter(|width| *width > 0.0).unwrap_or(self.max - self.min)
    }

    /// Returns whether at least one value is beyond the quantile at `percent`; if not, it is an end of the range.
    pub fn tells(&self, percent: f64) -> bool {
        self.count as f64 * percent.min(100.0 - percent) >= 100.0
    }

    /// Returns the quantile at a percentage, if it is one of [`quantiles`](Self::quantiles).
    pub fn quantile(&self, percent: f64) -> Option<f64> {
        self.quantiles.iter().find(|q| q.percent == percent).map(|q| q.value)
    }
}

/// A spread below this, for values whose largest is between 1 and 2, is rounding error: the sample counts as constant.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Returns mean, standard deviation, skewness and excess kurtosis of values of order one.
fn moments(values: &[f64]) -> [f64; 4] {
    let n = values.len() as f64;
    let mean = mean(values);
    let (centred, exponent) = rescaled(&values.iter().map(|v| v - mean).collect::<Vec<f64>>());
    let m2 = moment(&centred, 2);
    let sd = libm::scalbn((m2 * n / (n - 1.0).max(1.0)).sqrt(), exponent);
    [mean, sd, moment(&centred, 3) / libm::pow(m2, 1.5), moment(&centred, 4) / (m2 * m2) - 3.0]
}

/// Returns the central moment of order `k` of values less their mean.
fn moment(centred: &[f64], k: i32) -> f64 {
    centred.iter().map(|c| c.powi(k)).sum::<f64>() / centred.len() as f64
}

/// Returns the histogram of a sorted sample that varies with this standard deviation, in the scale of its values.
fn histogram(sorted: &[f64], sd: f64) -> Histogram {
    /// In interquartile ranges beyond the quartiles.
    const REACH: f64 = 6.0;
    const MAX_BINS: f64 = 100.0;
    let (lower, upper) = (quantile(sorted, 0.25), quantile(sorted, 0.75));
    let (min, max) = (sorted[0], sorted[sorted.len() - 1]);
    let root = libm::cbrt(sorted.len() as f64);
    let iqr = upper - lower;
    // An IQR of rounding errors would leave no value within reach.
    let (low, high, width) = if iqr > ROUNDING {
        (min.max(lower - REACH * iqr), max.min(upper + REACH * iqr), 2.0 * iqr / root)
    } else {
        (min, max, 3.49 * sd / root)
    };
    let bins = ((high - low) / width).ceil().clamp(1.0, MAX_BINS) as usize;
    let mut edges: Vec<f64> = (0..=bins).map(|k| low + (high - low) * k as f64 / bins as f64).collect();
    edges[bins] = high;
    // Values are sorted: each inner edge divides them, and equal values go up.
    let inner = edges[1..bins].iter().map(|edge| sorted.partition_point(|v| v < edge));
    let (first, last) = (sorted.partition_point(|&v| v < low), sorted.partition_point(|&v| v <= high));
    let ends: Vec<usize> = std::iter::once(first).chain(inner).chain([last]).collect();
    let counts = ends.windows(2).map(|ends| (ends[1] - ends[0]) as u64).collect();
    Histogram { edges, counts, below: first as u64, above: (sorted.len() - last) as u64 }
}

#[cfg(test)]
mod tests;
