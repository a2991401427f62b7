//! Lines of a program that is kept alive, as replies to rows.

use apportion_files::{Protocol, parse_answer};

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
    // What no parser of JSON has to read, with the number of a row all the same.
    let deep = format!("{{\"note\": {}{}, \"id\": 7, \"y1\": 1, \"y2\": 2}}", "[".repeat(500), "]".repeat(500));
    for line in [r#"{"id": 7, "y1": 1e400, "y2": 2}"#, r#"{"y1": 1, "id": "7", "y2": 2, "note": "\ud800"}"#, &deep] {
        assert!(words(Protocol::JsonLines, line).starts_with(object), "{line}");
    }
    for stray in [r#"{"id": 7, "y1": 1e400"#, r#"solved {"id": 7, "y1": 1e400}"#, r#"{"id": 7.5, "y1": 1e400}"#] {
        assert_eq!(read(Protocol::JsonLines, 1, stray), None, "{stray}");
    }
}

/// Reads a JSON object with row number 7: the values of these outputs, or what was found in their place.
fn object(outputs: &[&str], keys: &str) -> Result<Vec<f64>, String> {
    let outputs: Vec<String> = outputs.iter().map(|&name| name.to_owned()).collect();
    let (number, answer) = parse_answer(Protocol::JsonLines, &outputs, format!("{{\"id\": 7, {keys}}}").as_bytes())?;
    assert_eq!(number, 7);
    answer.map_err(|words| words.split_once(", found ").unwrap().1.to_owned())
}

#[test]
fn a_list_holds_the_values_of_a_series() {
    let outputs = ["peak", "y[0]", "y[1]", "y[2]", "z[4]"];
    assert_eq!(object(&outputs, r#""y": [1, 2, 3], "z[4]": 5, "peak": 4"#), Ok(vec![4.0, 1.0, 2.0, 3.0, 5.0]));
    assert!(object(&outputs, r#""y": [1, NaN, 3], "z[4]": 5, "peak": 4"#).unwrap()[2].is_nan());
    let one_by_one = r#""y[0]": 1, "y[1]": 2, "y[2]": 3, "z[4]": 5, "peak": 4, "y": "anything""#;
    assert_eq!(object(&outputs, one_by_one), Ok(vec![4.0, 1.0, 2.0, 3.0, 5.0]));
    let refused = |text: &str| object(&outputs[..4], text).unwrap_err();
    assert_eq!(refused(r#""y": [1, 2], "peak": 4"#), "a list of 2 as `y`");
    assert_eq!(refused(r#""y": [1, "a", 3], "peak": 4"#), "a text as `y`");
    assert_eq!(refused(r#""y": 3, "peak": 4"#), "a number as `y`");
    assert_eq!(refused(r#""peak": 4"#), "an object without `y`");
    assert_eq!(refused(r#""y[0]": 1, "y[2]": 3, "peak": 4"#), "an object without `y`");
}
