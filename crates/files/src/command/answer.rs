//! The reply of a program to one row.

use apportion::text::shortened;

/// The reply of a program to a row: a value for every output, NaN for a missing one; or why there are none.
pub(super) type Answer = Result<Vec<f64>, String>;

/// Returns the reply of a program that says why a row has no values.
pub(super) fn failed(reason: &str) -> Answer {
    let reason = shortened(reason);
    Err(if reason.is_empty() { "the program reported an error without a reason".to_owned() } else { reason })
}
