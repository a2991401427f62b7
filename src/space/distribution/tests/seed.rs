use super::*;

#[test]
fn seeds_of_near_coordinates_are_spread_evenly_and_differ() {
    let seed = Distribution::seed();
    let n = 4096;
    let seeds: Vec<f64> = (0..n).map(|i| seed.quantile(0.3 + 1e-9 * f64::from(i))).collect();
    let (low, high) = seed.support();
    assert!(seeds.iter().all(|seed| seed.fract() == 0.0 && (low..=high).contains(seed)));
    let distinct: std::collections::BTreeSet<u64> = seeds.iter().map(|seed| *seed as u64).collect();
    assert_eq!(distinct.len(), seeds.len());
    // Both ends of the bits: some generators use only the lower ones.
    for part in [|seed: f64| seed / 2f64.powi(31), |seed: f64| (seed % 1024.0) / 1024.0] {
        let mean = seeds.iter().map(|seed| part(*seed)).sum::<f64>() / f64::from(n);
        assert!((mean - 0.5).abs() < 4.0 * (1.0 / 12.0 / f64::from(n)).sqrt(), "{mean}");
    }
    assert_eq!(seed.tails(high), (1.0, 0.0));
    assert_eq!(seed.tails(2f64.powi(30) - 1.0), (0.5, 0.5));
    let lengths = Unit::parse("um").map(|unit| seed.to_si(&unit));
    assert!(matches!(lengths, Ok(Err(_))));
}
