//! Entries of families: the keys that determine a distribution, and how it is built from them.

use super::error::{finite, missing, wrong_unit};
use super::keys::{KEYS, Measure, probability};
use super::{Distribution, DistributionError, Parameter};
use apportion_base::quantity::Unit;

/// Keys that together determine a distribution.
#[derive(Debug)]
pub(super) struct KeySet {
    pub needs: &'static [&'static str],
    /// Optional keys in addition to these.
    pub may: &'static [&'static str],
    /// Whether two quantiles are also needed.
    has_quantiles: bool,
    /// Whether its parameters are solved for.
    pub is_solved: bool,
}

/// Requires all of these keys.
pub(super) const fn keys(needs: &'static [&'static str]) -> KeySet {
    KeySet { needs, may: &[], has_quantiles: false, is_solved: false }
}

/// Requires these keys, from which the parameters are solved for.
pub(super) const fn solved_keys(needs: &'static [&'static str]) -> KeySet {
    KeySet { is_solved: true, ..keys(needs) }
}

/// Mean and standard deviation, if they are not the parameters themselves.
pub(super) const MOMENTS: KeySet = solved_keys(&["mean", "sd"]);

/// Two quantiles.
pub(super) const TWO_QUANTILES: KeySet = two_quantiles_and(&[]);

/// Requires two quantiles and these keys.
pub(super) const fn two_quantiles_and(needs: &'static [&'static str]) -> KeySet {
    KeySet { has_quantiles: true, ..solved_keys(needs) }
}

impl KeySet {
    /// Returns the same with these optional keys.
    pub const fn perhaps(self, may: &'static [&'static str]) -> Self {
        Self { may, ..self }
    }

    pub fn takes(&self, key: &str) -> bool {
        self.needs.contains(&key) || self.may.contains(&key) || self.has_quantiles && probability(key).is_some()
    }

    /// Returns what is missing among `given`, in words.
    pub fn missing(&self, given: &Arguments<'_>) -> Option<String> {
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

/// The parameter in addition to location and scale.
pub(super) enum Shape {
    /// There is none.
    None,
    /// It is given under this key.
    Given(&'static str),
    /// It is solved for, from the shape of a narrow distribution to that of a wide one, in this many logarithmic steps.
    Between(f64, f64, u32),
    /// The share of the width below `mode`, which is given.
    Mode,
}

/// An entry of the list of families.
pub(super) struct Entry {
    pub name: &'static str,
    pub summary: &'static str,
    /// The sets of keys that determine one, the first of them its parameters.
    pub key_sets: &'static [KeySet],
    /// Whether it depends on ratios of values above 0, which have no meaning in a unit with an offset.
    pub of_ratios: bool,
    /// The parameter in addition to location and scale, if the parameters are solved for.
    pub shape: Shape,
    /// The values of optional keys; also of keys that are optional only in Python's constructors.
    pub defaults: &'static [(&'static str, f64)],
    /// Creates it from a location, a scale and a shape, if these are solved for; other parameters are as given.
    pub make: fn(&Arguments<'_>, [f64; 3]) -> Result<Distribution, DistributionError>,
    /// Creates it from its parameters; it may have no finite variance before it is truncated.
    pub build: fn(&Arguments<'_>) -> Result<Distribution, DistributionError>,
}

/// The fields that most entries share.
pub(super) const PLAIN: Entry = Entry {
    name: "",
    summary: "",
    key_sets: &[],
    of_ratios: false,
    shape: Shape::None,
    defaults: &[],
    make: |given, _| (given.entry.build)(given),
    build: |given| Err(given.missing("nothing".to_owned())),
};

impl Entry {
    /// Returns the default of an optional key.
    pub fn default(&self, key: &str) -> Option<f64> {
        self.defaults.iter().find(|(name, _)| *name == key).map(|(_, value)| *value)
    }

    /// Returns the keys that determine one, in words.
    pub fn takes(&self) -> String {
        let key_sets: Vec<String> = self.key_sets.iter().map(KeySet::in_words).collect();
        if key_sets == [""] { "no keys".to_owned() } else { key_sets.join("; or ") }
    }

    pub fn help(&self) -> String {
        format!("it takes {}", self.takes())
    }
}

/// The given parameters, by key.
#[derive(Clone, Copy)]
pub(super) struct Arguments<'a> {
    pub entry: &'static Entry,
    pub values: &'a [(&'static str, Parameter)],
}

impl<'a> Arguments<'a> {
    /// Iterates over the keys except that of truncation, which any family takes.
    pub fn keys(&self) -> impl Iterator<Item = &'static str> {
        self.values.iter().map(|(key, _)| *key).filter(|key| *key != "truncate")
    }

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
        let number = self.number_if(key).or_else(|| self.entry.default(key));
        number.ok_or_else(|| self.missing(format!("`{key}`")))
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
        missing(self.entry.name, &needed, self.entry.help())
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
        let numbers = match parameter {
            Parameter::Number(number) => std::slice::from_mut(number),
            Parameter::List(list) => list,
            _ => continue,
        };
        for number in numbers {
            *number = measure.to_si(*number, unit);
        }
    }
    (entry.build)(&Arguments { entry, values: &parameters })
}

/// Returns bounds, one or both of which may be infinite, in SI.
pub(super) fn bounds_to_si((min, max): (f64, f64), unit: &Unit) -> Result<(f64, f64), DistributionError> {
    Ok((bound_to_si("min", min, unit)?, bound_to_si("max", max, unit)?))
}

fn bound_to_si(key: &'static str, bound: f64, unit: &Unit) -> Result<f64, DistributionError> {
    if bound.is_finite() { finite(key, unit.to_si(bound)) } else { Ok(bound) }
}
