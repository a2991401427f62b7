//! Kept outputs as the matrix of products used by intervals by points.

use std::ops::Range;

use nalgebra::DMatrix;

use crate::design::Design;
use crate::estimate::{BlockOutputs, PointOutputs, ProductWork, Products};

/// Maximum number of base points whose products are in memory at a time: some megabytes.
const CHUNK: usize = 1 << 13;

/// One output at every run of the first base points of each replicate.
#[derive(Debug, Clone, Copy)]
pub struct KeptPoints<'a> {
    /// Maps runs to rows.
    pub design: &'a Design,
    /// Its replicates.
    pub replicates: &'a [&'a PointOutputs],
    /// Number of base points of each replicate that are used.
    pub per_replicate: u64,
}

impl<'a> KeptPoints<'a> {
    /// Returns all points of all replicates; `None` if no outputs have been kept.
    pub fn all(design: &'a Design, replicates: &'a [&'a PointOutputs]) -> Option<Self> {
        let per_replicate = replicates.iter().map(|kept| kept.points()).max().filter(|points| *points > 0)?;
        Some(Self { design, replicates, per_replicate })
    }

    /// Returns the first `points` base points of each replicate.
    #[must_use]
    pub fn prefix(self, points: u64) -> Self {
        Self { per_replicate: self.per_replicate.min(points), ..self }
    }

    /// Returns the total number of base points.
    pub fn count(&self) -> u64 {
        self.replicates.iter().map(|kept| kept.points().min(self.per_replicate)).sum()
    }

    /// Splits the points into chunks of blocks, in order; their sizes depend only on the number of points.
    pub(super) fn chunks(&self) -> Vec<Chunk<'a>> {
        let blocks = self.replicates.iter().flat_map(|kept| kept.blocks(self.per_replicate));
        let mut chunks: Vec<Chunk<'a>> = Vec::new();
        let mut first = 0;
        for columns in blocks {
            let points = columns.first().map_or(0, |column| column.len());
            match chunks.last_mut() {
                Some(chunk) if chunk.points.len() + points <= CHUNK => {
                    chunk.points.end += points;
                    chunk.blocks.push(columns);
                }
                _ => chunks.push(Chunk { points: first..first + points, blocks: vec![columns] }),
            }
            first += points;
        }
        chunks
    }
}

/// Some consecutive base points.
pub(super) struct Chunk<'a> {
    /// Their indices.
    pub points: Range<usize>,
    /// The columns of the runs of each of their blocks.
    blocks: Vec<Vec<&'a [f64]>>,
}

impl Chunk<'_> {
    /// Computes the products of every point: a row per point, a column per product.
    pub fn products(&self, design: &Design, products: &Products) -> DMatrix<f64> {
        let points = self.points.len();
        let mut matrix = DMatrix::zeros(points, products.columns());
        let mut work = ProductWork::default();
        let mut first = 0;
        for columns in &self.blocks {
            let ab: Vec<&[f64]> = design.ab_runs().iter().map(|run| columns[*run]).collect();
            let ba: Vec<&[f64]> = design.ba_runs().iter().map(|run| columns[*run]).collect();
            let block = BlockOutputs { a: columns[0], b: columns[1], ab: &ab, ba: &ba, paired: design.paired() };
            products.fill(&block, &mut matrix.as_mut_slice()[first..], points, &mut work);
            first += columns[0].len();
        }
        matrix
    }
}
