//! Physical ranges of quantities.

use std::f64::consts::FRAC_PI_2;
use std::fmt;

/// The physical range of a quantity. Every domain contains only finite numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Domain {
    /// Greater than zero.
    Positive,
    /// Zero or greater.
    NonNegative,
    /// From -1, excluded, to 1/2, included: the Poisson ratio of a stable isotropic solid.
    PoissonRatio,
    /// From 0 to a right angle, both included (rad).
    AcuteAngle,
}

impl Domain {
    /// Returns whether `value` is finite and in the domain.
    #[inline]
    pub fn contains(self, value: f64) -> bool {
        match self {
            Self::Positive => value > 0.0 && value < f64::INFINITY,
            Self::NonNegative => (0.0..f64::INFINITY).contains(&value),
            Self::PoissonRatio => value > -1.0 && value <= 0.5,
            Self::AcuteAngle => (0.0..=FRAC_PI_2).contains(&value),
        }
    }
}

/// Completes "must be": `> 0`, `>= 0`, `in (-1, 0.5]`, `in [0, pi/2]`.
impl fmt::Display for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Positive => "> 0",
            Self::NonNegative => ">= 0",
            Self::PoissonRatio => "in (-1, 0.5]",
            Self::AcuteAngle => "in [0, pi/2]",
        })
    }
}
