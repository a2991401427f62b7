//! Whole numbers, booleans, categories, measured values, and families by their stated parameters, against scipy.
//! `tests/oracle/factor_kinds.py` made the references.

use apportion::space::Distribution;
use apportion::space::distribution::{KEYS, Kind, Parameter};
use serde_json::Value;

fn oracle(part: &str) -> Vec<Value> {
    let all: Value = serde_json::from_str(include_str!("../../oracle/factor_kinds.json")).expect("json");
    all[part].as_array().expect("a list").clone()
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().expect("a list").iter().map(|number| number.as_f64().expect("a number")).collect()
}

fn kind(case: &Value) -> Distribution {
    let parameters = &case["parameters"];
    let (number, list) =
        (|key: &str| parameters[key].as_f64().expect("a number"), |key: &str| numbers(&parameters[key]));
    let made = match case["distribution"].as_str().expect("a name") {
        "integer" => Distribution::integer(number("min"), number("max")),
        "boolean" => Distribution::boolean(number("probability")),
        "categorical" => {
            let labels: Vec<&str> =
                parameters["labels"].as_array().expect("labels").iter().filter_map(Value::as_str).collect();
            Distribution::categorical(&labels, Some(&list("values")), Some(&list("weights")))
        }
        "empirical" => Distribution::empirical(&list("values"), None),
        "discrete" => Distribution::discrete(&list("values"), Some(&list("weights"))),
        "constant" => Distribution::constant(number("value")),
        other => panic!("{other}"),
    };
    made.unwrap_or_else(|error| panic!("{error}"))
}

fn stated(case: &Value) -> Distribution {
    let kind = Kind::from_name(case["law"].as_str().expect("a name")).expect("a family");
    let key = |typed: &str| KEYS.iter().find(|key| key.name == typed).expect("a key").name;
    let statements = case["stated"].as_object().expect("statements").iter();
    let statements: Vec<_> =
        statements.map(|(typed, value)| (key(typed), Parameter::Number(value.as_f64().expect("a number")))).collect();
    kind.make(&statements).unwrap_or_else(|error| panic!("{case}: {error}"))
}

#[test]
fn whole_numbers_categories_and_lists_are_those_of_scipy() {
    let cases = oracle("kinds");
    assert_eq!(cases.len(), 19);
    for case in cases {
        let distribution = kind(&case);
        for (u, expected) in numbers(&case["u"]).into_iter().zip(numbers(&case["quantile"])) {
            assert_eq!(distribution.quantile(u), expected, "{distribution:?} at {u}");
        }
        let (mean, sd) = (case["mean"].as_f64().expect("a number"), case["sd"].as_f64().expect("a number"));
        // A few ulp: of the mean, and of the sums that the sd is made of.
        assert!((distribution.mean() - mean).abs() <= 1e-15 * mean.abs() + 1e-15 * sd, "{distribution:?}");
        assert!((distribution.sd() - sd).abs() <= 1e-14 * sd + 1e-15 * mean.abs(), "{distribution:?}");
    }
}

#[test]
fn stated_parameters_give_the_distribution_of_scipy() {
    let cases = oracle("stated");
    assert_eq!(cases.len(), 10);
    for case in cases {
        let distribution = stated(&case);
        let (mean, sd) = (case["mean"].as_f64().expect("a number"), case["sd"].as_f64().expect("a number"));
        for (u, expected) in numbers(&case["u"]).into_iter().zip(numbers(&case["quantile"])) {
            let off = (distribution.quantile(u) - expected).abs();
            assert!(off <= TOLERANCE * (sd + expected.abs()), "{case}: {off:e} at {u}");
        }
        assert!((distribution.mean() - mean).abs() <= TOLERANCE * (sd + mean.abs()), "{case}");
        assert!((distribution.sd() - sd).abs() <= TOLERANCE * sd, "{case}");
    }
}

/// Parameters are solved for to about 1e-12; those of shape magnify the remaining error far out in a tail.
const TOLERANCE: f64 = 1e-9;
