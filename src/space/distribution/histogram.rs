//! The histogram: bins of constant density.

use super::prelude::*;

/// Adjoining bins with their probabilities, each of constant density: a piecewise linear distribution function.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    edges: Vec<f64>,
    weights: Vec<f64>,
    /// The bins of positive weight.
    bins: Vec<Bin>,
}

#[derive(Clone, Debug, PartialEq)]
struct Bin {
    min: f64,
    max: f64,
    probability: f64,
    /// Probability of the bins before it.
    before: f64,
    /// Probability of the bins after it.
    after: f64,
}

impl Distribution {
    /// Returns the distribution whose bin k is from `edges[k]` to `edges[k + 1]` and has a probability proportional to
    /// `weights[k]`, like counts and edges of `numpy.histogram`; the density inside a bin is constant.
    ///
    /// # Errors
    ///
    /// If there are no bins, or not one edge more than weights; an entry is not finite; edges do not rise; a weight is
    /// negative, or all are 0; or their sum or the moments overflow.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let load = Distribution::histogram(&[0.0, 1.0, 3.0], &[1.0, 3.0])?;
    /// assert_eq!((load.quantile(0.25), load.median(), load.mean()), (1.0, 1.0 + 2.0 / 3.0, 1.625));
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn histogram(edges: &[f64], weights: &[f64]) -> Result<Self, DistributionError> {
        let (bins, count) = (weights.len(), edges.len());
        if bins == 0 || count != bins + 1 {
            let problem =
                format!("there are {count} `edges` for {bins} `weights`, but n bins have n + 1 edges, at least 2");
            return Err(refused("edges", problem));
        }
        finite_entries("edges", edges)?;
        if let Some(index) = (1..count).find(|&k| edges[k] <= edges[k - 1]) {
            let must = format!("be above the one before it, {}", edges[index - 1]);
            return Err(entry("edges", index, edges[index], &must));
        }
        let total = sum_of_weights(weights, bins, "bins")?;
        let mut before = 0.0;
        let mut bins: Vec<Bin> = Vec::with_capacity(weights.len());
        for (edges, weight) in edges.windows(2).zip(weights).filter(|(_, weight)| **weight > 0.0) {
            let probability = weight / total;
            bins.push(Bin { min: edges[0], max: edges[1], probability, before: before / total, after: 0.0 });
            before += weight;
        }
        let mut after = 0.0;
        for bin in bins.iter_mut().rev() {
            bin.after = after;
            after += bin.probability;
        }
        Self::Histogram(Histogram { edges: edges.to_vec(), weights: weights.to_vec(), bins }).finite()
    }

    /// Returns the histogram whose bins are between quantiles: pairs of a probability and the value below which
    /// this share of all values lies. The distribution function is linear between them.
    ///
    /// # Errors
    ///
    /// If a probability is outside [0, 1] or duplicate, 0 or 1 is missing, or values do not rise with the
    /// probabilities.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let guess = Distribution::histogram_of_quantiles(&[(0.0, 1.0), (0.5, 2.0), (1.0, 5.0)])?;
    /// assert_eq!((guess.quantile(0.25), guess.quantile(0.75)), (1.5, 3.5));
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn histogram_of_quantiles(quantiles: &[(f64, f64)]) -> Result<Self, DistributionError> {
        let mut quantiles = quantiles.to_vec();
        quantiles.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((p, _)) = quantiles.iter().find(|(p, _)| !(0.0..=1.0).contains(p)) {
            return Err(wrong_quantiles(format!("the probability {p}")));
        }
        for end in [0.0, 1.0] {
            if quantiles.iter().all(|(p, _)| *p != end) {
                return Err(wrong_quantiles(format!("no value for the probability {end}")));
            }
        }
        for pair in quantiles.windows(2) {
            let [(p, low), (q, high)] = [pair[0], pair[1]];
            if p == q {
                return Err(wrong_quantiles(format!("two values for the probability {p}")));
            }
            if low >= high {
                return Err(wrong_quantiles(format!("{low} for the probability {p} and {high} for {q}")));
            }
        }
        let edges: Vec<f64> = quantiles.iter().map(|(_, value)| *value).collect();
        let weights: Vec<f64> = quantiles.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
        Self::histogram(&edges, &weights)
    }
}

fn wrong_quantiles(problem: String) -> DistributionError {
    let example = r#"{ "0" = 1, "0.5" = 2, "1" = 5 }"#;
    let must = "must have increasing values for probabilities from 0 to 1, including 0 and 1";
    refused("quantiles", format!("`quantiles` has {problem}, but {must}, as in {example}"))
}

impl Histogram {
    /// Iterates over the bins of positive weight: where each begins and ends in the unit interval, and its edges.
    pub(crate) fn bins(&self) -> impl Iterator<Item = (f64, f64, [f64; 2])> {
        self.bins.iter().map(|bin| (bin.before, bin.before + bin.probability, [bin.min, bin.max]))
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "histogram",
    summary: "Bins of constant density.",
    key_sets: &[keys(&["edges", "weights"]), keys(&["quantiles"])],
    build: |given| match given.get("quantiles") {
        Some(Parameter::Quantiles(quantiles)) => Distribution::histogram_of_quantiles(quantiles),
        _ => Distribution::histogram(given.list("edges")?, given.list("weights")?),
    },
    ..PLAIN
}];

impl Family for Histogram {
    fn at(&self, u: f64, v: f64) -> f64 {
        let place = self.bins.partition_point(|bin| bin.before + bin.probability <= u).min(self.bins.len() - 1);
        let bin = &self.bins[place];
        let (below, above) = ((u - bin.before) / bin.probability, (v - bin.after) / bin.probability);
        let value = if below < above {
            bin.min + (bin.max - bin.min) * below.max(0.0)
        } else {
            bin.max - (bin.max - bin.min) * above.max(0.0)
        };
        value.clamp(bin.min, bin.max)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let place = self.bins.partition_point(|bin| bin.max <= x);
        let Some(bin) = self.bins.get(place) else { return (1.0, 0.0) };
        let width = bin.max - bin.min;
        let (low, high) = ((x - bin.min).max(0.0) / width, ((bin.max - x) / width).min(1.0));
        (bin.before + bin.probability * low, bin.after + bin.probability * high)
    }

    fn moments(&self) -> (f64, f64) {
        let mean = self.bins.iter().map(|bin| bin.probability * (0.5 * bin.min + 0.5 * bin.max)).sum::<f64>();
        let variances = self.bins.iter().map(|bin| {
            let (deviation, width) = (0.5 * bin.min + 0.5 * bin.max - mean, bin.max - bin.min);
            bin.probability * (deviation * deviation + width * width / 12.0)
        });
        (mean, variances.sum::<f64>().sqrt())
    }

    fn support(&self) -> (f64, f64) {
        (self.bins[0].min, self.bins[self.bins.len() - 1].max)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("edges", self.edges.as_slice().into()), ("weights", self.weights.as_slice().into())]
    }
}
