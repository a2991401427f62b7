//! The discrete distribution on given values.

use super::error::{finite_entries, list, sum_of_weights};
use super::family::{Family, Parameter};
use super::keys::{Entry, PLAIN, keys};
use super::{Distribution, DistributionError};

/// Finitely many values with their probabilities.
#[derive(Clone, Debug, PartialEq)]
pub struct Discrete {
    values: Vec<f64>,
    weights: Option<Vec<f64>>,
    /// The values of positive weight, in ascending order.
    sorted: Vec<f64>,
    /// The probability of each of these values.
    probabilities: Vec<f64>,
    /// The probability of each of these values or a lower one; the last is exactly 1.
    cumulative: Vec<f64>,
}

impl Distribution {
    /// Each of `values` with a probability proportional to its weight; equal probabilities without `weights`.
    ///
    /// The order of the values is immaterial; a value given twice counts twice, a value of weight 0 never occurs.
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = the smallest value x with P(X <= x) > u
    /// ```
    ///
    /// # Errors
    ///
    /// If there are no values, as many weights as values are not given, an entry is not finite, a weight is
    /// negative, all weights are 0, or their sum or the moments overflow.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let grade = Distribution::discrete(&[2.0, 1.0, 5.0], Some(&[1.0, 2.0, 1.0]))?;
    /// assert_eq!(grade.quantile(0.4), 1.0);
    /// assert_eq!(grade.mean(), 2.25);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn discrete(values: &[f64], weights: Option<&[f64]>) -> Result<Self, DistributionError> {
        Self::Discrete(Discrete::new(values, weights)?).finite()
    }
}

impl Discrete {
    pub(super) fn new(values: &[f64], weights: Option<&[f64]>) -> Result<Self, DistributionError> {
        if values.is_empty() {
            return Err(list("values", "`values` is empty, but must hold at least one number"));
        }
        finite_entries("values", values)?;
        if let Some(weights) = weights {
            sum_of_weights(weights, values.len(), "values")?;
        }
        let weight = |index: usize| weights.and_then(|weights| weights.get(index)).copied().unwrap_or(1.0);
        let mut pairs: Vec<(f64, f64)> =
            values.iter().enumerate().map(|(index, value)| (*value, weight(index))).collect();
        pairs.retain(|(_, weight)| *weight > 0.0);
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut total = 0.0;
        let partial: Vec<f64> = pairs
            .iter()
            .map(|(_, weight)| {
                total += weight;
                total
            })
            .collect();
        Ok(Self {
            values: values.to_vec(),
            weights: weights.map(<[f64]>::to_vec),
            sorted: pairs.iter().map(|(value, _)| *value).collect(),
            probabilities: pairs.iter().map(|(_, weight)| weight / total).collect(),
            cumulative: partial.iter().map(|sum| sum / total).collect(),
        })
    }

    /// The values between `min` and `max`, both included, with their weights.
    pub(super) fn between(&self, min: f64, max: f64) -> Result<Distribution, DistributionError> {
        let is_left = |value: &f64| (min..=max).contains(value);
        let values: Vec<f64> = self.values.iter().copied().filter(is_left).collect();
        let weights = self.weights.as_ref().map(|weights| {
            let pairs = self.values.iter().zip(weights).filter(|(value, _)| is_left(value));
            pairs.map(|(_, weight)| *weight).collect::<Vec<f64>>()
        });
        let is_nothing =
            weights.as_ref().map_or(values.is_empty(), |weights| weights.iter().all(|weight| *weight == 0.0));
        match is_nothing {
            true => Err(DistributionError::NothingLeft { distribution: "discrete", min, max }),
            false => Distribution::discrete(&values, weights.as_deref()),
        }
    }

    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    pub(super) fn weights(&self) -> Option<&[f64]> {
        self.weights.as_deref()
    }

    /// The probability of `value`, which stands in the list once at most.
    pub(super) fn probability(&self, value: f64) -> f64 {
        let place = self.sorted.partition_point(|other| *other < value);
        if self.sorted.get(place) == Some(&value) { self.probabilities[place] } else { 0.0 }
    }

    /// The distinct values that occur, in ascending order, each with a `u` at which it is the quantile: the middle of
    /// its part of the unit interval.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let Distribution::Discrete(grade) = Distribution::discrete(&[2.0, 1.0, 2.0, 5.0], Some(&[1.0, 2.0, 1.0, 0.0]))?
    /// else {
    ///     unreachable!("made as one");
    /// };
    /// assert_eq!(grade.levels(), [(1.0, 0.25), (2.0, 0.75)]);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn levels(&self) -> Vec<(f64, f64)> {
        let mut levels: Vec<(f64, f64)> = Vec::new();
        let mut low = 0.0;
        for same in self.sorted.iter().zip(&self.cumulative).collect::<Vec<_>>().chunk_by(|a, b| a.0 == b.0) {
            let (&value, &high) = same[same.len() - 1];
            // A part without any double inside is never drawn.
            let middle = low + (high - low) / 2.0;
            if low < middle && middle < high {
                levels.push((value, middle));
            }
            low = high;
        }
        levels
    }
}

impl Discrete {
    fn expectation(&self, function: impl Fn(f64) -> f64) -> f64 {
        self.sorted.iter().zip(&self.probabilities).map(|(&value, probability)| function(value) * probability).sum()
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "discrete",
    summary: "One of some values, with weights.",
    ways: &[keys(&["values"]).perhaps(&["weights"])],
    build: |given| Distribution::discrete(given.list("values")?, given.list_if("weights")),
    ..PLAIN
}];

impl Family for Discrete {
    fn quantile(&self, u: f64) -> f64 {
        let index = self.cumulative.partition_point(|&probability| probability <= u);
        // The last entry is 1, which only a `u` out of range reaches.
        self.sorted.get(index).or(self.sorted.last()).copied().unwrap_or(f64::NAN)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let place = self.sorted.partition_point(|value| *value <= x);
        let below = place.checked_sub(1).map_or(0.0, |last| self.cumulative[last]);
        (below, 1.0 - below)
    }

    fn mean(&self) -> f64 {
        self.expectation(|value| value)
    }

    fn sd(&self) -> f64 {
        let mean = self.mean();
        self.expectation(|value| (value - mean) * (value - mean)).sqrt()
    }

    fn support(&self) -> (f64, f64) {
        (self.quantile(0.0), self.quantile(1.0))
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        let mut parameters = vec![("values", self.values.as_slice().into())];
        parameters.extend(self.weights.as_deref().map(|weights| ("weights", weights.into())));
        parameters
    }
}
