//! Invariance: offset, scale, and the division of a sample into blocks.

use proptest::prelude::*;

use super::*;

/// The estimators that do not depend on an offset.
fn centred(all: Vec<(String, f64)>) -> Vec<(String, f64)> {
    let by_name = ["sobol-1993", "homma-saltelli-1996", "saltelli-2002", "sobol-2007"];
    all.into_iter().filter(|(name, _)| !by_name.iter().any(|uncentred| name.ends_with(uncentred))).collect()
}

#[test]
fn an_offset_of_1e9_changes_no_index_of_a_centred_estimator() {
    // On a lattice of 2^-20, which the offset leaves exact.
    let sample = Sample::noise(1000, 0.0).map(|y| (y * 1048576.0).round() / 1048576.0);
    let plain = centred(everything(&sample.moments()));
    assert_eq!(plain.len(), 2 * (7 + 6) + 1);
    for offset in [1.0, -1e6, 1e9] {
        let shifted = centred(everything(&sample.map(|y| y + offset).moments()));
        // A mean at 1e9 is known to 1e-7; it enters squared, or times the difference of two other means, here below
        // 0.05, over a variance of 0.1.
        assert_close(&shifted, &plain, 1e-7);
    }
}

#[test]
fn a_scale_changes_nothing() {
    let sample = Sample::noise(400, 0.3);
    let plain = everything(&sample.moments());
    for exponent in [-300, -100, -1, 70, 330, 500] {
        // A power of two scales without rounding: the same bits, as long as squares neither over- nor underflow.
        let scaled = everything(&sample.map(|y| y * 2f64.powi(exponent)).moments());
        assert_eq!(scaled, plain, "2^{exponent}");
    }
    for scale in [-1.0, 1e-120, 1e-30, 1e100, 1e150] {
        let scaled = everything(&sample.map(|y| y * scale).moments());
        assert_close(&scaled, &plain, 1e-12);
    }
}

proptest! {
    #[test]
    fn merged_blocks_equal_one_block_wherever_they_are_cut(
        mut cuts in prop::collection::vec(0usize..=300, 0..6),
        offset in prop::sample::select(vec![0.0, 3.0, -1e3]),
        failures in prop::collection::vec((0usize..6, 0usize..300), 0..40),
    ) {
        let mut sample = Sample::noise(300, offset);
        for (column, row) in failures {
            sample.columns()[column][row] = f64::NAN;
        }
        cuts.extend([0, 300]);
        cuts.sort_unstable();
        let mut merged = Moments::default();
        for cut in cuts.windows(2) {
            merged.merge(&sample.part(cut[0]..cut[1]).moments());
        }
        let all = sample.moments();
        for swap in 0..2 {
            prop_assert_eq!(merged.swap(swap).base.n, all.swap(swap).base.n);
        }
        prop_assert_eq!((merged.count(), merged.constant()), (all.count(), all.constant()));
        // Means at 1e3 are known to 1e-13; the uncentred estimators multiply that by the offset over a variance of 0.1.
        let tolerance = 1e-11 * (1.0 + offset.abs());
        for ((name, merged), (_, all)) in everything(&merged).iter().zip(&everything(&all)) {
            prop_assert!((merged - all).abs() < tolerance, "{}: {} is not {}", name, merged, all);
        }
    }

    #[test]
    fn central_moments_merge_to_those_of_all_values(
        cut in 0usize..=500,
        offset in -1e3f64..1e3,
        exponent in -200i32..200,
    ) {
        let values: Vec<f64> = noise(500, 4).iter().map(|y| (libm::exp(*y) + offset) * 2f64.powi(exponent)).collect();
        let mut merged = CentralMoments::from_values(&values[..cut]);
        merged.merge(&CentralMoments::from_values(&values[cut..]));
        let all = CentralMoments::from_values(&values);
        prop_assert_eq!((merged.count(), merged.range()), (500, all.range()));
        let near = |a: Option<f64>, b: Option<f64>| (a.unwrap() / b.unwrap() - 1.0).abs() < 1e-9;
        prop_assert!(near(merged.mean(), all.mean()) && near(merged.variance(), all.variance()));
        // m4 of an output times 2^200 is 2^800: still a double.
        prop_assert!(near(merged.skewness(), all.skewness()));
        prop_assert!((merged.excess_kurtosis().unwrap() - all.excess_kurtosis().unwrap()).abs() < 1e-9);
    }
}

#[test]
fn merging_nothing_changes_nothing() {
    let block = Sample::noise(10, 0.0).moments();
    let (mut left, mut right) = (block.clone(), Moments::empty(2));
    left.merge(&Moments::empty(2));
    right.merge(&block);
    assert_eq!(left, block);
    assert_eq!(right, block);
}

#[test]
fn central_moments_of_known_distributions() {
    // Uniform on an even grid of n points: variance (n^2 - 1)/12, no skewness, kurtosis -6/5 (n^2 + 1)/(n^2 - 1).
    let grid: Vec<f64> = (0..1001).map(|i| 1e6 + f64::from(i)).collect();
    let moments = CentralMoments::from_values(&grid);
    let n2 = 1001.0f64.powi(2);
    assert_eq!((moments.mean(), moments.range()), (Some(1_000_500.0), Some((1e6, 1_001_000.0))));
    assert!((moments.variance().unwrap() / ((n2 - 1.0) / 12.0) - 1.0).abs() < 1e-14);
    assert!(moments.skewness().unwrap().abs() < 1e-14);
    assert!((moments.excess_kurtosis().unwrap() + 1.2 * (n2 + 1.0) / (n2 - 1.0)).abs() < 1e-13);
    // One 1 among n - 1 zeros, p = 1/n: skewness (1 - 2p)/sqrt(p(1 - p)), kurtosis (1 - 6p(1 - p))/(p(1 - p)).
    let mut rare = vec![0.0; 50];
    rare[7] = 1.0;
    let (moments, pq) = (CentralMoments::from_values(&rare), 0.02 * 0.98f64);
    assert!((moments.skewness().unwrap() - 0.96 / pq.sqrt()).abs() < 1e-13);
    assert!((moments.excess_kurtosis().unwrap() - (1.0 - 6.0 * pq) / pq).abs() < 1e-12);
}

#[test]
fn central_moments_without_values_or_variance_say_so() {
    let mut moments = CentralMoments::from_values(&[0.0, 0.0, f64::NAN, 0.0]);
    moments.merge(&CentralMoments::from_values(&[4.0]));
    assert_eq!((moments.count(), moments.mean(), moments.variance()), (4, Some(1.0), Some(3.0)));
    let none = CentralMoments::from_values(&[f64::NAN, f64::INFINITY]);
    assert_eq!((none.count(), none.mean(), none.variance(), none.range()), (0, None, None, None));
    assert_eq!((none.skewness(), none.excess_kurtosis()), (None, None));
    let constant = CentralMoments::from_values(&[0.1; 30]);
    assert_eq!((constant.mean(), constant.variance()), (Some(0.1), Some(0.0)));
    assert_eq!((constant.skewness(), constant.excess_kurtosis()), (None, None));
}
