//! What a design is asked to be: where its points come from, how many, and their seed.

use serde::Serialize;

/// Where the points of a design come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampler {
    /// Owen-scrambled Sobol' points: the default, and the most accurate one for most models.
    Sobol,
    /// Independent uniform points.
    Random,
    /// Latin hypercube points.
    LatinHypercube,
}

impl Sampler {
    /// All samplers, the default first.
    pub const ALL: [Self; 3] = [Self::Sobol, Self::Random, Self::LatinHypercube];

    /// The name used in study files and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sobol => "sobol",
            Self::Random => "random",
            Self::LatinHypercube => "latin-hypercube",
        }
    }

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
