//! Whether a number is right, by a second calculation.

use super::map::{Finding, Outcome};
use crate::model::{Reference, RowFailure, Unchecked};

/// Underflow takes no more than this from a number.
const LEAST: f64 = 2.0 * f64::MIN_POSITIVE * f64::EPSILON;

/// What has become of an output: its `value` or why there is none, the `flags` that the model raised on the row, and what a
/// second calculation says of it.
pub(super) fn judge(value: Result<f64, RowFailure>, flags: &[&str], second: &Result<Reference, Unchecked>) -> Finding {
    let value = match value {
        Ok(value) => value,
        Err(failure) => return Finding::new(Outcome::Refused, failure.to_string()),
    };
    let flagged = (!flags.is_empty()).then(|| format!("flags of the model: {}", flags.join(", ")));
    let finding = match second {
        Err(Unchecked::NotAvailable(why)) => {
            Finding::new(Outcome::Flagged, flagged.unwrap_or_else(|| format!("not checked: {why}")))
        }
        Err(Unchecked::NoValue(why)) => Finding::new(Outcome::Wrong, format!("a number where there is none: {why}")),
        Ok(reference) => compared(value, flagged, reference),
    };
    let reference = second.as_ref().ok().map(|reference| reference.value).filter(|value| value.is_finite());
    Finding { value: Some(value), reference, ..finding }
}

fn compared(value: f64, flagged: Option<String>, reference: &Reference) -> Finding {
    let &Reference { value: expected, stated, floor, tolerance, covered } = reference;
    let apart = if value == expected { 0.0 } else { (value - expected).abs() };
    let within = |relative: f64| apart.is_finite() && (apart <= relative * expected.abs() || apart <= LEAST);
    let is_stated = stated.is_none_or(|stated| apart <= stated);
    match flagged {
        _ if !within(floor) && !is_stated => {
            Finding::new(Outcome::Wrong, "the number deviates from the second calculation by more than is stated")
        }
        Some(flags) if within(tolerance) => Finding::new(Outcome::FlaggedConfirmed, flags),
        Some(flags) => Finding::new(Outcome::Flagged, flags),
        None if within(tolerance) => Finding::new(Outcome::Right, ""),
        None => Finding::new(Outcome::Flagged, covered),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(value: f64, flags: &[&str], reference: Reference) -> Outcome {
        judge(Ok(value), flags, &Ok(reference)).outcome
    }

    #[test]
    fn every_outcome_has_its_case() {
        let reference = Reference { value: 2.0, stated: Some(0.1), floor: 1e-6, tolerance: 1e-3, covered: "" };
        assert_eq!(outcome(2.001, &[], reference), Outcome::Right);
        assert_eq!(outcome(2.001, &["odd"], reference), Outcome::FlaggedConfirmed);
        assert_eq!(outcome(2.05, &["odd"], reference), Outcome::Flagged);
        assert_eq!(outcome(2.05, &[], reference), Outcome::Flagged);
        // More than is stated is wrong, flags or not.
        assert_eq!(outcome(2.2, &["odd"], reference), Outcome::Wrong);
        assert_eq!(outcome(2.2, &[], reference), Outcome::Wrong);
        let certain = Reference { stated: Some(0.0), ..reference };
        assert_eq!(outcome(2.000_001, &[], certain), Outcome::Right);
        assert_eq!(outcome(2.000_01, &[], certain), Outcome::Wrong);
        assert_eq!(outcome(2.2, &[], Reference { stated: None, ..reference }), Outcome::Flagged);
        assert_eq!(outcome(2.2, &[], Reference { stated: Some(f64::INFINITY), ..reference }), Outcome::Flagged);
        assert_eq!(outcome(1e300, &[], Reference { value: f64::INFINITY, ..reference }), Outcome::Wrong);
        assert_eq!(outcome(0.0, &[], Reference { value: 1e-323, stated: Some(0.0), ..reference }), Outcome::Right);
        let refused = judge(Err(RowFailure::new("no motion")), &["odd"], &Ok(reference));
        assert_eq!((refused.outcome, refused.reason.as_str()), (Outcome::Refused, "no motion"));
        let judged = |unchecked| judge(Ok(1.0), &[], &Err(unchecked)).outcome;
        assert_eq!(judged(Unchecked::NotAvailable("none".to_owned())), Outcome::Flagged);
        assert_eq!(judged(Unchecked::NoValue("nothing slips".to_owned())), Outcome::Wrong);
    }
}
