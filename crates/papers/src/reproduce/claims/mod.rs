//! The claims of the papers, each with a check that computes the answer.
//!
//! A check evaluates the physics (or uses the studies' results) with explicit criteria. One rule applies to all claims:
//! the answer at the scene and with the constants of the paper's figure is the [`Verdict`]; the share of the general
//! study's box where it holds is stated with it. Nothing is entered by hand: if the tests replace the physics, the
//! verdicts change.

mod bench;
mod dimensions;
mod environment;
mod in_time;
mod judge;
mod modes;
mod shares;

#[cfg(test)]
mod tests;

use apportion::result::json;
use bench::{Bench, Physics};
use judge::Answer;
use serde::Serialize;

use super::papers::{PaperClaim, filled, papers};
use super::{Effort, Reproduced};

/// A claim of the papers with our verdict.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Claim {
    /// Its number, from 1; two claims may share a number.
    pub number: usize,
    /// Its source, such as `CHK fig. 6, LG fig. 2a`.
    pub source: &'static str,
    /// The claim in one sentence.
    pub statement: &'static str,
    /// Our verdict in the setting of the paper: at its figure's scene, with its constants.
    #[serde(flatten)]
    pub verdict: Verdict,
    /// Where it holds over the whole ranges of the general study; for orders and percentages, under which friction.
    pub range: String,
    /// Our result, in a sentence or two.
    pub finding: String,
    /// The setting of the result: models, ranges, fidelity, varied factors and resolution.
    pub setting: String,
    /// Stems of its figures.
    pub figures: &'static [&'static str],
}

/// The verdict on a claim.
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
        own: String,
    },
}

impl Verdict {
    /// Returns `Reproduced` if the claim holds.
    fn reproduced_if(holds: bool) -> Self {
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

/// A function that checks a claim.
type Check = fn(&Bench<'_>) -> anyhow::Result<Answer>;

/// The checks by their names in `papers.toml`.
const CHECKS: [(&str, Check); 25] = [
    ("slip_time", in_time::slip_time),
    ("displacement", in_time::displacement),
    ("forces", in_time::forces),
    ("delay", in_time::delay),
    ("contacts", in_time::contacts),
    ("angle", modes::angle),
    ("rolling", modes::rolling),
    ("weaker_law", environment::weaker_law),
    ("length", dimensions::length),
    ("width", dimensions::width),
    ("thickness", dimensions::thickness),
    ("height", dimensions::height),
    ("velocity", environment::velocity),
    ("elastic_modulus", environment::elastic_modulus),
    ("contact_modulus", environment::contact_modulus),
    ("adhesion", environment::adhesion),
    ("constant_parameters", environment::constant_parameters),
    ("dimensional_order", |bench| shares::order(bench, "dimensional")),
    ("dimensional_percentage", |bench| shares::printed_percentages(bench, "dimensional", None)),
    ("most_effective", shares::most_effective),
    ("environmental_order", |bench| shares::order(bench, "environmental")),
    ("environmental_percentages", shares::environmental_percentages),
    ("general_order", |bench| shares::order(bench, "general")),
    ("general_percentages", shares::general_percentages),
    ("outweigh", shares::outweigh),
];

/// Checks every claim of the papers, in the order of their numbers. `studies` are all nine studies with intervals;
/// claims 17 to 20 depend on them. The same studies and effort give the same claims, to the last letter.
///
/// # Errors
/// An error if a study is missing or has no indices, or a scene has no critical force.
pub fn claims(studies: &[Reproduced], effort: Effort) -> anyhow::Result<Vec<Claim>> {
    answered(&Bench::new(Physics::ours(), effort, studies), &(1..=20))
}

/// Checks the claims whose numbers are in `numbers`.
fn answered(bench: &Bench<'_>, numbers: &std::ops::RangeInclusive<usize>) -> anyhow::Result<Vec<Claim>> {
    let asked = papers().claims.iter().filter(|claim| numbers.contains(&claim.number));
    let claim = |claim: &'static PaperClaim| {
        let (_, check) = CHECKS.iter().find(|(name, _)| *name == claim.check).expect("a check for every claim");
        let Answer { verdict, range, mut words } = check(bench)?;
        words.extend(bench.sizes.words());
        Ok(Claim {
            number: claim.number,
            source: claim.source,
            statement: claim.statement,
            verdict,
            range,
            finding: filled(&claim.finding, &words),
            setting: filled(&claim.setting, &words),
            figures: &claim.figures,
        })
    };
    asked.map(claim).collect()
}

/// Formats the claims as JSON: `format` (`apportion-claims`), `version`, `claims`, each with the fields of [`Claim`],
/// its verdict as `verdict` (`reproduced`, `not-reproduced`, `contradicted`, with `own`).
pub fn claims_json(claims: &[Claim]) -> String {
    #[derive(Serialize)]
    struct ClaimsFile<'a> {
        format: &'static str,
        version: u32,
        claims: &'a [Claim],
    }
    json(&ClaimsFile { format: "apportion-claims", version: 2, claims })
}
