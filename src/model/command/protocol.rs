//! What is said between the engine and a program that is kept alive: lines of text, described in
//! `docs/worker-protocol.md`.

use serde_json::Value;

use super::json_answer::{json, json_answer, keys_in_words};
use crate::model::shorten::{masked, shortened};

/// How rows and answers are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Protocol {
    /// A header with the names of the factors, then a line of cells for each row; a line of numbers as its answer.
    Csv,
    /// A JSON object for each row, and one as its answer.
    JsonLines,
}

impl Protocol {
    /// Both, the default first.
    pub const ALL: [Self; 2] = [Self::Csv, Self::JsonLines];

    /// The name in study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::JsonLines => "json-lines",
        }
    }
}

/// What a program answered to a row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// A value for every output; NaN where it gave none.
    Values,
    /// The row has no answer, for this reason in the program's words.
    Failed(String),
}

/// Reads the line with which a program answers a row, and appends one value for each of `outputs` to `values`, unless the
/// row failed: the number, NaN for an empty cell, `nan` or null, or an infinity. An empty line is no answer.
///
/// ```
/// use apportion::model::{Answer, parse_answer};
/// use apportion::Protocol;
///
/// let (outputs, mut values) = (["force".to_owned(), "time".to_owned()], Vec::new());
/// assert_eq!(parse_answer(Protocol::Csv, &outputs, b"1.5,2e-3\r", &mut values), Ok(Answer::Values));
/// assert_eq!(parse_answer(Protocol::JsonLines, &outputs, br#"{"time": 3, "force": 2.5}"#, &mut values), Ok(Answer::Values));
/// assert_eq!(values, [1.5, 2e-3, 2.5, 3.0]);
/// let failed = parse_answer(Protocol::Csv, &outputs, b"error: no root", &mut values);
/// assert_eq!(failed, Ok(Answer::Failed("no root".to_owned())));
/// let rubbish = parse_answer(Protocol::Csv, &outputs, b"Loading ...", &mut values);
/// assert_eq!(rubbish.unwrap_err(), "expected 2 numbers separated by commas, found `Loading ...`");
/// ```
///
/// # Errors
/// What was expected and what was found, if the line is no answer; `values` is then as it was.
pub fn parse_answer(
    protocol: Protocol,
    outputs: &[String],
    line: &[u8],
    values: &mut Vec<f64>,
) -> Result<Answer, String> {
    let before = values.len();
    let found = |words: String| format!("expected {}, found {words}", expected(protocol, outputs));
    let answer = match std::str::from_utf8(line) {
        Err(_) => Err("a line that is not text in UTF-8".to_owned()),
        Ok(text) if text.trim().is_empty() => Err(EMPTY.to_owned()),
        Ok(text) => match protocol {
            Protocol::Csv => csv_answer(outputs, text.trim(), values),
            Protocol::JsonLines => json(text.trim()).and_then(|parsed| json_line_answer(outputs, &parsed, values)),
        },
    };
    answer.map_err(|words| {
        values.truncate(before);
        found(words)
    })
}

