//! The moments of nested parts of a run of base points, which show how the error falls as the run grows.

use super::Moments;

/// Maximum number of parts that are kept.
pub const MAX_PARTS: usize = 64;

/// Number of outputs, series value by value, above which parts are coarse, and their maximum number then.
const FINE_OUTPUTS: usize = 256;
const MAX_COARSE_PARTS: usize = 16;

/// Minimum length of a coarse part: its sums are as many numbers as the outputs of about fourteen base points.
const COARSE_LENGTH: u64 = 8;

/// Maximum number of numbers in the parts of one output: with very many factors there are fewer parts.
const MAX_NUMBERS: usize = 1 << 19;

/// The division of base points into parts.
#[derive(Debug, Clone, Copy)]
pub struct PartShape {
    /// Base points in a part that is complete, a power of two.
    pub length: u64,
    /// Maximum number of parts.
    most: usize,
}

impl PartShape {
    /// Returns the shape in which block number `block` (of `size` base points) is summed, for a model with `outputs`
    /// outputs: that of the shortest run that contains the block. Later blocks, which only long runs reach, need no parts
    /// at all.
    pub fn of_block(block: u64, size: u64, outputs: usize) -> Self {
        let points = (block + 1).next_power_of_two() * size;
        if outputs <= FINE_OUTPUTS {
            let length = (points / MAX_PARTS as u64 / 2).clamp(1, size);
            return Self { length, most: MAX_PARTS };
        }
        let length = (points / MAX_COARSE_PARTS as u64).min(size);
        // A run that ends in the first block has parts too.
        Self { length: if block == 0 { COARSE_LENGTH } else { length }, most: MAX_COARSE_PARTS }
    }
}

/// Moments of consecutive base points, kept as those of up to [`MAX_PARTS`] consecutive parts of equal length, a power
/// of two; the last part may be shorter.
///
/// Neighbouring parts are merged in pairs whenever there are too many, in the same tree in which all are finally
/// merged: the bits of the sum do not depend on when that happened.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MomentParts {
    /// Base points in a part that is complete.
    length: u64,
    /// Maximum number of parts.
    most: usize,
    /// Total number of base points.
    points: u64,
    parts: Vec<Moments>,
}

impl MomentParts {
    /// Creates parts of this shape, of `points` base points in all.
    pub fn new(PartShape { length, most }: PartShape, points: u64, parts: Vec<Moments>) -> Self {
        debug_assert!(length.is_power_of_two() && points.div_ceil(length) == parts.len() as u64);
        let mut new = Self { length, most, points, parts };
        new.shrink();
        new
    }

    /// Returns the parts, in the order of their base points.
    pub fn parts(&self) -> &[Moments] {
        &self.parts
    }

    /// Returns the total number of base points, with or without outputs.
    pub fn points(&self) -> u64 {
        self.points
    }

    /// Returns only the first `parts` parts.
    #[must_use]
    pub fn prefix(&self, parts: usize) -> Self {
        let parts = parts.min(self.parts.len());
        let points = self.points.min(parts as u64 * self.length);
        Self { points, parts: self.parts[..parts].to_vec(), ..*self }
    }

    /// Returns only the sums of y_A and y_B of every part.
    #[must_use]
    pub fn without_swaps(&self) -> Self {
        Self { parts: self.parts.iter().map(Moments::without_swaps).collect(), ..*self }
    }

    /// Appends the base points that follow. All parts of `self` must be complete.
    pub fn append(&mut self, mut following: Self) {
        if self.parts.is_empty() {
            *self = following;
            return;
        }
        let length = self.length.max(following.length);
        self.lengthen(length);
        following.lengthen(length);
        self.parts.append(&mut following.parts);
        self.points += following.points;
        self.shrink();
    }

    /// Returns the moments of all base points together.
    pub fn sum(&self) -> Moments {
        merged(&self.parts)
    }

    fn lengthen(&mut self, length: u64) {
        while self.length < length && !self.parts.is_empty() {
            self.pair_up();
        }
    }

    fn shrink(&mut self) {
        while self.parts.len() > self.most() {
            self.pair_up();
        }
    }

    fn most(&self) -> usize {
        let numbers = self.parts.first().map_or(1, Moments::numbers);
        let most = (MAX_NUMBERS / numbers.max(1)).clamp(4, self.most);
        1 << most.ilog2()
    }

    fn pair_up(&mut self) {
        let mut parts = std::mem::take(&mut self.parts).into_iter();
        while let Some(mut pair) = parts.next() {
            if let Some(second) = parts.next() {
                pair.merge(&second);
            }
            self.parts.push(pair);
        }
        self.length *= 2;
    }
}

/// Merges the moments of `parts` in the tree of the run: the left branch has the largest power of two below their
/// number.
pub fn merged(parts: &[Moments]) -> Moments {
    match parts {
        [] => Moments::empty(0),
        [one] => one.clone(),
        many => {
            let (left, right) = many.split_at(many.len().next_power_of_two() / 2);
            let mut sum = merged(left);
            sum.merge(&merged(right));
            sum
        }
    }
}

#[cfg(test)]
#[path = "tests/parts.rs"]
mod tests;
