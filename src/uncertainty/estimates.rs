//! All reported quantities of one output in one flat list.
//!
//! Intervals work on lists of numbers: [`quantities`] computes the list, [`Layout`] defines the places in it.

use super::concentration::Side;
use crate::estimate::{
    Estimator, Indices, Moments, SecondOrder, ShapleyMethod, ShapleyMoments, second_order_of_salib, shapley_effects,
    shares,
};

/// The quantities estimated from the swaps of a design, in the order of the swaps. For dependent factors the swaps of
/// factors, groups and subsets are repeated before the dummy factor, redrawn given all others, followed by redrawn
/// subsets for Shapley effects.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Layout {
    /// Number of factors.
    pub factors: usize,
    /// Number of groups.
    pub groups: usize,
    /// Number of subsets that the study lists.
    pub subsets: usize,
    /// Whether the last swap is a dummy factor.
    pub dummy: bool,
    /// Estimators whose indices are reported in addition to the default ones.
    pub estimators: Vec<Estimator>,
    /// Whether the formulas of SALib replace the default ones.
    pub salib: bool,
    /// Whether there are second-order indices of the factors.
    pub second_order: bool,
    /// Whether factors depend on each other.
    pub dependent: bool,
    /// How the Shapley effects of the players are estimated, if requested.
    pub shapley: Option<ShapleyMethod>,
    /// The players, by their indices among the factors and groups in their order.
    pub players: Vec<usize>,
    /// The noise of a stochastic model, if it has one; there are no Shapley effects then, nor dependent factors.
    pub noise: Option<NoiseLayout>,
}

/// The swaps that give indices of the mean of a stochastic model over its noise.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NoiseLayout {
    /// The factor that is the noise.
    pub factor: usize,
    /// The relation of each swap to the noise.
    pub swaps: Vec<SwapNoise>,
}

/// The relation of a swap to the noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SwapNoise {
    /// It contains the noise: the mean has no such index.
    Holds,
    /// It does not, and no other swap is the same with the noise: the mean has only its first-order index.
    Alone,
    /// The swap of this number is the same with the noise: the mean also has its total index.
    With(usize),
}

impl NoiseLayout {
    /// Creates the layout for swaps of these factors, each list ascending, where `factor` is the noise.
    pub fn new(factor: usize, swaps: &[Vec<usize>]) -> Self {
        let beside = |swap: &Vec<usize>| {
            if swap.contains(&factor) {
                return SwapNoise::Holds;
            }
            let mut joined = swap.clone();
            joined.push(factor);
            joined.sort_unstable();
            let with = swaps.iter().position(|other| *other == joined).filter(|_| !swap.is_empty());
            with.map_or(SwapNoise::Alone, SwapNoise::With)
        };
        Self { factor, swaps: swaps.iter().map(beside).collect() }
    }
}

/// The numbers of one swap, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Number {
    FirstOrder,
    Total,
    ShareFirstOrder,
    ShareTotal,
    /// First-order index minus its check by another formula.
    CheckGap,
    /// Total minus first-order index.
    Interaction,
}

/// Number of variants.
const PER_SWAP: usize = Number::Interaction as usize + 1;

/// Numbers of one swap for one other estimator: first order and total, and their differences from the default ones.
const PER_ESTIMATOR: usize = 4;

impl Layout {
    /// Returns the layout of factors only.
    pub fn plain(factors: usize) -> Self {
        Self { factors, players: (0..factors).collect(), ..Self::default() }
    }

    /// Returns the number of factors, groups and subsets.
    pub fn listed(&self) -> usize {
        self.factors + self.groups + self.subsets
    }

    /// Returns the number of swaps with indices of their own, excluding those only for Shapley effects.
    pub fn swaps(&self) -> usize {
        self.redrawn(self.listed()) + usize::from(self.dummy)
    }

    /// Returns the swap in which the factors of the listed swap `swap` are redrawn: itself, if independent.
    pub fn redrawn(&self, swap: usize) -> usize {
        if self.dependent { self.listed() + swap } else { swap }
    }

    /// Returns the place of the numbers of swap `swap`.
    pub(super) fn swap(&self, swap: usize) -> usize {
        2 + swap * PER_SWAP
    }

    /// Returns the place of one of them.
    pub(super) fn place(&self, swap: usize, number: Number) -> usize {
        self.swap(swap) + number as usize
    }

    /// Returns the place of the numbers of swap `swap` for the estimator number `estimator`.
    pub(super) fn other(&self, estimator: usize, swap: usize) -> usize {
        self.swap(self.swaps()) + (estimator * self.swaps() + swap) * PER_ESTIMATOR
    }

    /// Returns the place of the second-order index of the first pair.
    pub(super) fn pairs(&self) -> usize {
        self.other(self.estimators.len(), 0)
    }

    /// Returns the place of the share of the variance of the mean over the noise; for the mean's indices after it see
    /// [`of_mean`](Self::of_mean).
    pub(super) fn mean_share(&self) -> usize {
        let pairs = self.factors * self.factors.saturating_sub(1) / 2;
        self.pairs() + if self.second_order { pairs } else { 0 }
    }

    /// Returns the place of the first-order index of swap `swap` of the mean over the noise; its total index is next.
    pub(super) fn of_mean(&self, swap: usize) -> usize {
        self.mean_share() + 1 + 2 * swap
    }

    /// Returns the place of the Shapley effect of the first player.
    pub(super) fn shapley(&self) -> usize {
        self.mean_share() + self.noise.as_ref().map_or(0, |noise| 1 + 2 * noise.swaps.len())
    }

