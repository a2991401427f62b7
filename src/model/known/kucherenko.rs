//! Two products of many inputs alike.

use super::function::{product, unit_cube, xs};
use super::parameters::{FINITE, Given, ParameterInfo};
use super::{Entry, Exact, Function, KnownInput, ParameterError, ParameterValue};

const DIMENSION: [ParameterInfo; 1] = [ParameterInfo { name: "dimension", description: "number of inputs d [10]" }];

pub(super) const PRODUCT: Entry = Entry {
    name: "kucherenko-1b",
    summary: "product of many inputs alike, almost a sum: low effective dimension in the superposition sense",
    formula: "prod_i (d - x_i) / (d - 1/2)",
    source: "Kucherenko, Feil, Shah and Mauntz 2011, Reliab. Eng. Syst. Saf. 96, 440-449 (function 1B)",
    parameters: &DIMENSION,
    build: |given| Ok(Box::new(Linear::new(given)?)),
};

pub(super) const ROOTS: Entry = Entry {
    name: "kucherenko-2b",
    summary: "product of roots of many inputs alike, steep at 0",
    formula: "(1 + 1/d)^d prod_i x_i^(1/d)",
    source: "Kucherenko, Feil, Shah and Mauntz 2011, Reliab. Eng. Syst. Saf. 96, 440-449 (function 2B)",
    parameters: &DIMENSION,
    build: |given| Ok(Box::new(Roots::new(given)?)),
};

/// prod (d - x_i) / (d - 1/2), x uniform on (0, 1)^d.
///
/// Mean 1; a product with r_i = 1 / (12 (d - 1/2)^2): S_i = r_i / D, S_ij = r_i r_j / D, D = (1 + r)^d - 1.
/// For d = 10: variance 0.009272, S_i = 0.0996, ST_i = 0.1004.
struct Linear {
    d: usize,
}

impl Linear {
    fn new(given: &Given<'_>) -> Result<Self, ParameterError> {
        Ok(Self { d: given.dimension(10, FINITE)? })
    }
}

impl Function for Linear {
    fn inputs(&self) -> Vec<KnownInput> {
        unit_cube(self.d)
    }

    fn parameters(&self) -> Vec<(&'static str, ParameterValue)> {
        vec![("dimension", ParameterValue::Number(self.d as f64))]
    }

    fn value(&self, x: &[f64]) -> f64 {
        let d = self.d as f64;
        x.iter().map(|x| (d - x) / (d - 0.5)).product()
    }

    fn expression(&self) -> String {
        let d = self.d;
        product(xs(d).map(|x| format!("(({d} - {x})/({d} - 0.5))")))
    }

    fn exact(&self) -> Exact {
        let d = self.d as f64;
        Exact::of_product(1.0, &vec![1.0 / (12.0 * (d - 0.5) * (d - 0.5)); self.d])
    }
}

/// (1 + 1/d)^d prod x_i^(1/d), x uniform on (0, 1)^d.
///
/// Mean 1; a product with r_i = 1 / (d (d + 2)): S_i = r_i / D, S_ij = r_i r_j / D, D = (1 + r)^d - 1.
/// For d = 10: variance 0.08653, S_i = 0.0963, ST_i = 0.1038.
struct Roots {
    d: usize,
}

impl Roots {
    fn new(given: &Given<'_>) -> Result<Self, ParameterError> {
        Ok(Self { d: given.dimension(10, FINITE)? })
    }
}

impl Function for Roots {
    fn inputs(&self) -> Vec<KnownInput> {
        unit_cube(self.d)
    }

    fn parameters(&self) -> Vec<(&'static str, ParameterValue)> {
        vec![("dimension", ParameterValue::Number(self.d as f64))]
    }

    fn value(&self, x: &[f64]) -> f64 {
        let d = self.d as f64;
        let logs: f64 = x.iter().map(|&x| libm::log(x)).sum();
        libm::exp(d * libm::log1p(1.0 / d) + logs / d)
    }

    fn expression(&self) -> String {
        let d = self.d;
        format!("(1 + 1/{d})^{d}*({})^(1/{d})", product(xs(d)))
    }

    fn exact(&self) -> Exact {
        let d = self.d as f64;
        Exact::of_product(1.0, &vec![1.0 / (d * (d + 2.0)); self.d])
    }
}
