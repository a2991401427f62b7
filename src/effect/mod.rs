//! What has indices, and the quantities that are estimated of it.
//!
//! An [`Effect`] is a factor, the noise of a stochastic model, a group, a subset or the dummy factor. All quantities of
//! an output stand in [`Quantities`] under their effects: numbers, errors and intervals are quantities of another type.

mod layout;
mod quantities;

pub use layout::{Layout, NoiseLayout, NoisePairing};
pub use quantities::{EffectQuantities, Kind, OfMean, OfPair, OtherQuantities, Quantities};
use serde::{Deserialize, Serialize};

/// What has indices of its own: the columns that a swap of a design replaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// A factor, or a group in place of its factors, by index.
    Factor(usize),
    /// The noise of a stochastic model, which takes the place of a factor in the design.
    Noise,
    /// A group, by index.
    Group(usize),
    /// A subset that the study lists, by index.
    Subset(usize),
    /// A dummy factor, which no model reads.
    Dummy,
}

impl Effect {
    /// Returns whether the effects of this kind together are all inputs of the model: factors and the noise.
    pub fn is_input(self) -> bool {
        matches!(self, Self::Factor(_) | Self::Noise)
    }

    /// Returns whether it is a factor, or a group in place of its factors.
    pub fn is_factor(self) -> bool {
        matches!(self, Self::Factor(_))
    }

    /// Returns whether it is a group that has indices in addition to its factors.
    pub fn is_group(self) -> bool {
        matches!(self, Self::Group(_))
    }
}

/// The first-order and the total index of an effect, or what belongs to each.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "IndexPair_{T}"))]
pub struct IndexPair<T> {
    /// First-order (of several factors: closed first-order) index.
    pub first_order: T,
    /// Total index.
    pub total: T,
}

impl<T> IndexPair<T> {
    /// Returns the pair with `change` applied to both.
    pub fn map<U>(self, mut change: impl FnMut(T) -> U) -> IndexPair<U> {
        IndexPair { first_order: change(self.first_order), total: change(self.total) }
    }
}
