//! Distances between distribution functions.

use crate::given::order::{Order, Partition};

/// Returns the distance of the distribution function of the rows of every class from that of all rows, `order` being
/// that of the output: the largest difference of the two, after Kolmogorov and Smirnov. 0 for a class without rows.
pub fn distances(order: &Order, Partition { labels, count }: &Partition) -> Vec<f64> {
    let (mut rows_of, mut largest) = (vec![0.0; *count], vec![0.0_f64; *count]);
    labels.iter().for_each(|&label| rows_of[label] += 1.0);
    let total = labels.len() as f64;
    let (mut passed, mut of_class) = (0.0, vec![0.0; *count]);
    for rows in order.iter() {
        // The class's function is farthest below right before one of its rows, and farthest above right after.
        for class in rows.iter().map(|&row| labels[row]) {
            largest[class] = largest[class].max(passed / total - of_class[class] / rows_of[class]);
        }
        for &row in rows {
            of_class[labels[row]] += 1.0;
            passed += 1.0;
        }
        for class in rows.iter().map(|&row| labels[row]) {
            largest[class] = largest[class].max(of_class[class] / rows_of[class] - passed / total);
        }
    }
    largest
}

#[cfg(test)]
mod tests {
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
}
