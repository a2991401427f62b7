//! All quantities of an output from its sums.

use super::{Estimator, Indices, Moments, second_order, shapley_effects, shares};
use crate::effect::{
    Effect, EffectQuantities, IndexPair, Layout, NoisePairing, OfMean, OfPair, OtherQuantities, Quantities,
};

/// Computes all quantities of an output with `moments`, NaN if one does not exist. `None` if there are no indices.
pub(crate) fn quantities(layout: &Layout, moments: &Moments) -> Option<Quantities<f64>> {
    let indices = Indices::from_moments(moments).ok()?;
    let sums = SwapSums { layout, moments, indices: &indices };
    let mut effects: Vec<EffectQuantities<f64>> =
        layout.effects.iter().enumerate().map(|(at, effect)| sums.of_swap(*effect, layout.swap(at))).collect();
    let mut redrawn = Vec::new();
    if layout.dependent {
        let listed = layout.effects.iter().take(layout.listed()).enumerate();
        redrawn = listed.map(|(at, effect)| sums.of_swap(*effect, layout.redrawn_swap(at))).collect();
    } else {
        fill_shares(&mut effects);
    }
    let inputs = layout.inputs();
    if layout.shapley {
        let single: Vec<f64> = (0..inputs).map(|factor| indices.total[layout.redrawn_swap(factor)]).collect();
        for (effect, shapley) in effects.iter_mut().zip(shapley_effects(&single, &indices.total[layout.swaps()..])) {
            effect.shapley = Some(shapley);
        }
    }
    let pairs = if layout.second_order { layout.pair_list() } else { Vec::new() };
    Some(Quantities {
        sums: IndexPair {
            first_order: indices.first_order[..inputs].iter().sum(),
            total: indices.total[..inputs].iter().sum(),
        },
        pairs: pairs.into_iter().map(|factors| OfPair { factors, value: sums.of_pair(factors) }).collect(),
        mean_share: layout.noise.as_ref().map(|noise| 1.0 - indices.total[noise.factor]),
        effects,
        redrawn,
    })
}

/// The sums of an output, and the indices of every swap.
struct SwapSums<'a> {
    layout: &'a Layout,
    moments: &'a Moments,
    indices: &'a Indices,
}

impl SwapSums<'_> {
    fn of_swap(&self, effect: Effect, swap: usize) -> EffectQuantities<f64> {
        let (first_order, total) = (self.indices.first_order[swap], self.indices.total[swap]);
        let others = self.layout.estimators.iter();
        EffectQuantities {
            effect,
            first_order,
            total,
            shares: IndexPair { first_order: f64::NAN, total: f64::NAN },
            check_gap: first_order - self.indices.check[swap],
            interaction: total - first_order,
            others: others.map(|estimator| self.by_estimator(*estimator, swap)).collect(),
            of_mean: self.of_mean(swap),
            shapley: None,
        }
    }

    fn by_estimator(&self, estimator: Estimator, swap: usize) -> OtherQuantities<f64> {
        let (first_formula, total_formula) = estimator.formulas();
        let first_order = first_formula.map_or(f64::NAN, |formula| formula.estimate(self.moments, swap));
        let total = total_formula.map_or(f64::NAN, |formula| formula.estimate(self.moments, swap));
        OtherQuantities {
            first_order,
            total,
            first_order_gap: first_order - self.indices.first_order[swap],
            total_gap: total - self.indices.total[swap],
        }
    }

    fn of_pair(&self, (j, k): (usize, usize)) -> f64 {
        second_order(self.moments, j, k)
    }

    /// Returns the indices of the mean: it has the variance V(E[y|x]) = V (1 - ST_noise), and all effects of the factors
    /// without the noise.
    fn of_mean(&self, swap: usize) -> Option<OfMean<f64>> {
        let noise = self.layout.noise.as_ref()?;
        let of_noise = self.indices.total[noise.factor];
        let rest = if 1.0 - of_noise > 0.0 { 1.0 - of_noise } else { f64::NAN };
        let first_order = self.indices.first_order[swap] / rest;
        match noise.pairings[swap] {
            NoisePairing::Contains => None,
            NoisePairing::Unpaired => Some(OfMean { first_order, total: None }),
            NoisePairing::PairedWith(joined) => {
                Some(OfMean { first_order, total: Some((self.indices.total[joined] - of_noise) / rest) })
            }
        }
    }
}

/// Computes shares in percent among the factors, and among the groups; they stay NaN for subsets, which may overlap, for
/// the dummy, and for the noise, which is not a factor.
fn fill_shares(effects: &mut [EffectQuantities<f64>]) {
    for is_of_kind in [Effect::is_factor, Effect::is_group] {
        let mut of_kind: Vec<_> = effects.iter_mut().filter(|quantities| is_of_kind(quantities.effect)).collect();
        let first_order: Vec<f64> = of_kind.iter().map(|quantities| quantities.first_order).collect();
        let total: Vec<f64> = of_kind.iter().map(|quantities| quantities.total).collect();
        for (quantities, share) in of_kind.iter_mut().zip(shares(&first_order).into_iter().flatten()) {
            quantities.shares.first_order = share;
        }
        for (quantities, share) in of_kind.iter_mut().zip(shares(&total).into_iter().flatten()) {
            quantities.shares.total = share;
        }
    }
}
