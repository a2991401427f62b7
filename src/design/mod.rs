//! The Saltelli design as a pure function of the row number: nothing is stored, and any row can be computed anywhere.
//!
//! A design has `replicates` independent randomisations of `base_samples / replicates` base points each. A base point
//! is one point of a 2d-dimensional sequence: its first d coordinates are the row of A, its last d the row of B. (Two
//! sequences of d dimensions each would look similar, but the indices then never converge.) Every base point has `2 +
//! k` rows: A, B, and one row AB_s for each of the k `Swap`s, which is A with some columns taken from B (Saltelli et
//! al. 2010, Comput. Phys. Commun. 181, 259-270, "radial" scheme of its table 2). Rows BA_s, B with columns from A, are
//! added for the estimators that need them. Rows at the same point are run only once. A design without swaps is
//! one of plain rows.

mod base;
mod error;
mod joe_kuo;
mod latin;
mod mixed;
mod random;
mod rows;
mod settings;
mod sobol;

use std::collections::BTreeSet;

pub use base::BasePoints;
pub use error::DesignError;
use joe_kuo::MAX_DIMENSIONS;
use latin::LatinHypercube;
use random::RandomPoints;
pub(crate) use random::shuffle;
use rows::Runs;
pub(crate) use rows::Swap;
pub use rows::{Matrix, RowKind, Rows, Run};
pub use settings::{DesignSettings, Sampler};
pub use sobol::SobolSequence;

/// Maximum number of replicates of a design.
const MAX_REPLICATES: u64 = 4096;

/// Maximum number of factors for second-order indices: their sums take d (d - 1) numbers for every output.
const MAX_PAIRED_FACTORS: usize = 256;

/// A checked Saltelli design.
///
/// ```
/// use apportion::{Design, DesignSettings, Rows};
///
/// let settings = DesignSettings { base_samples: 1024, ..DesignSettings::default() };
/// let design = Design::new(settings, 3, Rows::plain(vec![vec![0], vec![1], vec![2]]))?;
/// assert_eq!(design.rows(), 1024 * 5);
/// let mut u = [0.0; 3];
/// design.point(4711, &mut u);
/// assert!(u.iter().all(|&x| x > 0.0 && x < 1.0));
/// # Ok::<(), apportion::DesignError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    settings: DesignSettings,
    factors: usize,
    requested: Rows,
    runs: Runs,
    /// The swaps without a common column, whose pairs have second-order indices.
    disjoint: Vec<usize>,
}

impl Design {
    /// Maximum number of base points in a replicate: the length of the 32-bit Sobol' sequence.
    pub const MAX_POINTS: u64 = 1 << 32;

    /// Maximum number of factors of a design, for any sampler: every base point costs a run for each of them.
    pub const MAX_FACTORS: usize = 10_000;

    /// Creates a design over `factors` factors with `rows` (column numbers below `factors`) in addition to A and B.
    ///
    /// `base_samples` is rounded up to a multiple of `replicates`; [`Design::settings`] returns the rounded number.
    ///
    /// # Errors
    /// [`DesignError`] if there is no factor, no replicate or more than 4096, fewer than two or more than
    /// 2^32 base points a replicate, more factors than the Sobol' sequence has dimensions for, a swap of a column that
    /// does not exist, second-order indices without the rows BA, of more than 256 factors
    /// or of dependent factors.
    pub fn new(mut settings: DesignSettings, factors: usize, rows: Rows) -> Result<Self, DesignError> {
        let DesignSettings { sampler, base_samples, replicates, .. } = settings;
        let points = base_samples.div_ceil(replicates.max(1));
        let is_too_long = points > Design::MAX_POINTS;
        let varying = rows.varying(factors).len();
        refuse([
            (factors == 0, DesignError::NoFactors),
            (factors > Design::MAX_FACTORS, DesignError::FarTooManyFactors { factors }),
            (
                sampler == Sampler::Sobol && varying > MAX_DIMENSIONS / 2,
                DesignError::TooManyFactors { factors: varying },
            ),
            (replicates == 0, DesignError::NoReplicates),
            (replicates > MAX_REPLICATES, DesignError::TooManyReplicates { replicates }),
        ])?;
        if let Some(&column) = rows.swaps.iter().flatten().find(|&&column| column >= factors) {
            return Err(DesignError::NoSuchColumn { column, factors });
        }
        let (disjoint, is_dependent) = (disjoint_swaps(&rows.swaps), rows.copula.is_some());
        let of_copula = rows.copula.as_ref().map_or(factors, |copula| copula.factors());
        refuse([
            (base_samples / 2 < replicates, DesignError::TooFewSamples { base_samples, replicates }),
            (is_too_long, DesignError::TooManySamples { base_samples, replicates }),
            (rows.second_order && !rows.ba, DesignError::SecondOrderWithoutBa),
            (
                rows.second_order && disjoint.len() > MAX_PAIRED_FACTORS,
                DesignError::TooManyPairs { factors: disjoint.len() },
            ),
            (is_dependent && rows.second_order, DesignError::PairsOfDependentFactors),
            (of_copula != factors, DesignError::OtherFactors { copula: of_copula, factors }),
        ])?;
        let runs = Runs::new(&rows, factors);
        let rows_per_point = runs.runs.len() as u64;
        let all = u128::from(points) * u128::from(replicates);
        if all * u128::from(rows_per_point) > u128::from(u64::MAX) {
            return Err(DesignError::TooManyRuns { base_samples: all, rows_per_point });
        }
        settings.base_samples = points * replicates;
        Ok(Self { settings, factors, requested: rows, runs, disjoint })
    }

