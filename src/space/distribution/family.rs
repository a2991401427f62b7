//! The interface of a family of distributions.

use serde::Serialize;
use serde::ser::{SerializeSeq, Serializer};

use super::keys::{Entry, in_si};
use super::{Distribution, DistributionError, MeasuredFile};
use apportion_base::quantity::Unit;

/// A parameter as in a study file.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Parameter {
    /// A number.
    Number(f64),
    /// A list of numbers.
    List(Vec<f64>),
    /// A text.
    Text(String),
    /// A list of texts.
    Texts(Vec<String>),
    /// Two bounds, one of which may be infinite and is then written as a text: `[2.0, "inf"]`.
    #[serde(serialize_with = "bounds")]
    Bounds(f64, f64),
    /// Values by their probabilities; results contain the bins between them.
    #[serde(skip)]
    Quantiles(Vec<(f64, f64)>),
    /// Measured values and the file that they come from; results contain the name of the file.
    #[serde(skip)]
    Measured(Vec<f64>, MeasuredFile),
}

fn bounds<S: Serializer>(min: &f64, max: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    let mut list = serializer.serialize_seq(Some(2))?;
    for bound in [min, max] {
        match bound.is_finite() {
            true => list.serialize_element(bound)?,
            false => list.serialize_element(if *bound > 0.0 { "inf" } else { "-inf" })?,
        }
    }
    list.end()
}

impl From<f64> for Parameter {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<&[f64]> for Parameter {
    fn from(list: &[f64]) -> Self {
        Self::List(list.to_vec())
    }
}

/// One family; [`Distribution`] describes each of these. A family has [`quantile`](Self::quantile) or [`at`](Self::at).
pub(super) trait Family {
    /// Returns P(X <= x) and P(X > x), each to full precision if the distribution is continuous.
    fn tails(&self, x: f64) -> (f64, f64);
    /// Returns mean and standard deviation.
    fn moments(&self) -> (f64, f64);
    fn parameters(&self) -> Vec<(&'static str, Parameter)>;

    fn support(&self) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }

    /// Returns its name in study files; `own` is that of its first entry.
    fn name(&self, own: &'static str) -> &'static str {
        own
    }

    /// Returns the quantile at `u`, `v` being 1 - `u`, to full precision if either is small.
    fn at(&self, u: f64, _v: f64) -> f64 {
        self.quantile(u)
    }

    fn quantile(&self, u: f64) -> f64 {
        self.at(u, 1.0 - u)
    }

    /// Returns the quantile at 1 - `v`, to full precision if `v` is small.
    fn upper_quantile(&self, v: f64) -> f64 {
        self.at(1.0 - v, v)
    }

    fn fill(&self, u: &[f64], out: &mut [f64]) {
        for (value, &u) in out.iter_mut().zip(u) {
            *value = self.quantile(u);
        }
    }

    /// Returns the same quantity in SI, without a check of its variance: a truncated part may have one.
    fn in_si(&self, own: &'static Entry, unit: &Unit) -> Result<Distribution, DistributionError> {
        in_si(own, self.parameters(), unit)
    }

    /// Refuses parameters for which there is no variance.
    fn refuse_infinite_variance(&self) -> Result<(), DistributionError> {
        Ok(())
    }
}
