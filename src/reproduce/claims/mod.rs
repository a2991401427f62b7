//! What the papers claim, each answered by a check that computes.
//!
//! A check asks the physics (or the studies that have been run) a question with explicit criteria, at the nominal scene
//! and over the box of the general study, and the answers make the [`Verdict`]. Nothing is typed in by hand: the tests
//! put bent physics in the place of ours, and see the verdicts change.

mod bench;
mod curve;
mod dimensions;
mod environment;
mod export;
mod in_time;
mod judge;
mod models;
mod modes;
mod numbers;
mod shares;

#[cfg(test)]
mod tests;

pub use export::{claims_csv, claims_json};

use std::fmt;

use serde::Serialize;
use thiserror::Error;

use super::{Effort, Reproduced};
use apportion::afm::Failure;
use apportion::study::StudyError;
use bench::{Bench, Physics};

/// A claim of the papers with our answer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Claim {
    /// Its number, from 1; a number that holds two claims comes twice.
    pub number: usize,
    /// Where it stands, such as `CHK fig. 6, LG fig. 2a`.
    pub source: &'static str,
    /// What is claimed, in one sentence.
    pub statement: &'static str,
    /// Our answer.
    #[serde(flatten)]
    pub verdict: Verdict,
    /// Our figures, in a sentence or two.
    pub finding: String,
    /// The setting in which the finding holds: models, ranges, fidelity, what was varied and how finely.
    pub setting: String,
    /// Stems of the figures that show it.
    pub figures: &'static [&'static str],
}

/// The answer to a claim.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "verdict", rename_all = "kebab-case")]
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

impl Verdict {
    /// The verdict without its where: `reproduced`, `partly`, `not reproduced`, `contradicts`.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Partly { .. } => "partly",
            Self::NotReproduced => "not reproduced",
            Self::Contradicts { .. } => "contradicts",
        }
    }

    /// Where a claim holds in part, or what of the paper's own contradicts it; empty for the others.
    pub fn place(&self) -> &str {
        match self {
            Self::Partly { range } => range,
            Self::Contradicts { own } => own,
            Self::Reproduced | Self::NotReproduced => "",
        }
    }
}

/// Reads as in `partly: up to 600 nm/s`.
impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reproduced | Self::NotReproduced => f.write_str(self.word()),
            Self::Partly { range } => write!(f, "partly: {range}"),
            Self::Contradicts { own } => write!(f, "contradicts the paper's own {own}"),
        }
    }
}

/// Why the claims cannot be answered.
#[derive(Debug, Error)]
pub enum ClaimsError {
    /// A study of this program, from which the ranges are taken, cannot be read.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The general study lacks a factor that a claim is about.
    #[error("the general study does not give the range of every factor that the claims are about")]
    NoRanges,
    /// A scene has no critical force.
    #[error("a scene that a claim is about has no answer: {0}")]
    Scene(#[from] Failure),
    /// A study that a claim is about has not been run, or has no indices.
    #[error("claims 17 to 20 need the {group} study under {friction} friction, with its indices")]
    NoIndices {
        /// The study's group.
        group: &'static str,
        /// The name of its friction model.
        friction: &'static str,
    },
    /// The claims cannot be put into a file's format.
    #[error("the claims cannot be written: {0}")]
    Format(String),
}

/// Every claim of the papers with our answer, in the order of their numbers. `studies` are all nine studies, run with
/// intervals; claims 17 to 20 rest on them. The same studies and effort give the same claims, to the last letter.
///
/// # Errors
/// [`ClaimsError`] if a study is missing or has no indices, or a scene has no critical force.
pub fn claims(studies: &[Reproduced], effort: Effort) -> Result<Vec<Claim>, ClaimsError> {
    answered(Physics::ours(), studies, effort)
}

fn answered(physics: Physics<'_>, studies: &[Reproduced], effort: Effort) -> Result<Vec<Claim>, ClaimsError> {
    let bench = Bench::new(physics, effort)?;
    let mut claims = in_time::claims(&bench)?;
    claims.extend(modes::claims(&bench)?);
    claims.extend(models::claims(&bench)?);
    claims.extend(dimensions::claims(&bench)?);
    claims.extend(environment::claims(&bench)?);
    claims.extend(shares::claims(&bench, studies)?);
    claims.sort_by_key(|claim| claim.number);
    Ok(claims)
}
