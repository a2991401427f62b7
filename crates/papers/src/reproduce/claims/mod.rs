//! The claims of the papers, each with a check that computes the answer.
//!
//! A check evaluates the physics (or uses the studies' results) with explicit criteria. One rule applies to all claims:
//! the answer at the scene and with the constants of the paper's figure is the [`Verdict`]; the share of the general
//! study's box where it holds is stated with it. Nothing is entered by hand: if the tests replace the physics, the
//! verdicts change.

mod context;
mod curve;
mod dimensions;
mod environment;
mod in_time;
mod judge;
mod modes;
mod shares;
mod verdict;

#[cfg(test)]
mod tests;

use apportion::result::json;
use context::{ClaimContext, Physics};
use judge::Answer;
use serde::Serialize;
pub use verdict::Verdict;

use super::papers::papers;
use super::studies::{Effort, Reproduced};
use super::words::filled;

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

/// A function that checks a claim.
type Check = fn(&ClaimContext<'_>) -> anyhow::Result<Answer>;

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
    ("dimensional_order", |context| shares::order(context, "dimensional")),
    ("dimensional_percentage", |context| shares::printed_percentages(context, "dimensional", None)),
    ("most_effective", shares::most_effective),
    ("environmental_order", |context| shares::order(context, "environmental")),
    ("environmental_percentages", shares::environmental_percentages),
    ("general_order", |context| shares::order(context, "general")),
    ("general_percentages", shares::general_percentages),
    ("outweigh", shares::outweigh),
];

/// Checks every claim of the papers, in the order of their numbers. `studies` are all nine studies with intervals;
/// claims 17 to 20 depend on them. The same studies and effort give the same claims, to the last letter.
///
/// # Errors
/// An error if a study is missing or has no indices, or a scene has no critical force.
pub fn claims(studies: &[Reproduced], effort: Effort) -> anyhow::Result<Vec<Claim>> {
    answered(&ClaimContext::new(Physics::ours(), effort, studies), &(1..=20))
}

/// Checks the claims whose numbers are in `numbers`.
fn answered(context: &ClaimContext<'_>, numbers: &std::ops::RangeInclusive<usize>) -> anyhow::Result<Vec<Claim>> {
    let mut claims = Vec::new();
    for claim in papers().claims.iter().filter(|claim| numbers.contains(&claim.number)) {
        let (_, check) = CHECKS.iter().find(|(name, _)| *name == claim.check).expect("a check for every claim");
        let Answer { verdict, range, mut words } = check(context)?;
        words.extend(context.sizes.words());
        claims.push(Claim {
            number: claim.number,
            source: claim.source,
            statement: claim.statement,
            verdict,
            range,
            finding: filled(&claim.finding, &words),
            setting: filled(&claim.setting, &words),
            figures: &claim.figures,
        });
    }
    Ok(claims)
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
