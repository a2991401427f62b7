//! A product of normal inputs.

use super::parameters::{DIMENSION, FINITE, POSITIVE};
use super::{Exact, KnownAnswer, KnownInput, Made, ParameterError, ParameterInfo};
use crate::space::Distribution;

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "product",
    description: "product of normal inputs; with mu = 0 only interactions",
    formula: "prod_i x_i, x_i normal of mean mu_i and standard deviation sigma_i",
    source: "textbook: moments of a product of independent inputs",
    parameters: &[
        ParameterInfo { name: "mu", description: "means, one number or one per input [1, 2, 3, 3 ...]" },
        ParameterInfo { name: "sigma", description: "standard deviations, greater than 0, likewise [0.5]" },
        DIMENSION,
    ],
    build: |given| {
        let [mu, sigma] = given.per_input([("mu", &[1.0, 2.0, 3.0][..], FINITE), ("sigma", &[0.5], POSITIVE)])?;
        let mut inputs = Vec::with_capacity(mu.len());
        for (number, (&mu, &sigma)) in mu.iter().zip(&sigma).enumerate() {
            let Ok(distribution) = Distribution::normal(mu, sigma) else {
                return Err(ParameterError::out_of_range("sigma", sigma, "small enough for finite values"));
            };
            let description = format!("normal of mean {mu} and standard deviation {sigma}");
            inputs.push(KnownInput { name: format!("x{}", number + 1), description, domain: None, distribution });
        }
        Ok(Made::new(inputs, exact(&mu, &sigma), value))
    },
};

fn value(x: &[f64]) -> f64 {
    x.iter().product()
}

/// prod x_i, x_i normal of mean mu_i and standard deviation sigma_i.
///
/// Mean prod mu_i, variance prod (mu_i^2 + sigma_i^2) - prod mu_i^2. With the shares t_i = sigma_i^2 / (mu_i^2 +
/// sigma_i^2) and c_i = 1 - t_i: ST_i = t_i / (1 - prod c_j), S_i = t_i prod_{j != i} c_j / (1 - prod c_j), S_ij = t_i
/// t_j prod_{k != i, j} c_k / (1 - prod c_k), which are the rules of a product with r_i = (sigma_i / mu_i)^2 and also
/// hold for mu_i = 0. For mu = (1, 2, 3), sigma = 0.5: mean 6, variance 13.1406, S = (0.6849, 0.1712, 0.0761), ST =
/// (0.7479, 0.2200, 0.1011).
fn exact(mu: &[f64], sigma: &[f64]) -> Exact {
    let r: Vec<f64> = sigma.iter().zip(mu).map(|(sigma, mu)| (sigma / mu).powi(2)).collect();
    let t: Vec<f64> = r.iter().map(|&r| if r.is_infinite() { 1.0 } else { r / (1.0 + r) }).collect();
    // prod c_j over all but one input, by a count of zeros and the logarithm of the others.
    let zeros = r.iter().filter(|r| r.is_infinite()).count();
    let logs: Vec<f64> = r.iter().map(|r| if r.is_infinite() { 0.0 } else { -libm::log1p(*r) }).collect();
    let sum: f64 = logs.iter().sum();
    let varying = if zeros > 0 { 1.0 } else { -libm::expm1(sum) };
    let squares: f64 = sigma.iter().zip(mu).map(|(sigma, mu)| mu * mu + sigma * sigma).product();
    let mean = mu.iter().product();
    let mut first = vec![0.0; r.len()];
    for (i, first) in first.iter_mut().enumerate() {
        let other_zeros = zeros - usize::from(r[i].is_infinite());
        let others = if other_zeros > 0 { 0.0 } else { libm::exp(sum - logs[i]) };
        *first = t[i] * others / varying;
    }
    let total = t.iter().map(|t| t / varying).collect();
    Exact::closed(mean, squares * varying, first, total)
}
