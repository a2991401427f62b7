//! The Saltelli design as a pure function of the row number: nothing is stored, any row can be made anywhere.
//!
//! A design has `replicates` independent randomisations of `base_samples / replicates` base points each. A base point
//! is one point of a 2d-dimensional sequence: its first d coordinates are the row of A, its last d the row of B. (Two
//! sequences of d dimensions each would look alike, but the indices then never converge.) Every base point stands
//! for `2 + k` rows: A, B, and one row AB_j for each of the k [`Swap`]s, which is A with some columns taken from B
//! (Saltelli et al. 2010, Comput. Phys. Commun. 181, 259-270, "radial" scheme of its table 2).

mod joe_kuo;
mod latin;
mod random;
mod sobol;

use serde::Serialize;
use thiserror::Error;

pub use joe_kuo::MAX_DIMENSIONS;
pub use latin::LatinHypercube;
pub use random::RandomPoints;
pub use sobol::SobolSequence;

/// Most base points one replicate can hold: the length of the 32-bit Sobol' sequence.
pub const MAX_POINTS: u64 = 1 << 32;

/// Most replicates of a design.
pub const MAX_REPLICATES: u64 = 4096;

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
}

/// Why a design cannot be made.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum DesignError {
    /// There is nothing to vary.
    #[error("a design needs at least one factor")]
    NoFactors,
    /// More factors than the direction numbers serve.
    #[error(
        "{factors} factors need {} dimensions of the Sobol' sequence, which has {MAX_DIMENSIONS}: at most {} factors, or another sampler",
        factors * 2,
        MAX_DIMENSIONS / 2
    )]
    TooManyFactors {
        /// The number asked for.
        factors: usize,
    },
    /// No replicate at all.
    #[error("replicates = 0: at least 1 is needed, and at least 2 for intervals")]
    NoReplicates,
    /// A replicate would hold fewer than two base points, which have no variance.
    #[error(
        "base_samples = {base_samples} is too few for {replicates} replicate{}: at least {} base samples are needed (2 in each replicate)",
        if *replicates == 1 { "" } else { "s" },
        u128::from(*replicates) * 2
    )]
    TooFewSamples {
        /// The number asked for.
        base_samples: u64,
        /// The number of replicates that share them.
        replicates: u64,
    },
    /// More replicates than anybody needs: each costs memory and a pass over the others.
    #[error("replicates = {replicates}: at most {MAX_REPLICATES} are possible, and 4 to 32 are usual")]
    TooManyReplicates {
        /// The number asked for.
        replicates: u64,
    },
    /// More model runs than can be counted.
    #[error("{base_samples} base samples of {rows_per_point} runs each are more runs than can be counted")]
    TooManyRuns {
        /// The number asked for, rounded up to whole replicates.
        base_samples: u128,
        /// Model runs of each base sample.
        rows_per_point: u64,
    },
    /// A swap names a column that does not exist.
    #[error("a swap takes column {column}, but there are {factors} factors, counted from 0")]
    NoSuchColumn {
        /// The column.
        column: usize,
        /// Number of factors.
        factors: usize,
    },
    /// A replicate would be longer than the sequence.
    #[error(
        "{base_samples} base samples in {replicates} replicates exceed {MAX_POINTS} (2^32) points a replicate, the length of the sequence"
    )]
    TooManySamples {
        /// The number asked for.
        base_samples: u64,
        /// The number of replicates that share them.
        replicates: u64,
    },
}

/// What a design is asked to be; [`Design::new`] checks it.
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
    /// 2^14 base points of the scrambled Sobol' sequence in 16 replicates, seed 0.
    fn default() -> Self {
        Self { sampler: Sampler::Sobol, base_samples: 1 << 14, replicates: 16, seed: 0 }
    }
}

/// The columns that one row AB_j takes from B: those of one factor, or of a group of factors.
pub type Swap = Vec<usize>;

/// A checked Saltelli design.
///
/// ```
/// use apportion::design::{Design, DesignSettings};
///
/// let settings = DesignSettings { base_samples: 1024, ..DesignSettings::default() };
/// let design = Design::new(settings, 3, vec![vec![0], vec![1], vec![2]])?;
/// assert_eq!(design.rows(), 1024 * 5);
/// let mut u = [0.0; 3];
/// design.point(4711, &mut u);
/// assert!(u.iter().all(|&x| x > 0.0 && x < 1.0));
/// # Ok::<(), apportion::design::DesignError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    settings: DesignSettings,
    factors: usize,
    swaps: Vec<Swap>,
}

