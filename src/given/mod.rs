//! Sobol' indices from existing data: a table of inputs and outputs, from any source.
//!
//! There is no design, and rows must be independent draws. [`analyse`] checks the rows first ([`PointSet`]) and refuses
//! those that would give wrong numbers; then it estimates S_j = V(E[Y|X_j])/V(Y) by ranks and by bins,
//! two methods that share only the data. [`surrogate_indices`] adds total indices, and
//! more accurate first-order ones if the model is smooth and the inputs are independent of each other. [`measures`]
//! uses more than the variance.

mod alias;
mod binned;
mod column;
mod dependence;
mod evenness;
mod measures;
mod order;
mod outcome;
mod rank;
mod repeats;
mod replicates;
mod serial;
mod shared;
mod surrogate;

pub use binned::Binned;
use binned::bins_for;
pub(crate) use column::centred;
pub use column::{Column, NoVariance, TextColumn};
pub use dependence::{Dependence, PairDependence};
pub use evenness::PointSet;
pub(crate) use measures::measures_of_rows;
pub use measures::{InputMeasures, Measure, Measured, measures};
use order::Order;
pub use outcome::{InputIndices, OutputIndices};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
pub use replicates::{Replicates, average_replicates};
pub use surrogate::{SurrogateIndices, SurrogateOutput, SurrogateRefusal, Surrogates, surrogate_indices};
use thiserror::Error;

use crate::design::shuffle;

/// Minimum number of rows: with fewer, an interval is wider than the range of an index.
pub(crate) const MIN_ROWS: usize = 30;

/// Why a table cannot be analysed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum GivenError {
    /// There is no input, or no output.
    #[error("the table needs at least one input and one output: it has {inputs} and {outputs}")]
    Nothing {
        /// Number of inputs.
        inputs: usize,
        /// Number of outputs.
        outputs: usize,
    },
    /// Columns of different lengths.
    #[error("column `{name}` has {found} rows, the first one has {expected}")]
    Length {
        /// The column.
        name: String,
        /// Its rows.
        found: usize,
        /// Rows of the first column.
        expected: usize,
    },
    /// A value that is NaN or infinite.
    #[error("column `{name}`, row {row} (from 1): a value is not finite")]
    NotFinite {
        /// The column.
        name: String,
        /// The row, from 1.
        row: usize,
    },
    /// Too few rows.
    #[error(
        "the table has too few usable rows ({rows}): at least {MIN_ROWS} are needed, and some hundreds for narrow intervals"
    )]
    TooFewRows {
        /// Rows found.
        rows: usize,
    },
    /// The rows of a Saltelli design.
    #[error(
        "the rows are those of a pick-freeze (Saltelli) design: values of an input recur in other rows together with \
         those of other inputs. Rows that share values are not independent, and indices from them as from given data \
         would be wrong. Analyse the design as such (`apportion.salib.analyze.sobol` in Python, with the points as `X`), or \
         keep only its rows A and B"
    )]
    PickFreeze,
    /// The rows of a one-at-a-time design.
    #[error(
        "the rows are those of a one-at-a-time design (such as Morris trajectories, or sweeps around a base point): {pairs} \
         {}. They are not independent draws, and indices from them would be wrong. Analyse the design as such (Morris \
         trajectories in their order: `given-data` without a study and measures, or `apportion.salib.analyze.morris` in \
         Python), or keep only rows that were drawn at random", how.in_words(*rows)
    )]
    OneAtATime {
        /// Rows, or pairs of them.
        pairs: usize,
        /// In what they are alike.
        how: Alike,
        /// Rows of the table.
        rows: usize,
    },
    /// An input that is a function of others.
    #[error(
        "in all rows `{input}` is a function of {others}, as in a fractional factorial design: nothing tells its effect from \
         their interaction. Add rows that tell them apart, or leave `{input}` out (--inputs) and read that interaction \
         as its effect too"
    )]
    Alias {
        /// The input.
        input: String,
        /// The others, each in quotes.
        others: String,
    },
    /// Quasi-random points of which two inputs together are not even.
    #[error(
        "the rows are quasi-random points in more dimensions than {rows} of them fill: `{}` and `{}` depend on each other, and \
         first-order indices sum to more than 1, since inputs that do nothing seem to act. Draw the rows at random, or take \
         far more of them", pair.0, pair.1
    )]
    UnevenPoints {
        /// The two.
        pair: (String, String),
        /// Rows of the table.
        rows: usize,
    },
    /// Rows that repeat all inputs but one.
    #[error(
        "the {rows} rows have only {groups} different rows of all inputs but `{input}`. If it is a time or a place of a \
         series, write one row for each run, with a column for each of its values (in pandas: `pivot`); if it numbers \
         replicates, call it `seed`, and they are averaged"
    )]
    AllButOne {
        /// The one.
        input: String,
        /// Different rows of the others.
        groups: usize,
        /// Rows of the table.
        rows: usize,
    },
    /// Rows that repeat the inputs of others.
    #[error(
        "{repeated} of {rows} rows repeat the inputs of an earlier row. Rows with the same value of one input then share \
         the others too, and every index would come out too large. Keep one row of each, or their average"
    )]
    RepeatedRows {
        /// Rows that repeat an earlier one.
        repeated: usize,
        /// Rows of the table.
        rows: usize,
    },
}

