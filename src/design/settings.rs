//! What a design is asked to be: where its points come from, how many, and their seed.

use serde::Serialize;

use crate::names::named;

named! {
/// Where the points of a design come from.
#[derive(Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampler {
    /// Owen-scrambled Sobol' points: the default, and the most accurate one for most models.
    Sobol = "sobol",
    /// Independent uniform points.
    Random = "random",
    /// Latin hypercube points.
    LatinHypercube = "latin-hypercube",
}
}

impl Sampler {
    /// Whether its points are scrambled digital nets, complete at powers of two.
    pub fn is_digital(self) -> bool {
        self == Self::Sobol
    }
}

/// What a design is asked to be; [`Design::new`](super::Design::new) checks it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DesignSettings {
    /// Where the points come from.
    pub sampler: Sampler,
    /// Base points in all, over the replicates; rounded up to a multiple of `replicates`.
    pub base_samples: u64,
    /// Independent randomisations that share the base points; their spread gives the intervals.
    pub replicates: u64,
    /// Seed of every random number of the design; 0 is a seed like any other.
    pub seed: u64,
}

impl Default for DesignSettings {
    /// 2^14 base points of the scrambled Sobol' sequence in 4 replicates, seed 0.
    fn default() -> Self {
        Self { sampler: Sampler::Sobol, base_samples: 1 << 14, replicates: 4, seed: 0 }
    }
}
