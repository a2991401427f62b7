//! Finitely many values with their probabilities: discrete, measured, or with labels.

use std::collections::BTreeSet;

use super::prelude::*;
use apportion_base::quantity::Unit;

/// Finitely many values with their probabilities.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    values: Vec<f64>,
    weights: Option<Vec<f64>>,
    /// The values of positive weight, in ascending order.
    sorted: Vec<f64>,
    /// The probability of each of these values.
    probabilities: Vec<f64>,
    /// The probability of each of these values or a lower one; the last is exactly 1.
    cumulative: Vec<f64>,
    origin: Origin,
}

/// The kind of the values.
#[derive(Clone, Debug, PartialEq)]
enum Origin {
    /// As stated.
    Stated,
    /// Measured, and perhaps read from a file.
    Measured(Option<MeasuredFile>),
    /// The numbers of these labels, distinct; for false and true with the probability of true.
    Labels { labels: Vec<String>, truth: Option<f64> },
}

impl Distribution {
    /// Returns the distribution of `values` with probabilities proportional to `weights`, or equal ones without.
    ///
    /// The order of the values is irrelevant; a value given twice counts twice, a value of weight 0 never occurs.
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = the smallest value x with P(X <= x) > u
    /// ```
    ///
    /// # Errors
    ///
    /// If there are no values, the numbers of weights and values differ, an entry is not finite, a weight is negative,
    /// all weights are 0, or their sum or the moments overflow.
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
        Values::new(values, weights, Origin::Stated)?.distribution().finite()
    }

    /// Returns the distribution of the measured `values` with equal probability; a value measured twice counts twice.
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = x_(k),   k = floor(n u) + 1,   x_(1) <= x_(2) <= ... <= x_(n)
    /// mean = sum x_i / n,   sd = sqrt(sum (x_i - mean)^2 / n)
    /// ```
    ///
    /// The inverse of the empirical distribution function: no values between these or beyond them occur.
    ///
    /// # Errors
    ///
    /// If there are no values, or one is not finite.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let radius = Distribution::empirical(&[52.0, 48.0, 49.0, 51.0], None)?;
    /// assert_eq!((radius.quantile(0.1), radius.quantile(0.6), radius.mean()), (48.0, 51.0, 50.0));
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn empirical(values: &[f64], source: Option<MeasuredFile>) -> Result<Self, DistributionError> {
        Values::new(values, None, Origin::Measured(source))?.distribution().finite()
    }

    /// Returns the distribution of `labels` with probabilities proportional to `weights`, or equal ones without
    /// weights. The model gets the number of the label in `values`, or otherwise 0 for the first, 1 for the second and
    /// so on.
    ///
    /// Mean, standard deviation and quantiles are those of the numbers. A Sobol' index does not depend on the numbers
    /// of the labels as long as the model distinguishes them.
    ///
    /// # Errors
    ///
    /// As for [`discrete`](Self::discrete); also if a label is empty or duplicate, or two labels have one number.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let probe = Distribution::categorical(&["silicon", "nitride"], None, Some(&[3.0, 1.0]))?;
    /// assert_eq!(probe.label(probe.quantile(0.7)), Some("silicon"));
    /// assert_eq!(probe.value_of("nitride"), Some(1.0));
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn categorical<S: AsRef<str>>(
        labels: &[S],
        values: Option<&[f64]>,
        weights: Option<&[f64]>,
    ) -> Result<Self, DistributionError> {
        let labels: Vec<String> = labels.iter().map(|label| label.as_ref().to_owned()).collect();
        let mut seen = BTreeSet::new();
        for (index, label) in labels.iter().enumerate() {
            if label.trim().is_empty() {
                return Err(refused("labels", format!("`labels[{index}]` is empty, but every category needs a label")));
            }
            if !seen.insert(label) {
                return Err(refused("labels", format!("the label \"{label}\" is listed twice in `labels`")));
            }
        }
        let values: Vec<f64> = match values {
            Some(values) => values.to_vec(),
            None => (0..labels.len()).map(|place| place as f64).collect(),
        };
        if values.len() != labels.len() {
            let (values, labels) = (values.len(), labels.len());
            let problem = format!("there are {values} `values` for {labels} `labels`, but there must be one for each");
            return Err(refused("values", problem));
        }
        // 0 and -0 are one number. NaN and infinity are refused with their place below.
        let mut seen = BTreeSet::new();
        for (index, value) in values.iter().enumerate() {
            if value.is_finite() && !seen.insert((value + 0.0).to_bits()) {
                let must = "differ from those before it: every label needs its own value";
                return Err(entry("values", index, *value, must));
            }
        }
        Values::new(&values, weights, Origin::Labels { labels, truth: None })?.distribution().finite()
    }

    /// Returns the distribution that is 1 (`true`) with this probability, otherwise 0 (`false`).
    ///
    /// # Errors
    ///
    /// If `probability` is outside [0, 1].
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let wet = Distribution::boolean(0.25)?;
    /// assert_eq!((wet.mean(), wet.label(wet.quantile(0.8))), (0.25, Some("true")));
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn boolean(probability: f64) -> Result<Self, DistributionError> {
        within("probability", probability, (0.0, 1.0))?;
        let weights = [1.0 - probability, probability];
        let labels = vec!["false".to_owned(), "true".to_owned()];
        let origin = Origin::Labels { labels, truth: Some(probability) };
        Values::new(&[0.0, 1.0], Some(&weights), origin)?.distribution().finite()
    }
}

