//! The distribution of an output: moments, quantiles, histogram, and their chart.

mod histogram;
mod quantile;

pub use quantile::{PERCENTS, quantile};
use serde::{Deserialize, Serialize};

use crate::quantity::Unit;
use crate::sum::{mean, rescaled};

/// The distribution of one output over a sample, as in result files. Numbers are in `unit`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct OutputDistribution {
    /// The unit of the numbers.
    #[schemars(with = "String")]
    pub unit: Unit,
    /// Number of values n.
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
    /// Quantiles at [`PERCENTS`], of type 8 of Hyndman and Fan (1996).
    pub quantiles: Vec<QuantileRecord>,
    /// Histogram; `null` without variance.
    pub histogram: Option<Histogram>,
}

/// A quantile.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
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
/// at least a hundredth of the whole.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
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
        let scale = Scale { exponent, unit };
        let moments = Moments::from_values(&sorted);
        let varied = max - min > ROUNDING;
        let sample = varied.then(|| Sample::new(&sorted, moments.sd));
        let histogram = sample.as_ref().map(|sample| histogram::histogram(sample));
        Some(Self {
            unit: unit.clone(),
            count: sorted.len() as u64,
            mean: scale.value(moments.mean.clamp(min, max)),
            sd: (sorted.len() > 1).then(|| scale.span(moments.sd)).filter(|sd| sd.is_finite()),
            skewness: varied.then_some(moments.skewness),
            excess_kurtosis: varied.then_some(moments.excess_kurtosis),
            min: scale.value(min),
            max: scale.value(max),
            quantiles: PERCENTS
                .iter()
                .map(|&percent| QuantileRecord { percent, value: scale.value(quantile(&sorted, percent / 100.0)) })
                .collect(),
            histogram: histogram.map(|h| Histogram { edges: h.edges.iter().map(|&x| scale.value(x)).collect(), ..h }),
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

    /// Returns the quantile at a percentage of [`PERCENTS`].
    pub fn quantile(&self, percent: f64) -> Option<f64> {
        self.quantiles.iter().find(|q| q.percent == percent).map(|q| q.value)
    }
}

/// A spread below this, for values whose largest is between 1 and 2, is rounding error: the sample counts as constant.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Conversion from the working scale, in which the largest value is between 1 and 2, to the unit of the record.
struct Scale<'a> {
    exponent: i32,
    unit: &'a Unit,
}

impl Scale<'_> {
    fn value(&self, x: f64) -> f64 {
        self.unit.from_si(libm::scalbn(x, self.exponent))
    }

    /// Converts a difference of two values.
    fn span(&self, x: f64) -> f64 {
        self.unit.span_from_si(libm::scalbn(x, self.exponent))
    }
}

/// Moments of values of order one.
struct Moments {
    mean: f64,
    sd: f64,
    skewness: f64,
    excess_kurtosis: f64,
}

impl Moments {
    fn from_values(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = mean(values);
        let (centred, exponent) = rescaled(&values.iter().map(|v| v - mean).collect::<Vec<f64>>());
        let moment = |k: i32| centred.iter().map(|c| c.powi(k)).sum::<f64>() / n;
        let m2 = moment(2);
        Self {
            mean,
            sd: libm::scalbn((m2 * n / (n - 1.0).max(1.0)).sqrt(), exponent),
            skewness: moment(3) / libm::pow(m2, 1.5),
            excess_kurtosis: moment(4) / (m2 * m2) - 3.0,
        }
    }
}

/// A sorted sample that varies, with the quantities for its histogram.
struct Sample<'a> {
    sorted: &'a [f64],
    sd: f64,
    iqr: f64,
    /// The ends of the histogram.
    reach: (f64, f64),
}

impl<'a> Sample<'a> {
    fn new(sorted: &'a [f64], sd: f64) -> Self {
        /// In interquartile ranges beyond the quartiles.
        const REACH: f64 = 6.0;
        let (lower, upper) = (quantile(sorted, 0.25), quantile(sorted, 0.75));
        let iqr = upper - lower;
        let (min, max) = (sorted[0], sorted[sorted.len() - 1]);
        // An IQR of rounding errors would leave no value within reach.
        let (iqr, reach) = if iqr > ROUNDING {
            (iqr, (min.max(lower - REACH * iqr), max.min(upper + REACH * iqr)))
        } else {
            (0.0, (min, max))
        };
        Self { sorted, sd, iqr, reach }
    }

    fn n(&self) -> f64 {
        self.sorted.len() as f64
    }

    /// Returns the values within reach, and the numbers of those below and above.
    fn within(&self) -> (&'a [f64], usize, usize) {
        let from = self.sorted.partition_point(|&v| v < self.reach.0);
        let to = self.sorted.partition_point(|&v| v <= self.reach.1);
        (&self.sorted[from..to], from, self.sorted.len() - to)
    }
}

#[cfg(test)]
mod tests;
