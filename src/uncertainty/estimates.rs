//! All reported quantities of one output in one flat list.
//!
//! Intervals work on lists of numbers: [`quantities`] computes the list, [`Layout`] defines the places in it.

use super::concentration::Side;
use crate::estimate::{Estimator, Indices, Moments, SecondOrder, second_order_of_salib, shapley_effects, shares};

/// The quantities estimated from the swaps of a design, in the order of the swaps. For dependent factors the swaps of
/// factors, groups and subsets are repeated before the dummy factor, redrawn given all others, followed by redrawn
/// subsets for Shapley effects.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Layout {
    /// Number of factors, or of groups in their place.
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
    /// Whether there are Shapley effects of the factors.
    pub shapley: bool,
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

/// A reported quantity by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    /// The sum of the first-order indices of the factors.
    SumFirstOrder,
    /// The sum of their total indices.
    SumTotal,
    /// A number of a swap.
    Swap(usize, Number),
    /// A number of another estimator for a swap: estimator, swap, number.
    Other(usize, usize, OtherNumber),
    /// The second-order index of a pair, by its place in [`Layout::pair_list`].
    Pair(usize),
    /// The share of the variance of the mean over the noise.
    MeanShare,
    /// The first-order index of a swap of that mean.
    MeanFirstOrder(usize),
    /// Its total index.
    MeanTotal(usize),
    /// The Shapley effect of a factor.
    Shapley(usize),
}

/// The numbers of one swap.
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

/// The numbers of one swap for another estimator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OtherNumber {
    FirstOrder,
    Total,
    /// First-order index minus the default one.
    FirstOrderGap,
    /// Total index minus the default one.
    TotalGap,
}

impl Number {
    pub(super) const ALL: [Self; 6] =
        [Self::FirstOrder, Self::Total, Self::ShareFirstOrder, Self::ShareTotal, Self::CheckGap, Self::Interaction];
}

impl OtherNumber {
    pub(super) const ALL: [Self; 4] = [Self::FirstOrder, Self::Total, Self::FirstOrderGap, Self::TotalGap];
}

/// The behaviour of the errors of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ErrorKind {
    /// Where the true value may be outside an interval if few rows dominate the quantity.
    pub side: Side,
    /// Whether it helps to determine how fast all errors decrease with the number of points.
    pub is_pooled: bool,
}