impl Values {
    fn new(values: &[f64], weights: Option<&[f64]>, origin: Origin) -> Result<Self, DistributionError> {
        if values.is_empty() {
            return Err(refused("values", "`values` is empty, but must hold at least one number"));
        }
        finite_entries("values", values)?;
        if let Some(weights) = weights {
            sum_of_weights(weights, values.len(), "values")?;
        }
        let mut pairs: Vec<(f64, f64)> = match weights {
            Some(weights) => values.iter().copied().zip(weights.iter().copied()).collect(),
            None => values.iter().map(|value| (*value, 1.0)).collect(),
        };
        pairs.retain(|(_, weight)| *weight > 0.0);
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut total = 0.0;
        let mut partial = Vec::with_capacity(pairs.len());
        for (_, weight) in &pairs {
            total += weight;
            partial.push(total);
        }
        Ok(Self {
            values: values.to_vec(),
            weights: weights.map(<[f64]>::to_vec),
            sorted: pairs.iter().map(|(value, _)| *value).collect(),
            probabilities: pairs.iter().map(|(_, weight)| weight / total).collect(),
            cumulative: partial.iter().map(|sum| sum / total).collect(),
            origin,
        })
    }

    fn distribution(self) -> Distribution {
        match self.origin {
            Origin::Stated => Distribution::Discrete(self),
            Origin::Measured(_) => Distribution::Empirical(self),
            Origin::Labels { .. } => Distribution::Categorical(self),
        }
    }

    /// Returns the labels as given; empty for values without labels.
    pub fn labels(&self) -> &[String] {
        if let Origin::Labels { labels, .. } = &self.origin { labels } else { &[] }
    }

    /// Iterates over the labels with their numbers and probabilities, as given.
    pub fn categories(&self) -> impl Iterator<Item = (&str, f64, f64)> {
        self.labels().iter().zip(&self.values).map(|(label, &value)| {
            // Numbers of labels are distinct.
            let place = self.sorted.partition_point(|other| *other < value);
            let occurs = self.sorted.get(place) == Some(&value);
            (label.as_str(), value, if occurs { self.probabilities[place] } else { 0.0 })
        })
    }

    /// Returns whether the numbers are the positions of the labels, 0, 1, 2 and so on, which measure nothing.
    pub fn are_places(&self) -> bool {
        self.values.iter().enumerate().all(|(place, value)| *value == place as f64)
    }

    /// Returns the label whose number is `value`.
    pub fn label(&self, value: f64) -> Option<&str> {
        let place = self.values.iter().position(|other| *other == value)?;
        self.labels().get(place).map(String::as_str)
    }

    /// Returns the number of `label`.
    pub fn value_of(&self, label: &str) -> Option<f64> {
        self.labels().iter().position(|other| other == label).map(|place| self.values[place])
    }

