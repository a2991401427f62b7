//! Equality of two numbers, one of which may have been printed by another program.

/// Largest relative difference of two numbers that count as equal: ten digits are enough.
const SAME_VALUE: f64 = 1e-9;

/// Returns whether `found` is `expected` to a relative difference of 1e-9, or both are the same infinity; NaN equals nothing.
///
/// ```
/// use apportion_base::quantity::is_same;
///
/// assert!(is_same(0.333_333_333_33, 1.0 / 3.0));
/// assert!(!is_same(0.333, 1.0 / 3.0));
/// ```
pub fn is_same(found: f64, expected: f64) -> bool {
    found == expected || (found - expected).abs() <= SAME_VALUE * found.abs().max(expected.abs())
}
