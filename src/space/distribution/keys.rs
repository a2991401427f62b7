//! The keys of distributions, and the families that use them: one table each, which defines the reader of study files,
//! the JSON schema and the messages.

use super::error::{finite, missing, refused, wrong_unit};
use super::family::Parameter;
use super::solved::{Shape, solved};
use super::{Distribution, DistributionError, ENTRIES};
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
    measure: Measure,
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
enum Measure {
    /// A value, possibly with an offset of its unit.
    Value,
    /// A difference of two values.
    Span,
    /// The natural logarithm of a value.
    Log,
    /// A pure number.
    Pure,
}

const fn key(name: &'static str, kind: KeyKind, measure: Measure, description: &'static str) -> Key {
    Key { name, kind, description, measure }
}

const fn quantile(name: &'static str, description: &'static str) -> Key {
    key(name, KeyKind::Number, Measure::Value, description)
}

/// All keys of distributions.
pub static KEYS: [Key; 32] = {
    use KeyKind::{Bounds, Number, Numbers, Quantiles, Text, Texts};
    use Measure::{Log, Pure, Span, Value};
    [
        key("min", Number, Value, "Lower bound."),
        key("max", Number, Value, "Upper bound."),
        key("mean", Number, Value, "Mean: of the factor itself; before truncation of a truncated distribution."),
        key("sd", Number, Span, "Standard deviation, as the mean."),
        key("log_mean", Number, Log, "Mean of the natural logarithm, of a log-normal distribution."),
        key("log_sd", Number, Pure, "Standard deviation of the natural logarithm, of a log-normal distribution."),
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
fn probability(key: &str) -> Option<f64> {
    let percent: u8 = key.strip_prefix('p')?.parse().ok()?;
    Some(f64::from(percent) / 100.0)
}

/// Keys that together determine a distribution.
#[derive(Debug)]
pub(super) struct Way {
    needs: &'static [&'static str],
    /// Optional keys in addition to these.
    may: &'static [&'static str],
    /// Whether two quantiles are also needed.
    has_quantiles: bool,
    /// Whether its parameters are solved for.
    is_solved: bool,
}

/// Requires all of these keys.
pub(super) const fn keys(needs: &'static [&'static str]) -> Way {
    Way { needs, may: &[], has_quantiles: false, is_solved: false }
}

/// Requires these keys, from which the parameters are solved for.
pub(super) const fn solved_keys(needs: &'static [&'static str]) -> Way {
    Way { is_solved: true, ..keys(needs) }
}

/// Mean and standard deviation, if they are not the parameters themselves.
pub(super) const MOMENTS: Way = solved_keys(&["mean", "sd"]);

/// Two quantiles.
pub(super) const TWO_QUANTILES: Way = two_quantiles_and(&[]);

/// Requires two quantiles and these keys.
pub(super) const fn two_quantiles_and(needs: &'static [&'static str]) -> Way {
    Way { has_quantiles: true, ..solved_keys(needs) }
}

impl Way {
    /// Returns the same with these optional keys.
    pub const fn perhaps(self, may: &'static [&'static str]) -> Self {
        Self { may, ..self }
    }

    fn takes(&self, key: &str) -> bool {
        self.needs.contains(&key) || self.may.contains(&key) || self.has_quantiles && probability(key).is_some()
    }

    /// Returns what is missing among `given`, in words.
    fn missing(&self, given: &Given<'_>) -> Option<String> {
        let key = self.needs.iter().find(|key| given.get(key).is_none()).map(|key| format!("`{key}`"));
        let few = self.has_quantiles && given.quantiles().count() != 2;
        key.or_else(|| few.then(|| "two quantiles, such as `p05` and `p95`".to_owned()))
    }

    fn in_words(&self) -> String {
        let mut parts: Vec<&str> = self.needs.to_vec();
        if self.has_quantiles {
            parts.push("two of p01, p05, p10, p25, p50, p75, p90, p95, p99");
        }
        let may = if self.may.is_empty() { String::new() } else { format!("perhaps {}", self.may.join(", ")) };
        [parts.join(" and "), may].into_iter().filter(|words| !words.is_empty()).collect::<Vec<_>>().join(", ")
    }
}

