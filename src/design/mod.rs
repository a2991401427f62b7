//! The Saltelli design as a pure function of the row number: nothing is stored, any row can be made anywhere.
//!
//! A design has `replicates` independent randomisations of `base_samples / replicates` base points each. A base point
//! is one point of a 2d-dimensional sequence: its first d coordinates are the row of A, its last d the row of B. (Two
//! sequences of d dimensions each would look alike, but the indices then never converge.) Every base point stands
//! for `2 + k` rows: A, B, and one row AB_s for each of the k [`Swap`]s, which is A with some columns taken from B
//! (Saltelli et al. 2010, Comput. Phys. Commun. 181, 259-270, "radial" scheme of its table 2). [`Companions`] add rows
//! BA_s, BC_s and CB_s for the estimators that need them; C is then the coordinates 2d to 3d. Rows that are the same
//! point are one row: they are run once.

mod base;
mod error;
mod joe_kuo;
mod latin;
mod random;
mod rows;
mod sobol;

use serde::Serialize;

pub use base::BasePoints;
pub use error::DesignError;
pub use joe_kuo::MAX_DIMENSIONS;
pub use latin::LatinHypercube;
pub use random::RandomPoints;
pub use rows::{Companions, Matrix, RowKind, Rows, Run, Swap};
pub use sobol::SobolSequence;

use rows::Runs;

/// Most base points one replicate can hold: the length of the 32-bit Sobol' sequence.
pub const MAX_POINTS: u64 = 1 << 32;

/// Most replicates of a design.
pub const MAX_REPLICATES: u64 = 4096;

/// Most factors of a design with second-order indices: their sums take d (d - 1) numbers for every output.
pub const MAX_PAIRED_FACTORS: usize = 256;

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

/// A checked Saltelli design.
///
/// ```
/// use apportion::design::{Design, DesignSettings, Rows};
///
/// let settings = DesignSettings { base_samples: 1024, ..DesignSettings::default() };
/// let design = Design::new(settings, 3, Rows::plain(vec![vec![0], vec![1], vec![2]]))?;
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
    asked: Rows,
    runs: Runs,
    /// The swaps that are one factor each.
    single: Vec<usize>,
}

