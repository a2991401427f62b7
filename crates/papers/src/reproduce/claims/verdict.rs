//! The verdict on a claim.

use serde::Serialize;

/// The answer of a check to a claim.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "verdict", rename_all = "kebab-case")]
pub enum Verdict {
    /// Every part of it holds.
    Reproduced,
    /// Some part of it does not hold.
    NotReproduced,
    /// A number or figure of the same paper contradicts it.
    Contradicted {
        /// The number or figure.
        #[serde(rename = "own")]
        by: String,
    },
}

impl Verdict {
    pub(super) fn reproduced_if(holds: bool) -> Self {
        if holds { Self::Reproduced } else { Self::NotReproduced }
    }

    /// Returns the verdict in words: `reproduced`, `not reproduced`, `contradicted`.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::NotReproduced => "not reproduced",
            Self::Contradicted { .. } => "contradicted",
        }
    }
}
