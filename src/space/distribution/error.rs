//! What can be wrong with the parameters of a distribution.

use crate::quantity::Unit;

/// Why a distribution was refused; the text says what was wrong and what would be right.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DistributionError {
    /// A number that cannot be.
    #[error("`{key}` is {value:?}, but must {must}")]
    Parameter {
        /// Its key.
        key: &'static str,
        /// Its value.
        value: f64,
        /// What it must, such as "be greater than 0".
        must: String,
    },
    /// A number of a list that cannot be.
    #[error("`{key}[{index}]` is {value}, but must {must}")]
    Entry {
        /// The key of the list.
        key: &'static str,
        /// The entry, from 0.
        index: usize,
        /// Its value.
        value: f64,
        /// What it must, such as "be a finite number".
        must: String,
    },
    /// A list that cannot be as a whole.
    #[error("{problem}")]
    List {
        /// Its key.
        key: &'static str,
        /// What is wrong, and what would be right.
        problem: String,
    },
    /// Two numbers that are equal or the wrong way round.
    #[error("`{lower}` is {low} and `{upper}` is {high}, but `{lower}` must be below `{upper}`")]
    Order {
        /// The key of what should be lower.
        lower: &'static str,
        /// Its value.
        low: f64,
        /// The key of what should be higher.
        upper: &'static str,
        /// Its value.
        high: f64,
    },
    /// A key that the family needs is not there.
    #[error("the {distribution} distribution needs {needed}")]
    Missing {
        /// The name of the family.
        distribution: &'static str,
        /// What is missing.
        needed: String,
        /// The keys that determine it, in words.
        takes: String,
    },
    /// A key that the family does not have, or not beside another one.
    #[error("the {distribution} distribution has no `{key}`{}", .beside.map_or_else(String::new, |key| format!(" beside `{key}`")))]
    Foreign {
        /// The name of the family.
        distribution: &'static str,
        /// The key.
        key: &'static str,
        /// The key beside which it cannot stand.
        beside: Option<&'static str>,
        /// The keys that determine it, in words.
        takes: String,
    },
    /// The mean and standard deviation, or the quantiles, of no distribution of the family.
    #[error("there is no {distribution} distribution, or more than one, with {statements}")]
    NoSuchDistribution {
        /// The name of the family.
        distribution: &'static str,
        /// What was stated.
        statements: String,
        /// The key that was stated first.
        key: &'static str,
    },
    /// The parameters are sound one by one, but lead beyond the range of `f64`.
    #[error(
        "{} distribution with these parameters has values, a mean or a standard deviation \
         beyond 1.8e308: choose a narrower one, or a larger unit",
        named(.distribution)
    )]
    Overflow {
        /// The name of the family.
        distribution: &'static str,
    },
    /// Next to no probability is left by a truncation.
    #[error(
        "truncation leaves nothing of this {distribution} distribution: next to none of its values lie between {min} and {max}"
    )]
    NothingLeft {
        /// The name of the family.
        distribution: &'static str,
        /// The lower bound.
        min: f64,
        /// The upper bound.
        max: f64,
    },
    /// A unit in which values of the family have no meaning.
    #[error("{} distribution cannot be in {unit}{right}", named(.distribution))]
    Unit {
        /// The name of the family.
        distribution: &'static str,
        /// The unit.
        unit: String,
        /// Why, and what would be right.
        right: &'static str,
    },
}

impl DistributionError {
    /// The key of the parameter that is wrong, where it is one.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Self::Parameter { key, .. } | Self::Entry { key, .. } | Self::List { key, .. } => Some(key),
            Self::Foreign { key, .. } | Self::NoSuchDistribution { key, .. } => Some(key),
            Self::Order { lower, .. } => Some(lower),
            Self::NothingLeft { .. } => Some("truncate"),
            Self::Missing { .. } | Self::Overflow { .. } | Self::Unit { .. } => None,
        }
    }

    /// What would be right, where the message does not say it yet.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Missing { takes, .. } | Self::Foreign { takes, .. } => Some(format!("it takes {takes}")),
            Self::Order { lower: "min", low, high, .. } if low == high => {
                Some(format!("for a fixed value: distribution = \"constant\", value = {low}"))
            }
            _ => None,
        }
    }
}

/// The name of a family with its article.
fn named(distribution: &str) -> String {
    let article = if distribution.starts_with(['a', 'e', 'i', 'o']) { "an" } else { "a" };
    format!("{article} {distribution}")
}