    /// Returns the settings, with `base_samples` rounded up.
    pub fn settings(&self) -> &DesignSettings {
        &self.settings
    }

    /// Returns the number of base points in each replicate.
    pub fn points_per_replicate(&self) -> u64 {
        self.settings.base_samples / self.settings.replicates
    }

    /// Returns the same design with `points` base points in each replicate; except for Latin hypercubes, the longer of
    /// the two contains the points of the shorter.
    ///
    /// # Errors
    /// [`DesignError`] if that is too many or too few.
    pub fn with_points(&self, points: u64) -> Result<Self, DesignError> {
        let base_samples = points.saturating_mul(self.settings.replicates);
        Self::new(DesignSettings { base_samples, ..self.settings.clone() }, self.factors, self.requested.clone())
    }

    /// Returns the longest design that a run of this one can grow into.
    pub(crate) fn longest(&self) -> Self {
        let mut points = Design::MAX_POINTS;
        loop {
            match self.with_points(points) {
                Ok(longest) => return longest,
                Err(_) if points > self.points_per_replicate() => points /= 2,
                Err(_) => return self.clone(),
            }
        }
    }

    /// Returns the number of factors d.
    pub fn factors(&self) -> usize {
        self.factors
    }

    /// Returns the requested rows, including repetitions.
    pub fn requested(&self) -> &Rows {
        &self.requested
    }

    /// Returns the columns each AB_s takes from B.
    pub fn swaps(&self) -> &[Swap] {
        &self.requested.swaps
    }

    /// Returns whether every AB_s has a row BA_s.
    pub fn has_ba(&self) -> bool {
        self.requested.ba
    }

    /// Returns the swaps whose pairs have second-order indices: those that share no column with an earlier one. Empty if second-order indices were not requested.
    pub fn paired(&self) -> &[usize] {
        if self.requested.second_order { &self.disjoint } else { &[] }
    }

    /// Returns the number of columns of the base points: d for each of the matrices A and B; then those of dependent
    /// factors that follow others.
    pub fn columns(&self) -> usize {
        let mixed = self.runs.mixed.as_ref().map_or(0, |mixed| mixed.columns.len());
        2 * self.factors + mixed
    }

    /// Returns the factor of a column.
    pub(crate) fn factor_of(&self, column: usize) -> usize {
        let mixed = self.runs.mixed.as_ref().and_then(|mixed| mixed.columns.get(column.checked_sub(mixed.first)?));
        mixed.map_or(column % self.factors, |mixed| mixed.factor)
    }

    /// Returns the index of the column from which `run` takes `factor`.
    pub fn column(&self, run: &Run, factor: usize) -> usize {
        if let Some((_, column)) = run.mixed.iter().find(|(mixed, _)| *mixed == factor) {
            return *column;
        }
        let matrix = if run.columns.binary_search(&factor).is_ok() { run.from } else { run.base };
        self.first_column(matrix) + factor
    }

    /// Returns whether factors depend on each other.
    pub fn is_dependent(&self) -> bool {
        self.requested.copula.is_some()
    }

    /// Returns the index of the first of the d columns of `matrix`.
    pub fn first_column(&self, matrix: Matrix) -> usize {
        self.factors * matrix.place()
    }