    /// Returns the number of the most probable label, the first of several: the default nominal value.
    pub(super) fn most_probable(&self) -> f64 {
        let largest = self.categories().map(|(_, _, share)| share).fold(0.0, f64::max);
        self.categories().find(|(_, _, share)| *share == largest).map_or(f64::NAN, |(_, value, _)| value)
    }

    /// Returns the distinct values that occur, in ascending order, each with a `u` at which it is the quantile: the
    /// middle of its part of the unit interval.
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
            // A part that contains no double is never drawn.
            let middle = low + (high - low) / 2.0;
            if low < middle && middle < high {
                levels.push((value, middle));
            }
            low = high;
        }
        levels
    }

    fn expectation(&self, function: impl Fn(f64) -> f64) -> f64 {
        self.sorted.iter().zip(&self.probabilities).map(|(&value, probability)| function(value) * probability).sum()
    }
}

pub(super) const DISCRETE: &[Entry] = &[Entry {
    name: "discrete",
    summary: "One of several values, with weights.",
    key_sets: &[keys(&["values"]).perhaps(&["weights"])],
    build: |given| Distribution::discrete(given.list("values")?, given.list_if("weights")),
    ..PLAIN
}];

pub(super) const EMPIRICAL: &[Entry] = &[Entry {
    name: "empirical",
    summary: "Measured values, each as likely as any other.",
    key_sets: &[keys(&["values"]), keys(&["file"]).perhaps(&["column"])],
    build: |given| match given.get("file") {
        Some(Parameter::Measured(values, source)) => Distribution::empirical(values, Some(source.clone())),
        _ => Distribution::empirical(given.list("values")?, None),
    },
    ..PLAIN
}];

pub(super) const CATEGORICAL: &[Entry] = &[
    Entry {
        name: "categorical",
        summary: "Labels with weights; the model gets a number for each.",
        key_sets: &[keys(&["labels"]).perhaps(&["weights", "values"])],
        build: |given| match given.get("labels") {
            Some(Parameter::Texts(labels)) => {
                Distribution::categorical(labels, given.list_if("values"), given.list_if("weights"))
            }
            _ => Err(given.missing("`labels`".to_owned())),
        },
        ..PLAIN
    },
    Entry {
        name: "boolean",
        summary: "True with a probability; the model gets 1 or 0.",
        key_sets: &[keys(&[]).perhaps(&["probability"])],
        defaults: &[("probability", 0.5)],
        build: |given| Distribution::boolean(given.number("probability")?),
        ..PLAIN
    },
];

impl Family for Values {
    fn name(&self, default: &'static str) -> &'static str {
        if let Origin::Labels { truth: Some(_), .. } = self.origin { CATEGORICAL[1].name } else { default }
    }

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

    fn moments(&self) -> (f64, f64) {
        let mean = self.expectation(|value| value);
        (mean, self.expectation(|value| (value - mean) * (value - mean)).sqrt())
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        let mut parameters = Vec::new();
        match &self.origin {
            Origin::Labels { truth: Some(probability), .. } => return vec![("probability", (*probability).into())],
            Origin::Measured(Some(MeasuredFile { file, column, sha256 })) => {
                parameters.push(("file", Parameter::Text(file.clone())));
                parameters.extend(column.iter().map(|column| ("column", Parameter::Text(column.clone()))));
                parameters.push(("count", (self.values.len() as f64).into()));
                parameters.push(("sha256", Parameter::Text(sha256.clone())));
                return parameters;
            }
            Origin::Labels { labels, .. } => parameters.push(("labels", Parameter::Texts(labels.clone()))),
            Origin::Stated | Origin::Measured(None) => (),
        }
        parameters.push(("values", self.values.as_slice().into()));
        parameters.extend(self.weights.as_deref().map(|weights| ("weights", weights.into())));
        parameters
    }

    fn in_si(&self, _: &'static Entry, unit: &Unit) -> Result<Distribution, DistributionError> {
        let values: Vec<f64> = self.values.iter().map(|&value| unit.to_si(value)).collect();
        Self::new(&values, self.weights.as_deref(), self.origin.clone()).map(Self::distribution)
    }
}
