//! What surrogates say of a table, in its result file.

use serde::{Deserialize, Serialize};

use crate::given::{LEAST_EXPLAINED, SurrogateRefusal, Surrogates};

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
