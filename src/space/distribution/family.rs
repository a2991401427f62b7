//! What every family of distributions can do.

use serde::Serialize;
use serde::ser::{SerializeSeq, Serializer};

use super::{Distribution, DistributionError};
use crate::quantity::Unit;

/// A parameter as a study file holds it.
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
    /// Two bounds of which one may be infinite, which is written as a text: `[2.0, "inf"]`.
    #[serde(serialize_with = "bounds")]
    Bounds(f64, f64),
    /// A list of distributions.
    Laws(Vec<Distribution>),
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

/// The numbers of a family that is another one with words to it: those of its field `law`.
macro_rules! numbers_of_law {
    () => {
        fn quantile(&self, u: f64) -> f64 {
            self.law.quantile(u)
        }

        fn tails(&self, x: f64) -> (f64, f64) {
            self.law.tails(x)
        }

        fn mean(&self) -> f64 {
            self.law.mean()
        }

        fn sd(&self) -> f64 {
            self.law.sd()
        }

        fn support(&self) -> (f64, f64) {
            self.law.support()
        }
    };
}

pub(super) use numbers_of_law;

/// One family; [`Distribution`] describes each of these.
pub(super) trait Family {
    fn name(&self) -> &'static str;
    fn quantile(&self, u: f64) -> f64;
    /// P(X <= x) and P(X > x), each with its own last digits where the distribution is continuous.
    fn tails(&self, x: f64) -> (f64, f64);
    fn mean(&self) -> f64;
    fn sd(&self) -> f64;
    fn support(&self) -> (f64, f64);
    fn parameters(&self) -> Vec<(&'static str, Parameter)>;
    fn to_si(&self, unit: &Unit) -> Result<Distribution, DistributionError>;

    /// The quantile at 1 - `v`, with its last digits where `v` is small.
    fn upper_quantile(&self, v: f64) -> f64 {
        self.quantile(1.0 - v)
    }

    fn fill(&self, u: &[f64], out: &mut [f64]) {
        for (value, &u) in out.iter_mut().zip(u) {
            *value = self.quantile(u);
        }
    }
}
