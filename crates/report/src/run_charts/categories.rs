//! A factor of categories on an axis: its labels, and the positions of its values.

use apportion::result::FactorRecord;
use serde_json::Value;

/// Maximum number of categories with labels; more are drawn by number, since their labels would be only a letter long.
const MAX_CATEGORIES: usize = 12;

/// The labels of a factor, and the numbers that represent them in the result.
pub(super) struct Categories {
    /// In the order of the study.
    pub labels: Vec<String>,
    values: Vec<f64>,
}

impl Categories {
    /// Returns the categories of a factor that has few.
    pub fn new(factor: &FactorRecord) -> Option<Self> {
        let parameter = |key: &str| factor.distribution.get(key);
        let list = |key: &str| parameter(key).and_then(Value::as_array);
        let (labels, values): (Vec<String>, Vec<f64>) = match parameter("name").and_then(Value::as_str)? {
            "boolean" => (vec!["false".to_owned(), "true".to_owned()], vec![0.0, 1.0]),
            "categorical" => (
                list("labels")?.iter().map(|label| label.as_str().map(str::to_owned)).collect::<Option<_>>()?,
                list("values")?.iter().map(Value::as_f64).collect::<Option<_>>()?,
            ),
            _ => return None,
        };
        let few = (1..=MAX_CATEGORIES).contains(&labels.len()) && labels.len() == values.len();
        few.then_some(Self { labels, values })
    }

    /// Returns the position of a value; NaN for one that is not a category.
    pub fn place(&self, value: f64) -> f64 {
        self.values.iter().position(|other| *other == value).map_or(f64::NAN, |place| place as f64)
    }
}
