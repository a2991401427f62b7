use proptest::prelude::*;

use super::*;

fn rank_first_order(x: &[f64], y: &[f64], seed: u64) -> Estimate {
    of_order(&Order::from_values(x), &crate::given::centred(y).unwrap(), seed, 0)
}

/// Evaluates the formula as printed, ties in the order of `rows`.
fn printed(rows: &[usize], y: &[f64]) -> f64 {
    let n = y.len();
    let mean = y.iter().sum::<f64>() / n as f64;
    let products: f64 = (0..n).map(|k| y[rows[k]] * y[rows[(k + 1) % n]]).sum();
    let squares: f64 = y.iter().map(|y| y * y).sum();
    (products / n as f64 - mean * mean) / (squares / n as f64 - mean * mean)
}

#[test]
fn without_ties_it_is_the_printed_formula() {
    let x = [0.3, 0.1, 0.9, 0.5, 0.7, 0.2];
    let y = [1.0, 4.0, -2.0, 3.0, 0.5, 7.0];
    let got = rank_first_order(&x, &y, 0).estimate;
    // A few roundings of numbers of order one.
    assert!((got - printed(&[1, 5, 0, 3, 4, 2], &y)).abs() < 1e-14);
}

#[test]
fn ties_are_averaged_over_their_orders() {
    let x = [1.0, 1.0, 1.0, 2.0, 3.0, 3.0];
    let y = [1.0, 4.0, -2.0, 3.0, 0.5, 7.0];
    let mut sum = 0.0;
    for first in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        for last in [[4, 5], [5, 4]] {
            let rows: Vec<usize> = first.into_iter().chain([3]).chain(last).collect();
            sum += printed(&rows, &y);
        }
    }
    let got = rank_first_order(&x, &y, 0).estimate;
    assert!((got - sum / 12.0).abs() < 1e-14);
}

proptest! {
    #[test]
    fn shift_scale_and_monotone_inputs_change_nothing(
        rows in prop::collection::vec((0.0..1.0f64, -1.0..1.0f64), 30..60), shift in -1e6..1e6f64, exponent in -280..280i32,
    ) {
        let (x, y): (Vec<f64>, Vec<f64>) = rows.into_iter().unzip();
        let reference = rank_first_order(&x, &y, 1);
        let scale = 10f64.powi(exponent);
        let moved: Vec<f64> = y.iter().map(|y| (y + shift) * scale).collect();
        let x_exp: Vec<f64> = x.iter().map(|x| libm::exp(5.0 * x)).collect();
        let got = rank_first_order(&x_exp, &moved, 1);
        // The offset costs up to 6 of 16 digits of each value.
        prop_assert!((got.estimate - reference.estimate).abs() < 1e-8);
        let (a, b) = (got.interval.unwrap(), reference.interval.unwrap());
        prop_assert!((a.low - b.low).abs() < 1e-7 && (a.high - b.high).abs() < 1e-7);
        prop_assert!(a.low <= got.estimate && got.estimate <= a.high);
    }

    #[test]
    fn row_order_changes_nothing_but_rounding(
        rows in prop::collection::vec((0..6i32, -1.0..1.0f64), 30..60), turn in 1..29usize,
    ) {
        let of = |rows: &[(i32, f64)]| {
            let (x, y): (Vec<f64>, Vec<f64>) = rows.iter().map(|r| (f64::from(r.0), r.1)).unzip();
            rank_first_order(&x, &y, 1).estimate
        };
        let mut turned = rows.clone();
        turned.rotate_left(turn);
        prop_assert!((of(&rows) - of(&turned)).abs() < 1e-12);
    }
}
