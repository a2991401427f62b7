//! The first rows A and B of a run, whose outputs are kept.

use crate::design::Design;
use crate::run::SAMPLE;

/// The points of the unit cube of the first rows A and B of every replicate: computed again from the design, which is a
/// function of the row number.
pub(crate) struct FirstRows {
    factors: usize,
    /// For each replicate the columns of A, then those of B.
    replicates: Vec<Vec<Vec<f64>>>,
}

impl FirstRows {
    /// Computes those of at most `most` base points over all replicates, and of at least one in each.
    pub fn new(design: &Design, most: u64) -> Self {
        let replicates = design.settings().replicates;
        let points = (most.min(SAMPLE) / replicates).max(1).min(design.points_per_replicate()) as usize;
        let replicates = (0..replicates).map(|replicate| design.first_points(replicate, points));
        Self { factors: design.factors(), replicates: replicates.collect() }
    }

    /// Iterates over coordinate `factor` of these rows: A and B of each base point in turn.
    pub fn coordinates(&self, factor: usize) -> impl Iterator<Item = f64> {
        self.replicates.iter().flat_map(move |columns| {
            let (a, b) = (&columns[factor], &columns[self.factors + factor]);
            a.iter().zip(b).flat_map(|(a, b)| [*a, *b])
        })
    }

    /// Returns the outputs of the same rows, NaN where a run failed; `samples` are those that each replicate has kept.
    pub fn outputs(&self, samples: &[&Vec<f64>]) -> Vec<f64> {
        let mut all = Vec::new();
        for (columns, outputs) in self.replicates.iter().zip(samples) {
            let rows = 2 * columns.first().map_or(0, Vec::len);
            all.extend(outputs.iter().copied().chain(std::iter::repeat(f64::NAN)).take(rows));
        }
        all
    }

    /// Returns the points of the unit cube of at most `most` of the rows A, the first of every replicate, with their
    /// outputs; failed runs are left out.
    pub fn first(&self, most: usize, samples: &[&Vec<f64>]) -> Vec<(Vec<f64>, f64)> {
        let each = (most / self.replicates.len()).max(1);
        let mut rows = Vec::new();
        for (columns, outputs) in self.replicates.iter().zip(samples) {
            let points = each.min(columns.first().map_or(0, Vec::len));
            for (point, &y) in outputs.iter().step_by(2).take(points).enumerate() {
                if y.is_finite() {
                    rows.push((columns[..self.factors].iter().map(|column| column[point]).collect(), y));
                }
            }
        }
        rows.truncate(most);
        rows
    }
}
