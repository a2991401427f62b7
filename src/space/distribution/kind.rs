//! Families before their parameters are chosen.

use super::entry::{Arguments, Entry, KeySet};
use super::error::refused;
use super::keys::{KEYS, Key};
use super::solved::solved;
use super::{Distribution, DistributionError, ENTRIES, Parameter};

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

    /// Iterates over the arguments of its constructor in other languages: the parameters of its first set of keys.
    pub fn arguments(self) -> impl Iterator<Item = Argument> {
        let KeySet { needs, may, .. } = &self.0.key_sets[0];
        let needed = needs.iter().filter_map(move |key| self.argument(key, false));
        needed.chain(may.iter().filter_map(move |key| self.argument(key, true)))
    }

    fn argument(self, name: &str, is_optional: bool) -> Option<Argument> {
        let key = KEYS.iter().find(|key| key.name == name)?;
        let default = self.0.default(name);
        Some(Argument { key, is_optional: is_optional || default.is_some(), default })
    }

    /// Returns the keys that determine one, in words.
    pub fn takes(self) -> String {
        self.0.takes()
    }

    /// Returns the distribution that these parameters by key determine, as in a study file: its parameters, or a
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
        let given = Arguments { entry: self.0, values: parameters };
        let keys = self.key_set(&given)?;
        let made = match keys.is_solved {
            true => solved(&given, keys.may.contains(&"location")),
            false => (self.0.build)(&given),
        };
        let made = made.map_err(|error| self.with_hint(error, &given))?;
        match given.get("truncate") {
            Some(Parameter::Bounds(min, max)) => made.truncated(*min, *max),
            _ => made.finite(),
        }
    }

    /// Adds what to write instead of no spread, or of values below 0.
    fn with_hint(self, error: DistributionError, given: &Arguments<'_>) -> DistributionError {
        match error.key.and_then(|key| Some((key, given.number_if(key)?))) {
            Some(("sd" | "log_sd", 0.0) | ("gsd", 1.0)) => {
                error.with_help("for a fixed value, use the constant distribution".to_owned())
            }
            Some((key, value)) if self.0.of_ratios && value < 0.0 && !matches!(key, "sd" | "log_sd" | "shape") => {
                error.with_help("for negative amounts, give their size here, and negate it in the formula".to_owned())
            }
            _ => error,
        }
    }

    /// Returns the set of keys that those of `given` select.
    fn key_set(self, given: &Arguments<'_>) -> Result<&'static KeySet, DistributionError> {
        let Entry { name, key_sets, .. } = self.0;
        let fitting: Vec<&KeySet> = key_sets.iter().filter(|set| given.keys().all(|key| set.takes(key))).collect();
        if let Some(set) = fitting.iter().find(|set| set.missing(given).is_none()) {
            return Ok(set);
        }
        if let Some(missing) = fitting.first().and_then(|set| set.missing(given)) {
            return Err(given.missing(missing));
        }
        // The set with the most matching keys determines which key is wrong.
        let nearest = key_sets.iter().rev().max_by_key(|set| given.keys().filter(|key| set.takes(key)).count());
        let foreign = given.keys().find(|key| nearest.is_none_or(|set| !set.takes(key))).unwrap_or_default();
        let mut message = format!("the {name} distribution has no `{foreign}`");
        if key_sets.iter().any(|set| set.takes(foreign))
            && let Some(key) = given.keys().find(|key| nearest.is_some_and(|set| set.takes(key)))
        {
            message += &format!(" together with `{key}`");
        }
        Err(refused(foreign, message).with_help(self.0.help()))
    }
}
