//! A function with known indices as a model.

use super::{KnownFunction, KnownInput};
use crate::model::{FunctionModel, Input, Model, Output, RowFailure};
use apportion_base::quantity::Unit;

impl KnownFunction {
    /// Returns the single output, y.
    pub fn output() -> Output {
        Output::new("y", Unit::dimensionless(), "value of the function")
    }

    /// Creates its model. `base` has a value for every input, `factors` the input's index for each factor.
    pub fn model(self, base: Vec<f64>, factors: Vec<usize>) -> impl Model {
        let drives_all = factors.iter().copied().eq(0..base.len());
        FunctionModel::new(vec![Self::output()], move |x: &[f64], y: &mut [f64]| {
            let mut all = Vec::new();
            if !drives_all {
                all.clone_from(&base);
                for (input, value) in factors.iter().zip(x) {
                    all[*input] = *value;
                }
            }
            let x = if drives_all { x } else { &all };
            self.checked_value(x).map(|value| y[0] = value).map_err(RowFailure::new)
        })
    }

    /// Returns its inputs as those of a model. An input that is not a factor is fixed at its upper
    /// quartile: at the median, many functions hide the effect of other inputs (Sobol' G with a_1 = 0 is 0).
    pub fn model_inputs(&self) -> Vec<Input> {
        let inputs = self.inputs().iter().map(|KnownInput { name, description, domain, distribution }| Input {
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
}
