//! How far percentages are from the printed ones.

use super::Share;
use crate::reproduce::published;

/// What the printed percentages of `group` leave for the factors without one, in percent: 100 minus their sum.
pub fn printed_rest(group: &str) -> f64 {
    100.0 - published(group, "lugre").shares.iter().map(|(_, share)| share).sum::<f64>()
}

/// The distance of `shares`, percentages of all factors of the study `group`, to those that LG prints, in percentage
/// points: the root mean square of the differences over the printed factors and, as one more, the sum of all other
/// factors, which is printed implicitly as what remains to 100 ([`printed_rest`]). A printed factor without a share
/// counts as one of 0.
///
/// ```
/// use apportion::reproduce::readings::distance;
///
/// assert_eq!(distance("environmental", [("elastic_modulus", 74.0), ("velocity", 26.0), ("adhesion", 0.0)]), 0.0);
/// // 74 and 26 are missed by 3, the rest is met: the root of (9 + 9 + 0)/3.
/// let distance = distance("environmental", [("elastic_modulus", 77.0), ("velocity", 23.0)]);
/// assert!((distance - 6_f64.sqrt()).abs() < 1e-12);
/// ```
pub fn distance<'a>(group: &str, shares: impl IntoIterator<Item = (&'a str, f64)>) -> f64 {
    let printed = published(group, "lugre").shares.iter().map(|(_, share)| *share).chain([printed_rest(group)]);
    let ours = lumped(group, shares);
    root_mean_square(&ours.iter().zip(printed).map(|(ours, printed)| ours - printed).collect::<Vec<f64>>())
}

/// How far off the distance of `shares` is at most if every share lies in its interval, in percentage points; `None` if
/// one has none. A distance is a norm of differences, so it changes by no more than the norm of their changes.
pub(super) fn distance_error(group: &str, shares: &[Share]) -> Option<f64> {
    let mut half_widths = Vec::with_capacity(shares.len());
    for share in shares {
        let (low, high) = share.interval?;
        half_widths.push((share.factor.as_str(), (high - low) / 2.0));
    }
    Some(root_mean_square(&lumped(group, half_widths)))
}

/// The numbers of the printed factors in their order, then the sum of those of all others.
fn lumped<'a>(group: &str, numbers: impl IntoIterator<Item = (&'a str, f64)>) -> Vec<f64> {
    let printed = published(group, "lugre").shares;
    let mut lumped = vec![0.0; printed.len() + 1];
    for (factor, number) in numbers {
        lumped[printed.iter().position(|(name, _)| *name == factor).unwrap_or(printed.len())] += number;
    }
    lumped
}

fn root_mean_square(numbers: &[f64]) -> f64 {
    (numbers.iter().map(|x| x * x).sum::<f64>() / numbers.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::GROUPS;

    #[test]
    fn equal_shares_have_distance_zero() {
        for group in GROUPS {
            let printed = published(group.key, "lugre").shares.iter().copied();
            // The rest on one factor, or on several: they count together.
            let rest = printed_rest(group.key);
            assert_eq!(distance(group.key, printed.clone().chain([("height", rest)])), 0.0);
            assert_eq!(distance(group.key, printed.chain([("height", rest - 5.0), ("adhesion", 5.0)])), 0.0);
        }
    }

    #[test]
    fn with_one_printed_factor_it_is_the_difference() {
        let shares = [("thickness", 55.3), ("length", 31.1), ("width", 13.6), ("height", 0.0)];
        // 1e-12: rounding of percentages.
        assert!((distance("dimensional", shares) - 20.7).abs() < 1e-12);
    }

    #[test]
    fn unnormalised_shares_count_as_they_are() {
        let none: [(&str, f64); 0] = [];
        let expected = ((76.0_f64.powi(2) + 24.0_f64.powi(2)) / 2.0).sqrt();
        assert!((distance("dimensional", none) - expected).abs() < 1e-12);
    }

    #[test]
    fn its_error_is_that_of_the_lumped_shares() {
        let share = |factor: &str, half: f64| Share {
            factor: factor.to_owned(),
            share: 50.0,
            interval: Some((50.0 - half, 50.0 + half)),
            published: None,
        };
        let shares = [share("thickness", 3.0), share("length", 1.5), share("width", 2.5)];
        let expected = ((9.0 + 16.0) / 2.0_f64).sqrt();
        assert!((distance_error("dimensional", &shares).unwrap() - expected).abs() < 1e-12);
        let without = Share { interval: None, ..share("height", 0.0) };
        assert_eq!(distance_error("dimensional", &[without]), None);
    }
}
