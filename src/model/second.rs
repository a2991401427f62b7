//! A second calculation of a model's outputs, by another way or in more digits, to check the first by.

/// Another way to a model's outputs.
///
/// A model that has none can only be told to be finite.
pub trait SecondCalculation: Send + Sync {
    /// What it is, in a few words: `the formula in 106 bits`.
    fn name(&self) -> String;

    /// Every output at one point, which holds the SI values of the factors in the order of the space, beside what the model
    /// has answered there.
    fn calculate(&self, x: &[f64], answer: &Answered) -> Vec<Result<Reference, Unchecked>>;
}

/// What a model has answered at a point.
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
    /// they claim nothing, `None` where the model states no error of this output.
    pub stated: Option<f64>,
    /// Relative deviation below which nothing is wrong, whatever is stated: that of the arithmetic, or of a solver.
    pub floor: f64,
    /// Largest relative deviation of a value that is called right.
    pub tolerance: f64,
    /// What is to be said of a value that deviates more, as is stated; a sentence without a full stop.
    pub covered: &'static str,
}

/// Why there is nothing to check an output by.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Unchecked {
    /// The second calculation did not come through; a sentence without a full stop.
    NotAvailable(String),
    /// The second calculation says that there is no value; why not.
    NoValue(String),
}

/// The relative deviation of two computations of one formula below which nothing is wrong, and up to which a value is right.
pub(super) const OF_FORMULAS: f64 = 1e-9;

/// Formulas in twice the precision of doubles, by the inputs of a point.
pub(crate) struct InMoreDigits {
    formulas: Vec<super::Expression>,
    /// The values of all inputs, where the factors have not overwritten them.
    base: Vec<f64>,
    /// For each factor of the space: the input it drives.
    factors: Vec<usize>,
}

impl InMoreDigits {
    /// `formulas` of the factors themselves, of which there are so many.
    pub fn of_factors(formulas: Vec<super::Expression>, factors: usize) -> Self {
        Self { formulas, base: vec![0.0; factors], factors: (0..factors).collect() }
    }

    /// One formula of inputs, of which the factors drive some.
    pub fn of_inputs(formula: super::Expression, base: Vec<f64>, factors: Vec<usize>) -> Self {
        Self { formulas: vec![formula], base, factors }
    }
}

impl SecondCalculation for InMoreDigits {
    fn name(&self) -> String {
        "the formula in 106 bits".to_owned()
    }

    fn calculate(&self, x: &[f64], _: &Answered) -> Vec<Result<Reference, Unchecked>> {
        let mut inputs = self.base.clone();
        self.factors.iter().zip(x).for_each(|(&input, &value)| inputs[input] = value);
        self.formulas.iter().map(|formula| reference(formula, &inputs)).collect()
    }
}

/// A formula at `x`, with the bound of what rounding may make of it in doubles.
pub(super) fn reference(formula: &super::Expression, x: &[f64]) -> Result<Reference, Unchecked> {
    let not_available = |why: &str| Unchecked::NotAvailable(why.to_owned());
    let bounded = formula
        .bounded(x)
        .ok_or_else(|| not_available("the formula has a function (erf, gamma) that is not computed in 106 bits"))?;
    if bounded.value.is_nan() {
        return Err(not_available("the formula has no value in 106 bits"));
    }
    let stated = bounded.error.value();
    let covered = "rounding takes its digits, by cancellation or underflow: those left are within the bound of that";
    let value = bounded.value.value();
    Ok(Reference { value, stated: Some(stated), floor: OF_FORMULAS, tolerance: OF_FORMULAS, covered })
}
