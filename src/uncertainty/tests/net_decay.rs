use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::uncertainty::Side;
use crate::uncertainty::t_interval;

const POOLED: ErrorKind = ErrorKind { side: Side::Both, is_pooled: true };

/// Returns pseudo-random numbers about 0 with variance 1/12.
fn noise(n: usize, seed: u64) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    (0..n).map(|_| random.random_range(-0.5..0.5)).collect()
}

#[test]
fn independent_parts_have_the_error_of_their_mean() {
    // 40 quantities, 2 nets, 64 independent parts each: the error of a mean of 128 is sd/sqrt(128). The trend is
    // not trusted to be that of random points: intervals are wider than 1.96 such errors, by less than half.
    let quantities: Vec<PartInfluences> = (0..40).map(|q| vec![noise(64, 2 * q + 1), noise(64, 2 * q + 2)]).collect();
    let errors = net_errors(&quantities, &[POOLED; 40]);
    let half_width = |error: &StandardError| t_interval(0.0, *error).unwrap().high;
    let mean = errors.iter().map(half_width).sum::<f64>() / 40.0;
    let exact = 1.96 * (1.0f64 / 12.0 / 128.0).sqrt();
    assert!((0.9..1.5).contains(&(mean / exact)), "{}", mean / exact);
    assert!(errors.iter().all(|e| e.freedom > 2.5 && e.freedom < 6.0));
}

#[test]
fn a_quantity_without_influence_has_no_error() {
    let errors = net_errors(&[vec![vec![0.0; 8]; 2], vec![noise(8, 1), noise(8, 2)]], &[POOLED; 2]);
    assert_eq!(errors[0].error, 0.0);
    assert!(errors[1].error > 0.0);
}

#[test]
fn errors_scale_with_the_quantity_at_any_size() {
    let base = [vec![noise(64, 5), noise(64, 6)], vec![noise(64, 7), noise(64, 8)]];
    let expected = net_errors(&base, &[POOLED; 2]);
    for scale in [1e-150, 1e-30, 1e150] {
        let scaled: Vec<PartInfluences> =
            base.iter().map(|q| q.iter().map(|net| net.iter().map(|x| x * scale).collect()).collect()).collect();
        for (got, expected) in net_errors(&scaled, &[POOLED; 2]).iter().zip(&expected) {
            assert!((got.error / scale / expected.error - 1.0).abs() < 1e-9);
            assert!((got.freedom / expected.freedom - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn one_net_uses_only_the_trend_and_one_part_only_the_spread() {
    let single = net_errors(&[vec![noise(64, 3)]], &[POOLED])[0];
    assert!(single.error > 0.0 && single.freedom > 1.0 && single.freedom < 8.0);
    let spread = net_errors(&[vec![vec![-1.0], vec![1.0]]], &[POOLED])[0];
    assert_eq!(spread, StandardError { error: 1.0, freedom: 1.0 });
    assert!(net_errors(&[vec![vec![1.0]]], &[POOLED])[0].error.is_nan());
}

#[test]
fn an_incomplete_net_counts_its_chain_of_nets() {
    let shape = |parts: usize| Shape { nets: 1, parts, depth: parts.ilog2() as usize };
    assert_eq!(incomplete(&shape(64), 0.25), 1.0);
    // Random points: the variance is proportional to 1/points for any chain.
    assert!((incomplete(&shape(96), 0.5) - 64.0 / 96.0).abs() < 1e-15);
    // 96 = 64 + 32 parts at rho = 1/4, where the variance is proportional to points^-2: (4/9) 1 + (1/9) 4.
    assert!((incomplete(&shape(96), 0.25) - 8.0 / 9.0).abs() < 1e-15);
}
