//! Reading of result files, and refused files.

use std::path::Path;

use apportion::result::{ReadProblem, StudyResult, parse_result};
use apportion_files::parse_study;
use apportion_report::run_document;
use serde_json::{Value, json};

use crate::messages::messages;

const STUDY: &str = "
model = \"ishigami\"
[design]
base_samples = 128
[analysis]
second_order = true
estimators = [\"janon-monod\"]
subsets = [[\"x1\", \"x2\"]]
dummy = true
";

fn result() -> StudyResult {
    let study = parse_study(STUDY, Path::new("small.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    study.runner().threads(1).run().unwrap()
}

fn parsed(value: &Value) -> Result<StudyResult, ReadProblem> {
    parse_result(value.to_string().as_bytes())
}

#[test]
fn a_written_result_is_read_back() {
    let result = result();
    let text = result.json();
    assert_eq!(parse_result(text.as_bytes()).unwrap(), result);
}

#[test]
fn invalid_results_are_refused_with_the_reason() {
    let mut messages = messages!();
    for text in [
        "{\n  \"format\": ,",
        "",
        "{}",
        "{\"format\": \"apportion-sweep\", \"version\": 1}",
        "{\"format\": \"apportion-result\", \"version\": 2}",
        "{\"format\": \"apportion-result\", \"version\": 1}",
    ] {
        messages.add(text, &parse_result(text.as_bytes()).unwrap_err().to_string());
    }
}

#[test]
fn parts_that_do_not_fit_together_are_named() {
    let whole = serde_json::to_value(result()).unwrap();
    let fault = |pointer: &str, value: Value| {
        let mut changed = whole.clone();
        *changed.pointer_mut(pointer).unwrap() = value;
        parsed(&changed).unwrap_err().to_string()
    };
    let mut messages = messages!();
    for (pointer, value, place) in [
        ("/study/name", json!("../../etc/x"), "`study.name`"),
        ("/outputs/0/runs_ok", json!(u64::MAX), "`outputs[0].runs_ok`"),
        ("/outputs/0/name", json!(""), "`outputs[0].name`"),
        ("/outputs/0/indices/1/factor", json!("x9"), "`outputs[0].indices`"),
        ("/outputs/0/indices", json!([]), "`outputs[0].indices`"),
    ] {
        let case = format!("{pointer}: {value}");
        let message = fault(pointer, value);
        assert!(message.contains(place), "{case}: {message}");
        messages.add(&case, &message);
    }
    let mut twice = whole;
    let output = twice["outputs"][0].clone();
    twice["outputs"].as_array_mut().unwrap().push(output);
    messages.add("an output twice", &parsed(&twice).unwrap_err().to_string());
}

/// Every leaf of a result replaced by an invalid value: the result is refused, or drawn without a panic.
#[test]
fn rubbish_is_refused_or_drawn() {
    let whole = serde_json::to_value(result()).unwrap();
    let mut pointers = Vec::new();
    leaves(&whole, String::new(), &mut pointers);
    let (mut refused, mut accepted) = (0, 0);
    for pointer in pointers {
        for rubbish in [json!(null), json!(-1), json!(1e308), json!(0), json!(u64::MAX), json!("\u{0}<&\""), json!([])]
        {
            let mut changed = whole.clone();
            *changed.pointer_mut(&pointer).unwrap() = rubbish;
            match parsed(&changed) {
                Err(_) => refused += 1,
                Ok(result) => {
                    accepted += 1;
                    draw(&result);
                }
            }
        }
    }
    assert!(refused > 100 && accepted > 100, "{refused} refused, {accepted} accepted");
}

/// The positions of the leaves; of a long list only the first and the last entry.
fn leaves(value: &Value, at: String, pointers: &mut Vec<String>) {
    match value {
        Value::Object(map) => {
            pointers.push(at.clone());
            map.iter().for_each(|(key, value)| leaves(value, format!("{at}/{key}"), pointers));
        }
        Value::Array(list) => {
            pointers.push(at.clone());
            let last = list.len().saturating_sub(1);
            let ends = list.iter().enumerate().filter(|(place, _)| *place == 0 || *place == last);
            ends.for_each(|(place, value)| leaves(value, format!("{at}/{place}"), pointers));
        }
        _ => pointers.push(at),
    }
}

fn draw(result: &StudyResult) {
    let document = run_document(result);
    let _ = document.html();
    document.text();
    document.data_files();
}
