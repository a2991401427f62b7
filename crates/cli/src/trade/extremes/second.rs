//! A second calculation of a model's outputs, by another method or with more digits, to check the first.

/// Computes the outputs of a model in another way.
pub trait SecondCalculation: Send + Sync {
    /// Returns its name, in a few words.
    fn name(&self) -> String;

    /// Computes every output at the point `x`, the SI values of the factors in the order of the space, to compare with
    /// the model's outputs there.
    fn calculate(&self, x: &[f64], answer: &Answered) -> Vec<Result<Reference, Unchecked>>;
}

/// The result of a model at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Answered {
    /// Its outputs in SI units; `None` for a missing one.
    pub values: Vec<Option<f64>>,
    /// The relative error that it estimates for them, if it does.
    pub error_estimate: Option<f64>,
}

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
