use super::*;

#[test]
fn heavy_tails_are_warned_of_and_small_samples_are_not() {
    // 3 rows of 1000 have another value: g2 + 3 = 1/p - 3 + 3 p..., n/(g2 + 3) = 3.0.
    let rare: Vec<f64> = (0..1000).map(|i| f64::from(u8::from(i % 400 == 0))).collect();
    let Some(Warning::FewRows { rows, values: 1000, .. }) = of_values(&CentralMoments::from_values(&rare)) else {
        panic!("no warning of few rows");
    };
    assert_eq!(rows.round(), 3.0);
    let normal: Vec<f64> = (0..16).map(|i| f64::from(i * i)).collect();
    assert_eq!(of_values(&CentralMoments::from_values(&normal)), None);
    assert_eq!(of_values(&CentralMoments::from_values(&[1.0; 8])), None);
    let many: Vec<f64> = rare.iter().cycle().take(20_000).copied().collect();
    assert_eq!(of_values(&CentralMoments::from_values(&many)), None);
}

#[test]
fn lost_digits_are_warned_of() {
    // Steps of 1/8 about 1e15, for a standard deviation of 0.5: an error of 4/4.
    let shifted: Vec<f64> = (0..8).map(|i| 1e15 + f64::from(i % 2)).collect();
    assert_eq!(of_digits(&CentralMoments::from_values(&shifted)), Some(Warning::FewDigits { error: 1.0 }));
    let near: Vec<f64> = (0..8).map(|i| 1e11 + f64::from(i % 2)).collect();
    assert_eq!(of_digits(&CentralMoments::from_values(&near)), None);
    assert_eq!(of_digits(&CentralMoments::from_values(&[1.0; 8])), None);
}
