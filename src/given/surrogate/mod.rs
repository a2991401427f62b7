//! First-order and total indices from given data by a surrogate.
//!
//! The rows are divided into folds. A sparse polynomial chaos expansion fitted to all folds but one has exact indices
//! (Sudret 2008, Reliab. Eng. Syst. Saf. 93, 964-979), and the rows of that one correct its error, as far as rows of a
//! table can ([`contributions`]). The remaining error is bounded by the variance of the residual, and is included in
//! the upper end of every interval.

mod contributions;
mod coordinates;
mod estimates;
mod marginals;

use contributions::{Contributions, FoldSums};
use coordinates::Coordinates;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::order::Order;
use super::{Column, Dependence, GivenIndices, NoVariance, centred, drawn_rows};
use crate::space::Distribution;
use crate::surrogate::basis::Caps;
use crate::surrogate::extrapolation::ExtrapolationError;
use crate::surrogate::family::polynomials;
use crate::surrogate::fit::Expansion;
use crate::surrogate::net::Net;
use crate::surrogate::{Effects, NamedTerm, cross_fitted, leading_terms};
use crate::uncertainty::Estimate;

/// Parts of the table, each of which is corrected by an expansion of the others.
const FOLDS: usize = 8;

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
    /// Share of the variance of other rows that a useful surrogate explains: its residual raises the ends of all intervals.
    pub const MIN_EXPLAINED: f64 = 0.9;
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

/// Estimates first-order and total Sobol' indices of every output of a table by surrogates, cross-fitted and corrected.
///
/// `inputs` and `outputs` are the columns from which `indices` were estimated. `distributions` has one entry per input,
/// or is `None`: then the distributions are those of the columns, and the intervals include their error. They are
/// needed for high accuracy: from n random rows of unknown distributions no index has an error below about 1/sqrt(n).
///
/// Estimates are those of the surrogates (Sudret 2008), with the correction that is linear in their residuals. The part
/// that is quadratic in these is between 0 and [`unknown`](SurrogateOutput::unknown), which is added to the upper ends
/// of the 95 % intervals. The intervals assume independent rows, and are too wide for points that are more even.
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
    let folds: Vec<usize> = rows.iter().map(Vec::len).collect();
    let names: Vec<&str> = inputs.iter().map(|input| input.name.as_str()).collect();
    let job = Job { names: &names, coordinates: &coordinates, folds: &folds, uses_columns: distributions.is_none() };
    let outputs = outputs.iter().map(|output| Ok(job.output(&centred(&at_rows(output, &rows).values)?)));
    Ok(Surrogates {
        rows: folds.iter().sum(),
        folds: FOLDS,
        given_distributions: distributions.is_some(),
        outputs: outputs.collect(),
    })
}

fn at_rows(column: &Column, folds: &[Vec<usize>]) -> Column {
    let values = folds.iter().flatten().map(|&row| column.values[row]).collect();
    Column { name: column.name.clone(), values }
}

/// Returns the indices of the rows of every fold, each in rising order. They are assigned at random, but always in the
/// same way: rows of Sobol' points at equal distances in their order fill only a part of the space.
fn used_rows(rows: usize, inputs: usize) -> Vec<Vec<usize>> {
    let most = MAX_ROWS.min(MAX_VALUES / (inputs * Caps::degree_of(inputs))).max(super::MIN_ROWS);
    let all = drawn_rows(rows, most, 0);
    let mut folds = vec![Vec::new(); FOLDS];
    for (place, row) in all.into_iter().enumerate() {
        folds[place % FOLDS].push(row);
    }
    folds.iter_mut().for_each(|fold| fold.sort_unstable());
    folds
}

/// The table, shared by all outputs.
struct Job<'a> {
    /// The names of the inputs.
    names: &'a [&'a str],
    /// The trials, at least one.
    coordinates: &'a [Coordinates],
    /// Rows of every fold.
    folds: &'a [usize],
    /// Whether the distributions are those of the columns.
    uses_columns: bool,
}

/// Every fold, corrected by an expansion of the others.
struct Fitted {
    folds: Vec<FoldSums>,
    expansions: Vec<Expansion>,
    extrapolation: ExtrapolationError,
    polynomials_of: &'static str,
}

impl Fitted {
    /// Returns the mean square residual plus the error that no rows show.
    fn unknown(&self) -> f64 {
        left_square(&self.folds) + self.extrapolation.variance
    }
}

/// Returns the mean square residual of expansions.
fn left_square(folds: &[FoldSums]) -> f64 {
    let rows: usize = folds.iter().map(|fold| fold.rows).sum();
    folds.iter().map(|fold| fold.residual_square).sum::<f64>() / rows as f64
}

impl Job<'_> {
    /// Computes the surrogate estimates of the centred outputs `z`.
    fn output(&self, z: &[f64]) -> SurrogateOutput {
        let square = z.iter().map(|z| z * z).sum::<f64>() / z.len() as f64;
        let z: Vec<f64> = z.iter().map(|z| z / square.sqrt()).collect();
        let mut best = self.fitted(&self.coordinates[0], &z);
        for coordinates in &self.coordinates[1..] {
            let fitted = self.fitted(coordinates, &z);
            if fitted.unknown() < coordinates.trial.ratio * best.unknown() {
                best = fitted;
            }
        }
        estimates::surrogate_output(&best, self.names)
    }

    fn fitted(&self, coordinates: &Coordinates, z: &[f64]) -> Fitted {
        let caps = Caps::new(&coordinates.trial.families, coordinates.trial.unbounded_degree);
        let nets = self.nets(coordinates, caps, z);
        let expansions = cross_fitted(&nets, caps);
        let folds = nets.par_iter().zip(&expansions).map(|(net, expansion)| {
            let mut contributions = Contributions::new(net, expansion);
            if self.uses_columns {
                marginals::add(net, expansion, &mut contributions);
            }
            contributions.in_parts()
        });
        let folds: Vec<FoldSums> = folds.collect();
        let rows = self.folds.iter().sum::<usize>() as u64;
        let effects = Effects { swaps: (0..caps.families.len()).map(|input| vec![input]).collect(), pairs: Vec::new() };
        let extrapolation = ExtrapolationError::new(&expansions, caps.families, rows, left_square(&folds), &effects);
        Fitted { folds, expansions, extrapolation, polynomials_of: coordinates.name }
    }

    /// Returns every fold with its rows of the outputs `z`.
    fn nets(&self, coordinates: &Coordinates, caps: Caps<'_>, z: &[f64]) -> Vec<Net> {
        let inputs = coordinates.values.par_iter().zip(caps.families);
        let columns: Vec<Vec<Vec<f64>>> =
            inputs.map(|(values, family)| polynomials(family, values, caps.degree)).collect();
        let (mut nets, mut start) = (Vec::new(), 0);
        for count in self.folds {
            let rows = start..start + count;
            start = rows.end;
            let of_fold = columns.iter().map(|list| list.iter().map(|column| column[rows.clone()].to_vec()).collect());
            nets.push(Net::of_rows(of_fold.collect(), z[rows.clone()].to_vec()));
        }
        nets
    }
}
