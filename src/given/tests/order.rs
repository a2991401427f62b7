use proptest::prelude::*;

use super::*;

#[test]
fn small_orders_by_hand() {
    let order = Order::from_values(&[3.0, -0.0, 3.0, 1.0, 0.0]);
    let groups: Vec<&[usize]> = order.iter().collect();
    assert_eq!(groups, [&[1, 4][..], &[3], &[0, 2]]);
    assert_eq!((order.groups(), order.tied_pairs()), (3, 2.0));
    assert_eq!(order.labels(), [2, 0, 2, 1, 0]);
    assert_eq!(order.centred_ranks(), [1.5, -1.5, 1.5, 0.0, -1.5]);
    assert_eq!(order.classes(2), Partition { labels: vec![1, 0, 1, 0, 0], count: 2 });
    assert_eq!(Order::from_values(&[2.0; 4]).classes(3), Partition { labels: vec![0; 4], count: 1 });
}

#[test]
fn values_without_ties_fill_classes_evenly() {
    let values: Vec<f64> = (0..64).map(|k| f64::from(k * 37 % 64)).collect();
    let Partition { labels: classes, count } = Order::from_values(&values).classes(8);
    assert_eq!(count, 8);
    for class in 0..8 {
        assert_eq!(classes.iter().filter(|&&c| c == class).count(), 8);
    }
}

proptest! {
    #[test]
    fn classes_keep_ties_and_a_least_size(values in prop::collection::vec(0..9i32, 2..80), wanted in 1..12usize) {
        let values: Vec<f64> = values.into_iter().map(f64::from).collect();
        let Partition { labels: classes, count } = Order::from_values(&values).classes(wanted);
        prop_assert!(count <= wanted.max(1));
        for class in 0..count {
            let size = classes.iter().filter(|&&c| c == class).count();
            prop_assert!(size >= values.len().div_ceil(2 * wanted) || count == 1);
        }
        for (i, a) in values.iter().enumerate() {
            for (j, b) in values.iter().enumerate() {
                prop_assert!(a != b || classes[i] == classes[j]);
                prop_assert!(a >= b || classes[i] <= classes[j]);
            }
        }
    }

    #[test]
    fn shuffling_stays_within_ties(values in prop::collection::vec(0..5i32, 2..60), seed in any::<u64>()) {
        let values: Vec<f64> = values.into_iter().map(f64::from).collect();
        let order = Order::from_values(&values);
        let mut rows = order.shuffled(seed, 3);
        prop_assert_eq!(&rows, &order.shuffled(seed, 3));
        prop_assert!(rows.windows(2).all(|pair| values[pair[0]] <= values[pair[1]]));
        rows.sort_unstable();
        prop_assert_eq!(rows, (0..values.len()).collect::<Vec<_>>());
    }
}
