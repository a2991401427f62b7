//! The totals of blocks, merged in a tree of fixed shape in whatever order they come.
//!
//! Blocks `2 i m` to `2 (i + 1) m` of a replicate, m a power of two, are merged from their two halves as soon as both are
//! there. What is left in the end is merged from the right. The left branch of every merge holds the largest power of two
//! below the number of blocks, so that a longer run has the tree of the shorter one as its left branch: the open branches
//! of an unfinished run are all that it takes to go on with it, to any number of blocks, with the same bits.

use super::{BLOCK, Totals};
use crate::binary::{Binary, binary_fields};

/// Sums of a run that can be gone on with: what a checkpoint holds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sums {
    /// 0 if the blocks are those of any run of the design. Otherwise the base points of every replicate at which the run
    /// first looked at its indices: it grew from a number that is no whole blocks, and only such a run has its bits.
    pub(crate) began: u64,
    /// Base points of every replicate before the first block.
    pub(crate) from: u64,
    /// Totals of these base points, of each replicate; none if there are none.
    pub(super) heads: Vec<Totals>,
    /// Open branches of each replicate: their number of blocks, and their totals.
    pub(super) open: Vec<Vec<(u64, Totals)>>,
}

binary_fields!(Sums { began, from, heads, open });

impl Sums {
    /// Sums of no rows, of `replicates` replicates.
    pub fn new(replicates: u64) -> Self {
        Self { open: vec![Vec::new(); replicates as usize], ..Self::default() }
    }

    /// Rows in the sums.
    pub fn rows(&self) -> u64 {
        self.totals().fold(0, |rows, totals| rows.saturating_add(totals.runs))
    }

    /// Base points of every replicate that are in the sums, at least.
    pub fn points(&self) -> u64 {
        let blocks = |open: &Vec<(u64, Totals)>| open.iter().map(|(blocks, _)| blocks).sum::<u64>();
        match self.open.iter().map(blocks).min().unwrap_or(0) {
            0 => self.from,
            blocks => (self.from / BLOCK + blocks) * BLOCK,
        }
    }

    /// Whether a run that looks at its indices at `points` base points of every replicate first, and perhaps `grows`, has
    /// these sums on its way.
    pub(crate) fn is_stage_of(&self, points: u64, grows: bool) -> bool {
        let is_whole = points.is_power_of_two() && points >= BLOCK;
        if self.began == 0 {
            return !grows || is_whole || self.points() <= points;
        }
        let stages = std::iter::successors(Some(points), |stage| stage.checked_mul(2));
        let reached = stages.take_while(|stage| *stage <= self.from).last();
        grows && self.began == points && (self.from == 0 || reached == Some(self.from))
    }

    /// The base points of every replicate at which a run that begins with `points` and has these sums looks at its
    /// indices first.
    pub(crate) fn first_stage(&self, points: u64, grows: bool) -> u64 {
        let mut stage = points;
        // What grew from a number that is no whole blocks goes on from one stage to the next.
        while grows && (stage < self.points() || self.began > 0 && stage <= self.from) {
            stage *= 2;
        }
        stage
    }

    /// All totals in the sums.
    pub(crate) fn totals(&self) -> impl Iterator<Item = &Totals> {
        self.heads.iter().chain(self.open.iter().flatten().map(|(_, totals)| totals))
    }

    /// Whether the branches are such as a run of `replicates` replicates leaves.
    pub(crate) fn is_coherent(&self, replicates: u64) -> bool {
        let replicates = replicates as usize;
        let heads = if self.from == 0 { 0 } else { replicates };
        let shrink = |open: &Vec<(u64, Totals)>| open.is_sorted_by(|(a, _), (b, _)| a > b);
        let powers = |open: &Vec<(u64, Totals)>| open.iter().all(|(blocks, _)| blocks.is_power_of_two());
        let begins = self.began > 0 || self.from == 0 || self.from.is_power_of_two() && self.from >= BLOCK;
        let few = self.from < 1 << 50 && self.open.iter().flatten().all(|(blocks, _)| *blocks < 1 << 50);
        let open = self.open.len() == replicates && self.open.iter().all(|open| shrink(open) && powers(open));
        few && begins && open && self.heads.len() == heads
    }
}

/// Consecutive blocks of a replicate.
#[derive(Debug)]
pub(super) struct Branch {
    pub first: u64,
    pub blocks: u64,
    pub totals: Totals,
}

/// The blocks of a run on their way into the tree.
#[derive(Debug)]
pub(super) struct Fold {
    began: u64,
    from: u64,
    heads: Vec<Totals>,
    /// Of each replicate, in order. Blocks are counted from the first one behind `from`.
    branches: Vec<Vec<Branch>>,
    /// Totals of the last base points of each replicate, if they are no whole block. They are no part of the sums that a
    /// run goes on with.
    tails: Vec<Option<Totals>>,
}