/// Reads an answer that begins with the number of its row: a first cell in CSV, the key `id` of a JSON object.
///
/// ```
/// use apportion::model::{Answer, parse_numbered_answer};
/// use apportion::Protocol;
///
/// let (outputs, mut values) = (["force".to_owned()], Vec::new());
/// let csv = parse_numbered_answer(Protocol::Csv, &outputs, b"711953,1.5", &mut values);
/// assert_eq!(csv, Ok((711_953, Ok(Answer::Values))));
/// let json = br#"{"id": 711953, "error": "no root"}"#;
/// let json = parse_numbered_answer(Protocol::JsonLines, &outputs, json, &mut values);
/// assert_eq!(json, Ok((711_953, Ok(Answer::Failed("no root".to_owned())))));
/// assert_eq!(values, [1.5]);
/// let stray = parse_numbered_answer(Protocol::Csv, &outputs, b"1.5", &mut values);
/// assert_eq!(stray.unwrap_err(), "expected the row's number and a number, separated by a comma, found `#`");
/// ```
///
/// # Errors
/// What was expected and what was found, if the line has no row number. The answer behind a number may be none, as in
/// [`parse_answer`].
pub fn parse_numbered_answer(
    protocol: Protocol,
    outputs: &[String],
    line: &[u8],
    values: &mut Vec<f64>,
) -> Result<(u64, Result<Answer, String>), String> {
    let found = |words: String| format!("expected {}, found {words}", expected_numbered(protocol, outputs));
    let Ok(text) = std::str::from_utf8(line) else {
        return Err(found("a line that is not text in UTF-8".to_owned()));
    };
    let text = text.trim();
    if text.is_empty() {
        return Err(found(EMPTY.to_owned()));
    }
    let before = values.len();
    let (number, answer) = match protocol {
        Protocol::Csv => {
            let (number, rest) = text.split_once(',').ok_or_else(|| found(format!("`{}`", masked(text))))?;
            let number = whole(number.trim().trim_matches('"'));
            let number = number.ok_or_else(|| found(format!("`{}`", masked(text))))?;
            let rest = rest.trim();
            // The number has shown that the line is an answer: an empty cell is one.
            let answer = if rest.is_empty() && outputs.len() == 1 {
                values.push(f64::NAN);
                Ok(Answer::Values)
            } else {
                csv_answer(outputs, rest, values)
            };
            (number, answer)
        }
        Protocol::JsonLines => {
            let parsed = json(text).map_err(&found)?;
            let number = match parsed.get("id") {
                Some(Value::Number(number)) => whole(&number.to_string()),
                Some(Value::String(text)) => whole(text),
                _ => None,
            };
            let number = number.ok_or_else(|| found(format!("`{}`", masked(text))))?;
            (number, json_line_answer(outputs, &parsed, values))
        }
    };
    let answer = answer.map_err(|words| {
        values.truncate(before);
        found(words)
    });
    Ok((number, answer))
}

/// A row number as languages write it: `711953`, and also `711953.0` and `7.11953e5`.
fn whole(text: &str) -> Option<u64> {
    let value: f64 = text.parse().ok()?;
    ((0.0..1e15).contains(&value) && value.fract() == 0.0).then_some(value as u64)
}

fn expected_numbered(protocol: Protocol, outputs: &[String]) -> String {
    match (protocol, outputs) {
        (Protocol::Csv, [_]) => "the row's number and a number, separated by a comma".to_owned(),
        (Protocol::Csv, _) => format!("the row's number and {} numbers, separated by commas", outputs.len()),
        (Protocol::JsonLines, _) => format!("a JSON object with id (the row's number), {}", keys_in_words(outputs)),
    }
}

const EMPTY: &str = "an empty line";

fn expected(protocol: Protocol, outputs: &[String]) -> String {
    match (protocol, outputs) {
        (Protocol::Csv, [_]) => "a number".to_owned(),
        (Protocol::Csv, _) => format!("{} numbers separated by commas", outputs.len()),
        (Protocol::JsonLines, [name]) => format!("a JSON object such as {{\"{name}\": 1.5}}"),
        (Protocol::JsonLines, _) => format!("a JSON object with {}", keys_in_words(outputs)),
    }
}

fn failed(reason: &str) -> Answer {
    let reason = shortened(reason);
    Answer::Failed(if reason.is_empty() { "the program reported an error without a reason".to_owned() } else { reason })
}

fn csv_answer(outputs: &[String], text: &str, values: &mut Vec<f64>) -> Result<Answer, String> {
    if let Some(reason) = text.strip_prefix("error:") {
        return Ok(failed(reason));
    }
    let mut cells = 0;
    for cell in text.split(',') {
        cells += 1;
        let cell = cell.trim();
        let value = if cell.is_empty() { Some(f64::NAN) } else { cell.parse().ok() };
        values.push(value.ok_or_else(|| format!("`{}`", masked(text)))?);
    }
    if cells == outputs.len() {
        return Ok(Answer::Values);
    }
    Err(format!("{cells} cell{}: `{}`", if cells == 1 { "" } else { "s" }, masked(text)))
}

