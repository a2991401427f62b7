//! The protocol between the engine and a program that is kept alive: lines of text, described in
//! `docs/worker-protocol.md`.

use apportion::names::named;
use apportion::text::{cut, masked};
use serde_json::Value;

use super::answer::{Answer, failed};
use super::json_answer::{json, json_answer, keys_in_words};

named! {
    /// How rows and replies are written; the default first.
    pub enum Protocol {
        /// A header with the names of the factors, then a line of cells for each row; the reply is a line of numbers.
        Csv = "csv",
        /// A JSON object for each row, and one as the reply.
        JsonLines = "json-lines",
    }
}

/// Reads the line with which a program replies to a row: the number of the row, the first cell in CSV and the key `id`
/// of a JSON object; and one value for each of `outputs` (the number, NaN for an empty cell, `nan` or null, or an
/// infinity), or why the row has none.
///
/// ```
/// use apportion_files::parse_answer;
/// use apportion_files::Protocol;
///
/// let outputs = ["force".to_owned()];
/// assert_eq!(parse_answer(Protocol::Csv, &outputs, b"100003,1.5"), Ok((100_003, Ok(vec![1.5]))));
/// let json = br#"{"id": 100003, "error": "no root"}"#;
/// let json = parse_answer(Protocol::JsonLines, &outputs, json);
/// assert_eq!(json, Ok((100_003, Err("no root".to_owned()))));
/// let stray = parse_answer(Protocol::Csv, &outputs, b"1.5");
/// assert_eq!(stray.unwrap_err(), "expected the row's number and a number, separated by a comma, found `1.5`");
/// ```
///
/// # Errors
/// The expected and the found text, if the line has no row number.
pub fn parse_answer(
    protocol: Protocol,
    outputs: &[String],
    line: &[u8],
) -> Result<(u64, Result<Vec<f64>, String>), String> {
    let found = |words: String| format!("expected {}, found {words}", expected(protocol, outputs));
    let text = std::str::from_utf8(line).map_err(|_| found("a line that is not text in UTF-8".to_owned()))?.trim();
    if text.is_empty() {
        return Err(found("an empty line".to_owned()));
    }
    let no_number = || found(format!("`{}`", cut(text, MAX_LETTERS)));
    let (number, answer) = match protocol {
        Protocol::Csv => {
            let (number, rest) = text.split_once(',').ok_or_else(no_number)?;
            let number = whole(number.trim().trim_matches('"')).ok_or_else(no_number)?;
            (number, csv_answer(outputs, rest.trim()))
        }
        Protocol::JsonLines => {
            let parsed = json(text).map_err(&found)?;
            let number = match parsed.get("id") {
                Some(Value::Number(number)) => whole(&number.to_string()),
                Some(Value::String(text)) => whole(text),
                _ => None,
            };
            (number.ok_or_else(no_number)?, json_answer(outputs, &parsed))
        }
    };
    Ok((number, answer.unwrap_or_else(|words| Err(format!("not an answer: {}", found(words))))))
}

/// Returns whether a line would be the reply to a row if it had a row number.
pub(super) fn is_answer_without_number(protocol: Protocol, outputs: &[String], line: &[u8]) -> bool {
    let text = String::from_utf8_lossy(line);
    let text = text.trim();
    let answer = match protocol {
        _ if text.is_empty() => return false,
        Protocol::Csv => csv_answer(outputs, text),
        Protocol::JsonLines => json(text).and_then(|parsed| json_answer(outputs, &parsed)),
    };
    answer.is_ok()
}

/// Maximum number of characters of a line that are shown.
const MAX_LETTERS: usize = 100;

/// Parses a row number as languages write it: `711953`, and also `711953.0` and `7.11953e5`.
fn whole(text: &str) -> Option<u64> {
    let value: f64 = text.parse().ok()?;
    ((0.0..1e15).contains(&value) && value.fract() == 0.0).then_some(value as u64)
}

fn expected(protocol: Protocol, outputs: &[String]) -> String {
    match (protocol, outputs) {
        (Protocol::Csv, [_]) => "the row's number and a number, separated by a comma".to_owned(),
        (Protocol::Csv, _) => format!("the row's number and {} numbers, separated by commas", outputs.len()),
        (Protocol::JsonLines, _) => format!("a JSON object with id (the row's number), {}", keys_in_words(outputs)),
    }
}

