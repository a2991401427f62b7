//! The rows of a base point: the requested ones, and those that share a point and are run once.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::mixed::MixedColumns;
use crate::space::GaussianCopula;

/// The columns that one row AB_s takes from B: those of one factor, or of a group of factors. An empty swap is a dummy
/// factor: its rows repeat A or B but are run again, and show the noise of a model that is not deterministic.
pub type Swap = Vec<usize>;

/// The rows of a design in addition to A and B.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Rows {
    /// One row AB_s for each; column numbers start at 0.
    pub swaps: Vec<Swap>,
    /// Whether there is a row BA_s, B with the columns of the swap from A, for every AB_s.
    pub ba: bool,
    /// Whether the sums for second-order indices are kept; needs the rows BA.
    pub second_order: bool,
    /// The copula of dependent factors. A swap then takes its columns from B, and the other factors follow them.
    pub copula: Option<Arc<GaussianCopula>>,
    /// The swaps, by index, whose factors are drawn again given all others; the same for independent factors.
    pub redrawn: Vec<usize>,
    /// The columns of constants, in rising order: they take no dimension of the points and no row.
    pub constants: Vec<usize>,
}

impl Rows {
    /// Returns the rows AB_s of `swaps`, without rows BA.
    pub fn plain(swaps: Vec<Swap>) -> Self {
        Self { swaps, ..Self::default() }
    }

    /// Returns the columns that vary, of those of `factors` factors.
    pub(super) fn varying(&self, factors: usize) -> Vec<usize> {
        (0..factors).filter(|column| self.constants.binary_search(column).is_err()).collect()
    }
}

/// The kind of a row of a design; the number is that of its swap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowKind {
    /// The first d coordinates of the base point.
    A,
    /// The next d coordinates.
    B,
    /// A with the columns of the swap from B.
    Ab(usize),
    /// B with the columns of the swap from A.
    Ba(usize),
}

/// One of the independent matrices of a design.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Matrix {
    /// Dimensions 0 to d of the sequence.
    A,
    /// Dimensions d to 2d.
    B,
}

impl Matrix {
    /// Returns its position among the matrices of a design.
    pub(super) fn place(self) -> usize {
        match self {
            Self::A => 0,
            Self::B => 1,
        }
    }
}

/// A row that is run: the row of `base` with the `columns` of `from`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Run {
    /// The first kind among the rows at this point.
    pub kind: RowKind,
    /// The matrix of the columns that are not in `columns` or `mixed`.
    pub base: Matrix,
    /// The columns from `from`, in rising order.
    pub columns: Vec<usize>,
    /// The matrix of `columns`.
    pub from: Matrix,
    /// The columns of dependent factors, which follow others: the factor, and the index of its column among those of
    /// the base points; in rising order.
    pub mixed: Vec<(usize, usize)>,
}

impl Run {
    fn new(kind: RowKind, base: Matrix, columns: Vec<usize>, from: Matrix) -> Self {
        Self { kind, base, columns, from, mixed: Vec::new() }
    }
}

/// The runs of a base point, and the run for each row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Runs {
    pub runs: Vec<Run>,
    /// For each swap, the index of the run that is its row AB_s.
    pub ab: Vec<usize>,
    /// Likewise BA_s; empty without these rows.
    pub ba: Vec<usize>,
    /// The columns of dependent factors that come from no matrix.
    pub mixed: Option<Arc<MixedColumns>>,
}

impl Runs {
    /// Returns the runs for `rows` over `factors` factors, in the order A, B, AB_s, BA_s of their first rows.
    pub fn new(rows: &Rows, factors: usize) -> Self {
        let mixed = rows.copula.clone().map(|copula| MixedColumns::new(copula, 2 * factors));
        let [a, b] = [(RowKind::A, Matrix::A, Matrix::B), (RowKind::B, Matrix::B, Matrix::A)]
            .map(|(kind, base, from)| Run::new(kind, base, Vec::new(), from));
        let varying = rows.varying(factors);
        let numbers = [&a, &b].map(|run| (key(&varying, run.base, &[], run.from), Vec::new()));
        let numbers = numbers.into_iter().zip(0..).collect();
        let mut unique = Unique { factors, varying, runs: vec![a, b], numbers, mixed };
        let ab = unique.all_swapped(rows, RowKind::Ab, Matrix::A, Matrix::B);
        let ba = if rows.ba { unique.all_swapped(rows, RowKind::Ba, Matrix::B, Matrix::A) } else { Vec::new() };
        let Unique { runs, mixed, .. } = unique;
        Self { runs, ab, ba, mixed: mixed.map(Arc::new) }
    }
}

/// The source of the columns of a row.
type Key = (Matrix, Matrix, Vec<usize>);

/// Runs so far, and their indices by source.
struct Unique {
    factors: usize,
    varying: Vec<usize>,
    runs: Vec<Run>,
    /// Including the columns of dependent factors that follow others.
    numbers: BTreeMap<(Key, Vec<(usize, usize)>), usize>,
    mixed: Option<MixedColumns>,
}

impl Unique {
    /// Returns the index of the run for each swap, in rows of `base` with columns from `from`.
    fn all_swapped(&mut self, rows: &Rows, kind: fn(usize) -> RowKind, base: Matrix, from: Matrix) -> Vec<usize> {
        let swaps = rows.swaps.iter().enumerate();
        swaps.map(|(k, swap)| self.swapped(kind(k), base, swap, rows.redrawn.contains(&k), from)).collect()
    }

    fn swapped(&mut self, kind: RowKind, base: Matrix, swap: &Swap, redrawn: bool, from: Matrix) -> usize {
        if swap.is_empty() {
            self.runs.push(Run::new(kind, base, Vec::new(), from));
            return self.runs.len() - 1;
        }
        let mut columns = swap.clone();
        columns.sort_unstable();
        columns.dedup();
        columns.retain(|column| self.varying.binary_search(column).is_ok());
        let [first, other] = [base, from].map(|matrix| self.factors * matrix.place());
        let mixed = self.mixed.as_mut().map(|mixed| mixed.of_row(&columns, redrawn, first, other)).unwrap_or_default();
        let key = (key(&self.varying, base, &columns, from), mixed.clone());
        let number = *self.numbers.entry(key).or_insert(self.runs.len());
        if number == self.runs.len() {
            self.runs.push(Run { mixed, ..Run::new(kind, base, columns, from) });
        }
        number
    }
}

/// Returns the source of a row in a unique form: the matrix of most of its columns first, A before B if both have half,
/// and a row of a single matrix with that matrix twice.
fn key(varying: &[usize], base: Matrix, columns: &[usize], from: Matrix) -> Key {
    let (swapped, kept) = (columns.len(), varying.len() - columns.len());
    if swapped == 0 {
        return (base, base, Vec::new());
    }
    if kept == 0 {
        return (from, from, Vec::new());
    }
    if (swapped, base) > (kept, from) {
        let complement = varying.iter().copied().filter(|column| columns.binary_search(column).is_err()).collect();
        return (from, base, complement);
    }
    (base, from, columns.to_vec())
}

#[cfg(test)]
#[path = "tests/rows.rs"]
mod tests;