fn json_line_answer(outputs: &[String], parsed: &Value, values: &mut Vec<f64>) -> Result<Answer, String> {
    let reason = json_answer(outputs, parsed, values)?;
    Ok(reason.map_or(Answer::Values, |reason| failed(&reason)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(count: usize) -> Vec<String> {
        (1..=count).map(|number| format!("y{number}")).collect()
    }

    fn read(protocol: Protocol, outputs: usize, line: &str) -> Result<Vec<f64>, String> {
        let mut values = Vec::new();
        match parse_answer(protocol, &names(outputs), line.as_bytes(), &mut values)? {
            Answer::Values => Ok(values),
            Answer::Failed(reason) => Err(format!("failed: {reason}")),
        }
    }

    #[test]
    fn numbers_are_read_as_every_language_writes_them() {
        for (line, value) in [("1", 1.0), (" -1.5e-300\r", -1.5e-300), ("+.5", 0.5), ("5.", 5.0), ("1E3", 1000.0)] {
            assert_eq!(read(Protocol::Csv, 1, line), Ok(vec![value]), "{line}");
        }
        assert_eq!(read(Protocol::Csv, 3, "1, 2 ,3"), Ok(vec![1.0, 2.0, 3.0]));
        for line in [r#"{"y1": 1, "y2": 2e0, "note": "x"}"#, "[1, 2.0]"] {
            assert_eq!(read(Protocol::JsonLines, 2, line), Ok(vec![1.0, 2.0]), "{line}");
        }
        assert_eq!(read(Protocol::JsonLines, 1, "3"), Ok(vec![3.0]));
    }

    #[test]
    fn what_has_no_value_is_not_a_number() {
        for line in ["nan", "NaN", "-nan"] {
            assert!(read(Protocol::Csv, 1, line).unwrap()[0].is_nan(), "{line}");
        }
        let both = read(Protocol::Csv, 2, ",inf").unwrap();
        assert!(both[0].is_nan() && both[1] == f64::INFINITY);
        for line in ["{\"y1\": NaN}", "{\"y1\": null, \"note\": \"a \\\" NaN\"}", "[-Infinity]", "NaN"] {
            let value = read(Protocol::JsonLines, 1, line);
            let fits = if line == "NaN" { value.is_err() } else { value.is_ok_and(|values| values[0].is_nan()) };
            assert!(fits, "{line}");
        }
    }

    #[test]
    fn an_empty_line_is_no_answer() {
        for (protocol, line) in Protocol::ALL.into_iter().flat_map(|p| ["", " ", "\r"].map(|line| (p, line))) {
            assert!(read(protocol, 1, line).unwrap_err().ends_with("found an empty line"), "{line:?}");
            let numbered = parse_numbered_answer(protocol, &names(1), line.as_bytes(), &mut Vec::new());
            assert!(numbered.unwrap_err().ends_with("found an empty line"), "{line:?}");
        }
    }

    fn numbered(protocol: Protocol, outputs: usize, line: &str) -> Option<(u64, Result<Vec<f64>, String>)> {
        let mut values = Vec::new();
        let (number, answer) = parse_numbered_answer(protocol, &names(outputs), line.as_bytes(), &mut values).ok()?;
        let read = match answer {
            Ok(Answer::Values) => Ok(values),
            Ok(Answer::Failed(reason)) => Err(format!("failed: {reason}")),
            Err(words) => Err(words),
        };
        Some((number, read))
    }

    #[test]
    fn row_numbers_are_read_as_languages_write_them() {
        for line in ["100000,1.5", "100000.0, 1.5\r", "1e+05,1.5", "\"100000\",1.5"] {
            assert_eq!(numbered(Protocol::Csv, 1, line), Some((100_000, Ok(vec![1.5]))), "{line}");
        }
        for line in [r#"{"y1": 1.5, "id": 100000}"#, r#"{"id": "100000", "y1": 1.5}"#, r#"{"id": 1e5, "y1": 1.5}"#] {
            assert_eq!(numbered(Protocol::JsonLines, 1, line), Some((100_000, Ok(vec![1.5]))), "{line}");
        }
        assert!(numbered(Protocol::Csv, 1, "7,").unwrap().1.unwrap()[0].is_nan());
        assert_eq!(numbered(Protocol::Csv, 1, "7,error: x").unwrap().1, Err("failed: x".to_owned()));
        let reason = numbered(Protocol::Csv, 2, "7,1.5").unwrap().1.unwrap_err();
        assert_eq!(reason, "expected the row's number and 2 numbers, separated by commas, found 1 cell: `#`");
        for stray in ["1.5", "0.5,1", "-1,2", "nan,1", "step 7,1", "1e300,1"] {
            assert_eq!(numbered(Protocol::Csv, 1, stray), None, "{stray}");
        }
        for stray in ["[7, 1.5]", r#"{"y1": 1.5}"#, r#"{"id": 1.5, "y1": 1}"#, r#"{"id": null, "y1": 1}"#] {
            assert_eq!(numbered(Protocol::JsonLines, 1, stray), None, "{stray}");
        }
    }

    #[test]
    fn a_program_says_that_a_row_failed() {
        assert_eq!(read(Protocol::Csv, 2, "error: no root"), Err("failed: no root".to_owned()));
        assert_eq!(read(Protocol::JsonLines, 2, r#"{"error": "no root"}"#), Err("failed: no root".to_owned()));
        assert!(read(Protocol::Csv, 2, "error:").unwrap_err().contains("without a reason"));
        assert_eq!(read(Protocol::JsonLines, 1, r#"{"error": null, "y1": 2}"#), Ok(vec![2.0]));
    }

    #[test]
    fn rubbish_is_named_without_its_numbers() {
        let words = |protocol, outputs, line| read(protocol, outputs, line).unwrap_err();
        assert_eq!(words(Protocol::Csv, 1, "step 17 done"), "expected a number, found `step # done`");
        assert_eq!(words(Protocol::Csv, 2, "1.5"), "expected 2 numbers separated by commas, found 1 cell: `#`");
        assert_eq!(words(Protocol::Csv, 1, "1,2"), "expected a number, found 2 cells: `#,#`");
        let object = "expected a JSON object with y1, y2, found";
        assert_eq!(words(Protocol::JsonLines, 2, "{\"y1\": 1}"), format!("{object} an object without `y2`"));
        assert_eq!(words(Protocol::JsonLines, 2, "[1]"), format!("{object} a list of 1"));
        assert_eq!(words(Protocol::JsonLines, 2, "[1, true]"), format!("{object} true or false as `y2`"));
        assert_eq!(words(Protocol::JsonLines, 2, "{'y1': 12}"), format!("{object} `{{'y1': #}}`"));
        let mut values = Vec::new();
        let bytes = parse_answer(Protocol::Csv, &names(1), b"\xff\xfe", &mut values);
        assert_eq!(bytes.unwrap_err(), "expected a number, found a line that is not text in UTF-8");
    }

    proptest::proptest! {
        /// Whatever a program prints, there is an answer with all its values, or none and none.
        #[test]
        fn no_line_panics(
            line in proptest::collection::vec(proptest::prelude::any::<u8>(), 0..60),
            near in r#"[\[\]{}",:a-zA-Z0-9.+\\-]{0,40}"#,
            outputs in 1usize..4,
        ) {
            for line in [&line[..], near.as_bytes()] {
                for protocol in Protocol::ALL {
                    let mut values = vec![7.0];
                    let answer = parse_answer(protocol, &names(outputs), line, &mut values);
                    let added = if answer == Ok(Answer::Values) { outputs } else { 0 };
                    proptest::prop_assert!(values.len() == 1 + added || matches!(answer, Ok(Answer::Failed(_))));
                    let mut values = vec![7.0];
                    let answer = parse_numbered_answer(protocol, &names(outputs), line, &mut values);
                    let added = if matches!(answer, Ok((_, Ok(Answer::Values)))) { outputs } else { 0 };
                    proptest::prop_assert!(
                        values.len() == 1 + added || matches!(answer, Ok((_, Ok(Answer::Failed(_)))))
                    );
                }
            }
        }
    }
}
