//! A second calculation of a model's outputs, by another method or with more digits, to check the first.

/// Another way to compute the outputs of a model.
pub struct SecondCalculation {
    /// Its name, in a few words.
    pub name: String,
    /// Computes every output at a point, the SI values of the factors in the order of the space, to compare with the
    /// model's outputs there: in SI units, `None` for a missing one, and the relative error that it estimates for them.
    pub calculate: Box<Calculate>,
}

type Calculate = dyn Fn(&[f64], (&[Option<f64>], Option<f64>)) -> Vec<Result<Reference, Unchecked>> + Send + Sync;

/// An output by a second calculation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// The value in SI units; infinite beyond the range of doubles.
    pub value: f64,
    /// Possible distance of the model's value from it by the stated errors of both calculations; infinite if they claim
    /// nothing, `None` if no error is stated for this output.
    pub stated: Option<f64>,
    /// Maximum relative deviation of a value that is right.
    pub tolerance: f64,
    /// Relative deviation that is never wrong for any stated error: that of the arithmetic, or of a solver.
    pub floor: f64,
    /// Why a value may deviate by more; a sentence without a full stop.
    pub covered: &'static str,
}

impl Reference {
    /// Returns whether `value` is right; `None` if it deviates by more than is stated.
    pub fn agrees(&self, value: f64) -> Option<bool> {
        // Subnormal numbers have no relative precision.
        let underflow = 2.0 * f64::MIN_POSITIVE * f64::EPSILON;
        let apart = if value == self.value { 0.0 } else { (value - self.value).abs() };
        let within = |relative: f64| apart <= underflow || apart.is_finite() && apart <= relative * self.value.abs();
        let is_covered = within(self.floor) || self.stated.is_none_or(|stated| apart <= stated);
        is_covered.then(|| within(self.tolerance))
    }
}

/// Why an output cannot be checked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Unchecked {
    /// The second calculation failed; a sentence without a full stop.
    NotAvailable(String),
    /// The second calculation says that there is no value, with the reason.
    NoValue(String),
}
