//! Errors in the parameters of a distribution.

use apportion_base::quantity::Unit;

/// Why a distribution was refused; the text contains what is wrong and what is allowed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct DistributionError {
    /// The key of the invalid parameter, if it is a single one.
    pub key: Option<&'static str>,
    /// What is allowed, if the message does not contain it.
    pub help: Option<String>,
    /// Whether a key that the family needs is missing.
    pub is_incomplete: bool,
    message: String,
}

impl DistributionError {
    fn new(key: Option<&'static str>, message: impl Into<String>) -> Self {
        Self { key, help: None, is_incomplete: false, message: message.into() }
    }

    /// Adds what is allowed.
    pub(super) fn with_help(self, help: String) -> Self {
        Self { help: Some(help), ..self }
    }
}

/// Returns an error for keys that `distribution`, which takes those of `help`, needs.
pub(super) fn missing(distribution: &str, needed: &str, help: String) -> DistributionError {
    let error = DistributionError::new(None, format!("the {distribution} distribution needs {needed}"));
    DistributionError { is_incomplete: true, ..error.with_help(help) }
}

/// Returns an error for the parameter `key`.
pub(super) fn refused(key: &'static str, message: impl Into<String>) -> DistributionError {
    DistributionError::new(Some(key), message)
}

/// Returns an error for two numbers that are equal or in the wrong order.
pub(super) fn order(lower: &'static str, low: f64, upper: &'static str, high: f64) -> DistributionError {
    let message = format!("`{lower}` is {low} and `{upper}` is {high}, but `{lower}` must be below `{upper}`");
    let is_fixed = lower == "min" && low == high;
    let help = is_fixed.then(|| format!("for a fixed value, use the constant distribution of {low}"));
    DistributionError { help, ..refused(lower, message) }
}

/// Returns an error for parameters that are valid one by one, but exceed the range of `f64`.
pub(super) fn overflow(distribution: &str) -> DistributionError {
    let message = format!(
        "{} distribution with these parameters has values, a mean or a standard deviation beyond 1.8e308: choose a narrower one, \
         or a larger unit",
        named(distribution)
    );
    DistributionError::new(None, message)
}

/// Returns an error for a mean and standard deviation, or quantiles, outside the family; `key` is the first one.
pub(super) fn no_such_distribution(distribution: &str, statements: &str, key: &'static str) -> DistributionError {
    refused(key, format!("there is no {distribution} distribution, or more than one, with {statements}"))
}

/// Returns the name of a family with its article.
fn named(distribution: &str) -> String {
    let article = if distribution.starts_with(['a', 'e', 'i', 'o']) { "an" } else { "a" };
    format!("{article} {distribution}")
}

/// Returns an error for a unit in which values of the family have no meaning; `right` is what is allowed, and why.
pub(super) fn wrong_unit(distribution: &str, unit: &Unit, right: &str) -> DistributionError {
    DistributionError::new(None, format!("{} distribution cannot be in {unit}{right}", named(distribution)))
}

/// Refuses labels and seeds, for `what` under `key`, which needs an order.
pub(super) fn no_order(distribution: &'static str, key: &'static str, what: &str) -> DistributionError {
    let values = if distribution == "seed" { "seeds" } else { "labels" };
    let named = named(distribution);
    refused(key, format!("{named} distribution has {values}, which have no order: it cannot be {what}"))
}

/// Returns the value, if `is_right`, otherwise an error with `must`.
pub(super) fn number(key: &'static str, value: f64, is_right: bool, must: &str) -> Result<f64, DistributionError> {
    let must = if value.is_finite() { must } else { "be a finite number" };
    match value.is_finite() && is_right {
        true => Ok(value),
        false => Err(refused(key, format!("`{key}` is {value:?}, but must {must}"))),
    }
}

/// Returns the value, if it is finite.
pub(super) fn finite(key: &'static str, value: f64) -> Result<f64, DistributionError> {
    number(key, value, true, "")
}

/// Returns the value, if it is finite and greater than 0.
pub(super) fn positive(key: &'static str, value: f64) -> Result<f64, DistributionError> {
    number(key, value, value > 0.0, "be greater than 0")
}

/// Returns the value, if it is finite and within the range.
pub(super) fn within(key: &'static str, value: f64, (min, max): (f64, f64)) -> Result<f64, DistributionError> {
    number(key, value, (min..=max).contains(&value), &format!("lie between {min:?} and {max:?}"))
}

/// Checks that a parameter of a power law is large enough for a finite variance.
pub(super) fn of_finite_variance(key: &'static str, value: f64, least: f64) -> Result<(), DistributionError> {
    let must = format!(
        "be greater than {least:?}, or both tails be cut off (`truncate`): otherwise its variance is infinite and \
         indices are undefined"
    );
    number(key, value, value > least, &must).map(|_| ())
}

/// Checks that two bounds are finite and in order, and returns the finite width between them.
pub(super) fn bounds(min: f64, max: f64, distribution: &'static str) -> Result<f64, DistributionError> {
    finite("min", min)?;
    finite("max", max)?;
    match max - min {
        width if width <= 0.0 => Err(order("min", min, "max", max)),
        width if width.is_infinite() => Err(overflow(distribution)),
        width => Ok(width),
    }
}

/// Refuses a list with an entry that is infinite or NaN.
pub(super) fn finite_entries(key: &'static str, entries: &[f64]) -> Result<(), DistributionError> {
    match entries.iter().enumerate().find(|(_, value)| !value.is_finite()) {
        Some((index, &value)) => Err(entry(key, index, value, "be a finite number")),
        None => Ok(()),
    }
}

/// Returns an error for an entry of a list.
pub(super) fn entry(key: &'static str, index: usize, value: f64, must: &str) -> DistributionError {
    refused(key, format!("`{key}[{index}]` is {value}, but must {must}"))
}

/// Returns the sum of `weights`, one for each of `count` entries of the list `of`: finite, none negative, not all 0.
pub(super) fn sum_of_weights(weights: &[f64], count: usize, of: &str) -> Result<f64, DistributionError> {
    if weights.len() != count {
        let given = weights.len();
        let message = format!("there are {given} `weights` for {count} `{of}`, but there must be one for each");
        return Err(refused("weights", message));
    }
    finite_entries("weights", weights)?;
    if let Some((index, &value)) = weights.iter().enumerate().find(|(_, weight)| **weight < 0.0) {
        return Err(entry("weights", index, value, "not be negative"));
    }
    match weights.iter().sum::<f64>() {
        0.0 => Err(refused("weights", "all `weights` are 0, but at least one must be greater")),
        sum if sum.is_infinite() => Err(refused(
            "weights",
            "`weights` sum to more than 1.8e308: divide all of them by the same number, such as the largest",
        )),
        sum => Ok(sum),
    }
}
