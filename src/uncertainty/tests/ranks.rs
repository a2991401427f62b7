use super::*;
use crate::uncertainty::Interval;

fn error(error: f64, freedom: f64) -> StandardError {
    StandardError { error, freedom }
}

fn first(estimates: &[f64], errors: &[StandardError], parts: &[&PartInfluences], seed: u64) -> Option<Vec<f64>> {
    let ranked: Vec<Judgement> =
        (0..parts.len()).map(|k| Judgement::new(Estimate::alone(estimates[k]), errors[k], parts[k].clone())).collect();
    probability_first(&ranked.iter().collect::<Vec<_>>(), seed, 4096)
}

#[test]
fn two_independent_normals_rank_as_their_difference_says() {
    // Many degrees of freedom: P(X1 > X2) = Phi((m1 - m2)/sqrt(s1^2 + s2^2)) = Phi(1) = 0.8413.
    let parts = [vec![vec![1.0, -1.0, 0.0, 0.0]], vec![vec![0.0, 0.0, 1.0, -1.0]]];
    let errors = [error(0.3, 1e6), error(0.4, 1e6)];
    let got = first(&[1.5, 1.0], &errors, &[&parts[0], &parts[1]], 1).unwrap();
    // Standard error of a share of 4096 draws: 0.0057.
    assert!((got[0] - 0.8413).abs() < 0.025, "{got:?}");
    assert!((got[0] + got[1] - 1.0).abs() < 1e-12);
}

#[test]
fn a_common_error_does_not_change_the_order() {
    let parts = vec![vec![1.0, -1.0]];
    let got = first(&[1.0, 0.9], &[error(1.0, 5.0); 2], &[&parts, &parts], 1).unwrap();
    assert_eq!(got, [1.0, 0.0]);
}

#[test]
fn coordinates_keep_lengths_and_angles() {
    let directions = vec![vec![1.0, 0.0, 0.0], vec![0.6, 0.8, 0.0], vec![1.0, 0.0, 0.0], vec![0.0; 3]];
    let short = coordinates(directions);
    assert_eq!(short, [vec![1.0], vec![0.6, 0.8], vec![1.0, 0.0], vec![0.0, 0.0, 1.0]]);
}

#[test]
fn what_no_part_moves_may_still_be_first() {
    let (moved, unmoved) = (vec![vec![1.0, -1.0]], vec![vec![0.0, 0.0]]);
    let got = first(&[0.1, 0.0], &[error(1e-9, 1e6), error(0.1, 1e6)], &[&moved, &unmoved], 1).unwrap();
    // Phi(-1) = 0.1587.
    assert!((got[1] - 0.1587).abs() < 0.02, "{got:?}");
}

#[test]
fn certain_and_unknown_errors() {
    let none = vec![vec![0.0, 0.0]];
    let got = first(&[0.2, 0.5, 0.1], &[error(0.0, 3.0); 3], &[&none; 3], 0).unwrap();
    assert_eq!(got, [0.0, 1.0, 0.0]);
    let parts = vec![vec![1.0, -1.0]];
    let idle = first(&[0.5, 0.0], &[error(0.4, 1.0), error(0.0, 1.0)], &[&parts, &none], 0).unwrap();
    assert_eq!(idle, [1.0, 0.0]);
    let tied = first(&[0.0, 0.0], &[error(0.0, 3.0); 2], &[&none; 2], 0).unwrap();
    assert_eq!(tied, [0.5, 0.5]);
    assert_eq!(first(&[0.2, 0.5], &[error(f64::NAN, 0.0); 2], &[&none; 2], 0), None);
    let plain = |estimate: f64| Estimate::alone(estimate);
    assert_eq!(probability_above(plain(0.2), error(0.0, 1.0), 0.1), Some(1.0));
    assert_eq!(probability_above(plain(0.1), error(0.1, 4.0), 0.1), Some(0.5));
    assert_eq!(probability_above(plain(0.1), error(f64::NAN, 0.0), 0.1), None);
}

#[test]
fn a_wide_interval_gives_no_certainty() {
    let estimate = Estimate { estimate: 0.2, interval: Some(Interval { low: 0.0, high: 0.21 }) };
    for freedom in [3.0, 50.0, 1e9] {
        let above = |threshold: f64| probability_above(estimate, error(0.005, freedom), threshold).unwrap();
        assert!((above(0.0) - 0.975).abs() < 1e-6, "{freedom}: {}", above(0.0));
        assert!(above(0.01) < 0.975 && above(0.19) > 0.5 && above(0.21) < 0.08);
    }
}
