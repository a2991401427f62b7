//! First-order and total indices from given data by a surrogate.
//!
//! A polynomial chaos expansion fitted to the rows ([`crate::surrogate::chaos`]) has exact indices (Sudret 2008, Reliab.
//! Eng. Syst. Saf. 93, 964-979). What it leaves of held-out rows bounds their error.

mod coordinates;
mod estimates;
mod marginals;

use coordinates::Coordinates;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::order::Order;
use super::{Column, Dependence, GivenIndices, NoVariance, centred, drawn_rows};
use crate::correction::PlainFit;
use crate::space::Distribution;
use crate::surrogate::chaos::{degree_at, folds_at};
use crate::surrogate::{Effects, NamedTerm};
use crate::uncertainty::Estimate;

/// Maximum number of rows that are used.
const MAX_ROWS: usize = 1 << 16;

/// Maximum number of values of polynomials that are kept.
const MAX_VALUES: usize = 100_000_000;

/// Why no surrogate is fitted to a table.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SurrogateRefusal {
    /// Inputs depend on each other.
    #[error(
        "the inputs `{}` and `{}` depend on each other; a surrogate gives indices of independent inputs only, and total \
         indices are undefined here", .inputs.0, .inputs.1
    )]
    Dependent {
        /// The pair.
        inputs: (String, String),
    },
    /// Rows that follow each other in time.
    #[error("the rows follow each other in time: held-out rows are like their neighbours, and do not show the error")]
    InTime,
    /// The numbers of distributions and inputs differ.
    #[error("{distributions} distributions for {inputs} inputs")]
    Distributions {
        /// Number of distributions.
        distributions: usize,
        /// Number of inputs.
        inputs: usize,
    },
    /// A column has not been drawn from its stated distribution.
    #[error("the values of `{input}` do not follow its stated distribution: check its unit and its bounds")]
    OtherDistribution {
        /// The input.
        input: String,
    },
}

/// The estimates by surrogates for a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Surrogates {
    /// Rows used: all, or for very large tables some, drawn at random.
    pub rows: usize,
    /// Parts of the table, each corrected by an expansion of the others.
    pub folds: usize,
    /// Whether the distributions of the inputs were given; otherwise they are those of the columns.
    pub given_distributions: bool,
    /// One entry per output, in their order, or why there is none.
    pub outputs: Vec<Result<SurrogateOutput, NoVariance>>,
}

/// The estimates by surrogates for an output.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurrogateOutput {
    /// Share of the variance that the surrogates explain of the rows to which they were not fitted (Q^2); at most 1,
    /// and negative if they are worse than the mean.
    pub explained: f64,
    /// The rest, between 0 and 1: an index may exceed its estimate by this much, for any number of rows. The upper ends
    /// of the intervals contain it.
    pub unknown: f64,
    /// Whether the surrogates explain at least [`SurrogateOutput::MIN_EXPLAINED`]; if not, use the other estimates.
    pub serves: bool,
    /// The variable of the inputs in which the surrogates are polynomials, in words.
    pub polynomials_of: String,
    /// Mean number of terms of the surrogates.
    pub terms: f64,
    /// The terms with the largest variance, in falling order.
    pub leading_terms: Vec<NamedTerm>,
    /// One entry per input, in their order.
    pub indices: Vec<SurrogateIndices>,
    /// Sum of the first-order indices over the inputs.
    pub sum_first_order: f64,
}

impl SurrogateOutput {
    /// Share of the variance of other rows that a useful surrogate explains: its residual widens all intervals.
    pub const MIN_EXPLAINED: f64 = 0.5;
}

/// The indices of one input by surrogates, nominally between 0 and 1 and not clamped.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurrogateIndices {
    /// The input.
    pub input: String,
    /// First-order index, without the part that no rows determine.
    pub first_order: Estimate,
    /// Total index, without the part that no rows determine.
    pub total: Estimate,
}

