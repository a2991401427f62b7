//! A factor of categories on an axis: places side by side, with the labels.

use serde_json::Value;

use super::super::chart::{Series, Stroke};
use super::super::result::FactorRecord;
use super::slice_means::{Means, SLICES};

/// More categories than this are drawn by their numbers: their labels would be no longer than a letter.
const MOST: usize = 12;
/// Half of what the dots and the mean of a category take of its place.
const HALF: f64 = 0.32;
/// The golden ratio less 1: its multiples fill an interval evenly, whichever of them are taken.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The labels of a factor, and the numbers that stand for them in the result.
pub(super) struct Categories {
    /// In the order of the study.
    pub labels: Vec<String>,
    values: Vec<f64>,
}

impl Categories {
    /// The categories of a factor that has a few.
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
        let few = (1..=MOST).contains(&labels.len()) && labels.len() == values.len();
        few.then_some(Self { labels, values })
    }

    fn place(&self, value: f64) -> Option<f64> {
        self.values.iter().position(|other| *other == value).map(|place| place as f64)
    }

    /// Points spread over the width of their category, so that they do not lie on one another.
    pub fn strips(&self, points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
        let aside = |number: usize| HALF * (2.0 * (number as f64 * GOLDEN).fract() - 1.0);
        points.enumerate().filter_map(|(number, (x, y))| Some((self.place(x)? + aside(number), y))).collect()
    }

    /// A line over the numbers as one level line for each category: there is nothing between two of them.
    pub fn levels(&self, means: Means) -> Means {
        let gap = f64::NAN;
        let points = means.points.iter().filter_map(|&(x, y)| Some((self.place(x)?, y)));
        let band = means.band.iter().filter_map(|&(x, low, high)| Some((self.place(x)?, low, high)));
        Means {
            points: points.flat_map(|(x, y)| [(x - HALF, y), (x + HALF, y), (x + HALF, gap)]).collect(),
            band: band
                .flat_map(|(x, low, high)| [(x - HALF, low, high), (x + HALF, low, high), (x + HALF, gap, gap)])
                .collect(),
            series: Series { name: SLICES.to_owned(), stroke: Stroke::Solid, ..means.series },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn factor(distribution: Value) -> FactorRecord {
        serde_json::from_value(json!({
            "name": "probe", "unit": "GPa", "group": null, "distribution": distribution, "nominal": 169.0,
        }))
        .expect("a factor")
    }

    #[test]
    fn values_stand_at_the_places_of_their_labels() {
        let law = json!({"name": "categorical", "labels": ["<110>", "<100>"], "values": [169.0, 130.0]});
        let categories = Categories::new(&factor(law)).expect("categories");
        assert_eq!(categories.labels, ["<110>", "<100>"]);
        let strips = categories.strips([(130.0, 1.0), (169.0, 2.0), (1.0, 3.0)].into_iter());
        assert_eq!(strips.iter().map(|(x, y)| (x.round(), *y)).collect::<Vec<_>>(), [(1.0, 1.0), (0.0, 2.0)]);
        let means = Means { series: Series::default(), points: vec![(130.0, 5.0)], band: vec![(130.0, 4.0, 6.0)] };
        let levels = categories.levels(means);
        assert_eq!(levels.points[..2], [(1.0 - HALF, 5.0), (1.0 + HALF, 5.0)]);
        assert!(levels.points[2].1.is_nan() && levels.band[2].1.is_nan());
    }

    #[test]
    fn numbers_and_what_does_not_fit_together_are_no_categories() {
        let none = [
            json!({"name": "uniform", "min": 0.0, "max": 1.0}),
            json!({"name": "categorical", "labels": ["a"], "values": [0.0, 1.0]}),
            json!({"name": "categorical", "labels": ["a", 1], "values": [0.0, 1.0]}),
            json!({"name": "categorical", "labels": [], "values": []}),
            json!({"labels": ["a"], "values": [0.0]}),
        ];
        for law in none {
            assert!(Categories::new(&factor(law.clone())).is_none(), "{law}");
        }
        let many: Vec<String> = (0..=MOST).map(|place| place.to_string()).collect();
        let values: Vec<usize> = (0..=MOST).collect();
        let law = json!({"name": "categorical", "labels": many, "values": values});
        assert!(Categories::new(&factor(law)).is_none());
        assert_eq!(Categories::new(&factor(json!({"name": "boolean"}))).expect("two").labels, ["false", "true"]);
    }
}
