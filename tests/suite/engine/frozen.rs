//! Current numbers, stored in files: refactoring must not change the results.
//!
//! `FREEZE=1 cargo test --release frozen` writes the files again; do so only for an intended change of numbers.

use std::path::PathBuf;

use serde_json::{Value, json};

use crate::common::{Folder, analysed, study_path, succeed, text};

/// Largest relative difference: sums in another order would pass, other formulas would not.
const RELATIVE: f64 = 1e-12;

/// Largest difference of dimensionless numbers of order one (indices, shares, probabilities), which may lie near zero.
const ABSOLUTE: f64 = 1e-13;

/// Keys of an output that only show values, or repeat other keys.
const LEFT_OUT: [&str; 3] = ["convergence", "distribution", "scatter"];

/// Keys with the unit of the output, which may have any size.
const WITH_UNIT: [&str; 5] = ["mean", "variance", "mean_interval", "variance_interval", "effort"];

/// Texts for people, which may change.
const WORDS: [&str; 3] = [".text", ".reason", ".description"];

/// Estimates from the runs only, without the correction by surrogates.
const PLAIN: &str = "analysis.surrogate=\"off\"";

fn folder() -> PathBuf {
    crate::common::root().join("tests/frozen")
}

/// The values of a series among the outputs.
fn places(series: &Value) -> std::ops::Range<usize> {
    let first = series["first_output"].as_u64().unwrap() as usize;
    first..first + series["positions"].as_array().unwrap().len()
}

/// The stored part of a result: all numbers of its outputs, the counts of flags, and the effort.
fn essence(result: &Value) -> Value {
    let mut outputs = result["outputs"].clone();
    // Every fifth value of a series: the others are computed in the same way.
    let series: Vec<std::ops::Range<usize>> = result["series"].as_array().into_iter().flatten().map(places).collect();
    let mut number = 0;
    outputs.as_array_mut().unwrap().retain(|_| {
        let place = number;
        number += 1;
        series.iter().find(|values| values.contains(&place)).is_none_or(|values| (place - values.start) % 5 == 0)
    });
    for output in outputs.as_array_mut().unwrap() {
        output.as_object_mut().unwrap().retain(|key, _| !LEFT_OUT.contains(&key.as_str()));
    }
    json!({
        "model_runs": result["provenance"]["model_runs"],
        "factors": result["factors"],
        "outputs": outputs,
        "validity": result["validity"],
        "effort": result["effort"],
        "aggregate": result["aggregate"],
    })
}

/// Where `found` lacks a number or text of `held`, or differs from it. Additional entries of `found` are allowed.
fn differences(held: &Value, found: &Value, at: &str, has_unit: bool, into: &mut Vec<String>) {
    match (held, found) {
        (Value::Object(held), Value::Object(_)) => {
            for (key, value) in held {
                let has_unit = has_unit || WITH_UNIT.contains(&key.as_str());
                differences(value, &found[key.as_str()], &format!("{at}.{key}"), has_unit, into);
            }
        }
        (Value::Array(held), Value::Array(list)) if held.len() == list.len() => {
            for (number, (held, found)) in held.iter().zip(list).enumerate() {
                differences(held, found, &format!("{at}[{number}]"), has_unit, into);
            }
        }
        (Value::Number(one), Value::Number(other)) => {
            let (one, other) = (one.as_f64().unwrap(), other.as_f64().unwrap());
            let floor = if has_unit { 0.0 } else { ABSOLUTE };
            if (one - other).abs() > RELATIVE * one.abs().max(other.abs()) + floor {
                into.push(format!("{at}: {one} before, {other} now"));
            }
        }
        _ if held == found => (),
        // Words may change; numbers must stay.
        (Value::String(_), Value::String(_)) if WORDS.iter().any(|key| at.ends_with(key)) => (),
        _ => into.push(format!("{at}: {held} before, {found} now")),
    }
}

#[track_caller]
fn hold(name: &str, found: &Value) {
    let path = folder().join(format!("{name}.json"));
    if std::env::var_os("FREEZE").is_some() {
        std::fs::write(&path, serde_json::to_string_pretty(found).unwrap() + "\n").unwrap();
        return;
    }
    let held = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut faults = Vec::new();
    differences(&serde_json::from_str(&held).unwrap(), found, name, false, &mut faults);
    assert!(
        faults.is_empty(),
        "{} differences, the first:\n{}",
        faults.len(),
        faults[..faults.len().min(8)].join("\n")
    );
}

/// Every study of the folder `studies` that is evaluated in this process, with fewer base samples.
#[test]
fn studies_give_the_numbers_they_gave() {
    let mut names: Vec<String> = std::fs::read_dir(crate::common::root().join("studies"))
        .unwrap()
        .filter_map(|entry| Some(entry.unwrap().file_name().to_str()?.strip_suffix(".toml")?.to_owned()))
        .collect();
    names.sort();
    assert!(names.len() >= 21, "{names:?}");
    for name in names {
        let fewer = match name.as_str() {
            "sobol-g-target" => "design.max_runs=100000",
            "lugre-environmental-fixed-step" => "design.base_samples=128",
            _ => "design.base_samples=512",
        };
        let result = serde_json::to_value(analysed(&name, &[fewer, PLAIN])).unwrap();
        hold(&name, &essence(&result));
    }
}

/// The points of a design, and the result of `analyze` for outputs computed elsewhere.
#[test]
fn a_design_of_an_earlier_version_is_analysed() {
    let folder_of_run = Folder::new();
    let design = folder_of_run.path("design.csv");
    let study = study_path("ishigami");
    succeed(&["sample", text(&study), "--base-samples", "64", "--set", PLAIN, "-o", text(&design)]);
    let points = std::fs::read_to_string(&design).unwrap();
    let held = folder().join("ishigami-design.csv");
    if std::env::var_os("FREEZE").is_some() {
        std::fs::write(&held, &points).unwrap();
        // Its study by a path inside of the project.
        let manifest = std::fs::read_to_string(folder_of_run.path("design.csv.manifest.json")).unwrap();
        let manifest = manifest.replace(&format!("{}/", text(crate::common::root())), "");
        std::fs::write(folder().join("ishigami-design.csv.manifest.json"), manifest).unwrap();
    }
    assert!(points == std::fs::read_to_string(&held).unwrap(), "other points than before");
    let (a, b) = (7.0, 0.1);
    let outputs = points.lines().skip(1).map(|line| {
        let x: Vec<f64> = line.split(',').rev().take(3).map(|cell| cell.parse().unwrap()).collect();
        let y = x[2].sin() + a * x[1].sin().powi(2) + b * x[0].powi(4) * x[2].sin();
        format!("{y}\n")
    });
    let outputs = folder_of_run.with("outputs.csv", "y\n".to_owned() + &outputs.collect::<String>());
    let out = folder_of_run.path("out");
    succeed(&["analyze", text(&outputs), "--design", text(&held), "--out", text(&out)]);
    let name = crate::common::files(&out).into_iter().find(|name| name.ends_with(".json")).unwrap();
    let result = std::fs::read_to_string(out.join(name)).unwrap();
    hold("ishigami-analyzed", &essence(&serde_json::from_str(&result).unwrap()));
}
