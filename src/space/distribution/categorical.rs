//! Categories: labels with probabilities, for the model a number each.

use std::collections::BTreeSet;

use super::discrete::Discrete;
use super::error::{entry, list, within};
use super::family::{Family, Parameter, numbers_of_law};
use super::keys::{Entry, PLAIN, keys};
use super::{Distribution, DistributionError};
use crate::quantity::Unit;

/// Labels with their probabilities and the numbers that stand for them in the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Categorical {
    labels: Vec<String>,
    /// The number of each label, distinct, with its weight.
    law: Discrete,
    /// The probability of `true`, of the two categories false and true.
    truth: Option<f64>,
}

impl Distribution {
    /// Each of `labels` with a probability proportional to its weight, equal ones without `weights`. The model gets
    /// the number of the label in `values`, or else 0 for the first, 1 for the second and so on.
    ///
    /// Mean, standard deviation and quantiles are those of the numbers. A Sobol' index does not depend on which
    /// numbers stand for the labels as long as the model tells them apart.
    ///
    /// # Errors
    ///
    /// As [`discrete`](Self::discrete); also if a label is empty or stands twice, or two labels have one number.
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
                return Err(list("labels", format!("`labels[{index}]` is empty, but every category needs a label")));
            }
            if !seen.insert(label) {
                return Err(list("labels", format!("the label \"{label}\" stands in `labels` twice")));
            }
        }
        let places = || (0..labels.len()).map(|place| place as f64).collect();
        let values: Vec<f64> = values.map_or_else(places, <[f64]>::to_vec);
        if values.len() != labels.len() {
            let (values, labels) = (values.len(), labels.len());
            let problem = format!("there are {values} `values` for {labels} `labels`, but there must be one for each");
            return Err(list("values", problem));
        }
        // 0 and -0 are one number. What is no number is refused with its place below.
        let mut seen = BTreeSet::new();
        let is_repeated = |value: &f64| value.is_finite() && !seen.insert((value + 0.0).to_bits());
        if let Some(index) = values.iter().position(is_repeated) {
            let must = "differ from those before it: every label needs a value of its own".to_owned();
            return Err(entry("values", index, values[index], must));
        }
        let law = Discrete::new(&values, weights)?;
        Self::Categorical(Categorical { labels, law, truth: None }).finite()
    }

    /// 1 (`true`) with this probability, else 0 (`false`).
    ///
    /// # Errors
    ///
    /// If `probability` lies outside [0, 1].
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
        let law = Discrete::new(&[0.0, 1.0], Some(&[1.0 - probability, probability]))?;
        let labels = vec!["false".to_owned(), "true".to_owned()];
        Self::Categorical(Categorical { labels, law, truth: Some(probability) }).finite()
    }
}

impl Categorical {
    /// The labels as given.
    pub fn labels(&self) -> &[String] {
        &self.labels
    }

    /// Each label with its number and its probability, as given.
    pub fn categories(&self) -> impl Iterator<Item = (&str, f64, f64)> {
        let pairs = self.labels.iter().zip(self.law.values());
        pairs.map(|(label, &value)| (label.as_str(), value, self.law.probability(value)))
    }

    /// Whether the numbers are the places of the labels, 0, 1, 2 and so on, which measure nothing.
    pub fn are_places(&self) -> bool {
        self.law.values().iter().enumerate().all(|(place, value)| *value == place as f64)
    }

    /// The numbers of the labels that occur, in ascending order, each with a `u` at which it is the quantile.
    pub fn levels(&self) -> Vec<(f64, f64)> {
        self.law.levels()
    }

    /// The label whose number is `value`.
    pub fn label(&self, value: f64) -> Option<&str> {
        let place = self.law.values().iter().position(|other| *other == value)?;
        self.labels.get(place).map(String::as_str)
    }

    /// The number of `label`.
    pub fn value_of(&self, label: &str) -> Option<f64> {
        let place = self.labels.iter().position(|other| other == label)?;
        self.law.values().get(place).copied()
    }

    /// The number of the most probable label, the first one of equals: where a factor stands that nobody placed.
    pub fn most_probable(&self) -> f64 {
        let largest = self.categories().map(|(_, _, share)| share).fold(0.0, f64::max);
        self.categories().find(|(_, _, share)| *share == largest).map_or(f64::NAN, |(_, value, _)| value)
    }
}

pub(super) const ENTRIES: &[Entry] = &[
    Entry {
        name: "categorical",
        summary: "Labels with weights; the model gets a number for each.",
        ways: &[keys(&["labels"]).perhaps(&["weights", "values"])],
        build: |given| match given.get("labels") {
            Some(Parameter::Texts(labels)) => {
                Distribution::categorical(labels, given.list_if("values"), given.list_if("weights"))
            }
            _ => Err(given.refused("`labels`".to_owned())),
        },
        ..PLAIN
    },
    Entry {
        name: "boolean",
        summary: "True with a probability; the model gets 1 or 0.",
        ways: &[keys(&[]).perhaps(&["probability"])],
        build: |given| Distribution::boolean(given.number_or("probability", 0.5)),
        ..PLAIN
    },
];

impl Family for Categorical {
    fn name(&self, own: &'static str) -> &'static str {
        if self.truth.is_some() { ENTRIES[1].name } else { own }
    }

    numbers_of_law!();

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        if let Some(probability) = self.truth {
            return vec![("probability", probability.into())];
        }
        let mut parameters = vec![("labels", Parameter::Texts(self.labels.clone()))];
        parameters.extend(self.law.parameters());
        parameters
    }

    fn in_si(&self, _own: &'static Entry, unit: &Unit) -> Result<Distribution, DistributionError> {
        let values: Vec<f64> = self.law.values().iter().map(|&value| unit.to_si(value)).collect();
        let law = Discrete::new(&values, self.law.weights())?;
        Ok(Distribution::Categorical(Self { law, ..self.clone() }))
    }
}
