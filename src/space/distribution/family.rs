//! What every family of distributions can do.

use serde::Serialize;

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
    fn mean(&self) -> f64;
    fn sd(&self) -> f64;
    fn support(&self) -> (f64, f64);
    fn parameters(&self) -> Vec<(&'static str, Parameter)>;
    fn to_si(&self, unit: &Unit) -> Result<Distribution, DistributionError>;

    fn fill(&self, u: &[f64], out: &mut [f64]) {
        for (value, &u) in out.iter_mut().zip(u) {
            *value = self.quantile(u);
        }
    }
}
