use super::*;
use crate::surrogate::Term;
use crate::surrogate::chaos::Factor;
use crate::surrogate::family::{Family, polynomials};

const X: [[f64; 8]; 2] = [[0.1, 0.9, 0.35, 0.7, 0.2, 0.55, 0.8, 0.05], [-1.0, 0.5, 0.0, 2.0, 1.5, -0.5, 0.25, 0.75]];

fn model(a: f64, b: f64) -> f64 {
    a + b * b - 2.0 * a * b
}

/// Returns V, V_1, V_2, VT_1, VT_2 if the rows have these weights in the distribution of each input.
fn variances(weights: &[f64]) -> [f64; 5] {
    let mean = |of: &dyn Fn(usize) -> f64| -> f64 { (0..8).map(|i| weights[i] * of(i)).sum() };
    let all = mean(&|i| mean(&|j| model(X[0][i], X[1][j])));
    let one = mean(&|i| mean(&|j| model(X[0][i], X[1][j])).powi(2)) - all * all;
    let two = mean(&|j| mean(&|i| model(X[0][i], X[1][j])).powi(2)) - all * all;
    let both = mean(&|i| mean(&|j| model(X[0][i], X[1][j]).powi(2))) - all * all;
    [both, one, two, both - two, both - one]
}

#[test]
fn influences_are_derivatives_by_the_weights_of_rows() {
    let columns: Vec<Vec<Vec<f64>>> = X.iter().map(|x| polynomials(&Family::of_column(x), x, 2)).collect();
    let terms: Vec<Term> = vec![vec![], vec![(0, 1)], vec![(1, 1)], vec![(1, 2)], vec![(0, 1), (1, 1)]];
    let value = |term: &Term, rows: [usize; 2]| -> f64 {
        term.iter().map(|&(input, degree)| columns[input][degree - 1][rows[input]]).product()
    };
    let coefficient = |term: &Term| -> f64 {
        let all = (0..8).flat_map(|i| (0..8).map(move |j| [i, j]));
        all.map(|[i, j]| model(X[0][i], X[1][j]) * value(term, [i, j])).sum::<f64>() / 64.0
    };
    let expansion = Expansion { coefficients: terms.iter().map(coefficient).collect(), terms: terms.into() };
    let factors = X.iter().map(|x| Factor::new(&Family::of_column(x), x, 2)).collect();
    let Influences { variance, first_order, total } =
        Influences::new(&Basis { factors, rows: 8, parts: Vec::new() }, &expansion);
    let influences: Vec<Vec<f64>> = [vec![variance], first_order, total].concat();
    for row in 0..8 {
        let step = 1e-4;
        let moved = |step: f64| -> Vec<f64> {
            (0..8).map(|i| (1.0 - step) / 8.0 + if i == row { step } else { 0.0 }).collect()
        };
        let (up, down) = (variances(&moved(step)), variances(&moved(-step)));
        for (number, influences) in influences.iter().enumerate() {
            let derivative = (up[number] - down[number]) / (2.0 * step);
            assert!((influences[row] - derivative).abs() < 1e-6, "{number} {row}: {} {derivative}", influences[row]);
        }
    }
}
