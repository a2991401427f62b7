use super::*;

#[test]
fn a_split_design_stays_within_its_runs_and_has_a_power_of_two_in_each_replicate() {
    assert_eq!(split(300, 10, 4, true), Ok((8, 27)));
    assert_eq!(split(300, 10, 4, false), Ok((16, 0)));
    assert_eq!(split(80, 10, 4, true), Ok((8, 0)));
    assert_eq!(split(79, 10, 4, true), Err(80));
    assert_eq!(split(1 << 60, u64::MAX, 4, true), Err(u64::MAX));
    for (runs, per_point) in [(97, 5), (480, 10), (1000, 3), (5000, 22), (1 << 40, 10)] {
        let (base, plain) = split(runs, per_point, 4, true).unwrap();
        assert!(base * (per_point + u64::from(plain)) <= runs && (base / 4).is_power_of_two());
        assert!(base == 8 || 8 * base * per_point >= runs && 3 * base * per_point <= runs, "{runs}: {base}");
    }
}