impl Design {
    /// A design over `factors` factors with the rows `rows` (column numbers below `factors`) beside A and B.
    ///
    /// `base_samples` is rounded up to a multiple of `replicates`; [`Design::settings`] tells the number in force.
    ///
    /// # Errors
    /// [`DesignError`] if there is no factor, no replicate or more than [`MAX_REPLICATES`], fewer than two or more than
    /// 2^32 base points a replicate, more factors than the Sobol' sequence has dimensions for, a swap of a column that
    /// does not exist, or second-order indices without the rows BA or of more than [`MAX_PAIRED_FACTORS`] factors.
    pub fn new(mut settings: DesignSettings, factors: usize, rows: Rows) -> Result<Self, DesignError> {
        let DesignSettings { sampler, base_samples, replicates, .. } = settings;
        let matrices = rows.companions.matrices();
        if factors == 0 {
            return Err(DesignError::NoFactors);
        }
        if sampler == Sampler::Sobol && factors > MAX_DIMENSIONS / matrices {
            return Err(DesignError::TooManyFactors { factors, matrices });
        }
        if replicates == 0 {
            return Err(DesignError::NoReplicates);
        }
        if replicates > MAX_REPLICATES {
            return Err(DesignError::TooManyReplicates { replicates });
        }
        if let Some(&column) = rows.swaps.iter().flatten().find(|&&column| column >= factors) {
            return Err(DesignError::NoSuchColumn { column, factors });
        }
        if base_samples / 2 < replicates {
            return Err(DesignError::TooFewSamples { base_samples, replicates });
        }
        let points = base_samples.div_ceil(replicates);
        if points > MAX_POINTS {
            return Err(DesignError::TooManySamples { base_samples, replicates });
        }
        let single = single_factors(&rows.swaps, factors);
        if rows.second_order && !rows.companions.ba {
            return Err(DesignError::SecondOrderWithoutBa);
        }
        if rows.second_order && single.len() > MAX_PAIRED_FACTORS {
            return Err(DesignError::TooManyPairs { factors: single.len() });
        }
        let runs = Runs::of(&rows, factors);
        let rows_per_point = runs.runs.len() as u64;
        let all = u128::from(points) * u128::from(replicates);
        if all * u128::from(rows_per_point) > u128::from(u64::MAX) {
            return Err(DesignError::TooManyRuns { base_samples: all, rows_per_point });
        }
        settings.base_samples = points * replicates;
        Ok(Self { settings, factors, asked: rows, runs, single })
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

    /// The rows that were asked for, repetitions and all.
    pub fn asked(&self) -> &Rows {
        &self.asked
    }

    /// The columns each AB_s takes from B.
    pub fn swaps(&self) -> &[Swap] {
        &self.asked.swaps
    }

    /// The companions of every AB_s.
    pub fn companions(&self) -> Companions {
        self.asked.companions
    }

    /// The swaps whose pairs have second-order indices: those of one factor each, the first one of every factor. Empty
    /// if second-order indices were not asked for.
    pub fn paired(&self) -> &[usize] {
        if self.asked.second_order { &self.single } else { &[] }
    }

    /// Columns of the base points: d for each of the matrices A, B and, if there are rows of it, C.
    pub fn columns(&self) -> usize {
        self.factors * self.asked.companions.matrices()
    }

    /// The rows of one base point that are run, in the order in which rows are counted.
    pub fn runs(&self) -> &[Run] {
        &self.runs.runs
    }

    /// For each swap: which of [`Design::runs`] is its row AB_s.
    pub fn ab_runs(&self) -> &[usize] {
        &self.runs.ab
    }

    /// For each swap: which of [`Design::runs`] is its row BA_s; empty without these companions.
    pub fn ba_runs(&self) -> &[usize] {
        &self.runs.ba
    }

    /// For each swap: which of [`Design::runs`] is its row BC_s; empty without these companions.
    pub fn bc_runs(&self) -> &[usize] {
        &self.runs.bc
    }

    /// For each swap: which of [`Design::runs`] is its row CB_s; empty without these companions.
    pub fn cb_runs(&self) -> &[usize] {
        &self.runs.cb
    }

    /// Rows of one base point: A, B and those asked for, each point once.
    pub fn rows_per_point(&self) -> u64 {
        self.runs.runs.len() as u64
    }

    /// Rows in all, which is the number of model runs.
    pub fn rows(&self) -> u64 {
        self.settings.base_samples * self.rows_per_point()
    }

    /// True if the points of a replicate are complete nets: a power of two of them, or points that need none.
    pub fn balanced(&self) -> bool {
        self.settings.sampler != Sampler::Sobol || self.points_per_replicate().is_power_of_two()
    }

    /// The base points of one replicate, in [`Design::columns`] columns.
    pub fn replicate(&self, replicate: u64) -> BasePoints {
        BasePoints::new(&self.settings, replicate, self.factors, self.asked.companions.matrices())
    }

    /// Replicate, base point within it, and kind of a row, in the order in which rows are counted. A row that is
    /// several kinds at once has the first of them.
    pub fn locate(&self, row: u64) -> (u64, u64, RowKind) {
        let (base, run) = (row / self.rows_per_point(), row % self.rows_per_point());
        (base / self.points_per_replicate(), base % self.points_per_replicate(), self.runs.runs[run as usize].kind)
    }

    /// Row number `row` of the design as a point of the unit cube: `u` has one entry per factor.
    pub fn point(&self, row: u64, u: &mut [f64]) {
        let (replicate, point, _) = self.locate(row);
        let run = &self.runs.runs[(row % self.rows_per_point()) as usize];
        let mut columns = vec![vec![0.0; 1]; self.columns()];
        self.replicate(replicate).fill(point, &mut columns);
        for (column, u) in u.iter_mut().enumerate() {
            let matrix = if run.columns.binary_search(&column).is_ok() { run.from } else { run.base };
            *u = columns[matrix as usize * self.factors + column][0];
        }
    }
}

/// The numbers of the swaps that are one factor, the first of every factor, in the order of the swaps.
fn single_factors(swaps: &[Swap], factors: usize) -> Vec<usize> {
    let mut seen = vec![false; factors];
    let first = |swap: &Swap| match swap[..] {
        [column] => !std::mem::replace(&mut seen[column], true),
        _ => false,
    };
    swaps.iter().map(first).enumerate().filter(|(_, single)| *single).map(|(number, _)| number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn design(sampler: Sampler) -> Design {
        let settings = DesignSettings { sampler, base_samples: 64, replicates: 4, seed: 3 };
        Design::new(settings, 3, Rows::plain(vec![vec![0], vec![1], vec![2], vec![0, 2]])).unwrap()
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

    /// The same points with all companions of the same swaps.
    fn with_companions(sampler: Sampler) -> Design {
        let plain = design(sampler);
        let companions = Companions { ba: true, bc: true, cb: true };
        Design::new(plain.settings.clone(), 3, Rows { companions, second_order: true, ..plain.asked }).unwrap()
    }

    #[test]
    fn companions_mix_a_b_and_c_and_every_run_is_where_it_is_said_to_be() {
        for sampler in Sampler::ALL {
            let design = with_companions(sampler);
            assert_eq!((design.columns(), design.paired()), (9, &[0, 1, 2][..]));
            // A, B, 4 AB; BA_3 is AB_1 and BA_1 is AB_3; 4 BC; CB_1 is BC_3 and CB_3 is BC_1.
            assert_eq!(design.rows_per_point(), 2 + 4 + 2 + 4 + 2);
            let (replicate, point) = (2, 11);
            let first_row = (replicate * 16 + point) * design.rows_per_point();
            let row = |run: usize| {
                let mut u = [0.0; 3];
                design.point(first_row + run as u64, &mut u);
                u
            };
            let mut columns = vec![vec![0.0]; 9];
            design.replicate(replicate).fill(point, &mut columns);
            let [a, b, c] = [0, 3, 6].map(|first| [columns[first][0], columns[first + 1][0], columns[first + 2][0]]);
            assert_eq!([row(0), row(1)], [a, b]);
            let with = |mut base: [f64; 3], swap: usize, from: [f64; 3]| {
                design.swaps()[swap].iter().for_each(|&column| base[column] = from[column]);
                base
            };
            for swap in 0..4 {
                assert_eq!(row(design.ab_runs()[swap]), with(a, swap, b));
                assert_eq!(row(design.ba_runs()[swap]), with(b, swap, a));
                assert_eq!(row(design.bc_runs()[swap]), with(b, swap, c));
                assert_eq!(row(design.cb_runs()[swap]), with(c, swap, b));
            }
            for (run, expected) in design.runs().iter().enumerate() {
                assert_eq!(design.locate(first_row + run as u64), (replicate, point, expected.kind));
            }
            assert!(design.runs().iter().any(|run| run.kind == RowKind::Cb(2)));
            let mut all: Vec<[f64; 3]> = (0..design.runs().len()).map(row).collect();
            all.sort_by(|x, y| x.partial_cmp(y).unwrap());
            all.dedup();
            assert_eq!(all.len() as u64, design.rows_per_point(), "no point is run twice");
        }
    }

    #[test]
    fn a_third_matrix_leaves_a_and_b_as_they_are_and_is_another_one() {
        for sampler in Sampler::ALL {
            let (plain, more) = (design(sampler), with_companions(sampler));
            let mut two = vec![vec![0.0; 16]; plain.columns()];
            let mut three = vec![vec![0.0; 16]; more.columns()];
            plain.replicate(1).fill(0, &mut two);
            more.replicate(1).fill(0, &mut three);
            assert_eq!(two[..], three[..6], "{sampler:?}");
            assert!(three[6..].iter().flatten().all(|u| *u > 0.0 && *u < 1.0 && !two.concat().contains(u)));
        }
    }

    #[test]
    fn second_order_indices_are_of_single_factors_each_once() {
        let ba = Companions { ba: true, ..Companions::NONE };
        let swaps = vec![vec![0, 1], vec![2], vec![], vec![0], vec![2], vec![1, 1]];
        let rows = Rows { swaps, companions: ba, second_order: true };
        let paired = |rows: &Rows| Design::new(DesignSettings::default(), 3, rows.clone()).map(|d| d.paired().to_vec());
        assert_eq!(paired(&rows), Ok(vec![1, 3]));
        assert_eq!(paired(&Rows { second_order: false, ..rows.clone() }), Ok(vec![]));
        let without = Rows { companions: Companions::NONE, ..rows };
        assert_eq!(paired(&without), Err(DesignError::SecondOrderWithoutBa));
        let all = |d: usize| Rows { swaps: (0..d).map(|j| vec![j]).collect(), companions: ba, second_order: true };
        assert!(Design::new(DesignSettings::default(), 256, all(256)).is_ok());
        let error = Design::new(DesignSettings::default(), 257, all(257)).unwrap_err();
        assert_eq!(error, DesignError::TooManyPairs { factors: 257 });
        assert!(error.to_string().contains("32896 pairs"));
    }

    #[test]
    fn a_third_matrix_needs_dimensions_too() {
        let bc = Rows { companions: Companions { bc: true, ..Companions::NONE }, ..Rows::default() };
        assert!(Design::new(DesignSettings::default(), 1365, bc.clone()).is_ok());
        let error = Design::new(DesignSettings::default(), 1366, bc.clone()).unwrap_err();
        assert_eq!(error, DesignError::TooManyFactors { factors: 1366, matrices: 3 });
        assert!(error.to_string().contains("4098 dimensions") && error.to_string().contains("at most 1365"));
        let random = DesignSettings { sampler: Sampler::Random, ..DesignSettings::default() };
        assert!(Design::new(random, 1366, bc).is_ok());
    }

    #[test]
    fn rows_are_counted_replicate_by_replicate() {
        let design = design(Sampler::Sobol);
        assert_eq!(design.rows(), 64 * 6);
        assert_eq!(design.locate(0), (0, 0, RowKind::A));
        assert_eq!(design.locate(6 * 16 + 1), (1, 0, RowKind::B));
        assert_eq!(design.locate(64 * 6 - 1), (3, 15, RowKind::Ab(3)));
    }

    #[test]
    fn impossible_designs_are_refused_with_the_reason() {
        let settings = DesignSettings::default;
        let of = |settings, factors| Design::new(settings, factors, Rows::default()).unwrap_err();
        assert_eq!(of(settings(), 0), DesignError::NoFactors);
        assert_eq!(of(settings(), 3000), DesignError::TooManyFactors { factors: 3000, matrices: 2 });
        assert_eq!(of(DesignSettings { replicates: 0, ..settings() }, 1), DesignError::NoReplicates);
        for base_samples in [0, 1, 31] {
            let error = of(DesignSettings { base_samples, ..settings() }, 1);
            assert_eq!(error, DesignError::TooFewSamples { base_samples, replicates: 16 });
        }
        let error = of(DesignSettings { replicates: 5000, base_samples: 1 << 20, ..settings() }, 1);
        assert_eq!(error, DesignError::TooManyReplicates { replicates: 5000 });
        // Dummies, since equal rows are run once.
        let rows = Rows::plain(vec![vec![]; 1 << 21]);
        let full =
            DesignSettings { base_samples: MAX_POINTS * MAX_REPLICATES, replicates: MAX_REPLICATES, ..settings() };
        assert!(matches!(Design::new(full, 1, rows), Err(DesignError::TooManyRuns { .. })));
        let error = Design::new(settings(), 2, Rows::plain(vec![vec![2]])).unwrap_err();
        assert_eq!(error, DesignError::NoSuchColumn { column: 2, factors: 2 });
        let error = of(DesignSettings { base_samples: u64::MAX, replicates: 2, ..settings() }, 1);
        assert!(matches!(error, DesignError::TooManySamples { .. }));
    }

    #[test]
    fn samples_are_rounded_up_to_whole_replicates() {
        let settings = DesignSettings { base_samples: 1000, ..DesignSettings::default() };
        let design = Design::new(settings, 2, Rows::default()).unwrap();
        assert_eq!(design.settings().base_samples, 1008);
        assert!(!design.balanced());
    }
}
