//! The outputs of every run of a design, kept for intervals that need them point by point.

use std::sync::Arc;

/// One output at every run of consecutive base points: a column per unique run, the points in order; not finite where a
/// run failed. Stored in shared blocks, so that appending copies no outputs.
#[derive(Debug, Clone, Default)]
pub struct PointOutputs {
    blocks: Vec<Arc<Block>>,
    points: u64,
}

/// The outputs of the base points of one block.
#[derive(Debug)]
struct Block {
    points: usize,
    /// Column by column.
    outputs: Vec<f64>,
}

impl PointOutputs {
    /// Stores the outputs of one block, a column for each unique run, all of one length.
    pub fn of_block(columns: &[&[f64]]) -> Self {
        let points = columns.first().map_or(0, |column| column.len());
        let block = Block { points, outputs: columns.concat() };
        Self { blocks: vec![Arc::new(block)], points: points as u64 }
    }

    /// Appends the base points that follow.
    pub fn append(&mut self, following: Self) {
        self.blocks.extend(following.blocks);
        self.points += following.points;
    }

    /// Returns the total number of base points.
    pub fn points(&self) -> u64 {
        self.points
    }

    /// Returns whether a run of a base point has no value.
    pub fn has_failures(&self) -> bool {
        self.blocks.iter().any(|block| block.outputs.iter().any(|y| !y.is_finite()))
    }

    /// Returns the first `end` base points; blocks that end there are shared.
    #[must_use]
    pub fn prefix(&self, end: u64) -> Self {
        let mut prefix = Self::default();
        for (block, columns) in self.blocks.iter().zip(self.blocks(end)) {
            let is_whole = columns.first().is_some_and(|column| column.len() == block.points);
            let of_block = if is_whole {
                Self { blocks: vec![Arc::clone(block)], points: block.points as u64 }
            } else {
                Self::of_block(&columns)
            };
            prefix.append(of_block);
        }
        prefix
    }

    /// Iterates over the columns of every block up to base point number `end`, in order.
    pub fn blocks<'a>(&'a self, end: u64) -> impl Iterator<Item = Vec<&'a [f64]>> {
        let mut left = usize::try_from(end).unwrap_or(usize::MAX);
        let mut take = move |block: &Block| {
            let taken = block.points.min(left);
            left -= taken;
            taken
        };
        let cut = |(block, taken): (&'a Arc<Block>, usize)| -> Vec<&'a [f64]> {
            block.outputs.chunks_exact(block.points).map(|column| &column[..taken]).collect()
        };
        let sized = self.blocks.iter().map(move |block| (block, take(block)));
        sized.filter(|(_, taken)| *taken > 0).map(cut)
    }
}

#[cfg(test)]
#[path = "tests/point_outputs.rs"]
mod tests;
