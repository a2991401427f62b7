//! Output of a program that is a model.

use apportion_files::{Protocol, parse_answer};

/// Every line is an answer with a value for each output, a failure with a reason, or no answer.
pub fn run(bytes: &[u8]) {
    let outputs = ["y".to_owned(), "a long name".to_owned(), "\u{3bc}".to_owned()];
    for protocol in [Protocol::Csv, Protocol::JsonLines] {
        for line in bytes.split(|byte| *byte == b'\n') {
            for count in 1..=outputs.len() {
                match parse_answer(protocol, &outputs[..count], line) {
                    Ok((_, Ok(values))) => assert_eq!(values.len(), count),
                    Ok((_, Err(reason))) => assert!(!reason.is_empty() && reason.len() < 1000, "{reason}"),
                    Err(found) => assert!(found.starts_with("expected ") && found.len() < 1000, "{found}"),
                }
            }
        }
    }
}