    /// Returns whether every factor is a player, so that Shapley effects are those of factors.
    pub(super) fn has_shapley_of_factors(&self) -> bool {
        self.shapley.is_some() && self.players.iter().copied().eq(0..self.factors)
    }

    /// Returns the pairs of factors, in the order of their second-order indices.
    pub fn pair_list(&self) -> Vec<(usize, usize)> {
        (0..self.factors).flat_map(|j| (j + 1..self.factors).map(move |k| (j, k))).collect()
    }

    /// Returns where the true value may be outside an interval if few rows dominate the quantity number `place`:
    /// indices and their sums are sums of contributions of one sign, shares and gaps are not.
    pub(super) fn side(&self, place: usize) -> Side {
        let (of_swaps, of_others) = (self.swap(0)..self.other(0, 0), self.other(0, 0)..self.pairs());
        let difference = if of_swaps.contains(&place) {
            let (first, last) = (Number::ShareFirstOrder as usize, Number::CheckGap as usize);
            (first..=last).contains(&((place - of_swaps.start) % PER_SWAP))
        } else {
            of_others.contains(&place) && (place - of_others.start) % PER_ESTIMATOR >= 2 || place >= self.mean_share()
        };
        if difference { Side::Both } else { Side::Above }
    }

    /// Returns the places of the quantities whose errors decay at a separate rate: orders are random, and the errors
    /// that depend on them fall no faster with the number of points than those of random points.
    pub(super) fn random(&self) -> std::ops::Range<usize> {
        let is_random = self.shapley == Some(ShapleyMethod::Permutations);
        self.shapley()..self.shapley() + if is_random { self.players.len() } else { 0 }
    }

    /// Returns the quantities that determine the decay of errors: default first-order and total indices, no dummy.
    pub(super) fn pooled(&self, length: usize) -> Vec<bool> {
        let real = self.swap(self.swaps() - usize::from(self.dummy));
        (0..length).map(|place| (2..real).contains(&place) && (place - 2) % PER_SWAP < 2).collect()
    }
}

/// Computes all quantities of an output with `moments`, NaN if one does not exist. `None` if there are no indices.
pub(super) fn quantities(layout: &Layout, moments: &Moments) -> Option<Vec<f64>> {
    let indices = if layout.salib { Indices::of_salib(moments) } else { Indices::from_moments(moments) };
    let Indices { first_order, total, check } = indices.ok()?;
    let share_first_order = all_shares(layout, &first_order);
    let share_total = all_shares(layout, &total);
    let factors = 0..layout.factors;
    let mut list = vec![first_order[factors.clone()].iter().sum(), total[factors].iter().sum()];
    for s in 0..layout.swaps() {
        let (first, total) = (first_order[s], total[s]);
        list.extend([first, total, share_first_order[s], share_total[s], first - check[s], total - first]);
    }
    for estimator in &layout.estimators {
        let (first_formula, total_formula) = estimator.formulas();
        for s in 0..layout.swaps() {
            let first = first_formula.map_or(f64::NAN, |formula| formula.estimate(moments, s));
            let other = total_formula.map_or(f64::NAN, |formula| formula.estimate(moments, s));
            list.extend([first, other, first - first_order[s], other - total[s]]);
        }
    }
    if layout.second_order {
        let of_pair = |(j, k)| match layout.salib {
            true => second_order_of_salib(moments, j, k),
            false => SecondOrder::Difference.estimate(moments, j, k),
        };
        list.extend(layout.pair_list().into_iter().map(of_pair));
    }
    match layout.shapley {
        None => (),
        Some(ShapleyMethod::Subsets) => {
            let single: Vec<f64> = layout.players.iter().map(|player| total[layout.redrawn(*player)]).collect();
            list.extend(shapley_effects(&single, &total[layout.swaps()..]));
        }
        Some(ShapleyMethod::Permutations) => {
            list.extend(moments.shapley().map_or(vec![f64::NAN; layout.players.len()], ShapleyMoments::effects));
        }
    }
    if let Some(noise) = &layout.noise {
        // The mean has the variance V(E[y|x]) = V (1 - ST_noise), and all effects of the factors without the noise.
        let share = 1.0 - total[noise.factor];
        let index = |part: f64| if share > 0.0 { part / share } else { f64::NAN };
        list.push(share);
        for (s, beside) in noise.swaps.iter().enumerate() {
            list.extend(match *beside {
                SwapNoise::Holds => [f64::NAN; 2],
                SwapNoise::Alone => [index(first_order[s]), f64::NAN],
                SwapNoise::With(joined) => [index(first_order[s]), index(total[joined] - total[noise.factor])],
            });
        }
    }
    Some(list)
}

/// Computes shares in percent among the factors, and among the groups; NaN for subsets, which may overlap, for the
/// dummy, for the noise, which is not a factor, and for dependent factors, whose indices do not partition the variance.
fn all_shares(layout: &Layout, indices: &[f64]) -> Vec<f64> {
    if layout.dependent {
        return vec![f64::NAN; indices.len()];
    }
    let (factors, rest) = indices.split_at(layout.factors);
    let (groups, others) = rest.split_at(layout.groups);
    let of = |list: &[f64]| shares(list).unwrap_or_else(|| vec![f64::NAN; list.len()]);
    let mut known = factors.to_vec();
    if let Some(noise) = &layout.noise {
        known.remove(noise.factor);
    }
    let mut of_factors = of(&known);
    if let Some(noise) = &layout.noise {
        of_factors.insert(noise.factor, f64::NAN);
    }
    [of_factors, of(groups), vec![f64::NAN; others.len()]].concat()
}
