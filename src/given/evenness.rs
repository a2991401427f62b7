//! Tests whether rows are independent draws, or too even for that.
//!
//! Quasi-random points (Sobol', Halton, lattices) fill space more evenly than random ones. That benefits integrals, but
//! neighbours in one input are then systematically far apart in the others, and the rank estimator, which treats
//! neighbours as independent draws of the others, does not converge: on Sobol' points its error is 0.1 to 0.3 at any
//! size. Latin hypercubes are even in each input alone, which does not affect ranks; there it converges.

use super::order::{Order, Partition};

/// Classes per input of the grids on which rows are counted.
pub(super) const GRIDS: [usize; 6] = [4, 8, 16, 32, 64, 128];

/// A standard normal number below which counts are too even, with probability 1e-9 a test by chance.
const TOO_EVEN: f64 = -6.0;

/// Minimum degrees of freedom of a test: with fewer, perfectly even counts occur by chance.
const MIN_FREEDOM: f64 = 27.0;

/// Maximum number of pairs of inputs that are tested.
const MAX_PAIRS: usize = 500;

/// The kind of points of the rows of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum PointSet {
    /// There is no evidence against independent draws. (A Latin hypercube counts as such.)
    Independent,
    /// Too even for independent draws: quasi-random points, with the evidence in words.
    TooEven(String),
    /// Every combination of the values of the inputs, once.
    Grid,
}

impl PointSet {
    /// Returns why ranks are refused, in words; `None` for independent rows.
    pub fn reason(&self) -> Option<String> {
        match self {
            Self::Independent => None,
            Self::Grid => Some("the rows are a full grid of the inputs' values, not independent draws".to_owned()),
            Self::TooEven(evidence) => Some(format!(
                "the rows are quasi-random points (Sobol', Halton, lattice) or equally even points: {evidence}"
            )),
        }
    }
}

/// Classifies rows as independent draws, or too even for that; `inputs` are those that vary.
///
/// Measured (`cargo bench --bench given`): none of 400,000 tables of independent rows, Latin hypercubes and rounded
/// values, of 1 to 8 inputs and 32 to 1000 rows, is classified as quasi-random. In their original order, all Sobol',
/// Halton and lattice points of two inputs or more are detected from 256 rows on, nearly all from 64; with shuffled
/// rows, all but one Kronecker table in eight at 256, and few below 100. A single input reveals less: 100 scrambled
/// Sobol' points pass.
///
/// Three tests, each with a chance of error far below 1e-6 a table: rows are counted in square grids over the ranks of
/// pairs of inputs, and of row number and input (which detects a single sequence in its order), and Pearson's statistic
/// must not be far in its lower tail; and the rank of an input must not step from row to row by only a few numbers
/// (rank-1 and Kronecker lattices).
pub(super) fn point_set(inputs: &[(&str, &Order)], rows: usize) -> PointSet {
    let fitting: Vec<usize> = GRIDS.into_iter().filter(|grid| grid * grid <= rows).collect();
    // About 1 to 16 rows a cell (more beyond the finest grid): evenness appears on different scales.
    let finest = fitting.iter().rev().take(3).rev();
    for &grid in finest {
        if let Some(evidence) = too_even(inputs, rows, grid) {
            return PointSet::TooEven(evidence);
        }
    }
    let steps = inputs.iter().find_map(|(name, order)| Some((name, few_steps(order, rows)?)));
    steps.map_or(PointSet::Independent, |(name, steps)| {
        PointSet::TooEven(format!("from row to row the rank of `{name}` moves by one of only {steps} different steps"))
    })
}

/// Returns whether there are as many different rows as combinations of values.
pub(super) fn is_grid(inputs: &[(&str, &Order)], rows: usize) -> bool {
    let combinations = inputs.iter().map(|(_, order)| order.groups() as u128);
    let combinations = combinations.fold(1u128, |product, groups| product.saturating_mul(groups));
    if inputs.len() < 2 || combinations != rows as u128 {
        return false;
    }
    // Each combination has a number; all occur if none occurs twice.
    let mut seen = vec![false; rows];
    let mut numbers = vec![0usize; rows];
    for (_, order) in inputs {
        for (number, label) in numbers.iter_mut().zip(order.labels()) {
            *number = *number * order.groups() + label;
        }
    }
    numbers.into_iter().all(|number| !std::mem::replace(&mut seen[number], true))
}

/// Returns whether the rank of an input moves by very few different steps from row to row, as in a lattice; in a time
/// series there are some more.
pub(super) fn is_lattice(inputs: &[(&str, &Order)], rows: usize) -> bool {
    inputs.iter().any(|(_, order)| few_steps(order, rows).is_some_and(|different| different * 20 <= rows))
}

