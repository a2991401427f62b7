//! The effects of a study, and what is estimated of them.

use super::Effect;
use crate::estimate::Estimator;

/// What is estimated from the swaps of a design. The swaps are those of the effects, in their order; for dependent
/// factors all but the dummy follow once more, redrawn given all other factors; then redrawn subsets for Shapley effects.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Layout {
    /// Factors (or groups in their place), further groups, subsets, dummy.
    pub effects: Vec<Effect>,
    /// Estimators whose indices are reported in addition to the default ones.
    pub estimators: Vec<Estimator>,
    /// Whether there are second-order indices of the factors.
    pub second_order: bool,
    /// Whether factors depend on each other.
    pub dependent: bool,
    /// Whether there are Shapley effects of the factors.
    pub shapley: bool,
    /// The noise of a stochastic model, if it has one; there are no Shapley effects then, nor dependent factors.
    pub noise: Option<NoiseLayout>,
}

/// The effects that have indices of the mean of a stochastic model over its noise.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NoiseLayout {
    /// The position of the noise among the effects.
    pub factor: usize,
    /// The relation of each effect to the noise.
    pub pairings: Vec<NoisePairing>,
}

/// The relation of an effect to the noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoisePairing {
    /// It contains the noise: the mean has no such index.
    Contains,
    /// It does not, and no other effect is the same with the noise: the mean has only its first-order index.
    Unpaired,
    /// The effect at this position is the same with the noise: the mean also has its total index.
    PairedWith(usize),
}

impl NoiseLayout {
    /// Creates the layout for swaps of these factors, each list ascending, where `factor` is the noise.
    pub fn new(factor: usize, swaps: &[Vec<usize>]) -> Self {
        Self { factor, pairings: swaps.iter().map(|swap| pairing(factor, swap, swaps)).collect() }
    }
}

fn pairing(noise: usize, swap: &[usize], swaps: &[Vec<usize>]) -> NoisePairing {
    if swap.contains(&noise) {
        return NoisePairing::Contains;
    }
    let mut joined = swap.to_vec();
    joined.push(noise);
    joined.sort_unstable();
    let with = swaps.iter().position(|other| *other == joined).filter(|_| !swap.is_empty());
    with.map_or(NoisePairing::Unpaired, NoisePairing::PairedWith)
}

impl Layout {
    /// Returns the layout of factors only.
    pub fn plain(factors: usize) -> Self {
        Self { effects: (0..factors).map(Effect::Factor).collect(), ..Self::default() }
    }

    /// Returns the number of factors, the noise included.
    pub fn inputs(&self) -> usize {
        self.effects.iter().filter(|effect| effect.is_input()).count()
    }

    /// Returns the number of effects that dependent factors repeat, redrawn: all but the dummy.
    pub(crate) fn listed(&self) -> usize {
        self.effects.iter().filter(|effect| **effect != Effect::Dummy).count()
    }

    /// Returns the number of swaps with indices of their own, excluding those only for Shapley effects.
    pub(crate) fn swaps(&self) -> usize {
        self.effects.len() + if self.dependent { self.listed() } else { 0 }
    }

    /// Returns the swap of the effect at `position`; of dependent factors the one that the others follow.
    pub(crate) fn swap(&self, position: usize) -> usize {
        if self.effects[position] == Effect::Dummy { self.swaps() - 1 } else { position }
    }

    /// Returns the swap in which only the factors of the effect at `position` are redrawn: its own, if independent.
    pub(crate) fn redrawn_swap(&self, position: usize) -> usize {
        if self.dependent && position < self.listed() { self.listed() + position } else { self.swap(position) }
    }

    /// Returns the pairs of factors, in the order of their second-order indices.
    pub fn pair_list(&self) -> Vec<(usize, usize)> {
        let factors = self.inputs();
        (0..factors).flat_map(|j| (j + 1..factors).map(move |k| (j, k))).collect()
    }
}