/// Parses `text` as a reply; the error describes it if it is not one.
fn csv_answer(outputs: &[String], text: &str) -> Result<Answer, String> {
    if let Some(reason) = text.strip_prefix("error:") {
        return Ok(failed(reason));
    }
    let value = |cell: &str| if cell.is_empty() { Some(f64::NAN) } else { cell.parse().ok() };
    let values: Option<Vec<f64>> = text.split(',').map(|cell| value(cell.trim())).collect();
    match values {
        Some(values) if values.len() == outputs.len() => Ok(Ok(values)),
        Some(values) => {
            let (cells, s) = (values.len(), if values.len() == 1 { "" } else { "s" });
            Err(format!("{cells} cell{s}: `{}`", masked(text)))
        }
        None => Err(format!("`{}`", masked(text))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(count: usize) -> Vec<String> {
        (1..=count).map(|number| format!("y{number}")).collect()
    }

    /// Reads the number of the row, and its values or why there are none; `None` if the line has no number.
    fn read(protocol: Protocol, outputs: usize, line: &str) -> Option<(u64, Result<Vec<f64>, String>)> {
        parse_answer(protocol, &names(outputs), line.as_bytes()).ok()
    }

    #[test]
    fn numbers_are_read_as_every_language_writes_them() {
        for (cell, value) in [("1", 1.0), (" -1.5e-300\r", -1.5e-300), ("+.5", 0.5), ("5.", 5.0), ("1E3", 1000.0)] {
            assert_eq!(read(Protocol::Csv, 1, &format!("7,{cell}")), Some((7, Ok(vec![value]))), "{cell}");
        }
        assert_eq!(read(Protocol::Csv, 3, "7, 1, 2 ,3"), Some((7, Ok(vec![1.0, 2.0, 3.0]))));
        let object = r#"{"y1": 1, "id": 7, "y2": 2e0, "note": "x"}"#;
        assert_eq!(read(Protocol::JsonLines, 2, object), Some((7, Ok(vec![1.0, 2.0]))));
    }

    #[test]
    fn row_numbers_are_read_as_languages_write_them() {
        for line in ["100000,1.5", "100000.0, 1.5\r", "1e+05,1.5", "\"100000\",1.5"] {
            assert_eq!(read(Protocol::Csv, 1, line), Some((100_000, Ok(vec![1.5]))), "{line}");
        }
        for line in [r#"{"y1": 1.5, "id": 100000}"#, r#"{"id": "100000", "y1": 1.5}"#, r#"{"id": 1e5, "y1": 1.5}"#] {
            assert_eq!(read(Protocol::JsonLines, 1, line), Some((100_000, Ok(vec![1.5]))), "{line}");
        }
        for stray in ["1.5", "0.5,1", "-1,2", "nan,1", "step 7,1", "1e300,1", "", " ", "\r"] {
            assert_eq!(read(Protocol::Csv, 1, stray), None, "{stray:?}");
        }
        for stray in ["[7, 1.5]", r#"{"y1": 1.5}"#, r#"{"id": 1.5, "y1": 1}"#, r#"{"id": null, "y1": 1}"#, ""] {
            assert_eq!(read(Protocol::JsonLines, 1, stray), None, "{stray:?}");
        }
    }

    #[test]
    fn missing_values_are_nan() {
        for line in ["7,nan", "7,NaN", "7,-nan", "7,"] {
            assert!(read(Protocol::Csv, 1, line).unwrap().1.unwrap()[0].is_nan(), "{line}");
        }
        let both = read(Protocol::Csv, 2, "7,,inf").unwrap().1.unwrap();
        assert!(both[0].is_nan() && both[1] == f64::INFINITY);
        for value in ["NaN", "null", "-Infinity"] {
            let line = format!("{{\"id\": 7, \"y1\": {value}, \"note\": \"a \\\" NaN\"}}");
            assert!(read(Protocol::JsonLines, 1, &line).unwrap().1.unwrap()[0].is_nan(), "{line}");
        }
    }

    #[test]
    fn invalid_answers_after_a_row_number_are_reported() {
        let words = |protocol, line: &str| read(protocol, 2, line).unwrap().1.unwrap_err();
        let cells = "not an answer: expected the row's number and 2 numbers, separated by commas, found";
        assert_eq!(words(Protocol::Csv, "7,1.5"), format!("{cells} 1 cell: `#`"));
        assert_eq!(words(Protocol::Csv, "7,step 17"), format!("{cells} `step #`"));
        let object = "not an answer: expected a JSON object with id (the row's number), y1, y2, found";
        assert_eq!(words(Protocol::JsonLines, r#"{"id": 7, "y1": 1}"#), format!("{object} an object without `y2`"));
        assert_eq!(
            words(Protocol::JsonLines, r#"{"id": 7, "y1": 1, "y2": true}"#),
            format!("{object} true or false as `y2`")
        );
    }

    #[test]
    fn answers_without_a_number_are_seen() {
        for (protocol, line, is_one) in [
            (Protocol::Csv, "1.5,2", true),
            (Protocol::Csv, "error: no root", true),
            (Protocol::Csv, "1.5", false),
            (Protocol::Csv, "Loading ...", false),
            (Protocol::Csv, "", false),
            (Protocol::JsonLines, r#"{"y1": 1, "y2": 2}"#, true),
            (Protocol::JsonLines, r#"{"step": 1}"#, false),
        ] {
            assert_eq!(is_answer_without_number(protocol, &names(2), line.as_bytes()), is_one, "{line}");
        }
    }
}
