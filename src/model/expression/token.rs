//! Tokens of a formula.

use std::ops::Range;

use super::error::{ExpressionError, ExpressionProblem};

/// A token.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token {
    Number(f64),
    /// A name, or several joined by dots, as in `np.sin`, which is never defined.
    Name(String),
    Sign(&'static str),
    End,
}

/// Longer signs first, so that `**` is not read as two.
const SIGNS: [&str; 17] =
    ["**", "<=", ">=", "==", "!=", "+", "-", "*", "/", "^", "(", ")", ",", "<", ">", "\u{2212}", "\u{b7}"];

pub(super) fn begins_name(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

pub(super) fn in_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Returns all tokens with their places, and the end.
pub(super) fn tokens(text: &str) -> Result<Vec<(Token, Range<usize>)>, ExpressionError> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let length = if first.is_whitespace() {
            first.len_utf8()
        } else if first.is_ascii_digit() || first == '.' {
            let length = number_length(rest);
            match rest[..length].parse().ok().filter(|number: &f64| number.is_finite()) {
                Some(number) => tokens.push((Token::Number(number), at..at + length)),
                None => return wrong(at, length, ExpressionProblem::Number(rest[..length].to_owned())),
            }
            length
        } else if begins_name(first) {
            let length = dotted_length(rest);
            tokens.push((Token::Name(rest[..length].to_owned()), at..at + length));
            length
        } else if let Some(sign) = SIGNS.into_iter().find(|sign| rest.starts_with(sign)) {
            let plain = match sign {
                "**" => "^",
                "\u{2212}" => "-",
                "\u{b7}" => "*",
                other => other,
            };
            tokens.push((Token::Sign(plain), at..at + sign.len()));
            sign.len()
        } else if first == '=' {
            return wrong(at, 1, ExpressionProblem::Assignment);
        } else {
            return wrong(at, first.len_utf8(), ExpressionProblem::Character(first));
        };
        at += length;
    }
    tokens.push((Token::End, text.len()..text.len()));
    Ok(tokens)
}

fn wrong<T>(at: usize, length: usize, problem: ExpressionProblem) -> Result<T, ExpressionError> {
    Err(ExpressionError { problem, place: at..at + length })
}

/// Returns the length in bytes of the name at the beginning of `text`, with any names joined to it by dots.
fn dotted_length(text: &str) -> usize {
    let mut from = 0;
    loop {
        let end = text[from..].find(|c| !in_name(c)).map_or(text.len(), |length| from + length);
        match text[end..].strip_prefix('.') {
            Some(next) if next.starts_with(begins_name) => from = end + 1,
            _ => return end,
        }
    }
}

/// Returns the bytes of the number at the beginning of `text`, with all following digits and dots: `1.2.3` is one.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let end = end_of_digits(bytes, 0);
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let stop = end_of_digits(bytes, (end + 1 + sign).min(bytes.len()));
        if stop > end + 1 + sign {
            return stop;
        }
    }
    end
}

fn end_of_digits(bytes: &[u8], from: usize) -> usize {
    from + bytes[from..].iter().take_while(|byte| byte.is_ascii_digit() || **byte == b'.').count()
}
