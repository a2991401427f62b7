//! The reproduction on a terminal.

use super::claims::Claim;
use super::percentages::summary;
use super::{Reproduction, comparison_table};

/// What came out, as text: the table of shares, a line for each verdict, and what is to be said of the printed
/// percentages; each if it was asked for.
pub fn in_words(reproduction: &Reproduction) -> String {
    let mut text = String::new();
    if !reproduction.studies.is_empty() {
        text.push_str(&comparison_table(&reproduction.studies));
    }
    if !reproduction.claims.is_empty() {
        text.push_str(&format!("\nThe papers' claims\n{}", verdicts(&reproduction.claims)));
    }
    if !reproduction.percentages.is_empty() {
        text.push_str("\nThe percentages that LG prints\n");
        text.extend(summary(&reproduction.percentages).iter().map(|sentence| format!("- {sentence}\n")));
    }
    text
}

/// Two lines for each claim: what is claimed, and what we answer.
fn verdicts(claims: &[Claim]) -> String {
    let lines = claims
        .iter()
        .map(|claim| format!("{:>2}  {}\n    {}; {}\n", claim.number, claim.statement, claim.verdict, claim.range));
    lines.collect()
}