/// In what the rows of a one-at-a-time design are alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Alike {
    /// A row and the one before it.
    Consecutive,
    /// Pairs of rows, in any order.
    Pairs,
    /// Rows and a base point.
    Base,
}

impl Alike {
    fn in_words(self, rows: usize) -> String {
        match self {
            Self::Consecutive => format!("of {rows} rows differ from the row before in a single input"),
            Self::Pairs => {
                format!("pairs of the {rows} rows differ in one or two inputs only, far more than by chance")
            }
            Self::Base => {
                format!("of {rows} rows leave the most frequent value in a few inputs only, far more than by chance")
            }
        }
    }
}

/// The results for a table.
#[derive(Debug, Clone, PartialEq)]
pub struct GivenIndices {
    /// Rows used.
    pub rows: usize,
    /// The kind of points of the rows.
    pub points: PointSet,
    /// The dependence between the inputs; `None` with fewer than two inputs that vary.
    pub dependence: Option<Dependence>,
    /// One entry per output.
    pub outputs: Vec<OutputIndices>,
    /// How many independent rows they are worth, if they follow each other in time: then there are no intervals.
    pub effective_rows: Option<f64>,
}

impl GivenIndices {
    /// Returns the number of bins of an input that has different values in all rows.
    pub fn bins(&self) -> usize {
        bins_for(self.rows)
    }
}

