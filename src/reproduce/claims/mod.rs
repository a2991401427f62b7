//! What the papers claim, each answered by a check that computes.

use std::fmt;

/// A claim of the papers with our answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// Its number, from 1.
    pub number: usize,
    /// Where it stands, such as `CHK fig. 6, LG fig. 2a`.
    pub source: &'static str,
    /// What is claimed, in one sentence.
    pub statement: &'static str,
    /// Our answer.
    pub verdict: Verdict,
    /// Our figures, in a sentence or two.
    pub finding: String,
    /// The setting in which the finding holds: models, ranges, fidelity, what was varied and how finely.
    pub setting: String,
    /// Stems of the figures that show it.
    pub figures: &'static [&'static str],
}

/// The answer to a claim.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It holds.
    Reproduced,
    /// It holds in part.
    Partly {
        /// Where it holds, and where not.
        range: String,
    },
    /// It does not hold.
    NotReproduced,
    /// What the paper itself gives says otherwise.
    Contradicts {
        /// What of the paper's own.
        own: String,
    },
}

/// Reads as in `partly: up to 600 nm/s`.
impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reproduced => f.write_str("reproduced"),
            Self::Partly { range } => write!(f, "partly: {range}"),
            Self::NotReproduced => f.write_str("not reproduced"),
            Self::Contradicts { own } => write!(f, "contradicts the paper's own {own}"),
        }
    }
}
