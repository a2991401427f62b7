//! A constant.

use super::function::{unit_cube, written};
use super::parameters::{FINITE, Given};
use super::{Entry, Exact, Function, KnownInput, ParameterError, ParameterInfo, ParameterValue};

pub(super) const ENTRY: Entry = Entry {
    name: "constant",
    summary: "no input acts: there are no indices, and a program has to say so",
    formula: "c",
    source: "textbook",
    parameters: &[
        ParameterInfo { name: "c", description: "the value [1]" },
        ParameterInfo { name: "dimension", description: "number of inputs d [2]" },
    ],
    build: |given| Ok(Box::new(Constant::new(given)?)),
};

/// c, x uniform on (0, 1)^d. Mean c, variance 0, no indices: 0/0.
struct Constant {
    c: f64,
    d: usize,
}

impl Constant {
    fn new(given: &Given<'_>) -> Result<Self, ParameterError> {
        Ok(Self { c: given.number("c", 1.0, FINITE)?, d: given.dimension(2, FINITE)? })
    }
}

impl Function for Constant {
    fn inputs(&self) -> Vec<KnownInput> {
        unit_cube(self.d)
    }

    fn parameters(&self) -> Vec<(&'static str, ParameterValue)> {
        vec![("c", ParameterValue::Number(self.c)), ("dimension", ParameterValue::Number(self.d as f64))]
    }

    fn value(&self, _x: &[f64]) -> f64 {
        self.c
    }

    fn expression(&self) -> String {
        written(self.c)
    }

    fn exact(&self) -> Exact {
        Exact::of_sum(self.c, &vec![0.0; self.d])
    }
}
