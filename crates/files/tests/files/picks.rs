//! The numbers that are extracted from what a run of a program has written.

use apportion_files::{Match, Pick, PickMethod, Source};

fn found(method: PickMethod, text: &str) -> Result<f64, String> {
    method.number(text, "it")
}

fn regex(text: &str, which: Match) -> PickMethod {
    PickMethod::Regex(text.parse().unwrap(), which)
}

#[test]
fn a_regex_takes_its_first_group_of_the_first_or_last_match() {
    let text = "force = 1.5 nN\nforce = -2.5D-3 nN\n";
    assert_eq!(found(regex(r"force = (\S+)", Match::First), text), Ok(1.5));
    assert_eq!(found(regex(r"force = (\S+)", Match::Last), text), Ok(-2.5e-3));
    assert_eq!(found(regex(r"\d+\.\d+", Match::First), text), Ok(1.5));
    assert_eq!(found(regex("time", Match::Last), text).unwrap_err(), "nothing in it matches the regex");
    let rubbish = found(regex("(force.*)", Match::Last), text).unwrap_err();
    assert!(rubbish.starts_with("the text found in it is not a number: `force = #"), "{rubbish}");
}

#[test]
fn a_column_takes_the_last_row_or_the_first() {
    let column = |name: &str, which| PickMethod::Column(name.to_owned(), which);
    let text = "\u{feff}t,\"y, nN\"\r\n0, 1.5\r\n1, 2.5\r\n\r\n";
    assert_eq!(found(column("y, nN", Match::Last), text), Ok(2.5));
    assert_eq!(found(column("y, nN", Match::First), text), Ok(1.5));
    assert_eq!(found(column("z", Match::Last), text).unwrap_err(), "it has no column `z`");
    assert_eq!(found(column("t", Match::Last), "t,y\n").unwrap_err(), "it has no row");
    let short = "it has no cell of column `y` in its last row";
    assert_eq!(found(column("y", Match::Last), "t,y\n1\n").unwrap_err(), short);
    assert!(found(column("y", Match::Last), "t,y\n1,x\n").unwrap_err().contains("not a number: `x`"));
}

#[test]
fn a_pointer_leads_to_a_number() {
    let pointer = |text: &str| PickMethod::Pointer(text.to_owned());
    let text = r#"{"a/b": [0, {"y": 2.5e-3, "s": "7", "n": null, "l": [1]}]}"#;
    assert_eq!(found(pointer("/a~1b/1/y"), text), Ok(2.5e-3));
    assert_eq!(found(pointer("/a~1b/1/s"), text), Ok(7.0));
    assert!(found(pointer("/a~1b/1/n"), text).unwrap().is_nan());
    assert_eq!(found(pointer("/a/b"), text).unwrap_err(), "it has no value at `/a/b`");
    assert_eq!(found(pointer("/a~1b/1/l"), text).unwrap_err(), "the text found in it is not a number: `[#]`");
    assert_eq!(found(pointer("/a"), "{").unwrap_err(), "it is not JSON");
}

#[test]
fn a_series_takes_row_after_row() {
    let pick = |method| Pick { source: Source::Stdout, method };
    let value = |pick: &Pick, number, text| found(pick.of_value(number).method, text);
    let column = pick(PickMethod::Column("y".to_owned(), Match::Last));
    assert_eq!([0, 1].map(|number| value(&column, number, "t,y\n0,1\n1,2\n")), [Ok(1.0), Ok(2.0)]);
    assert_eq!(value(&column, 2, "t,y\n0,1\n1,2\n").unwrap_err(), "it has no row 3");
    assert_eq!(value(&column, 1, "t,y\n0,1\n1\n").unwrap_err(), "it has no cell of column `y` in its row 2");
    let regex = pick(regex(r"y = (\S+)", Match::Last));
    assert_eq!(value(&regex, 1, "y = 1\ny = 2\ny = 3\n"), Ok(2.0));
    assert_eq!(value(&regex, 3, "y = 1\ny = 2\ny = 3\n").unwrap_err(), "it has no match of the regex 4");
    let pointer = pick(PickMethod::Pointer("/y".to_owned()));
    assert_eq!(value(&pointer, 1, "{\"y\": [1, 2]}"), Ok(2.0));
    assert_eq!(value(&pointer, 2, "{\"y\": [1, 2]}").unwrap_err(), "it has no value at `/y/2`");
}