    /// Returns whether every row is at a point of its own: there are no swaps.
    pub fn is_plain(&self) -> bool {
        self.requested.swaps.is_empty()
    }

    /// Returns the same points without swaps, `rows` of them in all, rounded down to as many in A and B of every replicate.
    ///
    /// # Errors
    /// [`DesignError`] if that is too few.
    pub(crate) fn plain(&self, rows: u64) -> Result<Self, DesignError> {
        let each = 2 * self.settings.replicates;
        let settings = DesignSettings { base_samples: rows / each * each / 2, ..self.settings.clone() };
        let constants = self.requested.constants.clone();
        Self::new(settings, self.factors, Rows { constants, ..Rows::default() })
    }

    /// Returns the rows of one base point that are run, in the order in which rows are counted.
    pub fn runs(&self) -> &[Run] {
        &self.runs.runs
    }

    /// Returns the index in [`Design::runs`] of the row AB_s of each swap.
    pub fn ab_runs(&self) -> &[usize] {
        &self.runs.ab
    }

    /// Returns the index in [`Design::runs`] of the row BA_s of each swap; empty without these rows.
    pub fn ba_runs(&self) -> &[usize] {
        &self.runs.ba
    }

    /// Returns the number of distinct values of every factor: swapped rows repeat those of A and B.
    pub fn distinct_values(&self) -> u64 {
        2 * self.settings.base_samples
    }

    /// Returns the number of rows of one base point: A, B and the requested ones, each distinct point once.
    pub fn rows_per_point(&self) -> u64 {
        self.runs.runs.len() as u64
    }

    /// Returns the total number of rows, which is the number of model runs.
    pub fn rows(&self) -> u64 {
        self.settings.base_samples * self.rows_per_point()
    }

    /// Returns whether the points of a replicate are complete nets: a power of two of them, or points that need none.
    pub(crate) fn balanced(&self) -> bool {
        !self.settings.sampler.is_digital() || self.is_plain() || self.points_per_replicate().is_power_of_two()
    }

    /// Returns the base points of one replicate, in [`Design::columns`] columns.
    pub fn replicate(&self, replicate: u64) -> BasePoints {
        let varying = self.requested.varying(self.factors);
        BasePoints::new(&self.settings, replicate, self.factors, &varying, self.runs.mixed.clone())
    }

    /// Returns the replicate, base point within it, and kind of a row, in the order in which rows are counted. A row of
    /// several kinds has the first of them.
    pub(crate) fn locate(&self, row: u64) -> (u64, u64, RowKind) {
        let (base, run) = (row / self.rows_per_point(), row % self.rows_per_point());
        (base / self.points_per_replicate(), base % self.points_per_replicate(), self.runs.runs[run as usize].kind)
    }

    /// Returns the first `points` base points of `replicate`: the columns of A, then those of B.
    pub(crate) fn first_points(&self, replicate: u64, points: usize) -> Vec<Vec<f64>> {
        let mut columns = vec![vec![0.0; points]; 2 * self.factors()];
        self.replicate(replicate).fill(0, &mut columns);
        columns
    }

    /// Writes row number `row` of the design as a point of the unit cube to `u`, which has one entry per factor.
    pub fn point(&self, row: u64, u: &mut [f64]) {
        let (replicate, point, _) = self.locate(row);
        let run = &self.runs.runs[(row % self.rows_per_point()) as usize];
        let mut columns = vec![vec![0.0; 1]; self.columns()];
        self.replicate(replicate).fill(point, &mut columns);
        for (factor, u) in u.iter_mut().enumerate() {
            *u = columns[self.column(run, factor)][0];
        }
    }
}

/// Returns the first error whose condition is met.
fn refuse<const N: usize>(errors: [(bool, DesignError); N]) -> Result<(), DesignError> {
    errors.into_iter().find(|(is_met, _)| *is_met).map_or(Ok(()), |(_, error)| Err(error))
}

/// Returns the indices of the swaps that share no column with an earlier one of them.
fn disjoint_swaps(swaps: &[Swap]) -> Vec<usize> {
    let mut seen: BTreeSet<usize> = BTreeSet::new();
    let mut disjoint = Vec::new();
    for (number, swap) in swaps.iter().enumerate() {
        if !swap.is_empty() && swap.iter().all(|column| !seen.contains(column)) {
            seen.extend(swap);
            disjoint.push(number);
        }
    }
    disjoint
}

#[cfg(test)]
mod tests;
