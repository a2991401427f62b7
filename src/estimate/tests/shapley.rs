use super::*;

/// Owen and Prieur (2017), SIAM/ASA J. Uncertain. Quantif. 5, 986-1002, section 4: of x1 + x2 with correlation r, the effects
/// are (1 + r^2 ... )/2 each by symmetry; with weights b1, b2: phi_1 V = b1^2 s1^2 (1 - r^2/2) + b2^2 s2^2 r^2/2 + b1 b2 r s1 s2.
#[test]
fn two_normal_factors_have_a_closed_form() {
    let (b1, b2, r) = (2.0f64, 1.0f64, 0.6f64);
    let variance = b1 * b1 + b2 * b2 + 2.0 * r * b1 * b2;
    let cost = |b: f64| b * b * (1.0 - r * r) / variance;
    let effects = shapley_effects(&[cost(b1), cost(b2)], &[]);
    let expected = (b1 * b1 * (1.0 - r * r / 2.0) + b2 * b2 * r * r / 2.0 + b1 * b2 * r) / variance;
    assert!((effects[0] - expected).abs() < 1e-15 && (effects[0] + effects[1] - 1.0).abs() < 1e-15);
}

#[test]
fn additive_costs_are_their_own_effects_and_symmetric_ones_are_shared_out() {
    let single = [0.1, 0.2, 0.3, 0.4];
    let proper: Vec<f64> = proper_subsets(4).iter().map(|u| u.iter().map(|&j| single[j]).sum()).collect();
    let effects = shapley_effects(&single, &proper);
    assert!(effects.iter().zip(single).all(|(a, b)| (a - b).abs() < 1e-15), "{effects:?}");
    // Only all factors together have an effect: x1 x2 x3 of mean 0.
    let effects = shapley_effects(&[1.0; 3], &[1.0; 3]);
    assert!(effects.iter().all(|x| (x - 1.0 / 3.0).abs() < 1e-15), "{effects:?}");
    assert_eq!(shapley_effects(&[0.7], &[]), [1.0]);
    assert_eq!(proper_subsets(3), [vec![0, 1], vec![0, 2], vec![1, 2]]);
}