/// What one row of a design is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowKind {
    /// The base point's first half.
    A,
    /// The base point's second half.
    B,
    /// A with the columns of swap number `.0` from B.
    Swapped(usize),
}

impl Design {
    /// A design over `factors` factors with one row AB_j for each entry of `swaps` (column numbers below `factors`).
    ///
    /// `base_samples` is rounded up to a multiple of `replicates`; [`Design::settings`] tells the number in force.
    ///
    /// # Errors
    /// [`DesignError`] if there is no factor, no replicate or more than [`MAX_REPLICATES`], fewer than two or more than
    /// 2^32 base points a replicate, more factors than the Sobol' sequence has dimensions for, or a swap of a column
    /// that does not exist.
    pub fn new(mut settings: DesignSettings, factors: usize, swaps: Vec<Swap>) -> Result<Self, DesignError> {
        let DesignSettings { sampler, base_samples, replicates, .. } = settings;
        if factors == 0 {
            return Err(DesignError::NoFactors);
        }
        if sampler == Sampler::Sobol && factors > MAX_DIMENSIONS / 2 {
            return Err(DesignError::TooManyFactors { factors });
        }
        if replicates == 0 {
            return Err(DesignError::NoReplicates);
        }
        if replicates > MAX_REPLICATES {
            return Err(DesignError::TooManyReplicates { replicates });
        }
        if let Some(&column) = swaps.iter().flatten().find(|&&column| column >= factors) {
            return Err(DesignError::NoSuchColumn { column, factors });
        }
        if base_samples / 2 < replicates {
            return Err(DesignError::TooFewSamples { base_samples, replicates });
        }
        let points = base_samples.div_ceil(replicates);
        if points > MAX_POINTS {
            return Err(DesignError::TooManySamples { base_samples, replicates });
        }
        let rows_per_point = 2 + swaps.len() as u64;
        let all = u128::from(points) * u128::from(replicates);
        if all * u128::from(rows_per_point) > u128::from(u64::MAX) {
            return Err(DesignError::TooManyRuns { base_samples: all, rows_per_point });
        }
        settings.base_samples = points * replicates;
        Ok(Self { settings, factors, swaps })
    }

    /// The settings in force, with `base_samples` rounded up.
    pub fn settings(&self) -> &DesignSettings {
        &self.settings
    }

    /// Base points in each replicate.
    pub fn points_per_replicate(&self) -> u64 {
        self.settings.base_samples / self.settings.replicates
    }

    /// Number of factors d.
    pub fn factors(&self) -> usize {
        self.factors
    }

    /// The columns each AB_j takes from B.
    pub fn swaps(&self) -> &[Swap] {
        &self.swaps
    }

    /// Rows of one base point: A, B and one for each swap.
    pub fn rows_per_point(&self) -> u64 {
        2 + self.swaps.len() as u64
    }

    /// Rows in all, which is the number of model runs.
    pub fn rows(&self) -> u64 {
        self.settings.base_samples * self.rows_per_point()
    }

    /// True if the points of a replicate are complete nets: a power of two of them, or points that need none.
    pub fn balanced(&self) -> bool {
        self.settings.sampler != Sampler::Sobol || self.points_per_replicate().is_power_of_two()
    }

    /// The base points of one replicate.
    pub fn replicate(&self, replicate: u64) -> BasePoints {
        let (dimensions, seed) = (self.factors * 2, self.settings.seed);
        match self.settings.sampler {
            Sampler::Sobol => BasePoints::Sobol(SobolSequence::scrambled(dimensions, seed, replicate)),
            Sampler::Random => BasePoints::Random(RandomPoints::new(dimensions, seed, replicate)),
            Sampler::LatinHypercube => {
                BasePoints::Latin(LatinHypercube::new(dimensions, self.points_per_replicate(), seed, replicate))
            }
        }
    }

    /// Replicate, base point within it, and kind of a row, in the order in which rows are counted.
    pub fn locate(&self, row: u64) -> (u64, u64, RowKind) {
        let (base, kind) = (row / self.rows_per_point(), row % self.rows_per_point());
        let kind = match kind {
            0 => RowKind::A,
            1 => RowKind::B,
            j => RowKind::Swapped(j as usize - 2),
        };
        (base / self.points_per_replicate(), base % self.points_per_replicate(), kind)
    }

