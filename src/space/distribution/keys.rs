//! The keys of distributions in study files: one table for their reader, the JSON schema and the messages.

use apportion_base::quantity::Unit;

/// A key of a distribution in a study file.
#[derive(Debug)]
pub struct Key {
    /// The key as typed.
    pub name: &'static str,
    /// The type of its value.
    pub kind: KeyKind,
    /// Its meaning, for editors.
    pub description: &'static str,
    pub(super) measure: Measure,
}

/// The type of a key's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyKind {
    /// A number.
    Number,
    /// A list of numbers.
    Numbers,
    /// Two numbers.
    Bounds,
    /// A text.
    Text,
    /// A list of texts.
    Texts,
    /// A table of values by probabilities.
    Quantiles,
}

/// How a number is converted to SI.
#[derive(Clone, Copy, Debug)]
pub(super) enum Measure {
    /// A value, possibly with an offset of its unit.
    Value,
    /// A difference of two values.
    Span,
    /// The natural logarithm of a value.
    Log,
    /// A pure number.
    Pure,
}

impl Measure {
    pub fn to_si(self, number: f64, unit: &Unit) -> f64 {
        match self {
            Self::Value => unit.to_si(number),
            Self::Span => unit.span_to_si(number),
            Self::Log => number + libm::log(unit.to_si(1.0)),
            Self::Pure => number,
        }
    }
}

const fn key(name: &'static str, kind: KeyKind, measure: Measure, description: &'static str) -> Key {
    Key { name, kind, description, measure }
}

const fn quantile(name: &'static str, description: &'static str) -> Key {
    key(name, KeyKind::Number, Measure::Value, description)
}

/// All keys of distributions.
pub static KEYS: [Key; 36] = {
    use KeyKind::{Bounds, Number, Numbers, Quantiles, Text, Texts};
    use Measure::{Log, Pure, Span, Value};
    [
        key("min", Number, Value, "Lower bound."),
        key("max", Number, Value, "Upper bound."),
        key("mean", Number, Value, "Mean: of the factor itself; before truncation of a truncated distribution."),
        key("sd", Number, Span, "Standard deviation, as the mean."),
        key("log_mean", Number, Log, "Mean of the natural logarithm, of a log-normal distribution."),
        key("log_sd", Number, Pure, "Standard deviation of the natural logarithm, of a log-normal distribution."),
        key("median", Number, Value, "Median, of a log-normal distribution."),
        key("gsd", Number, Pure, "Geometric standard deviation, above 1, of a log-normal distribution."),
        key("mode", Number, Value, "The most probable value."),
        key("alpha", Number, Pure, "First shape parameter of a beta distribution."),
        key("beta", Number, Pure, "Second shape parameter of a beta distribution."),
        key("shape", Number, Pure, "Shape parameter of a Weibull, gamma or Pareto distribution."),
        key("scale", Number, Span, "Scale parameter of a distribution that has one."),
        key(
            "location",
            Number,
            Value,
            "Location parameter; the lower end of a Weibull, gamma or exponential distribution.",
        ),
        key("df", Number, Pure, "Degrees of freedom of a Student t distribution."),
        quantile("p01", "Quantile: 1 % of the values lie below it."),
        quantile("p05", "Quantile: 5 % of the values lie below it."),
        quantile("p10", "Quantile: 10 % of the values lie below it."),
        quantile("p25", "Quantile: 25 % of the values lie below it."),
        quantile("p50", "Quantile: half of the values lie below it."),
        quantile("p75", "Quantile: 75 % of the values lie below it."),
        quantile("p90", "Quantile: 90 % of the values lie below it."),
        quantile("p95", "Quantile: 95 % of the values lie below it."),
        quantile("p99", "Quantile: 99 % of the values lie below it."),
        key(
            "n",
            Number,
            Pure,
            "Number of trials of a binomial distribution; of successes, of a negative binomial one.",
        ),
        key("p", Number, Pure, "Probability of success of a binomial, negative binomial or geometric distribution."),
        key("probability", Number, Pure, "Probability of true, of a boolean; 0.5 by default."),
        key("value", Number, Value, "The one value of a constant."),
        key("values", Numbers, Value, "The values of a discrete distribution, measured ones, or those of labels."),
        key("weights", Numbers, Pure, "The weights of values or bins; equal by default (except for bins)."),
        key("edges", Numbers, Value, "The edges of the bins of a histogram, one more than weights."),
        key(
            "quantiles",
            Quantiles,
            Value,
            "Quantiles that a histogram goes through: values by their probabilities from 0 to 1, as in { \"0\" = 1, \"1\" = 5 }.",
        ),
        key(
            "truncate",
            Bounds,
            Value,
            "Truncation: only values between these two occur; inf and -inf cut nothing off. All other keys describe the \
             distribution before truncation.",
        ),
        key("labels", Texts, Pure, "The labels of the categories."),
        key("file", Text, Pure, "A file of measured values, relative to the study."),
        key("column", Text, Pure, "The column of that file, where it has several."),
    ]
};

/// Returns the probability below the quantile of that key, for example `p05`.
pub(super) fn probability(key: &str) -> Option<f64> {
    let percent: u8 = key.strip_prefix('p')?.parse().ok()?;
    Some(f64::from(percent) / 100.0)
}
