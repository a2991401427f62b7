//! Validity flags: a result exists, but an assumption behind it is violated.

use apportion_base::names::named;

named! {
    /// A violated assumption.
    pub enum Flag {
        /// The contact radius exceeds 0.3 particle radii: half-space contact mechanics no longer holds.
        LargeContact = "large-contact",
        /// The mean pressure F_Z/(pi a^2) exceeds the hardness of the particle: it would flow plastically.
        AboveHardness = "above-hardness",
        /// The cantilever twists by more than 0.1 rad: the small-angle geometry no longer holds.
        LargeTwist = "large-twist",
        /// The Tabor parameter is outside the range of the chosen contact theory. Never raised without adhesion, where
        /// all theories agree.
        TaborOutOfRange = "tabor-out-of-range",
        /// The LuGre fast form was used although the velocity is above 1 % of the Stribeck velocity.
        FastLuGreForm = "fast-lugre-form",
    }
}

impl Flag {
    /// Returns a sentence for reports.
    pub const fn description(self) -> &'static str {
        match self {
            Self::LargeContact => {
                "The contact radius exceeds 0.3 particle radii: half-space contact mechanics no longer holds."
            }
            Self::AboveHardness => {
                "The mean contact pressure exceeds the hardness: the particle would flow plastically."
            }
            Self::LargeTwist => "The cantilever twists by more than 0.1 rad: the small-angle geometry no longer holds.",
            Self::TaborOutOfRange => "The Tabor parameter lies outside the range of the chosen contact theory.",
            Self::FastLuGreForm => {
                "The fast form of the LuGre law was used although the velocity is above 1 % of the Stribeck velocity."
            }
        }
    }
}

/// A set of [`Flag`]s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Flags(u8);

impl Flags {
    /// The empty set.
    pub const NONE: Self = Self(0);

    /// Returns this set with `flag` added if `raised`.
    #[inline(always)]
    #[must_use]
    pub const fn with(self, flag: Flag, raised: bool) -> Self {
        Self(self.0 | (raised as u8) << flag as u8)
    }

    /// Returns whether `flag` is in the set.
    #[inline]
    pub const fn contains(self, flag: Flag) -> bool {
        self.0 >> flag as u8 & 1 != 0
    }

    /// Iterates over the flags in the set, in the order of [`Flag::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Flag> {
        Flag::ALL.iter().copied().filter(move |&flag| self.contains(flag))
    }
}

#[cfg(test)]
#[path = "tests/flags.rs"]
mod tests;
