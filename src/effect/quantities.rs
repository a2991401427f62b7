//! All quantities of one output, each under its effect.

use super::{Effect, IndexPair};

/// The quantities of one effect.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectQuantities<T> {
    /// The effect.
    pub effect: Effect,
    /// First-order (of several factors: closed first-order) index.
    pub first_order: T,
    /// Total index.
    pub total: T,
    /// The percentages of both among the factors, or among the groups.
    pub shares: IndexPair<T>,
    /// First-order index minus its check by another formula.
    pub check_gap: T,
    /// Total minus first-order index.
    pub interaction: T,
    /// The indices by each of the other requested estimators.
    pub others: Vec<OtherQuantities<T>>,
    /// Indices of the mean over the noise; `None` without noise, and of what contains it.
    pub of_mean: Option<OfMean<T>>,
    /// The Shapley effect of a factor, if requested.
    pub shapley: Option<T>,
}

/// The indices of one effect by another estimator than the default one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OtherQuantities<T> {
    /// First-order index.
    pub first_order: T,
    /// Total index.
    pub total: T,
    /// First-order index minus the default one.
    pub first_order_gap: T,
    /// Total index minus the default one.
    pub total_gap: T,
}

/// The indices of one effect on the mean of a stochastic model over its noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OfMean<T> {
    /// (Closed) first-order index: S/(1 - ST of the noise).
    pub first_order: T,
    /// Total index; `None` without the joint index with the noise, from which it follows.
    pub total: Option<T>,
}

/// The second-order index of a pair of factors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OfPair<T> {
    /// The positions of the factors, in rising order.
    pub factors: (usize, usize),
    /// Their index.
    pub value: T,
}

/// All quantities of one output.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantities<T> {
    /// The sums of the indices of all factors.
    pub sums: IndexPair<T>,
    /// The quantities of each effect.
    pub effects: Vec<EffectQuantities<T>>,
    /// The same for dependent factors, redrawn given all others; empty if factors are independent.
    pub redrawn: Vec<EffectQuantities<T>>,
    /// The second-order indices of the factors, if requested.
    pub pairs: Vec<OfPair<T>>,
    /// The share of the variance that is variance of the mean over the noise, if there is a noise.
    pub mean_share: Option<T>,
}

/// The kinds of quantities, by the behaviour of their errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A first-order or total index by the default estimators, of an effect but the dummy.
    Index,
    /// Another sum of contributions of one sign: a sum of indices, an index of the dummy, by another estimator or of a pair.
    Sum,
    /// A difference, or a quotient of two numbers that both have errors.
    Difference,
}

impl<T> EffectQuantities<T> {
    fn map<U>(self, f: &mut impl FnMut(Kind, T) -> U) -> EffectQuantities<U> {
        let index = if self.effect == Effect::Dummy { Kind::Sum } else { Kind::Index };
        EffectQuantities {
            effect: self.effect,
            first_order: f(index, self.first_order),
            total: f(index, self.total),
            shares: self.shares.map(|share| f(Kind::Difference, share)),
            check_gap: f(Kind::Difference, self.check_gap),
            interaction: f(Kind::Sum, self.interaction),
            others: self.others.into_iter().map(|other| other.map(f)).collect(),
            of_mean: self.of_mean.map(|of_mean| OfMean {
                first_order: f(Kind::Difference, of_mean.first_order),
                total: of_mean.total.map(|total| f(Kind::Difference, total)),
            }),
            shapley: self.shapley.map(|shapley| f(Kind::Difference, shapley)),
        }
    }
}

impl<T> OtherQuantities<T> {
    fn map<U>(self, f: &mut impl FnMut(Kind, T) -> U) -> OtherQuantities<U> {
        OtherQuantities {
            first_order: f(Kind::Sum, self.first_order),
            total: f(Kind::Sum, self.total),
            first_order_gap: f(Kind::Difference, self.first_order_gap),
            total_gap: f(Kind::Difference, self.total_gap),
        }
    }
}

impl<T> Quantities<T> {
    /// Returns the quantities with `f` applied to each and its kind, always in the same order.
    pub fn map<U>(self, mut f: impl FnMut(Kind, T) -> U) -> Quantities<U> {
        Quantities {
            sums: self.sums.map(|sum| f(Kind::Sum, sum)),
            effects: self.effects.into_iter().map(|effect| effect.map(&mut f)).collect(),
            redrawn: self.redrawn.into_iter().map(|effect| effect.map(&mut f)).collect(),
            pairs: self
                .pairs
                .into_iter()
                .map(|OfPair { factors, value }| OfPair { factors, value: f(Kind::Sum, value) })
                .collect(),
            mean_share: self.mean_share.map(|share| f(Kind::Difference, share)),
        }
    }

    /// Returns all quantities in the order of [`map`](Self::map).
    pub fn into_list(self) -> Vec<T> {
        let mut list = Vec::with_capacity(8 * self.effects.len() + 2);
        self.map(|_, quantity| list.push(quantity));
        list
    }

    /// Pairs each quantity with the one at its place in `list`, which is in the order of [`map`](Self::map).
    ///
    /// # Panics
    /// If `list` is shorter.
    pub fn zip<U>(self, list: impl IntoIterator<Item = U>) -> Quantities<(T, U)> {
        let mut list = list.into_iter();
        self.map(|_, quantity| (quantity, list.next().expect("one entry for each quantity")))
    }
}
