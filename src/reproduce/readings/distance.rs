//! How far percentages are from the printed ones.

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
    let printed = published(group, "lugre").shares;
    let mut differences: Vec<f64> = printed.iter().map(|(_, share)| -share).collect();
    let mut rest = -printed_rest(group);
    for (factor, share) in shares {
        match printed.iter().position(|(name, _)| *name == factor) {
            Some(place) => differences[place] += share,
            None => rest += share,
        }
    }
    differences.push(rest);
    (differences.iter().map(|difference| difference * difference).sum::<f64>() / differences.len() as f64).sqrt()
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
}