    /// Row number `row` of the design as a point of the unit cube: `u` has one entry per factor.
    pub fn point(&self, row: u64, u: &mut [f64]) {
        let (replicate, point, kind) = self.locate(row);
        let mut columns = vec![vec![0.0; 1]; self.factors * 2];
        self.replicate(replicate).fill(point, &mut columns);
        for (column, u) in u.iter_mut().enumerate() {
            let from_b = match kind {
                RowKind::A => false,
                RowKind::B => true,
                RowKind::Swapped(j) => self.swaps[j].contains(&column),
            };
            *u = columns[if from_b { self.factors + column } else { column }][0];
        }
    }
}

/// The base points of one replicate: 2d columns, of which the first d belong to A and the last d to B.
#[derive(Debug, Clone)]
pub enum BasePoints {
    /// Scrambled Sobol' points.
    Sobol(SobolSequence),
    /// Random points.
    Random(RandomPoints),
    /// Latin hypercube points.
    Latin(LatinHypercube),
}

impl BasePoints {
    /// The points `first`, `first + 1`, ... into `columns`: one per dimension, all of one length.
    pub fn fill(&self, first: u64, columns: &mut [Vec<f64>]) {
        match self {
            Self::Sobol(sequence) => {
                for (dimension, column) in columns.iter_mut().enumerate() {
                    sequence.fill(dimension, first, column);
                }
            }
            Self::Random(points) => points.fill(first, columns),
            Self::Latin(points) => points.fill(first, columns),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn design(sampler: Sampler) -> Design {
        let settings = DesignSettings { sampler, base_samples: 64, replicates: 4, seed: 3 };
        Design::new(settings, 3, vec![vec![0], vec![1], vec![2], vec![0, 2]]).unwrap()
    }

    #[test]
    fn swapped_rows_are_a_with_the_named_columns_of_b() {
        for sampler in Sampler::ALL {
            let design = design(sampler);
            let row = |k| {
                let mut u = [0.0; 3];
                design.point(5 * design.rows_per_point() + k, &mut u);
                u
            };
            let (a, b) = (row(0), row(1));
            assert!(a.iter().zip(b).all(|(a, b)| *a != b));
            assert_eq!(row(2), [b[0], a[1], a[2]]);
            assert_eq!(row(4), [a[0], a[1], b[2]]);
            assert_eq!(row(5), [b[0], a[1], b[2]]);
        }
    }

    #[test]
    fn rows_are_counted_replicate_by_replicate() {
        let design = design(Sampler::Sobol);
        assert_eq!(design.rows(), 64 * 6);
        assert_eq!(design.locate(0), (0, 0, RowKind::A));
        assert_eq!(design.locate(6 * 16 + 1), (1, 0, RowKind::B));
        assert_eq!(design.locate(64 * 6 - 1), (3, 15, RowKind::Swapped(3)));
    }

    #[test]
    fn impossible_designs_are_refused_with_the_reason() {
        let settings = DesignSettings::default;
        let of = |settings, factors| Design::new(settings, factors, vec![]).unwrap_err();
        assert_eq!(of(settings(), 0), DesignError::NoFactors);
        assert_eq!(of(settings(), 3000), DesignError::TooManyFactors { factors: 3000 });
        assert_eq!(of(DesignSettings { replicates: 0, ..settings() }, 1), DesignError::NoReplicates);
        for base_samples in [0, 1, 31] {
            let error = of(DesignSettings { base_samples, ..settings() }, 1);
            assert_eq!(error, DesignError::TooFewSamples { base_samples, replicates: 16 });
        }
        let error = of(DesignSettings { replicates: 5000, base_samples: 1 << 20, ..settings() }, 1);
        assert_eq!(error, DesignError::TooManyReplicates { replicates: 5000 });
        let swaps = vec![vec![0]; 1 << 21];
        let full =
            DesignSettings { base_samples: MAX_POINTS * MAX_REPLICATES, replicates: MAX_REPLICATES, ..settings() };
        assert!(matches!(Design::new(full, 1, swaps), Err(DesignError::TooManyRuns { .. })));
        let error = Design::new(settings(), 2, vec![vec![2]]).unwrap_err();
        assert_eq!(error, DesignError::NoSuchColumn { column: 2, factors: 2 });
        let error = of(DesignSettings { base_samples: u64::MAX, replicates: 2, ..settings() }, 1);
        assert!(matches!(error, DesignError::TooManySamples { .. }));
    }

    #[test]
    fn samples_are_rounded_up_to_whole_replicates() {
        let settings = DesignSettings { base_samples: 1000, ..DesignSettings::default() };
        let design = Design::new(settings, 2, vec![]).unwrap();
        assert_eq!(design.settings().base_samples, 1008);
        assert!(!design.balanced());
    }
}
