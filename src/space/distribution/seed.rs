//! The seeds of a stochastic model.

use super::prelude::*;
use apportion_base::quantity::Unit;

/// The largest seed, 2^31 - 1: the largest integer that the generators of C, R, Fortran and NumPy all accept.
const LARGEST: f64 = ((1u64 << 31) - 1) as f64;

/// Whole numbers from 0 to 2^31 - 1, equally likely, in no order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Seed;

impl Distribution {
    /// Returns the seeds of a stochastic model: a whole number from 0 to 2^31 - 1, a function of the coordinate; seeds
    /// of near coordinates look independent. The factor of this distribution is the *noise* of a study.
    ///
    /// # Formula
    ///
    /// The upper 31 bits of the finaliser of SplitMix64 (Steele, Lea and Flood 2014, OOPSLA, fig. 17) of the bits of
    /// `u`. It does not rise with `u`: the values are uniform, but without an inverse.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let seed = Distribution::seed();
    /// assert_eq!(seed.quantile(0.25), seed.quantile(0.25));
    /// assert_ne!(seed.quantile(0.25), seed.quantile(0.25000001));
    /// assert_eq!(seed.support(), (0.0, 2147483647.0));
    /// ```
    pub fn seed() -> Self {
        Self::Seed(Seed)
    }
}

/// Returns the finaliser of SplitMix64: every bit of the result depends on every bit of `x`.
pub(crate) fn mixed(x: u64) -> u64 {
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Returns the seed for a mixed number.
pub(crate) fn seed_of(mixed: u64) -> f64 {
    (mixed >> 33) as f64
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "seed",
    summary: "The seed of a stochastic model.",
    key_sets: &[keys(&[])],
    build: |_| Ok(Distribution::seed()),
    ..PLAIN
}];

impl Family for Seed {
    fn quantile(&self, u: f64) -> f64 {
        seed_of(mixed(u.to_bits()))
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let below = ((x.floor() + 1.0) / (LARGEST + 1.0)).clamp(0.0, 1.0);
        (below, 1.0 - below)
    }

    fn moments(&self) -> (f64, f64) {
        (LARGEST / 2.0, (LARGEST * (LARGEST + 2.0) / 12.0).sqrt())
    }

    fn support(&self) -> (f64, f64) {
        (0.0, LARGEST)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        Vec::new()
    }

    fn in_si(&self, _: &'static Entry, unit: &Unit) -> Result<Distribution, DistributionError> {
        if [0.0, 1.0].iter().any(|&x| unit.to_si(x) != x) {
            let right = ": a seed is a pure number, so leave the unit out";
            return Err(wrong_unit("seed", unit, right));
        }
        Ok(Distribution::Seed(Self))
    }
}

#[cfg(test)]
#[path = "tests/seed.rs"]
mod tests;