/// An entry of the list of families.
pub(super) struct Entry {
    pub name: &'static str,
    pub summary: &'static str,
    /// The ways to specify one, the first of them by its own parameters.
    pub ways: &'static [Way],
    /// Whether it depends on ratios of values above 0, which have no meaning in a unit with an offset.
    pub of_ratios: bool,
    /// The parameter in addition to location and scale, if the parameters are solved for.
    pub shape: Shape,
    /// The values of optional keys; also of keys that are optional only in Python's constructors.
    pub defaults: &'static [(&'static str, f64)],
    /// Creates it from a location, a scale and a shape, if these are solved for; other parameters are as given.
    pub make: fn(&Given<'_>, [f64; 3]) -> Result<Distribution, DistributionError>,
    /// Creates it from its parameters; it may have no finite variance before it is truncated.
    pub build: fn(&Given<'_>) -> Result<Distribution, DistributionError>,
}

/// The fields that most entries share.
pub(super) const PLAIN: Entry = Entry {
    name: "",
    summary: "",
    ways: &[],
    of_ratios: false,
    shape: Shape::None,
    defaults: &[],
    make: |given, _| (given.entry.build)(given),
    build: |given| Err(given.missing("nothing".to_owned())),
};

/// Parameters by key.
#[derive(Clone, Copy)]
pub(super) struct Given<'a> {
    pub entry: &'static Entry,
    pub values: &'a [(&'static str, Parameter)],
}

impl<'a> Given<'a> {
    pub fn get(&self, key: &str) -> Option<&'a Parameter> {
        self.values.iter().find(|(name, _)| *name == key).map(|(_, value)| value)
    }

    pub fn number_if(&self, key: &str) -> Option<f64> {
        if let Some(Parameter::Number(number)) = self.get(key) { Some(*number) } else { None }
    }

    pub fn number_or(&self, key: &str, default: f64) -> f64 {
        self.number_if(key).unwrap_or(default)
    }

    pub fn number(&self, key: &str) -> Result<f64, DistributionError> {
        let default = || self.entry.defaults.iter().find(|(name, _)| *name == key).map(|(_, value)| *value);
        self.number_if(key).or_else(default).ok_or_else(|| self.missing(format!("`{key}`")))
    }

    pub fn list_if(&self, key: &str) -> Option<&'a [f64]> {
        if let Some(Parameter::List(list)) = self.get(key) { Some(list) } else { None }
    }

    pub fn list(&self, key: &str) -> Result<&'a [f64], DistributionError> {
        self.list_if(key).ok_or_else(|| self.missing(format!("`{key}`")))
    }

    /// Iterates over the quantiles that have a key: key, probability and value, in rising order of the probabilities.
    pub fn quantiles(&self) -> impl Iterator<Item = (&'static str, f64, f64)> {
        KEYS.iter().filter_map(|key| Some((key.name, probability(key.name)?, self.number_if(key.name)?)))
    }

    pub fn missing(&self, needed: String) -> DistributionError {
        missing(self.entry.name, &needed, Kind(self.entry).help())
    }
}

/// An argument of the constructor of a family.
#[derive(Debug)]
pub struct Argument {
    /// The key.
    pub key: &'static Key,
    /// Whether it is optional.
    pub is_optional: bool,
    /// Its default, if that is a number.
    pub default: Option<f64>,
}

