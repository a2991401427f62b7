use proptest::prelude::*;

use super::*;

proptest! {
    #[test]
    fn distances_are_differences_of_distribution_functions(
        rows in prop::collection::vec((0..12i32, 0..4usize), 2..60)
    ) {
        let z: Vec<f64> = rows.iter().map(|row| f64::from(row.0)).collect();
        let labels: Vec<usize> = rows.iter().map(|row| row.1).collect();
        let got = distances(&Order::from_values(&z), &Partition { labels: labels.clone(), count: 4 });
        let below = |value: f64, class: Option<usize>| {
            let of = |k: &usize| class.is_none_or(|class| labels[*k] == class);
            (0..z.len()).filter(of).filter(|&k| z[k] <= value).count() as f64 / (0..z.len()).filter(of).count() as f64
        };
        for (class, got) in got.iter().enumerate().filter(|(class, _)| labels.contains(class)) {
            let gaps = (-1..12).map(|value| (below(value.into(), Some(class)) - below(value.into(), None)).abs());
            prop_assert!((got - gaps.fold(0.0, f64::max)).abs() < 1e-14);
        }
    }
}
