//! What a program prints that is a model.

use apportion::model::{Answer, Protocol, parse_answer};

/// Every line is an answer with a value for each output, a failure with a reason, or no answer, and then changes nothing.
pub fn run(bytes: &[u8]) {
    let outputs = ["y".to_owned(), "a long name".to_owned(), "\u{3bc}".to_owned()];
    for protocol in [Protocol::Csv, Protocol::JsonLines] {
        for line in bytes.split(|byte| *byte == b'\n') {
            for count in 1..=outputs.len() {
                let mut values = vec![f64::MAX];
                let answer = parse_answer(protocol, &outputs[..count], line, &mut values);
                let added = if matches!(answer, Ok((_, Ok(Answer::Values)))) { count } else { 0 };
                assert_eq!((values[0], values.len()), (f64::MAX, 1 + added));
                if let Err(found) | Ok((_, Err(found))) = &answer {
                    assert!(found.starts_with("expected ") && found.len() < 1000, "{found}");
                }
            }
        }
    }
}
