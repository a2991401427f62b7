//! The empirical distribution: values that were measured.

use super::discrete::Discrete;
use super::family::{Family, Parameter, numbers_of_law};
use super::keys::{Entry, PLAIN, keys};
use super::{Distribution, DistributionError};
use crate::quantity::Unit;

/// Measured values, each as likely as any other.
#[derive(Clone, Debug, PartialEq)]
pub struct Empirical {
    law: Discrete,
    source: Option<MeasuredFile>,
}

/// The file that measured values come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeasuredFile {
    /// Its path as given.
    pub file: String,
    /// The name of its column; none for a file of bare numbers.
    pub column: Option<String>,
    /// SHA-256 of the file in hexadecimal.
    pub sha256: String,
}

impl Distribution {
    /// Each of the measured `values` with equal probability; a value measured twice counts twice.
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = x_(k),   k = floor(n u) + 1,   x_(1) <= x_(2) <= ... <= x_(n)
    /// mean = sum x_i / n,   sd = sqrt(sum (x_i - mean)^2 / n)
    /// ```
    ///
    /// The inverse of the empirical distribution function: nothing between the values, nothing beyond them.
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
        Self::Empirical(Empirical { law: Discrete::new(values, None)?, source }).finite()
    }
}

impl Empirical {
    /// The measured values between `min` and `max`, both included.
    pub(super) fn between(&self, min: f64, max: f64) -> Result<Distribution, DistributionError> {
        let values = self.law.values().iter().copied().filter(|value| (min..=max).contains(value));
        let values: Vec<f64> = values.collect();
        match values.is_empty() {
            true => Err(DistributionError::NothingLeft { distribution: "empirical", min, max }),
            false => Distribution::empirical(&values, self.source.clone()),
        }
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "empirical",
    summary: "Measured values, each as likely as any other.",
    ways: &[keys(&["values"]), keys(&["file"]).perhaps(&["column"])],
    build: |given| match given.get("file") {
        Some(Parameter::Measured(values, source)) => Distribution::empirical(values, Some(source.clone())),
        _ => Distribution::empirical(given.list("values")?, None),
    },
    ..PLAIN
}];

impl Family for Empirical {
    numbers_of_law!();

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        let Some(MeasuredFile { file, column, sha256 }) = &self.source else { return self.law.parameters() };
        let mut parameters = vec![("file", Parameter::Text(file.clone()))];
        parameters.extend(column.iter().map(|column| ("column", Parameter::Text(column.clone()))));
        parameters.push(("count", (self.law.values().len() as f64).into()));
        parameters.push(("sha256", Parameter::Text(sha256.clone())));
        parameters
    }

    fn in_si(&self, _own: &'static Entry, unit: &Unit) -> Result<Distribution, DistributionError> {
        let values: Vec<f64> = self.law.values().iter().map(|&value| unit.to_si(value)).collect();
        Distribution::empirical(&values, self.source.clone())
    }
}
