//! The reproduction on a terminal.

use super::claims::Claim;
use super::readings::{chances, summary};
use super::{Reproduction, comparison_table};

/// What came out, as text: the table of shares, a line for each verdict, and what the readings say; each if it was asked
/// for.
pub fn in_words(reproduction: &Reproduction) -> String {
    let mut text = String::new();
    if !reproduction.studies.is_empty() {
        text.push_str(&comparison_table(&reproduction.studies));
    }
    if !reproduction.claims.is_empty() {
        text.push_str(&format!("\nThe papers' claims\n{}", verdicts(&reproduction.claims)));
    }
    if let Some(readings) = &reproduction.readings {
        text.push_str("\nWhat the published percentages could mean\n");
        for sentence in summary(readings).into_iter().chain(chances(readings)) {
            text.push_str(&format!("- {sentence}\n"));
        }
    }
    text
}

/// Two lines for each claim: what is claimed, and what we answer.
fn verdicts(claims: &[Claim]) -> String {
    let lines = claims.iter().map(|claim| format!("{:>2}  {}\n    {}\n", claim.number, claim.statement, claim.verdict));
    lines.collect()
}
