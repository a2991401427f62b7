//! A function with known indices as a model.

use super::{KnownFunction, KnownInput};
use crate::model::{FunctionModel, Input, Model, Output, RowFailure};
use apportion_base::quantity::Unit;

/// Returns the single output, y.
pub fn known_output() -> Output {
    Output::new("y", Unit::dimensionless(), "value of the function")
}

/// Creates the model of `function`. `base` has a value for every input, `factors` the input's index for each factor.
pub fn known_model(function: KnownFunction, base: Vec<f64>, factors: Vec<usize>) -> impl Model {
    let drives_all = factors.iter().copied().eq(0..base.len());
    FunctionModel::new(vec![known_output()], move |x: &[f64], y: &mut [f64]| {
        let mut all = Vec::new();
        if !drives_all {
            all.clone_from(&base);
            for (input, value) in factors.iter().zip(x) {
                all[*input] = *value;
            }
        }
        let x = if drives_all { x } else { &all };
        function.checked_value(x).map(|value| y[0] = value).map_err(RowFailure::new)
    })
}

/// Returns the inputs of a function with its parameters chosen. An input that is not a factor is fixed at its upper
/// quartile: at the median, many functions hide the effect of other inputs (Sobol' G with a_1 = 0 is 0).
pub fn known_inputs(function: &KnownFunction) -> Vec<Input> {
    let inputs = function.inputs().iter().map(|KnownInput { name, description, domain, distribution }| Input {
        symbol: name.clone(),
        name: name.clone(),
        unit: Unit::dimensionless(),
        nominal: distribution.quantile(0.75),
        domain: *domain,
        description: description.clone(),
        distribution: Some(distribution.clone()),
    });
    inputs.collect()
}
