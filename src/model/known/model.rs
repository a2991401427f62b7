//! A function with known indices as a model.

use super::KnownFunction;
use crate::model::{FunctionModel, Model, Output, RowFailure};
use crate::quantity::Unit;

/// The one output, y.
pub(in crate::model) fn known_output() -> Output {
    Output::new("y", Unit::dimensionless(), "value of the function")
}

/// The model of `function`. `base` holds a value for every input, `factors` the number of the input that each factor of the space
/// drives.
pub fn known_model(function: KnownFunction, base: Vec<f64>, factors: Vec<usize>) -> impl Model {
    let drives_all = factors.iter().copied().eq(0..base.len());
    FunctionModel::new(vec![known_output()], move |x: &[f64], y: &mut [f64]| {
        let mut all = Vec::new();
        if !drives_all {
            all.clone_from(&base);
            factors.iter().zip(x).for_each(|(input, value)| all[*input] = *value);
        }
        let x = if drives_all { x } else { &all };
        y[0] = function.value(x);
        match y[0].is_nan().then(|| function.reason(x)).flatten() {
            Some(reason) => Err(RowFailure::new(reason)),
            None => Ok(()),
        }
    })
}
