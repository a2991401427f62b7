//! What can be wrong with the parameters of a distribution.

use crate::quantity::Unit;

/// Why a distribution was refused; the text says what was wrong and what would be right.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DistributionError {
    /// A parameter is infinite or not a number.
    #[error("`{parameter}` is {value}, but must be a finite number")]
    NotFinite {
        /// Its name.
        parameter: &'static str,
        /// Its value.
        value: f64,
    },
    /// A parameter is zero or negative.
    #[error("`{parameter}` is {value:?}, but must be greater than 0")]
    NotPositive {
        /// Its name.
        parameter: &'static str,
        /// Its value.
        value: f64,
    },
    /// A shape parameter is beyond what can be computed well.
    #[error("`{parameter}` is {value:?}, but must lie between {min:?} and {max:?}")]
    OutOfRange {
        /// Its name.
        parameter: &'static str,
        /// Its value.
        value: f64,
        /// The smallest value.
        min: f64,
        /// The largest value.
        max: f64,
    },
    /// The bounds are equal or the wrong way round.
    #[error("`min` is {min} and `max` is {max}, but `min` must be below `max`")]
    Bounds {
        /// The lower bound.
        min: f64,
        /// The upper bound.
        max: f64,
    },
    /// The mode of a triangular distribution lies outside its bounds.
    #[error("`mode` is {mode}, but must lie between `min` ({min}) and `max` ({max})")]
    Mode {
        /// The mode.
        mode: f64,
        /// The lower bound.
        min: f64,
        /// The upper bound.
        max: f64,
    },
    /// A normal distribution has next to no probability between the bounds it is truncated to.
    #[error(
        "a normal distribution of mean {mean} and sd {sd} has no probability between `min` ({min}) and `max` ({max}): \
         move the bounds within 35 sd of the mean"
    )]
    Truncation {
        /// The mean before truncation.
        mean: f64,
        /// The standard deviation before truncation.
        sd: f64,
        /// The lower bound.
        min: f64,
        /// The upper bound.
        max: f64,
    },
    /// A Gumbel distribution has next to no probability between the bounds it is truncated to.
    #[error(
        "a Gumbel distribution of location {location} and scale {scale} has no probability between `min` ({min}) and \
         `max` ({max}): move the bounds to between 6 scales below and 600 above the location"
    )]
    GumbelTruncation {
        /// The location before truncation.
        location: f64,
        /// The scale before truncation.
        scale: f64,
        /// The lower bound.
        min: f64,
        /// The upper bound.
        max: f64,
    },
    /// A discrete distribution without values.
    #[error("`values` is empty, but must hold at least one number")]
    NoValues,
    /// An entry of a list is infinite or not a number.
    #[error("`{list}[{index}]` is {value}, but must be a finite number")]
    EntryNotFinite {
        /// The name of the list.
        list: &'static str,
        /// The entry, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A discrete distribution with more or fewer weights than values.
    #[error("there are {weights} `weights` for {values} `values`, but there must be one weight for each value")]
    Lengths {
        /// How many values.
        values: usize,
        /// How many weights.
        weights: usize,
    },
    /// A negative weight.
    #[error("`weights[{index}]` is {value}, but must not be negative")]
    NegativeWeight {
        /// The entry, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// All weights are zero.
    #[error("all `weights` are 0, but at least one must be greater")]
    ZeroWeights,
    /// Weights whose sum is no number.
    #[error("`weights` sum to more than 1.8e308: divide all of them by the same number, such as the largest")]
    WeightSum,
    /// A bound of whole numbers that is none.
    #[error("`{parameter}` is {value:?}, but must be a whole number between -2^53 and 2^53")]
    NotWhole {
        /// Its name.
        parameter: &'static str,
        /// Its value.
        value: f64,
    },
    /// A category without a label.
    #[error("`labels[{index}]` is empty, but every category needs a label")]
    EmptyLabel {
        /// The entry, from 0.
        index: usize,
    },
    /// Two categories of one label.
    #[error("the label \"{label}\" stands in `labels` twice")]
    RepeatedLabel {
        /// The label.
        label: String,
    },
    /// Categories with more or fewer numbers than labels.
    #[error("there are {values} `values` for {labels} `labels`, but there must be one value for each label")]
    Labels {
        /// How many labels.
        labels: usize,
        /// How many values.
        values: usize,
    },
    /// Two categories of one number.
    #[error("`values[{index}]` is {value}, as is one before it, but every label needs a value of its own")]
    RepeatedValue {
        /// The entry, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// Something is stated that the family does not have.
    #[error("{} distribution cannot be given by `{statistic}`", named(.distribution))]
    NotStated {
        /// The name of the family.
        distribution: &'static str,
        /// What was stated.
        statistic: &'static str,
    },
    /// The same thing is stated twice.
    #[error("`{statistic}` is stated twice")]
    StatedTwice {
        /// What was stated.
        statistic: &'static str,
    },
    /// Too little or too much is stated.
    #[error("{name} distribution is determined by {needed}, but {given} of these {verb} given", name = named(.distribution), verb = if *.given == 1 { "is" } else { "are" })]
    Determined {
        /// The name of the family.
        distribution: &'static str,
        /// How many statements of which it takes, in words.
        needed: &'static str,
        /// How many there are.
        given: usize,
    },
    /// Two values that are the wrong way round.
    #[error("`{lower}` is {low} and `{upper}` is {high}, but `{lower}` must be below `{upper}`")]
    Order {
        /// What should be lower.
        lower: &'static str,
        /// Its value.
        low: f64,
        /// What should be higher.
        upper: &'static str,
        /// Its value.
        high: f64,
    },
    /// The statements contradict each other, or say one thing twice.
    #[error("there is no {distribution} distribution, or more than one, with {statements}")]
    NoSuchDistribution {
        /// The name of the family.
        distribution: &'static str,
        /// What was stated.
        statements: String,
        /// What was stated first.
        first: &'static str,
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
    /// All indices rest on variances, and this distribution has none.
    #[error(
        "{name} distribution with `{parameter}` = {value:?} has no finite variance, of which indices are shares: \
         `{parameter}` must be greater than {least:?}, or both tails cut off, as in truncate = [a, b]",
        name = named(.distribution)
    )]
    InfiniteVariance {
        /// The name of the family.
        distribution: &'static str,
        /// The parameter that decides.
        parameter: &'static str,
        /// Its value.
        value: f64,
        /// What it must exceed.
        least: f64,
    },
    /// Next to no probability is left by a truncation.
    #[error(
        "`truncate` leaves nothing of this {distribution} distribution: next to none of its values lie between {min} and \
         {max}"
    )]
    NothingLeft {
        /// The name of the family.
        distribution: &'static str,
        /// The lower bound.
        min: f64,
        /// The upper bound.
        max: f64,
    },
    /// A truncation from a lower to an upper value that are no such.
    #[error("`truncate` is [{min}, {max}], but must be two numbers, the lower one first; inf and -inf cut nothing off")]
    TruncationBounds {
        /// The lower bound.
        min: f64,
        /// The upper bound.
        max: f64,
    },
    /// A mixture of nothing.
    #[error("`components` is empty, but must hold at least one distribution")]
    NoComponents,
    /// A mixture with more or fewer weights than components.
    #[error("there are {weights} `weights` for {components} `components`, but there must be one weight for each")]
    Components {
        /// How many components.
        components: usize,
        /// How many weights.
        weights: usize,
    },
    /// Labels and seeds, which have no order, cannot be truncated, nor be a part of a mixture.
    #[error("{} distribution has {}, which have no order: it cannot be {what}", named(.distribution), unordered(.distribution))]
    NoOrder {
        /// The name of the family.
        distribution: &'static str,
        /// What was asked for.
        what: &'static str,
    },
    /// A list that must rise, and does not.
    #[error("`{list}[{index}]` is {value}, which is not above the one before it, {before}")]
    NotRising {
        /// The name of the list.
        list: &'static str,
        /// The entry, from 0.
        index: usize,
        /// Its value.
        value: f64,
        /// The one before it.
        before: f64,
    },
    /// Edges of a histogram that do not go with its weights.
    #[error("there are {edges} `edges` for {weights} `weights`, but n bins have n + 1 edges, at least 2")]
    Edges {
        /// How many edges.
        edges: usize,
        /// How many weights.
        weights: usize,
    },
    /// Quantiles that do not determine a histogram.
    #[error(
        "`quantiles` has {found}, but must have rising values for probabilities from 0 to 1, the lowest and highest value among them, as in {{ \"0\" = 1, \"0.5\" = 2, \"1\" = 5 }}"
    )]
    Quantiles {
        /// What is wrong.
        found: String,
    },
    /// Seeds of a stochastic model are pure numbers.
    #[error("a seed is a pure number, and cannot be in {unit}: leave the unit out")]
    UnitOfSeed {
        /// The unit.
        unit: String,
    },
    /// Ratios of values have no meaning in a unit whose zero is not that of SI.
    #[error("{} distribution cannot be in {unit}, whose 0 is not that of SI: state it in {absolute}", named(.distribution))]
    OffsetUnit {
        /// The name of the family.
        distribution: &'static str,
        /// The unit.
        unit: String,
        /// A unit that serves.
        absolute: &'static str,
    },
}