/// Returns whether counts over a grid of two inputs are clearly more even than those of independent draws.
pub(super) fn is_even_pair(a: &Order, b: &Order, rows: usize) -> bool {
    /// A standard normal number: a pair alone is less clear than a table.
    const CLEAR: f64 = -3.0;
    let fitting = GRIDS.into_iter().rev().filter(|grid| grid * grid <= rows).take(3);
    let mut deviations = fitting.filter_map(|grid| deviation(&a.classes(grid), &b.classes(grid)));
    deviations.any(|deviation| deviation.normal() < CLEAR)
}

/// Returns where the counts of rows over a grid are too even, and by how many standard deviations.
fn too_even(inputs: &[(&str, &Order)], rows: usize, grid: usize) -> Option<String> {
    let classes: Vec<Partition> = inputs.iter().map(|(_, order)| order.classes(grid)).collect();
    let row_classes = Partition { labels: (0..rows).map(|row| row * grid / rows).collect(), count: grid };
    let mut pooled = Deviation::default();
    let mut by_row = Deviation::default();
    for ((name, _), classes) in inputs.iter().zip(&classes) {
        let Some(one) = deviation(&row_classes, classes) else { continue };
        if let Some(z) = one.too_even() {
            return Some(evidence(&format!("row number and `{name}`"), z));
        }
        by_row.add(one);
    }
    for (i, j) in nearest_pairs(inputs.len()) {
        let Some(one) = deviation(&classes[i], &classes[j]) else { continue };
        if let Some(z) = one.too_even() {
            return Some(evidence(&format!("`{}` and `{}`", inputs[i].0, inputs[j].0), z));
        }
        pooled.add(one);
    }
    let rows = by_row.too_even().map(|z| evidence("row number and each input", z));
    rows.or_else(|| pooled.too_even().map(|z| evidence("pairs of inputs", z)))
}

fn evidence(grid: &str, z: f64) -> String {
    format!("counts over a grid of {grid} are too even for independent draws (z = {z:.1}, limit -6)")
}

/// Iterates over pairs of column numbers, neighbours first, up to the maximum number.
fn nearest_pairs(columns: usize) -> impl Iterator<Item = (usize, usize)> {
    (1..columns).flat_map(move |lag| (lag..columns).map(move |j| (j - lag, j))).take(MAX_PAIRS)
}

/// Pearson's chi-square statistic with its degrees of freedom.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Deviation {
    statistic: f64,
    freedom: f64,
}

impl Deviation {
    fn add(&mut self, other: Self) {
        self.statistic += other.statistic;
        self.freedom += other.freedom;
    }

    /// Returns the statistic as a standard normal number (Wilson and Hilferty 1931): far below 0 if counts are too
    /// even, far above if the columns depend on each other.
    pub fn normal(self) -> f64 {
        let v = 2.0 / (9.0 * self.freedom);
        (libm::cbrt(self.statistic / self.freedom) - (1.0 - v)) / v.sqrt()
    }

    fn too_even(self) -> Option<f64> {
        Some(self.normal()).filter(|&z| self.freedom >= MIN_FREEDOM && z < TOO_EVEN)
    }
}

/// Computes the deviation from independence of the counts over two classifications; `None` if either has one class.
pub(super) fn deviation(a: &Partition, b: &Partition) -> Option<Deviation> {
    let (rows, columns) = (a.count, b.count);
    if rows < 2 || columns < 2 {
        return None;
    }
    let mut counts = vec![0.0; rows * columns];
    let (mut row_sums, mut column_sums) = (vec![0.0; rows], vec![0.0; columns]);
    for (&row, &column) in a.labels.iter().zip(&b.labels) {
        counts[row * columns + column] += 1.0;
        row_sums[row] += 1.0;
        column_sums[column] += 1.0;
    }
    let n = a.labels.len() as f64;
    let mut statistic = 0.0;
    for (r, row_sum) in row_sums.iter().enumerate() {
        for (c, column_sum) in column_sums.iter().enumerate() {
            let expected = row_sum * column_sum / n;
            statistic += f64::powi(counts[r * columns + c] - expected, 2) / expected;
        }
    }
    // With fixed sums of rows and columns its mean is the freedom times n/(n - 1).
    statistic *= (n - 1.0) / n;
    Some(Deviation { statistic, freedom: ((rows - 1) * (columns - 1)) as f64 })
}

/// Returns the number of different steps, modulo the number of rows, of the rank of an input from row to row, if it is
/// far below the 63 % of the rows for independent draws; also `None` for a column with ties, and for one that mostly
/// moves to a close rank, as sorted columns and time series do.
fn few_steps(order: &Order, rows: usize) -> Option<usize> {
    if order.groups() < rows {
        return None;
    }
    let rank = order.labels();
    let mut steps: Vec<usize> = rank.windows(2).map(|pair| (pair[1] + rows - pair[0]) % rows).collect();
    steps.sort_unstable();
    let close = steps.iter().filter(|&&step| step.min(rows - step) <= (rows / 50).max(2)).count();
    let different = steps.chunk_by(|a, b| a == b).count();
    (close * 2 < steps.len() && different * 4 <= rows).then_some(different)
}