/// Refuses a unit with an offset, such as `degC`, to a family that is made of ratios.
pub(super) fn refuse_offset(distribution: &'static str, unit: &Unit) -> Result<(), DistributionError> {
    let right = ", whose 0 is not that of SI: state it in K";
    match unit.has_offset() {
        true => Err(DistributionError::Unit { distribution, unit: unit.to_string(), right }),
        false => Ok(()),
    }
}

/// Refuses labels and seeds, for `what` under `key`, which needs an order.
pub(super) fn no_order(distribution: &'static str, key: &'static str, what: &str) -> DistributionError {
    let values = if distribution == "seed" { "seeds" } else { "labels" };
    let named = named(distribution);
    let problem = format!("{named} distribution has {values}, which have no order: it cannot be {what}");
    DistributionError::List { key, problem }
}

/// The value, if `is_right`, else an error with what it `must`.
pub(super) fn number(key: &'static str, value: f64, is_right: bool, must: &str) -> Result<f64, DistributionError> {
    match value.is_finite() {
        true if is_right => Ok(value),
        true => Err(DistributionError::Parameter { key, value, must: must.to_owned() }),
        false => Err(DistributionError::Parameter { key, value, must: "be a finite number".to_owned() }),
    }
}

/// The value, if it is finite.
pub(super) fn finite(key: &'static str, value: f64) -> Result<f64, DistributionError> {
    number(key, value, true, "")
}

/// The value, if it is finite and greater than 0.
pub(super) fn positive(key: &'static str, value: f64) -> Result<f64, DistributionError> {
    number(key, value, value > 0.0, "be greater than 0")
}

/// The value, if it is finite and within the range.
pub(super) fn within(key: &'static str, value: f64, (min, max): (f64, f64)) -> Result<f64, DistributionError> {
    number(key, value, (min..=max).contains(&value), &format!("lie between {min:?} and {max:?}"))
}

/// The value of a parameter of a power law, if it is great enough for a finite variance.
pub(super) fn of_finite_variance(key: &'static str, value: f64, least: f64) -> Result<(), DistributionError> {
    let must = format!(
        "be greater than {least:?}, or both tails be cut off, as in truncate = [a, b]: else it has no finite variance, of which \
         indices are shares"
    );
    number(key, value, value > least, &must).map(|_| ())
}

/// Two finite bounds in order, and the finite width between them.
pub(super) fn bounds(min: f64, max: f64, distribution: &'static str) -> Result<f64, DistributionError> {
    finite("min", min)?;
    finite("max", max)?;
    match max - min {
        width if width <= 0.0 => Err(DistributionError::Order { lower: "min", low: min, upper: "max", high: max }),
        width if width.is_infinite() => Err(DistributionError::Overflow { distribution }),
        width => Ok(width),
    }
}

/// Refuses a list with an entry that is infinite or not a number.
pub(super) fn finite_entries(key: &'static str, entries: &[f64]) -> Result<(), DistributionError> {
    match entries.iter().enumerate().find(|(_, value)| !value.is_finite()) {
        Some((index, &value)) => Err(entry(key, index, value, "be a finite number".to_owned())),
        None => Ok(()),
    }
}

pub(super) fn entry(key: &'static str, index: usize, value: f64, must: String) -> DistributionError {
    DistributionError::Entry { key, index, value, must }
}

pub(super) fn list(key: &'static str, problem: impl Into<String>) -> DistributionError {
    DistributionError::List { key, problem: problem.into() }
}

/// The sum of `weights`, one for each of `count` entries of the list `of`: finite, none of them negative, not all of them 0.
pub(super) fn sum_of_weights(weights: &[f64], count: usize, of: &str) -> Result<f64, DistributionError> {
    if weights.len() != count {
        let given = weights.len();
        return Err(list(
            "weights",
            format!("there are {given} `weights` for {count} `{of}`, but there must be one for each"),
        ));
    }
    finite_entries("weights", weights)?;
    if let Some((index, &value)) = weights.iter().enumerate().find(|(_, weight)| **weight < 0.0) {
        return Err(entry("weights", index, value, "not be negative".to_owned()));
    }
    match weights.iter().sum::<f64>() {
        0.0 => Err(list("weights", "all `weights` are 0, but at least one must be greater")),
        sum if sum.is_infinite() => {
            let advice = "divide all of them by the same number, such as the largest";
            Err(list("weights", format!("`weights` sum to more than 1.8e308: {advice}")))
        }
        sum => Ok(sum),
    }
}