/// Estimates first-order indices of every output with respect to every input.
///
/// `inputs` and `outputs` are columns of one length, in any units: indices have none. `seed` orders tied input values
/// for the interval of the rank estimator; the estimates do not depend on it.
///
/// # Errors
/// [`GivenError`]: no columns, columns of different lengths, values that are not finite, fewer than 30 rows,
/// or rows that are not independent because they belong to a design or repeat each other, or that are even points in far
/// too many dimensions. Points that are too even for ranks are analysed only by bins.
///
/// # Example
/// ```
/// use apportion::given::{Column, analyse};
///
/// // y = 3 a + b with independent uniform a and b: exactly S_a = 0.9, S_b = 0.1.
/// let mut state = 7u64;
/// let mut uniform = || {
///     state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
///     (state >> 11) as f64 / (1u64 << 53) as f64
/// };
/// let a = Column { name: "a".into(), values: (0..2000).map(|_| uniform()).collect() };
/// let b = Column { name: "b".into(), values: (0..2000).map(|_| uniform()).collect() };
/// let values = a.values.iter().zip(&b.values).map(|(a, b)| 3.0 * a + b).collect();
/// let y = Column { name: "y".into(), values };
///
/// let result = analyse(&[a, b], &[y], 0)?;
/// let indices = result.outputs[0].indices.as_ref().map_err(|no_variance| no_variance.to_string())?;
/// let s_a = indices[0].rank.ok_or("no estimate")?;
/// let interval = s_a.interval.ok_or("no interval")?;
/// assert!(interval.low < 0.9 && 0.9 < interval.high);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn analyse(inputs: &[Column], outputs: &[Column], seed: u64) -> Result<GivenIndices, GivenError> {
    let rows = check(inputs, outputs)?;
    let orders: Vec<Order> = inputs.iter().map(|input| Order::from_values(&input.values)).collect();
    let varying: Vec<usize> = (0..inputs.len()).filter(|&j| orders[j].groups() > 1).collect();
    let varied: Vec<(&str, &Order)> = varying.iter().map(|&j| (inputs[j].name.as_str(), &orders[j])).collect();
    let in_time: Vec<f64> = varied.iter().map(|(_, order)| serial::autocorrelation(order)).collect();
    let of_outputs = outputs.iter().map(|output| serial::autocorrelation(&Order::from_values(&output.values)));
    let of_output = of_outputs.fold(0.0, f64::max);
    let effective_rows = in_time.iter().filter_map(|of_input| serial::effective_rows([*of_input, of_output], rows));
    let effective_rows = effective_rows.min_by(f64::total_cmp);
    let points = if evenness::is_grid(&varied, rows) {
        PointSet::Grid
    } else {
        repeats::check(&varied, rows)?;
        alias::check(&varied)?;
        evenness::point_set(&varied, rows)
    };
    // The rows of a point sequence have an order too.
    let effective_rows = effective_rows.filter(|_| points != PointSet::Grid && !evenness::is_lattice(&varied, rows));
    let points = if effective_rows.is_some() { PointSet::Independent } else { points };
    let dependence = dependence::between(&varied, effective_rows.map_or(rows, |rows| rows as usize));
    let rows_are = Rows { is_random: points == PointSet::Independent, has_intervals: effective_rows.is_none() };
    let is_even = orders.iter().map(|order| match points {
        PointSet::Independent => false,
        PointSet::Grid => true,
        PointSet::TooEven(_) => is_even(order, &varied, rows),
    });
    let is_even: Vec<bool> = is_even.collect();
    let outputs = outputs.iter().map(|output| outcome::of_output(output, inputs, (&orders, &is_even), rows_are, seed));
    let outputs: Vec<OutputIndices> = outputs.collect();
    let uneven = dependence.as_ref().and_then(|of| of.uneven.clone());
    if let (PointSet::TooEven(_), Some(pair)) = (&points, uneven)
        && outputs.iter().any(OutputIndices::sums_above_one)
    {
        return Err(GivenError::UnevenPoints { pair, rows });
    }
    Ok(GivenIndices { rows, points, dependence, outputs, effective_rows })
}

/// What the rows allow.
#[derive(Debug, Clone, Copy)]
struct Rows {
    /// Whether they may be independent draws: then neighbours by rank are.
    is_random: bool,
    /// Whether the errors of estimates are known.
    has_intervals: bool,
}

/// Returns whether the rows of neighbours in an input are as even in most other inputs as those of a net: then the noise
/// of means over bins is not that of random rows.
fn is_even(order: &Order, varied: &[(&str, &Order)], rows: usize) -> bool {
    let others: Vec<&Order> = varied.iter().map(|(_, other)| *other).filter(|other| *other != order).collect();
    let even = others.iter().filter(|other| evenness::is_even_pair(order, other, rows)).count();
    2 * even >= others.len()
}

/// Returns the indices of `most` of `rows` rows, or of all if there are no more, in random order.
fn drawn_rows(rows: usize, most: usize, seed: u64) -> Vec<usize> {
    let mut all: Vec<usize> = (0..rows).collect();
    shuffle(&mut all, &mut ChaCha8Rng::seed_from_u64(seed));
    all.truncate(most);
    all
}

/// Returns the number of rows, if the table can be analysed.
fn check(inputs: &[Column], outputs: &[Column]) -> Result<usize, GivenError> {
    let Some(first) = inputs.first().filter(|_| !outputs.is_empty()) else {
        return Err(GivenError::Nothing { inputs: inputs.len(), outputs: outputs.len() });
    };
    let rows = first.values.len();
    for Column { name, values } in inputs.iter().chain(outputs) {
        if values.len() != rows {
            return Err(GivenError::Length { name: name.clone(), found: values.len(), expected: rows });
        }
        if let Some(row) = values.iter().position(|value| !value.is_finite()) {
            return Err(GivenError::NotFinite { name: name.clone(), row: row + 1 });
        }
    }
    if rows < MIN_ROWS {
        return Err(GivenError::TooFewRows { rows });
    }
    Ok(rows)
}