/// Estimates first-order and total Sobol' indices of every output of a table by surrogates.
///
/// `inputs` and `outputs` are the columns from which `indices` were estimated. `distributions` has one entry per input,
/// or is `None`: then the distributions are those of the columns, and the intervals include their error. They are
/// needed for high accuracy: from n random rows of unknown distributions no index has an error below about 1/sqrt(n).
///
/// Estimates are those of the surrogates (Sudret 2008), with 95 % intervals from what fits leave of the rows that they have
/// not seen, which hold for independent rows and for Sobol' points.
///
/// # Errors
/// [`SurrogateRefusal`]: inputs that depend on each other, a number of distributions other than that of inputs, a
/// column that does not follow its distribution.
pub fn surrogate_indices(
    inputs: &[Column],
    outputs: &[Column],
    indices: &GivenIndices,
    distributions: Option<&[Distribution]>,
) -> Result<Surrogates, SurrogateRefusal> {
    if indices.effective_rows.is_some() {
        return Err(SurrogateRefusal::InTime);
    }
    if let Some(dependent) = indices.dependence.as_ref().and_then(Dependence::dependent) {
        return Err(SurrogateRefusal::Dependent { inputs: dependent.clone() });
    }
    let rows = used_rows(indices.rows, inputs.len());
    let inputs: Vec<Column> = inputs.iter().map(|input| at_rows(input, &rows)).collect();
    let orders: Vec<Order> = inputs.iter().map(|input| Order::from_values(&input.values)).collect();
    let coordinates = match distributions {
        Some(list) if list.len() != inputs.len() => {
            return Err(SurrogateRefusal::Distributions { distributions: list.len(), inputs: inputs.len() });
        }
        Some(list) => coordinates::of_distributions(&inputs, &orders, list)?,
        None => coordinates::of_columns(&inputs, &orders),
    };
    let names: Vec<&str> = inputs.iter().map(|input| input.name.as_str()).collect();
    let job = Job { names: &names, coordinates: &coordinates, uses_columns: distributions.is_none() };
    let outputs = outputs.iter().map(|output| job.output(&at_rows(output, &rows).values));
    Ok(Surrogates {
        rows: rows.len(),
        folds: folds_at(rows.len()),
        given_distributions: distributions.is_some(),
        outputs: outputs.collect(),
    })
}

fn at_rows(column: &Column, rows: &[usize]) -> Column {
    Column { name: column.name.clone(), values: rows.iter().map(|&row| column.values[row]).collect() }
}

/// Returns the indices of the rows, in random order, but always in the same: the first ones must be like all.
fn used_rows(rows: usize, inputs: usize) -> Vec<usize> {
    let most = MAX_ROWS.min(MAX_VALUES / (inputs * degree_at(rows))).max(super::MIN_ROWS);
    drawn_rows(rows, most, 0)
}

/// Returns what must be added to the centred and scaled outputs `z` for outputs of the sign of `y`.
fn offset(y: &[f64], z: &[f64]) -> f64 {
    let largest = (0..z.len()).fold(0, |best, row| if z[row] > z[best] { row } else { best });
    let smallest = (0..z.len()).fold(0, |best, row| if z[row] < z[best] { row } else { best });
    y[largest] * ((z[largest] - z[smallest]) / (y[largest] - y[smallest])) - z[largest]
}

/// The table, shared by all outputs.
struct Job<'a> {
    /// The names of the inputs.
    names: &'a [&'a str],
    /// The variables and polynomials to try, at least one.
    coordinates: &'a [Coordinates],
    /// Whether the distributions are those of the columns.
    uses_columns: bool,
}

impl Job<'_> {
    /// Computes the surrogate estimates of the outputs `y`.
    fn output(&self, y: &[f64]) -> Result<SurrogateOutput, NoVariance> {
        let z = centred(y)?;
        let sd = (z.iter().map(|z| z * z).sum::<f64>() / z.len() as f64).sqrt();
        let offset = offset(y, &z) / sd;
        let z: Vec<f64> = z.iter().map(|z| z / sd).collect();
        let inputs = 0..self.names.len();
        let effects = Effects { swaps: inputs.map(|input| vec![input]).collect(), pairs: Vec::new() };
        let fitted = |of: &Coordinates| PlainFit::new(&of.families, &of.values, &z, Some(offset), &effects);
        let (mut best, mut name) = (fitted(&self.coordinates[0]), self.coordinates[0].name);
        for coordinates in &self.coordinates[1..] {
            let next = fitted(coordinates);
            if next.unknown() < best.unknown() {
                (best, name) = (next, coordinates.name);
            }
        }
        Ok(estimates::surrogate_output(&best, &effects, name, self.names, self.uses_columns))
    }
}