impl Layout {
    /// Returns the layout of factors only.
    pub fn plain(factors: usize) -> Self {
        Self { factors, ..Self::default() }
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

    /// Returns the place of `quantity` in the list.
    pub(super) fn place(&self, quantity: Quantity) -> usize {
        match quantity {
            Quantity::SumFirstOrder => 0,
            Quantity::SumTotal => 1,
            Quantity::Swap(swap, number) => 2 + swap * Number::ALL.len() + number as usize,
            Quantity::Other(estimator, swap, number) => {
                let first = self.place(Quantity::Swap(self.swaps(), Number::FirstOrder));
                first + (estimator * self.swaps() + swap) * OtherNumber::ALL.len() + number as usize
            }
            Quantity::Pair(pair) => {
                pair + self.place(Quantity::Other(self.estimators.len(), 0, OtherNumber::FirstOrder))
            }
            Quantity::MeanShare => {
                let pairs = self.factors * self.factors.saturating_sub(1) / 2;
                self.place(Quantity::Pair(if self.second_order { pairs } else { 0 }))
            }
            Quantity::MeanFirstOrder(swap) => self.place(Quantity::MeanShare) + 1 + 2 * swap,
            Quantity::MeanTotal(swap) => self.place(Quantity::MeanFirstOrder(swap)) + 1,
            Quantity::Shapley(factor) => {
                let of_mean = self.noise.as_ref().map_or(0, |noise| 1 + 2 * noise.swaps.len());
                self.place(Quantity::MeanShare) + of_mean + factor
            }
        }
    }

    /// Returns the names of all quantities, in the order of the list.
    fn names(&self) -> Vec<Quantity> {
        let swaps = 0..self.swaps();
        let mut names = vec![Quantity::SumFirstOrder, Quantity::SumTotal];
        names.extend(swaps.clone().flat_map(|swap| Number::ALL.map(|number| Quantity::Swap(swap, number))));
        for estimator in 0..self.estimators.len() {
            let of_swap = |swap| OtherNumber::ALL.map(|number| Quantity::Other(estimator, swap, number));
            names.extend(swaps.clone().flat_map(of_swap));
        }
        if self.second_order {
            names.extend((0..self.pair_list().len()).map(Quantity::Pair));
        }
        if let Some(noise) = &self.noise {
            names.push(Quantity::MeanShare);
            let of_swap = |swap| [Quantity::MeanFirstOrder(swap), Quantity::MeanTotal(swap)];
            names.extend((0..noise.swaps.len()).flat_map(of_swap));
        }
        if self.shapley {
            names.extend((0..self.factors).map(Quantity::Shapley));
        }
        names
    }

    /// Returns the pairs of factors, in the order of their second-order indices.
    pub fn pair_list(&self) -> Vec<(usize, usize)> {
        (0..self.factors).flat_map(|j| (j + 1..self.factors).map(move |k| (j, k))).collect()
    }

    /// Returns the behaviour of the errors of all quantities, in the order of the list: indices and their sums are sums
    /// of contributions of one sign, shares and gaps are not.
    pub(super) fn error_kinds(&self) -> Vec<ErrorKind> {
        let real = self.swaps() - usize::from(self.dummy);
        let kind = |name| match name {
            Quantity::Swap(swap, Number::FirstOrder | Number::Total) if swap < real => (Side::Above, true),
            Quantity::Swap(_, Number::ShareFirstOrder | Number::ShareTotal | Number::CheckGap)
            | Quantity::Other(_, _, OtherNumber::FirstOrderGap | OtherNumber::TotalGap)
            | Quantity::MeanShare
            | Quantity::MeanFirstOrder(_)
            | Quantity::MeanTotal(_)
            | Quantity::Shapley(_) => (Side::Both, false),
            _ => (Side::Above, false),
        };
        self.names().into_iter().map(kind).map(|(side, is_pooled)| ErrorKind { side, is_pooled }).collect()
    }
}

/// Computes all quantities of an output with `moments`, NaN if one does not exist. `None` if there are no indices.
pub(super) fn quantities(layout: &Layout, moments: &Moments) -> Option<Vec<f64>> {
    let indices = if layout.salib { Indices::of_salib(moments) } else { Indices::from_moments(moments) };
    let Indices { first_order, total, check } = indices.ok()?;
    let share_first_order = all_shares(layout, &first_order);
    let share_total = all_shares(layout, &total);
    let factors = 0..layout.factors;
    let formulas: Vec<_> = layout.estimators.iter().map(|estimator| estimator.formulas()).collect();
    let first_by = |estimator: usize, swap| formulas[estimator].0.map_or(f64::NAN, |f| f.estimate(moments, swap));
    let total_by = |estimator: usize, swap| formulas[estimator].1.map_or(f64::NAN, |f| f.estimate(moments, swap));
    let pairs = layout.pair_list();
    let shapley = if layout.shapley {
        let single: Vec<f64> = factors.clone().map(|factor| total[layout.redrawn(factor)]).collect();
        shapley_effects(&single, &total[layout.swaps()..])
    } else {
        Vec::new()
    };
    // The mean has the variance V(E[y|x]) = V (1 - ST_noise), and all effects of the factors without the noise.
    let of_noise = layout.noise.as_ref().map_or(f64::NAN, |noise| total[noise.factor]);
    let of_mean = |part: f64| if 1.0 - of_noise > 0.0 { part / (1.0 - of_noise) } else { f64::NAN };
    let relation = |swap: usize| layout.noise.as_ref().map_or(SwapNoise::Holds, |noise| noise.swaps[swap]);
    let value = |name| match name {
        Quantity::SumFirstOrder => first_order[factors.clone()].iter().sum(),
        Quantity::SumTotal => total[factors.clone()].iter().sum(),
        Quantity::Swap(swap, Number::FirstOrder) => first_order[swap],
        Quantity::Swap(swap, Number::Total) => total[swap],
        Quantity::Swap(swap, Number::ShareFirstOrder) => share_first_order[swap],
        Quantity::Swap(swap, Number::ShareTotal) => share_total[swap],
        Quantity::Swap(swap, Number::CheckGap) => first_order[swap] - check[swap],
        Quantity::Swap(swap, Number::Interaction) => total[swap] - first_order[swap],
        Quantity::Other(estimator, swap, OtherNumber::FirstOrder) => first_by(estimator, swap),
        Quantity::Other(estimator, swap, OtherNumber::Total) => total_by(estimator, swap),
        Quantity::Other(estimator, swap, OtherNumber::FirstOrderGap) => first_by(estimator, swap) - first_order[swap],
        Quantity::Other(estimator, swap, OtherNumber::TotalGap) => total_by(estimator, swap) - total[swap],
        Quantity::Pair(pair) if layout.salib => second_order_of_salib(moments, pairs[pair].0, pairs[pair].1),
        Quantity::Pair(pair) => SecondOrder::Difference.estimate(moments, pairs[pair].0, pairs[pair].1),
        Quantity::Shapley(factor) => shapley[factor],
        Quantity::MeanShare => 1.0 - of_noise,
        Quantity::MeanFirstOrder(swap) => match relation(swap) {
            SwapNoise::Holds => f64::NAN,
            SwapNoise::Alone | SwapNoise::With(_) => of_mean(first_order[swap]),
        },
        Quantity::MeanTotal(swap) => match relation(swap) {
            SwapNoise::With(joined) => of_mean(total[joined] - of_noise),
            SwapNoise::Holds | SwapNoise::Alone => f64::NAN,
        },
    };
    Some(layout.names().into_iter().map(value).collect())
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

#[cfg(test)]
mod tests;