/// The name of a family with its article.
fn named(distribution: &str) -> String {
    let article = if distribution.starts_with(['a', 'e', 'i', 'o']) { "an" } else { "a" };
    format!("{article} {distribution}")
}

/// What a family without an order has for values.
fn unordered(distribution: &str) -> &'static str {
    if distribution == "seed" { "seeds" } else { "labels" }
}

/// Refuses a unit with an offset, such as `degC`, to a family that is made of ratios.
pub(super) fn refuse_offset(distribution: &'static str, unit: &Unit) -> Result<(), DistributionError> {
    match unit.has_offset() {
        true => Err(DistributionError::OffsetUnit { distribution, unit: unit.to_string(), absolute: "K" }),
        false => Ok(()),
    }
}

/// The value, if it is finite.
pub(super) fn finite(parameter: &'static str, value: f64) -> Result<f64, DistributionError> {
    match value.is_finite() {
        true => Ok(value),
        false => Err(DistributionError::NotFinite { parameter, value }),
    }
}

/// The value, if it is finite and greater than 0.
pub(super) fn positive(parameter: &'static str, value: f64) -> Result<f64, DistributionError> {
    match finite(parameter, value)? > 0.0 {
        true => Ok(value),
        false => Err(DistributionError::NotPositive { parameter, value }),
    }
}

/// Two finite bounds in order, and the finite width between them.
pub(super) fn bounds(min: f64, max: f64, distribution: &'static str) -> Result<f64, DistributionError> {
    finite("min", min)?;
    finite("max", max)?;
    match max - min {
        width if width <= 0.0 => Err(DistributionError::Bounds { min, max }),
        width if width.is_infinite() => Err(DistributionError::Overflow { distribution }),
        width => Ok(width),
    }
}

/// Bounds of which one or both may be infinite, in SI.
pub(super) fn bounds_to_si((min, max): (f64, f64), unit: &Unit) -> Result<(f64, f64), DistributionError> {
    let in_si = |parameter: &'static str, bound: f64| match bound.is_finite() {
        true => finite(parameter, unit.to_si(bound)),
        false => Ok(bound),
    };
    Ok((in_si("min", min)?, in_si("max", max)?))
}

/// The value, if it is finite and within the range.
pub(super) fn within(parameter: &'static str, value: f64, range: (f64, f64)) -> Result<f64, DistributionError> {
    let (min, max) = range;
    match (min..=max).contains(&finite(parameter, value)?) {
        true => Ok(value),
        false => Err(DistributionError::OutOfRange { parameter, value, min, max }),
    }
}
