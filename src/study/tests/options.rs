use super::*;

#[test]
fn a_number_of_runs_is_a_power_of_two_base_points_in_each_replicate() {
    assert_eq!(base_samples_within(300, 10, 4), Ok(16));
    assert_eq!(base_samples_within(80, 10, 4), Ok(8));
    assert_eq!(base_samples_within(79, 10, 4), Err(80));
    assert_eq!(base_samples_within(1 << 60, u64::MAX, 4), Err(u64::MAX));
    for (runs, per_point) in [(97, 5), (480, 10), (1000, 3), (5000, 22), (1 << 40, 10)] {
        let base = base_samples_within(runs, per_point, 4).unwrap();
        assert!(base * per_point <= runs && 2 * base * per_point > runs && (base / 4).is_power_of_two());
    }
}
