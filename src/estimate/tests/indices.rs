use super::*;
use crate::estimate::{BlockOutputs, Workspace};

fn indices(a: &[f64], b: &[f64], swapped: &[f64]) -> Result<Indices, Undefined> {
    let block = BlockOutputs { a, b, ab: &[swapped], ..BlockOutputs::default() };
    Indices::from_moments(&Moments::of_block(block, &mut Workspace::default()))
}

#[test]
fn constant_outputs_have_a_name_at_any_size() {
    for value in [0.0, 0.1, 1e300, 1.0 / 3.0, 1e-150, 1e-300, -5e-324] {
        let y = vec![value; 100];
        assert_eq!(indices(&y, &y, &y), Err(Undefined::ZeroVariance), "{value}");
    }
}

#[test]
fn a_rare_event_in_only_one_sample_has_indices_without_a_check() {
    // y is 1 in a single row of A, and B has no such row: B and AB, with the factor from B, are 0 everywhere.
    let zero = [0.0; 16];
    let mut a = zero;
    a[5] = 1.0;
    let got = indices(&a, &zero, &zero).unwrap();
    // One of the 48 values of A, B and AB is 1, none of those of B and AB, and one of the 32 of A and AB. The covariance of
    // y_A and y_B about f0 = 1/32 is -1/32^2.
    let (all, covariance) = ((1.0 / 48.0) * (47.0 / 48.0), -1.0 / 1024.0);
    // S = mean (y_B - f0)(y_AB - y_A)/D = (1/32)(1/16)/D, D = S (V3 - cov)/2 + (1 - S)(V3 - cov).
    let (s, denominator) = (got.first_order[0], all - covariance);
    assert!((s * (1.0 - s / 2.0) * denominator - 1.0 / 512.0).abs() < 1e-14, "{got:?}");
    // ST = mean (y_AB - y_A)^2/2/V = (1/32)/((1/32)(31/32)), more than 1.
    assert!((got.total[0] - 32.0 / 31.0).abs() < 1e-14, "{got:?}");
    assert!(got.check[0].is_nan());
}

#[test]
fn variances_beyond_double_precision_have_a_name() {
    let y: Vec<f64> = (1..100).map(f64::from).collect();
    let scaled = |scale: f64| y.iter().map(|y| y * scale).collect::<Vec<_>>();
    for scale in [1e-170, 1e-200, 1e200] {
        let y = scaled(scale);
        assert_eq!(indices(&y, &y, &y), Err(Undefined::Unrepresentable), "{scale}");
    }
    let signs: Vec<f64> = (0..100).map(|i| if i % 2 == 0 { 1e-170 } else { -1e-170 }).collect();
    assert_eq!(indices(&signs, &signs, &signs), Err(Undefined::Unrepresentable));
    let b: Vec<f64> = y.iter().rev().copied().collect();
    let large: Vec<f64> = y.iter().map(|y| y * 1e160).collect();
    assert_eq!(indices(&y, &b, &large), Err(Undefined::Unrepresentable));
    let offset: Vec<f64> = y.iter().map(|y| 1e15 + y / 100.0).collect();
    assert_eq!(indices(&offset, &offset, &offset), Err(Undefined::BelowRounding));
    assert!(indices(&scaled(1e-100), &scaled(1e-100), &scaled(1e-100)).is_ok());
}
