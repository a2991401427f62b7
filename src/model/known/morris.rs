//! Morris's function of twenty inputs.

use super::function::unit_cube;
use super::{Exact, KnownAnswer, Made};

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "morris",
    description: "twenty inputs: ten that matter, ten that hardly do, interactions up to the fourth order",
    formula: "sum b_i w_i + sum_{i<j} b_ij w_i w_j + sum_{i<j<k} b_ijk w_i w_j w_k + b_1234 w_1 w_2 w_3 w_4, \
              w_i = 2 (x_i - 1/2), but 2 (1.1 x_i / (x_i + 0.1) - 1/2) for i = 3, 5, 7; b_i = 20 (i <= 10), \
              b_ij = -15 (i, j <= 6), b_ijk = -10 (i, j, k <= 5), b_1234 = 5, else b_i = (-1)^i, b_ij = (-1)^(i+j), \
              b_ijk = 0",
    source: "Morris 1991, Technometrics 33, 161-174, with (-1)^i and (-1)^(i+j) for the coefficients it draws at random",
    parameters: &[],
    build: |_| Ok(Made::new(unit_cube(INPUTS), exact(), value)),
};

const INPUTS: usize = 20;

fn bent(input: usize) -> bool {
    matches!(input, 2 | 4 | 6)
}

fn sign(parity: usize) -> f64 {
    if parity.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// Returns b_i; the parity of i counted from 1.
fn single(i: usize) -> f64 {
    if i < 10 { 20.0 } else { sign(i + 1) }
}

fn double(i: usize, j: usize) -> f64 {
    if j < 6 { -15.0 } else { sign(i + j) }
}

const TRIPLE: f64 = -10.0;
const QUADRUPLE: f64 = 5.0;

fn value(x: &[f64]) -> f64 {
    let mut w = [0.0; INPUTS];
    for (i, (w, &x)) in w.iter_mut().zip(x).enumerate() {
        *w = 2.0 * if bent(i) { 1.1 * x / (x + 0.1) - 0.5 } else { x - 0.5 };
    }
    let mut sum = QUADRUPLE * w[0] * w[1] * w[2] * w[3];
    for i in 0..INPUTS {
        let pairs: f64 = (i + 1..INPUTS).map(|j| double(i, j) * w[j]).sum();
        sum += w[i] * (single(i) + pairs);
    }
    for i in 0..5 {
        for j in i + 1..5 {
            sum += TRIPLE * w[i] * w[j] * w[j + 1..5].iter().sum::<f64>();
        }
    }
    sum
}

/// A polynomial of the first degree in each w_i, x uniform on (0, 1)^20; inputs are counted from 0 in the code.
///
/// With m_i and v_i mean and variance of w_i (0 and 1/3; for i = 3, 5, 7 from E[x/(x + 0.1)] = 1 - 0.1 ln 11 and
/// E[(x/(x + 0.1))^2] = 1 - 0.2 ln 11 + 0.01 (10 - 1/1.1)), the coefficient of a product of centred w_i is
/// C_u = sum_{T >= u} b_T prod_{T - u} m_i, and V_u = C_u^2 prod_u v_i. Mean 34.4691, variance 1074.94.
fn exact() -> Exact {
    let log = libm::log(11f64);
    let (e1, e2) = (1.0 - 0.1 * log, 1.0 - 0.2 * log + 0.01 * (10.0 - 1.0 / 1.1));
    let mut means = [0.0; INPUTS];
    let mut variances = [1.0 / 3.0; INPUTS];
    for i in (0..INPUTS).filter(|i| bent(*i)) {
        means[i] = 2.0 * (1.1 * e1 - 0.5);
        variances[i] = 4.0 * 1.21 * (e2 - e1 * e1);
    }
    let terms = terms();
    let mut parts = Vec::with_capacity(terms.len());
    for (set, _) in &terms {
        let variance = set.iter().map(|&i| variances[i]).product::<f64>();
        parts.push((set.clone(), coefficient(set, &terms, &means).powi(2) * variance));
    }
    Exact::of_parts(coefficient(&[], &terms, &means), INPUTS, &parts)
}

/// Returns the coefficient C_u of the product of the centred w_i of `set`, u.
fn coefficient(set: &[usize], terms: &[(Vec<usize>, f64)], means: &[f64; INPUTS]) -> f64 {
    let wider = terms.iter().filter(|(term, _)| set.iter().all(|i| term.contains(i)));
    wider.map(|(term, b)| b * term.iter().filter(|i| !set.contains(i)).map(|&i| means[i]).product::<f64>()).sum()
}

/// Returns every term with its inputs and its coefficient; each subset of a term's inputs is a separate term.
fn terms() -> Vec<(Vec<usize>, f64)> {
    let mut terms = vec![(vec![0, 1, 2, 3], QUADRUPLE)];
    for i in 0..INPUTS {
        terms.push((vec![i], single(i)));
        for j in i + 1..INPUTS {
            terms.push((vec![i, j], double(i, j)));
            terms.extend((j + 1..5).map(|k| (vec![i, j, k], TRIPLE)));
        }
    }
    terms
}
