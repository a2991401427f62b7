//! Distances between distribution functions.

use crate::given::order::Order;

/// How far the distribution function of the rows of a class lies from that of all rows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Distance {
    /// Rows of the class, by weight.
    pub weight: f64,
    /// Farthest above.
    above: f64,
    /// Farthest below.
    below: f64,
}

impl Distance {
    /// After Kolmogorov and Smirnov: the larger of the two.
    pub fn kolmogorov(&self) -> f64 {
        self.above.max(self.below)
    }

    /// After Kuiper: the sum of the two.
    pub fn kuiper(&self) -> f64 {
        self.above + self.below
    }
}

/// The distance of every class; `order` is that of the output, and a row counts as often as its weight says. 0 for a class
/// without weight.
pub fn distances(order: &Order, (labels, count): &(Vec<usize>, usize), weights: &[f64]) -> Vec<Distance> {
    let mut all = vec![Distance::default(); *count];
    labels.iter().zip(weights).for_each(|(&label, weight)| all[label].weight += weight);
    let total: f64 = weights.iter().sum();
    let (mut passed, mut of_class) = (0.0, vec![0.0; *count]);
    for rows in order.iter() {
        // A class is farthest below right before a row of its own, and farthest above right after.
        for &row in rows {
            let class = &mut all[labels[row]];
            if class.weight > 0.0 {
                class.below = class.below.max(passed / total - of_class[labels[row]] / class.weight);
            }
        }
        for &row in rows {
            of_class[labels[row]] += weights[row];
            passed += weights[row];
        }
        for &row in rows {
            let class = &mut all[labels[row]];
            if class.weight > 0.0 {
                class.above = class.above.max(of_class[labels[row]] / class.weight - passed / total);
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn halves_by_hand() {
        let z = [1.0, 2.0, 3.0, 4.0];
        let classes = (vec![0, 0, 1, 1], 2);
        let got = distances(&Order::of(&z), &classes, &[1.0; 4]);
        assert_eq!((got[0].kolmogorov(), got[0].kuiper(), got[1].kolmogorov()), (0.5, 0.5, 0.5));
        // A row that counts for nothing is as if it was not there.
        let got = distances(&Order::of(&z), &classes, &[1.0, 0.0, 0.0, 1.0]);
        assert_eq!((got[0].weight, got[0].kolmogorov(), got[1].kuiper()), (1.0, 0.5, 0.5));
    }

    proptest! {
        #[test]
        fn they_are_what_both_functions_differ_by_at_any_value(
            rows in prop::collection::vec((0..12i32, 0..4usize, 0..3u32), 2..60)
        ) {
            let z: Vec<f64> = rows.iter().map(|row| f64::from(row.0)).collect();
            let labels: Vec<usize> = rows.iter().map(|row| row.1).collect();
            let weights: Vec<f64> = rows.iter().map(|row| f64::from(row.2)).collect();
            prop_assume!(weights.iter().sum::<f64>() > 0.0);
            let got = distances(&Order::of(&z), &(labels.clone(), 4), &weights);
            let below = |value: f64, class: Option<usize>| {
                let of = |k: &usize| class.is_none_or(|class| labels[*k] == class);
                let all: f64 = (0..z.len()).filter(of).map(|k| weights[k]).sum();
                let passed: f64 = (0..z.len()).filter(of).filter(|&k| z[k] <= value).map(|k| weights[k]).sum();
                passed / all
            };
            for (class, got) in got.iter().enumerate().filter(|(_, got)| got.weight > 0.0) {
                let gaps = (-1..12).map(|value| below(value.into(), Some(class)) - below(value.into(), None));
                let (above, under) = gaps.fold((0.0_f64, 0.0_f64), |(a, b), gap| (a.max(gap), b.max(-gap)));
                prop_assert!((got.kolmogorov() - above.max(under)).abs() < 1e-14);
                prop_assert!((got.kuiper() - above - under).abs() < 1e-14);
            }
        }
    }
}
