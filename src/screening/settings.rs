//! The settings of a screening, and their errors.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::design::{DesignError, Sampler};
use crate::run::RunError;

/// Minimum number of trajectories: with fewer there is no meaningful spread.
pub(super) const MIN_TRAJECTORIES: u64 = 4;
/// Maximum number of model runs of a screening: its effects are kept in memory, 8 bytes each.
const MAX_RUNS: u64 = 1 << 27;

/// Independent randomisations of quasi-random points, whose spread gives the intervals.
const REPLICATES: u64 = 8;
/// Maximum number of parts into which independent trajectories are divided for their intervals.
const PARTS: u64 = 64;

/// The layout of the points of a screening. All cost d + 1 runs a trajectory for d factors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "name", rename_all = "kebab-case")]
pub enum ScreeningDesign {
    /// Radial (Campolongo, Saltelli and Cariboni 2011, Comput. Phys. Commun. 182, 978-988): from a base point a, every
    /// factor by itself steps to its coordinate of an auxiliary point b. Both are halves of one point of 2d dimensions.
    Radial {
        /// The sampler.
        sampler: Sampler,
    },
    /// Morris's own trajectories (Morris 1991, Technometrics 33, 161-174): a random walk on a grid of p levels, in
    /// which every factor in turn, in random order, makes one step of p / (2 (p - 1)) of its range; in every other
    /// trajectory one of a third of the levels, which detects an output with the period of the first step.
    Trajectory {
        /// Levels p of the grid, even; 4 is usual.
        levels: u32,
    },
}

impl ScreeningDesign {
    /// Returns the name on the command line and in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Radial { .. } => "radial",
            Self::Trajectory { .. } => "trajectory",
        }
    }

    /// Returns its sampler, if it has one.
    pub fn sampler(self) -> Option<Sampler> {
        match self {
            Self::Radial { sampler } => Some(sampler),
            Self::Trajectory { .. } => None,
        }
    }
}

/// The settings of a screening.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ScreeningSettings {
    /// The layout of the points.
    pub design: ScreeningDesign,
    /// Trajectories r: elementary effects of each factor. Rounded up to equal parts, see [`in_force`](Self::in_force).
    pub trajectories: u64,
    /// Seed of every random number; 0 is a valid seed.
    pub seed: u64,
}

impl Default for ScreeningSettings {
    /// Returns 32 radial trajectories on scrambled Sobol' points, seed 0.
    fn default() -> Self {
        Self { design: ScreeningDesign::Radial { sampler: Sampler::Sobol }, trajectories: 32, seed: 0 }
    }
}

impl ScreeningSettings {
    /// Maximum number of levels of the trajectory design's grid.
    pub const MAX_LEVELS: u32 = 1000;

    /// Shortest step of the radial design, as a part of the factor's range.
    ///
    /// With steps s >= h, an elementary effect is at most |difference of the output| / h, so that sigma is finite wherever
    /// the output has a variance; with steps down to 0, a single jump of the output makes sigma infinite, since the
    /// integral of 1/s diverges. The price is a small shift of sigma: for x^2, -3 %.
    pub const MIN_STEP: f64 = 0.02;

    /// Returns the settings with `trajectories` rounded up to equal independent parts, and the number of these parts,
    /// used for the intervals: 8 randomisations of quasi-random points (fewer below 16 trajectories), or every
    /// independent trajectory by itself (64 parts above 64 trajectories).
    ///
    /// # Errors
    /// [`ScreeningError`] if there are too few trajectories or too many runs for `factors` factors, or the levels are
    /// odd or out of range.
    pub fn in_force(self, factors: usize) -> Result<(Self, u64), ScreeningError> {
        if self.trajectories < MIN_TRAJECTORIES {
            return Err(ScreeningError::TooFewTrajectories { trajectories: self.trajectories });
        }
        if let ScreeningDesign::Trajectory { levels } = self.design
            && (levels % 2 == 1 || !(2..=ScreeningSettings::MAX_LEVELS).contains(&levels))
        {
            return Err(ScreeningError::Levels { levels });
        }
        let parts = match self.design.sampler() {
            Some(Sampler::Random) | None => self.trajectories.min(PARTS),
            Some(_) => (self.trajectories / 2).min(REPLICATES),
        };
        let runs = u128::from(self.trajectories) * (factors as u128 + 1);
        if runs > u128::from(MAX_RUNS) {
            return Err(ScreeningError::TooManyRuns { trajectories: self.trajectories, factors });
        }
        Ok((Self { trajectories: self.trajectories.next_multiple_of(parts), ..self }, parts))
    }
}

/// Why a screening cannot start.
#[derive(Debug, Error)]
pub enum ScreeningError {
    /// Too few trajectories.
    #[error("{trajectories} trajectories are too few: at least {MIN_TRAJECTORIES} are needed, and 10 to 50 are usual")]
    TooFewTrajectories {
        /// The number requested.
        trajectories: u64,
    },
    /// A grid that the method does not allow.
    #[error(
        "{levels} levels: the trajectory design needs an even number from 2 to {}, so that all levels are equally likely; 4 is usual",
        ScreeningSettings::MAX_LEVELS
    )]
    Levels {
        /// The number requested.
        levels: u32,
    },
    /// Too many runs for their effects to be kept.
    #[error(
        "{trajectories} trajectories of {factors} factors are more than {MAX_RUNS} model runs: a screening needs 10 to 50 trajectories"
    )]
    TooManyRuns {
        /// The number requested.
        trajectories: u64,
        /// Number of factors.
        factors: usize,
    },
    /// Factors that depend on each other.
    #[error(
        "elementary effects change one factor and keep all others, but factors of this study depend on each other: run the \
         study with Shapley effects instead"
    )]
    Dependent,
    /// The points cannot be generated.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// The run failed.
    #[error("{0}")]
    Run(#[from] RunError),
}
