use super::*;
use crate::uncertainty::t_interval;

const ERROR: StandardError = StandardError { error: 0.1, freedom: 5.0 };

#[test]
fn one_part_that_carries_all_makes_the_interval_long_above() {
    let mut parts = vec![vec![-0.01; 32]; 4];
    parts[1][7] = 1.0;
    let even = t_interval(0.3, ERROR).unwrap();
    let above = interval(0.3, ERROR, &parts, Side::Above).unwrap();
    assert_eq!(above.low, even.low);
    // 1/f' = 1/5 + 1.5 (1 - 3/128) is below the minimum of 1.5 degrees of freedom, whose quantile is 6.0.
    assert!((above.high - 0.3 - 0.1 * t_quantile(1.5).unwrap()).abs() < 1e-12, "{above:?}");
    let both = interval(0.3, ERROR, &parts, Side::Both).unwrap();
    assert_eq!((both.high, (0.3 - both.low - (both.high - 0.3)).abs() < 1e-12), (above.high, true));
}

#[test]
fn parts_alike_leave_the_interval_as_it_was() {
    let parts: PartInfluences =
        (0..4).map(|net| (0..32).map(|i| f64::from((i * 7 + net * 3) % 32) - 15.5).collect()).collect();
    assert_eq!(interval(0.3, ERROR, &parts, Side::Above), t_interval(0.3, ERROR));
    // Scale does not matter, and without influences there is no kurtosis.
    let small: PartInfluences = parts.iter().map(|net| net.iter().map(|x| x * 1e-200).collect()).collect();
    assert!((excess_kurtosis(&small) - excess_kurtosis(&parts)).abs() < 1e-12);
    assert_eq!(excess_kurtosis(&vec![vec![0.0; 8]; 2]), 0.0);
}

#[test]
fn no_interval_without_an_error_and_none_longer_than_its_own_freedom_allows() {
    let parts = vec![vec![1.0, 0.0, 0.0, 0.0]; 1];
    let unknown = StandardError { error: f64::NAN, freedom: 0.0 };
    assert_eq!(interval(0.3, unknown, &parts, Side::Above), None);
    let one = StandardError { error: 0.1, freedom: 1.0 };
    assert_eq!(interval(0.3, one, &parts, Side::Above), t_interval(0.3, one));
}