/// A family of distributions, before its parameters are chosen.
#[derive(Clone, Copy)]
pub struct Kind(&'static Entry);

impl Default for Kind {
    /// Returns the default of study files.
    fn default() -> Self {
        Self(&ENTRIES[0][0])
    }
}

impl Kind {
    /// Iterates over all of them, the default of study files first.
    pub fn all() -> impl Iterator<Item = Self> + Clone {
        ENTRIES.iter().copied().flatten().map(Self)
    }

    /// Returns the family of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().find(|kind| kind.name() == name)
    }

    /// Returns the name in study files.
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Returns one line for people.
    pub fn summary(self) -> &'static str {
        self.0.summary
    }

    /// Iterates over the arguments of its constructor in other languages: its own parameters.
    pub fn arguments(self) -> impl Iterator<Item = Argument> {
        let Entry { ways, defaults, .. } = self.0;
        let argument = |name: &str, is_optional: bool| {
            let key = KEYS.iter().find(|key| key.name == name)?;
            let default = defaults.iter().find(|(key, _)| *key == name).map(|(_, value)| *value);
            Some(Argument { key, is_optional: is_optional || default.is_some(), default })
        };
        let needs = ways[0].needs.iter().filter_map(move |key| argument(key, false));
        needs.chain(ways[0].may.iter().filter_map(move |key| argument(key, true)))
    }

    /// Returns the keys that determine one, in words.
    pub fn takes(self) -> String {
        let ways: Vec<String> = self.0.ways.iter().map(Way::in_words).collect();
        if ways == [""] { "no keys".to_owned() } else { ways.join("; or ") }
    }

    fn help(self) -> String {
        format!("it takes {}", self.takes())
    }

    /// Returns the distribution that these parameters by key determine, as in a study file: its own parameters, or a
    /// mean and a standard deviation, or two quantiles; truncated if `truncate` is given.
    ///
    /// Solved parameters are accurate to 1e-9 standard deviations.
    ///
    /// ```
    /// use apportion::space::distribution::{Kind, Parameter};
    ///
    /// let family = Kind::from_name("log-normal").ok_or("no such family")?;
    /// let roughness = family.make(&[("p05", Parameter::Number(1.0)), ("p95", Parameter::Number(4.0))])?;
    /// assert!((roughness.median() - 2.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`DistributionError`] if a key is missing or superfluous; if no distribution of the family has that mean and
    /// standard deviation or these quantiles; or as for the constructor of the family.
    pub fn make(self, parameters: &[(&'static str, Parameter)]) -> Result<Distribution, DistributionError> {
        let given = Given { entry: self.0, values: parameters };
        let way = self.way(&given)?;
        let made = match way.is_solved {
            true => solved(&given, way.may.contains(&"location"))?,
            false => (self.0.build)(&given)?,
        };
        match given.get("truncate") {
            Some(Parameter::Bounds(min, max)) => made.truncated(*min, *max),
            _ => made.finite(),
        }
    }

    /// Returns the way that the given keys select.
    fn way(self, given: &Given<'_>) -> Result<&'static Way, DistributionError> {
        let keys = || given.values.iter().map(|(key, _)| *key).filter(|key| *key != "truncate");
        let fits = |way: &&Way| keys().all(|key| way.takes(key));
        let fitting = || self.0.ways.iter().filter(fits);
        if let Some(way) = fitting().find(|way| way.missing(given).is_none()) {
            return Ok(way);
        }
        if let Some(missing) = fitting().next().and_then(|way| way.missing(given)) {
            return Err(given.missing(missing));
        }
        // The way with the most matching keys determines which key is wrong.
        let fitted = |way: &&Way| keys().filter(|key| way.takes(key)).count();
        let nearest = self.0.ways.iter().rev().max_by_key(fitted);
        let foreign = keys().find(|key| nearest.is_none_or(|way| !way.takes(key))).unwrap_or_default();
        let is_known = self.0.ways.iter().any(|way| way.takes(foreign));
        let beside = if is_known { keys().find(|key| nearest.is_some_and(|way| way.takes(key))) } else { None };
        let beside = beside.map_or_else(String::new, |key| format!(" together with `{key}`"));
        let message = format!("the {} distribution has no `{foreign}`{beside}", self.0.name);
        Err(refused(foreign, message).with_help(self.help()))
    }
}

/// Returns the distribution with `parameters`, which are in `unit`, in SI.
pub(super) fn in_si(
    entry: &'static Entry,
    mut parameters: Vec<(&'static str, Parameter)>,
    unit: &Unit,
) -> Result<Distribution, DistributionError> {
    if entry.of_ratios && unit.has_offset() {
        return Err(wrong_unit(entry.name, unit, ", whose 0 is not that of SI: state it in K"));
    }
    for (name, parameter) in &mut parameters {
        let measure = KEYS.iter().find(|key| key.name == *name).map_or(Measure::Pure, |key| key.measure);
        let number = |number: &mut f64| match measure {
            Measure::Value => *number = unit.to_si(*number),
            Measure::Span => *number = unit.span_to_si(*number),
            Measure::Log => *number += libm::log(unit.to_si(1.0)),
            Measure::Pure => (),
        };
        match parameter {
            Parameter::Number(value) => number(value),
            Parameter::List(list) => list.iter_mut().for_each(number),
            _ => (),
        }
    }
    (entry.build)(&Given { entry, values: &parameters })
}

/// Returns bounds, one or both of which may be infinite, in SI.
pub(super) fn bounds_to_si((min, max): (f64, f64), unit: &Unit) -> Result<(f64, f64), DistributionError> {
    let in_si = |key: &'static str, bound: f64| match bound.is_finite() {
        true => finite(key, unit.to_si(bound)),
        false => Ok(bound),
    };
    Ok((in_si("min", min)?, in_si("max", max)?))
}
