//! Memory that is reused from block to block.

/// The changes in the rows of a swap: D = y_AB - y_A and E = y_BA - y_B.
#[derive(Debug, Default)]
pub(super) struct Differences {
    pub d: Vec<f64>,
    pub e: Vec<f64>,
}

/// Buffers for [`super::Moments::of_block`]; used ones are as good as new ones.
#[derive(Debug, Default)]
pub struct Workspace {
    /// Differences of the current swap.
    pub(super) differences: Differences,
    /// Columns of A, B and the rows of a swap without the base points that failed.
    pub(super) kept: [Vec<f64>; 4],
    /// Those of all paired swaps.
    pub(super) paired: Vec<Differences>,
}

/// Writes the differences `y - origin` to `buffer`.
pub(super) fn difference(y: &[f64], origin: &[f64], buffer: &mut Vec<f64>) {
    buffer.clear();
    buffer.extend(y.iter().zip(origin).map(|(y, origin)| y - origin));
}

impl Workspace {
    /// Returns the base points at which A and B are both finite.
    pub(super) fn without_failures(&mut self, a: &[f64], b: &[f64]) -> (&[f64], &[f64]) {
        let [kept_a, kept_b, ..] = &mut self.kept;
        kept_a.clear();
        kept_b.clear();
        for (a, b) in a.iter().zip(b).filter(|(a, b)| a.is_finite() && b.is_finite()) {
            kept_a.push(*a);
            kept_b.push(*b);
        }
        (kept_a, kept_b)
    }
}
