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
#[path = "tests/distances.rs"]
mod tests;
