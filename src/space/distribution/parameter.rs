//! The parameters of distributions, as in study files.

use serde::{Serialize, Serializer};
use serde_json::Value;

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
    serializer.collect_seq([min, max].map(|bound| match bound.is_finite() {
        true => Value::from(*bound),
        false => Value::from(if *bound > 0.0 { "inf" } else { "-inf" }),
    }))
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
