//! A second calculation of a model's outputs, by another way or in more digits, to check the first by.

/// Another way to a model's outputs.
pub trait SecondCalculation: Send + Sync {
    /// What it is, in a few words.
    fn name(&self) -> String;

    /// Every output at the point `x`, the SI values of the factors in the order of the space, to compare with what the model
    /// answered there.
    fn calculate(&self, x: &[f64], answer: &Answered) -> Vec<Result<Reference, Unchecked>>;
}

/// What a model answered at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Answered {
    /// Its outputs in SI units; `None` where there is none.
    pub values: Vec<Option<f64>>,
    /// The relative error that it estimates of them, if it does.
    pub error_estimate: Option<f64>,
}

/// An output by a second calculation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// The value in SI units; infinite beyond the range of doubles.
    pub value: f64,
    /// How far the value of the model may lie from it by what the two calculations say of their own errors; infinite where
    /// they claim nothing, `None` where nothing is stated of this output.
    pub stated: Option<f64>,
    /// Largest relative deviation of a value that is right.
    pub tolerance: f64,
    /// Relative deviation that is never wrong, whatever is stated: that of the arithmetic, or of a solver.
    pub floor: f64,
    /// Why a value may deviate by more; a sentence without a full stop.
    pub covered: &'static str,
}

impl Reference {
    /// Whether `value` is right; `None` if it deviates by more than is stated.
    pub fn agrees(&self, value: f64) -> Option<bool> {
        // Subnormal numbers have no relative precision.
        let underflow = 2.0 * f64::MIN_POSITIVE * f64::EPSILON;
        let apart = if value == self.value { 0.0 } else { (value - self.value).abs() };
        let within = |relative: f64| apart <= underflow || apart.is_finite() && apart <= relative * self.value.abs();
        let is_covered = within(self.floor) || self.stated.is_none_or(|stated| apart <= stated);
        is_covered.then(|| within(self.tolerance))
    }
}

/// Why there is nothing to check an output by.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Unchecked {
    /// The second calculation did not come through; a sentence without a full stop.
    NotAvailable(String),
    /// The second calculation says that there is no value; why not.
    NoValue(String),
}
