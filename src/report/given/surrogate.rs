//! What surrogates say of a table, in its result file.

use serde::{Deserialize, Serialize};

use crate::given::{InputIndices, LEAST_EXPLAINED, SurrogateOutput, SurrogateRefusal, Surrogates};
use crate::report::result::{EstimateRecord, SurrogateTermRecord, estimate_record};
use crate::uncertainty::SurrogateTerm;

/// Surrogates, or why there are none.
pub type SurrogateResult = Result<Surrogates, SurrogateRefusal>;

/// How surrogates were fitted to a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GivenSurrogateRecord {
    /// Why there are none, if so.
    pub refused: Option<String>,
    /// Rows used; `null` without surrogates.
    pub rows: Option<u64>,
    /// Parts of the table, each corrected by a surrogate of the others; `null` without surrogates.
    pub folds: Option<u64>,
    /// `"columns"`: those of the columns; `"given"`: those of a study. `null` without surrogates.
    pub distributions: Option<String>,
    /// Share of the variance that a surrogate must explain to serve.
    pub least_explained: f64,
}

/// Indices of an output by surrogates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GivenSurrogateOutput {
    /// Share of the variance that they explain of rows that they were not fitted to, Q^2.
    pub explained: f64,
    /// The share that they leave, between 0 and 1: no rows of a table tell to which inputs it belongs. An index is larger than
    /// its estimate by up to so much, which the upper bounds contain.
    pub unknown: f64,
    /// Whether the indices are the ones to read: `explained` is at least the least share.
    pub serves: bool,
    /// In which variable of the inputs the surrogates are polynomials, in words.
    pub polynomials_of: String,
    /// Terms of each surrogate, on average.
    pub terms: f64,
    /// The terms that carry most of the variance.
    pub leading_terms: Vec<SurrogateTermRecord>,
    /// One entry per input.
    pub indices: Vec<GivenSurrogateIndex>,
    /// Sum of the first-order indices over the inputs.
    pub sum_first_order: f64,
}

/// The indices of one input by surrogates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GivenSurrogateIndex {
    /// The input.
    pub input: String,
    /// Its first-order index.
    pub first_order: EstimateRecord,
    /// Its total index.
    pub total: EstimateRecord,
}

pub(super) fn surrogate_record(result: &SurrogateResult) -> GivenSurrogateRecord {
    let fitted = result.as_ref().ok();
    GivenSurrogateRecord {
        refused: result.as_ref().err().map(ToString::to_string),
        rows: fitted.map(|all| all.rows as u64),
        folds: fitted.map(|all| all.folds as u64),
        distributions: fitted.map(|all| if all.given_distributions { "given" } else { "columns" }.to_owned()),
        least_explained: LEAST_EXPLAINED,
    }
}

pub(super) fn surrogate_output(output: &SurrogateOutput, inputs: &[InputIndices]) -> GivenSurrogateOutput {
    let term = |term: &SurrogateTerm| SurrogateTermRecord {
        degrees: term.factors.iter().map(|&(number, degree)| (inputs[number].input.clone(), degree)).collect(),
        share: 100.0 * term.share,
    };
    let indices = output.indices.iter().zip(inputs).map(|(index, input)| GivenSurrogateIndex {
        input: input.input.clone(),
        first_order: estimate_record(index.first_order),
        total: estimate_record(index.total),
    });
    GivenSurrogateOutput {
        explained: output.explained,
        unknown: output.unknown,
        serves: output.serves(),
        polynomials_of: output.polynomials_of.to_owned(),
        terms: output.term_count,
        leading_terms: output.terms.iter().map(term).collect(),
        indices: indices.collect(),
        sum_first_order: output.indices.iter().map(|index| index.first_order.estimate).sum(),
    }
}
