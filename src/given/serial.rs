//! Rows that follow each other in time.

use super::order::Order;

/// Autocorrelation below which rows are as good as independent.
const NEGLIGIBLE: f64 = 0.2;

/// Standard errors of the autocorrelation of independent rows that are clear.
const CLEAR: f64 = 6.0;

/// Returns the rank autocorrelation at lag 1 of a column; 0 of one that is sorted, which says nothing of the others, and
/// of one whose steps are those of a point sequence.
pub(super) fn autocorrelation(order: &Order) -> f64 {
    let ranks = order.centred_ranks();
    let squares: f64 = ranks.iter().map(|rank| rank * rank).sum();
    let is_sorted = ranks.is_sorted() || ranks.is_sorted_by(|a, b| a >= b);
    if squares == 0.0 || is_sorted {
        return 0.0;
    }
    ranks.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / squares
}

/// Returns the number of independent rows that say as much about a product of columns with these autocorrelations as
/// `rows` rows (Bartlett 1946), if it is clearly smaller.
pub(super) fn effective_rows(autocorrelations: [f64; 2], rows: usize) -> Option<f64> {
    let level = NEGLIGIBLE.max(CLEAR / (rows as f64).sqrt());
    let [a, b] = autocorrelations;
    (a > level && b > level).then(|| rows as f64 * (1.0 - a * b) / (1.0 + a * b))
}
