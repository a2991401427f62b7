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
        let rows = |replicate: u64| design.first_points(replicate, points);
        Self { factors: design.factors(), replicates: (0..replicates).map(rows).collect() }
    }

    /// Iterates over coordinate `factor` of these rows: A and B of each base point in turn.
    pub fn coordinates(&self, factor: usize) -> impl Iterator<Item = f64> {
        self.replicates.iter().flat_map(move |columns| {
            let (a, b) = (&columns[factor], &columns[self.factors + factor]);
            a.iter().zip(b).flat_map(|(a, b)| [*a, *b])
        })
    }

    /// Returns the outputs of the same rows, NaN where a run failed; `samples` are those that each replicate has kept.
    pub fn outputs(&self, samples: &[Vec<f64>]) -> Vec<f64> {
        let of_replicate = |(columns, outputs): (&Vec<Vec<f64>>, &Vec<f64>)| {
            let rows = 2 * columns.first().map_or(0, Vec::len);
            outputs.iter().copied().chain(std::iter::repeat(f64::NAN)).take(rows).collect::<Vec<f64>>()
        };
        self.replicates.iter().zip(samples).flat_map(of_replicate).collect()
    }

    /// Returns the points of the unit cube of at most `most` of the rows A, the first of every replicate, with their
    /// outputs; failed runs are left out.
    pub fn first(&self, most: usize, samples: &[Vec<f64>]) -> Vec<(Vec<f64>, f64)> {
        let each = (most / self.replicates.len()).max(1);
        let of_replicate = |(columns, outputs): (&Vec<Vec<f64>>, &Vec<f64>)| {
            let row = |(point, y): (usize, &f64)| {
                let u = columns[..self.factors].iter().filter_map(|column| column.get(point).copied());
                (u.collect::<Vec<_>>(), *y)
            };
            let length = columns.first().map_or(0, Vec::len);
            let rows = outputs.iter().step_by(2).take(each.min(length)).enumerate();
            rows.map(row).filter(|(_, y)| y.is_finite()).collect::<Vec<_>>()
        };
        let mut rows: Vec<_> = self.replicates.iter().zip(samples).flat_map(of_replicate).collect();
        rows.truncate(most);
        rows
    }
}