impl Fold {
    /// The run goes on with `sums`.
    pub fn new(sums: Sums) -> Self {
        let Sums { began, from, heads, open } = sums;
        let tails = vec![None; open.len()];
        // Where the base points before are one branch of the tree themselves, they are taken for it.
        let (shift, from, heads) = if began == 0 { (from / BLOCK, 0, heads) } else { (0, from, heads) };
        let branches = |(replicate, open): (usize, Vec<(u64, Totals)>)| {
            let head = heads.get(replicate).filter(|_| shift > 0);
            let mut first = 0;
            let mut branches = Vec::with_capacity(open.len() + 1);
            for (blocks, totals) in head.map(|head| (shift, head.clone())).into_iter().chain(open) {
                branches.push(Branch { first, blocks, totals });
                first += blocks;
            }
            branches
        };
        let branches: Vec<Vec<Branch>> = open.into_iter().enumerate().map(branches).collect();
        let heads = if shift > 0 { Vec::new() } else { heads };
        let mut fold = Self { began, from, heads, branches, tails };
        for replicate in 0..fold.branches.len() {
            if let Some(last) = fold.branches[replicate].pop() {
                fold.insert(replicate, last.first, last.blocks, last.totals);
            }
        }
        fold
    }

    /// Base points of every replicate before the first block.
    pub fn from(&self) -> u64 {
        self.from
    }

    /// Blocks of `replicate` that are there without a gap.
    pub fn blocks(&self, replicate: usize) -> u64 {
        self.whole(replicate).last().map_or(0, |branch| branch.first + branch.blocks)
    }

    fn whole(&self, replicate: usize) -> impl Iterator<Item = &Branch> {
        let mut next = 0;
        self.branches[replicate].iter().take_while(move |branch| {
            let follows = branch.first == next;
            next = branch.first + branch.blocks;
            follows
        })
    }

    /// The branch with which that of `blocks` blocks from `first` on makes one of twice as many, taken out.
    pub fn take_sibling(&mut self, replicate: usize, first: u64, blocks: u64) -> Option<(u64, Totals)> {
        let sibling = first ^ blocks;
        let branches = &mut self.branches[replicate];
        let place = branches.iter().rposition(|branch| branch.first == sibling && branch.blocks == blocks)?;
        let Branch { first, totals, .. } = branches.remove(place);
        Some((first, totals))
    }

    /// Puts a branch in its place, whose sibling is not there.
    pub fn put(&mut self, replicate: usize, first: u64, blocks: u64, totals: Totals) {
        let branches = &mut self.branches[replicate];
        let place = branches.partition_point(|branch| branch.first < first);
        branches.insert(place, Branch { first, blocks, totals });
    }

    /// Puts a branch in its place, merged with all that it makes larger branches with.
    fn insert(&mut self, replicate: usize, mut first: u64, mut blocks: u64, mut totals: Totals) {
        while let Some((other, sibling)) = self.take_sibling(replicate, first, blocks) {
            totals = merged((first, totals), (other, sibling));
            (first, blocks) = (first.min(other), 2 * blocks);
        }
        self.put(replicate, first, blocks, totals);
    }

    pub fn put_tail(&mut self, replicate: usize, totals: Totals) {
        self.tails[replicate] = Some(totals);
    }

    /// Appends the bytes of the [`Sums`] of all blocks without a gap.
    pub fn write_sums(&self, out: &mut Vec<u8>) {
        self.began.write(out);
        self.from.write(out);
        self.heads.write(out);
        self.branches.len().write(out);
        for replicate in 0..self.branches.len() {
            self.whole(replicate).count().write(out);
            for branch in self.whole(replicate) {
                branch.blocks.write(out);
                branch.totals.write(out);
            }
        }
    }

    /// The totals of each replicate.
    pub fn into_totals(self) -> Vec<Totals> {
        let mut heads = self.heads.into_iter();
        let mut totals = Vec::with_capacity(self.branches.len());
        for (branches, tail) in self.branches.into_iter().zip(self.tails) {
            let all = branches.into_iter().map(|branch| branch.totals).chain(tail);
            let whole = all.rev().reduce(|right, mut left| {
                left.merge(&right);
                left
            });
            totals.extend(match (heads.next(), whole) {
                (Some(mut head), Some(whole)) => {
                    head.merge(&whole);
                    Some(head)
                }
                (head, whole) => head.or(whole),
            });
        }
        totals
    }
}

/// The totals of two neighbouring branches.
pub(super) fn merged(one: (u64, Totals), other: (u64, Totals)) -> Totals {
    let ((_, mut left), (_, right)) = if one.0 < other.0 { (one, other) } else { (other, one) };
    left.merge(&right);
    left
}

/// Appends `branch` to those before it, merged with all that it makes larger branches with.
pub(super) fn append(branches: &mut Vec<Branch>, mut branch: Branch) {
    while let Some(last) =
        branches.pop_if(|last| last.blocks == branch.blocks && last.first == branch.first ^ branch.blocks)
    {
        let Branch { first, blocks, totals } = last;
        branch = Branch { first, blocks: 2 * blocks, totals: merged((first, totals), (branch.first, branch.totals)) };
    }
    branches.push(branch);
}

#[cfg(test)]
mod tests;
