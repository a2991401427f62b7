use super::*;

#[test]
fn every_draw_is_counted_and_every_point_as_likely() {
    // 5000 points: not a power of two, so that words are rejected; 400 resamples.
    let (points, resamples) = (5000usize, 400u64);
    let mut totals = vec![0u64; points];
    let (mut counts, mut squares) = (Vec::new(), 0u64);
    for resample in 0..resamples {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        random.set_stream(resample);
        count(&mut counts, points as u64, points, &mut random);
        assert_eq!(counts.iter().map(|c| u64::from(*c)).sum::<u64>(), points as u64);
        totals.iter_mut().zip(&counts).for_each(|(total, count)| *total += u64::from(*count));
        squares += counts.iter().map(|c| u64::from(*c).pow(2)).sum::<u64>();
    }
    // Each total is binomial with mean and variance 400: chi-squared over the points has mean 4999 and standard
    // deviation 100, and 5 of them are allowed. E count^2 = 2 - 1/n.
    let chi: f64 = totals.iter().map(|t| (*t as f64 - 400.0).powi(2) / 400.0).sum();
    assert!((chi - 4999.0).abs() < 500.0, "{chi}");
    let mean_square = squares as f64 / (points as u64 * resamples) as f64;
    assert!((mean_square - 2.0).abs() < 0.01, "{mean_square}");
}
