//! The centred sums used by every estimator: constant in size, mergeable in any fixed tree.

use super::base_moments::BaseMoments;
use super::pair_moments::PairMoments;
use super::swap_moments::{Columns, SwapMoments};
use super::workspace::Workspace;
use apportion_base::sum;

/// First and second moments of the outputs of a Saltelli design, all centred on their own means.
///
/// Every swap has its own sums over the base points at which all of its rows, A, B, AB_s and possibly BA_s, have an
/// output: a failed row removes a base point from its own swap only.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Moments {
    base: BaseMoments,
    /// Smallest and largest output among the rows A and B; `None` if there are none.
    range: Option<(f64, f64)>,
    swaps: Vec<SwapMoments>,
    pairs: Option<PairMoments>,
}

/// The outputs of a block of base points, columns of one length. An output that is not finite is a failed run.
#[derive(Debug, Clone, Copy, Default)]
pub struct BlockOutputs<'a> {
    /// Outputs of the rows A.
    pub a: &'a [f64],
    /// Outputs of the rows B.
    pub b: &'a [f64],
    /// Outputs of the rows AB_s, one slice per swap.
    pub ab: &'a [&'a [f64]],
    /// Outputs of the rows BA_s, one slice per swap, or empty without these rows.
    pub ba: &'a [&'a [f64]],
    /// The swaps whose pairs are counted for second-order indices, in rising order; none without `ba`.
    pub paired: &'a [usize],
}

impl Moments {
    /// Creates moments of no base points, for `swaps` rows AB_s.
    pub fn empty(swaps: usize) -> Self {
        Self { swaps: vec![SwapMoments::default(); swaps], ..Self::default() }
    }

    /// Computes the moments of one block; `work` is reused between calls.
    ///
    /// ```
    /// use apportion::estimate::{BlockOutputs, Moments, Total, Workspace};
    ///
    /// // y = x, sampled at every pair of 0, 1 and 0, 1: AB, which takes x from B, has the outputs of B.
    /// let (a, b) = ([0.0, 0.0, 1.0, 1.0], [0.0, 1.0, 0.0, 1.0]);
    /// let block = BlockOutputs { a: &a, b: &b, ab: &[&b], ..BlockOutputs::default() };
    /// let moments = Moments::of_block(block, &mut Workspace::default());
    /// assert_eq!(Total::Jansen1999.estimate(&moments, 0), 1.0);
    /// ```
    pub fn of_block(outputs: BlockOutputs<'_>, work: &mut Workspace) -> Self {
        let BlockOutputs { a, b, ab, ba, paired } = outputs;
        let all = BaseMoments::from_columns(a, b);
        let complete = Some(all).filter(|all| all.mean_a.is_finite() && all.mean_b.is_finite());
        let swaps = (0..ab.len())
            .map(|swap| {
                let columns = Columns { a, b, ab: ab[swap], ba: ba.get(swap).copied() };
                SwapMoments::from_columns(complete, columns, work)
            })
            .collect();
        let pairs = (!paired.is_empty()).then(|| PairMoments::from_columns(paired, (a, b), (ab, ba), work));
        match complete {
            Some(base) => Self { base, range: range(a, b), swaps, pairs },
            None => {
                let (a, b) = work.without_failures(a, b);
                Self { base: BaseMoments::from_columns(a, b), range: range(a, b), swaps, pairs }
            }
        }
    }

    /// Creates moments of weighted base points from their sums, without the range of the output.
    pub(super) fn from_sums(base: BaseMoments, swaps: Vec<SwapMoments>, pairs: Option<PairMoments>) -> Self {
        let constant = base.aa == 0.0 && base.bb == 0.0 && base.mean_a == base.mean_b;
        let spread = if constant { 0.0 } else { base.half_gap().abs() + (base.aa + base.bb).sqrt() };
        let range = (base.n > 0).then(|| (base.mean() - spread, base.mean() + spread));
        Self { base, range, swaps, pairs }
    }

    /// Adds the base points of `other`, which has the same swaps.
    pub fn merge(&mut self, other: &Self) {
        if other.base.n == 0 {
            return;
        }
        if self.base.n == 0 {
            self.clone_from(other);
            return;
        }
        debug_assert_eq!(self.swaps.len(), other.swaps.len());
        if let (Some((low, high)), Some((other_low, other_high))) = (self.range, other.range) {
            self.range = Some((low.min(other_low), high.max(other_high)));
        }
        self.base.merge(&other.base);
        for (mine, theirs) in self.swaps.iter_mut().zip(&other.swaps) {
            mine.merge(theirs);
        }
        if let (Some(mine), Some(theirs)) = (&mut self.pairs, &other.pairs) {
            mine.merge(theirs);
        }
    }

    /// Returns only the sums of y_A and y_B.
    #[must_use]
    pub fn without_swaps(&self) -> Self {
        Self { base: self.base, range: self.range, ..Self::default() }
    }

    /// Returns the number of base points at which A and B have an output.
    pub fn count(&self) -> u64 {
        self.base.n
    }

    /// Returns the smallest number of base points of any index.
    pub fn fewest(&self) -> u64 {
        self.swaps.iter().map(|swap| swap.base.n).fold(self.base.n, u64::min)
    }

    /// Returns the approximate number of stored numbers.
    pub(super) fn numbers(&self) -> usize {
        let pairs = self.pairs.as_ref().map_or(0, |pairs| 2 * pairs.swaps().len().pow(2));
        self.swaps.len() * (size_of::<SwapMoments>() / size_of::<f64>()) + pairs
    }

    /// Returns the number of rows AB_s.
    pub fn swaps(&self) -> usize {
        self.swaps.len()
    }

    /// Returns the sums of one swap.
    ///
    /// # Panics
    /// If there is no such swap.
    pub fn swap(&self, swap: usize) -> &SwapMoments {
        &self.swaps[swap]
    }

    /// Returns whether the swaps have sums of rows BA.
    pub fn has_ba(&self) -> bool {
        !self.swaps.is_empty() && self.swaps.iter().all(|swap| swap.ba.is_some())
    }

    /// Returns the sums of y_A and y_B.
    pub fn base(&self) -> &BaseMoments {
        &self.base
    }

    /// Returns the moments for second-order indices, if requested.
    pub fn pairs(&self) -> Option<&PairMoments> {
        self.pairs.as_ref()
    }

    /// Returns the smallest and largest output among the rows A and B; `None` if there are none.
    pub fn range(&self) -> Option<(f64, f64)> {
        self.range
    }

    /// Returns whether every row A and B has the same output.
    pub fn constant(&self) -> bool {
        self.range.is_none_or(|(low, high)| low == high)
    }

    /// Returns the mean of the output over the rows A and B.
    pub fn mean(&self) -> f64 {
        self.base.mean()
    }

    /// Returns the variance of the output over the rows A and B pooled (two-pass; divided by the number of rows 2n).
    pub fn variance(&self) -> f64 {
        self.base.variance()
    }
}

/// Returns the smallest and largest of both columns; `None` if they are empty.
fn range(a: &[f64], b: &[f64]) -> Option<(f64, f64)> {
    let ((low, high), (other_low, other_high)) = (sum::range(a), sum::range(b));
    (!a.is_empty()).then(|| (low.min(other_low), high.max(other_high)))
}
