//! The default estimators in twice the precision of doubles, term by term as they are published.

use crate::design::{Design, RowKind};
use crate::extended::Extended;
use crate::run::Store;

/// The outputs of every row of a design, of one output of the model, by what the rows are.
pub(super) struct Columns {
    a: Vec<f64>,
    b: Vec<f64>,
    /// For each swap.
    ab: Vec<Vec<f64>>,
    /// For each swap; empty without such rows.
    ba: Vec<Vec<f64>>,
}

/// First-order and total index of every swap.
pub(super) type Indices = Vec<[f64; 2]>;

impl Columns {
    /// Those of output number `output` in `store`, which holds all rows of `design`; not a number where a run failed.
    pub fn new(design: &Design, store: &Store, output: usize) -> Self {
        let rows_per_point = design.rows_per_point() as usize;
        let mut columns = vec![Vec::new(); rows_per_point];
        for replicate in 0..design.settings().replicates {
            let rows = 0..design.points_per_replicate() * design.rows_per_point();
            let Some(piece) = store.piece(replicate, rows) else { continue };
            for (row, values) in piece.values.chunks_exact(store.outputs()).enumerate() {
                columns[row % rows_per_point].push(values[output]);
            }
        }
        let place = |kind| design.runs().iter().position(|run| run.kind == kind);
        let of = |run: Option<usize>| run.map_or_else(Vec::new, |run| columns[run].clone());
        let all = |runs: &[usize]| runs.iter().map(|&run| columns[run].clone()).collect();
        Self {
            a: of(place(RowKind::A)),
            b: of(place(RowKind::B)),
            ab: all(design.ab_runs()),
            ba: all(design.ba_runs()),
        }
    }

    /// The indices over the base points at which all rows of a swap have a value; `None` if there are fewer than two, or
    /// no variance.
    pub fn indices(&self) -> Option<Indices> {
        (0..self.ab.len()).map(|swap| self.of_swap(swap)).collect()
    }

    fn of_swap(&self, swap: usize) -> Option<[f64; 2]> {
        let rows: Vec<&[f64]> =
            [&self.a, &self.b, &self.ab[swap]].into_iter().chain(self.ba.get(swap)).map(Vec::as_slice).collect();
        let complete = |point: &usize| rows.iter().all(|row| row[*point].is_finite());
        let points: Vec<usize> = (0..self.a.len()).filter(complete).collect();
        let taken = |row: &&[f64]| points.iter().map(|&point| Extended::from(row[point])).collect::<Vec<_>>();
        let rows: Vec<Vec<Extended>> = rows.iter().map(taken).collect();
        let indices = match &rows[..] {
            _ if points.len() < 2 => return None,
            [a, b, ab, ba] => azzini_2021(a, b, ab, ba),
            [a, b, ab] => pooled(a, b, ab),
            _ => return None,
        };
        let indices = indices.map(Extended::value);
        indices.iter().all(|index| index.is_finite()).then_some(indices)
    }
}

fn sum(terms: impl Iterator<Item = Extended>) -> Extended {
    terms.fold(Extended::ZERO, |sum, term| sum + term)
}

fn mean(values: &[Extended]) -> Extended {
    sum(values.iter().copied()) / (values.len() as f64).into()
}

/// The variance of all values of some columns, divided by their number.
fn variance(columns: &[&[Extended]]) -> Extended {
    let all = columns.concat();
    let mean = mean(&all);
    sum(all.iter().map(|y| (*y - mean).square())) / (all.len() as f64).into()
}

/// Azzini, Mara and Rosati 2021.
fn azzini_2021(a: &[Extended], b: &[Extended], ab: &[Extended], ba: &[Extended]) -> [Extended; 2] {
    let each = |term: &dyn Fn(usize) -> Extended| sum((0..a.len()).map(term));
    let all = each(&|i| (a[i] - b[i]).square() + (ba[i] - ab[i]).square());
    let first = each(&|i| (ba[i] - b[i]) * (a[i] - ab[i])).times_power_of_two(1);
    let total = each(&|i| (b[i] - ba[i]).square() + (a[i] - ab[i]).square());
    [first / all, total / all]
}

/// Saltelli et al. 2010 (b) and Jansen 1999 over pooled variances: see
/// [`FirstOrder::SaltelliPooled`](crate::estimate::FirstOrder::SaltelliPooled) and its like of the total.
fn pooled(a: &[Extended], b: &[Extended], ab: &[Extended]) -> [Extended; 2] {
    let n = Extended::from(a.len() as f64);
    let centre = mean(&[a, b].concat());
    let each = |term: &dyn Fn(usize) -> Extended| sum((0..a.len()).map(term)) / n;
    let all = variance(&[a, b, ab]);
    let half = all.times_power_of_two(-1);
    let c = each(&|i| (a[i] - centre) * (b[i] - centre)).max(-half).min(half);
    let first = each(&|i| (b[i] - centre) * (ab[i] - a[i]));
    let total = each(&|i| (a[i] - ab[i]).square()).times_power_of_two(-1);
    [mixture(first, all - c, variance(&[b, ab]) - c), mixture(total, all, variance(&[a, ab]))]
}

/// The solution of x (x one + (1 - x) none) = n between 0 and 1; n/none below, n/one above.
fn mixture(n: Extended, none: Extended, one: Extended) -> Extended {
    let one = one.max(none.times_power_of_two(-1));
    if n.is_negative() || n.is_zero() {
        return n / none;
    }
    if n >= one {
        return n / one;
    }
    let ratio = n / none;
    let under = Extended::ONE + ((one / none - Extended::ONE) * ratio).times_power_of_two(2);
    ratio.times_power_of_two(1) / (Extended::ONE + under.max(Extended::ZERO).sqrt())
}

/// The largest difference of two sets of indices, in units of 1 or of the index if that is larger.
pub(super) fn difference(one: &Indices, other: &Indices) -> f64 {
    let pairs = one.iter().flatten().zip(other.iter().flatten());
    pairs.map(|(one, other)| (one - other).abs() / other.abs().max(1.0)).fold(0.0, f64::max)
}
