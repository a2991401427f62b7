//! The settings of a design: its sampler, size and seed.

use serde::{Deserialize, Serialize};

use apportion_base::names::named;

named! {
/// Where the points of a design come from.
#[derive(Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
    /// Returns whether its points are scrambled digital nets, complete at powers of two.
    pub fn is_digital(self) -> bool {
        self == Self::Sobol
    }
}

/// The settings of a design, checked by [`Design::new`](super::Design::new).
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct DesignSettings {
    /// The sampler.
    pub sampler: Sampler,
    /// Total number of base points over the replicates; rounded up to a multiple of `replicates`.
    pub base_samples: u64,
    /// Independent randomisations that share the base points; their spread gives the intervals.
    pub replicates: u64,
    /// Seed of every random number of the design; 0 is a valid seed.
    pub seed: u64,
}

impl Default for DesignSettings {
    /// Returns 2^14 base points of the scrambled Sobol' sequence in 4 replicates, seed 0.
    fn default() -> Self {
        Self { sampler: Sampler::Sobol, base_samples: 1 << 14, replicates: 4, seed: 0 }
    }
}
