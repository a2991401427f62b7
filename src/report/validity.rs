//! Whether the model holds where it was run, in sentences.

use super::format::{count, grouped, share_of_runs};
use super::listed;
use super::result::ValidityRecord;

/// Most flags in a sentence.
const NAMED: usize = 3;

/// On how many of the runs assumptions of the model do not hold; that it checks none, where it has no flags.
pub(super) fn sentence(validity: &[ValidityRecord]) -> String {
    if validity.is_empty() {
        return "Whether the model holds is not checked: it has no validity flags.".to_owned();
    }
    let mut raised: Vec<&ValidityRecord> = validity.iter().filter(|flag| flag.runs > 0).collect();
    if raised.is_empty() {
        return "No run leaves the range where the model holds, as far as its flags tell.".to_owned();
    }
    raised.sort_by(|a, b| b.share.total_cmp(&a.share));
    let said = |flag: &&ValidityRecord| {
        let runs = match flag.share {
            1.0.. => "all runs".to_owned(),
            share => format!("{} of the runs", share_of_runs(share)),
        };
        format!("on {runs} {}", clause(&flag.description, &flag.flag))
    };
    let mut all: Vec<String> = raised.iter().take(NAMED).map(said).collect();
    match raised.len().saturating_sub(NAMED) {
        0 => (),
        1 => all.push("another flag is raised".to_owned()),
        more => all.push(format!("{more} more flags are raised")),
    }
    let more = if raised[0].share > 0.5 { ", so that the numbers are those of a model outside its range" } else { "" };
    format!("The model does not hold everywhere: {}{more}.", listed(&all))
}

/// How many runs failed, and what that means; nothing if none did. Of some of the outputs, their names say which.
pub(super) fn of_failures(failed: u64, all: u64, outputs: Option<&str>) -> Option<String> {
    (failed > 0 && failed < all).then(|| {
        let (of, whose) = match outputs {
            None => (String::new(), ": the numbers describe"),
            Some(names) => (format!(" for {names}"), ", whose numbers describe"),
        };
        format!(
            "{} of {} ({}) failed{of}{whose} the part of the factor space where runs succeed.",
            grouped(failed),
            count(all, "run", "runs"),
            share_of_runs(failed as f64 / all as f64)
        )
    })
}

/// What a flag says, as the rest of a sentence: without what follows a colon.
fn clause(description: &str, flag: &str) -> String {
    let text = description.split(": ").next().unwrap_or_default().trim_end_matches('.').trim();
    match text.strip_prefix("The ") {
        Some(rest) => format!("the {rest}"),
        None => format!("the flag {} is raised", flag.replace('-', " ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flag(flag: &str, description: &str, runs: u64) -> ValidityRecord {
        let (flag, description) = (flag.to_owned(), description.to_owned());
        ValidityRecord { flag, description, runs, share: runs as f64 / 1000.0 }
    }

    #[test]
    fn a_model_outside_its_range_is_told() {
        let range = "The parameter lies outside the range.";
        let flags = [flag("a", "The twist is large: nothing holds.", 265), flag("b", range, 1000)];
        assert_eq!(
            sentence(&flags),
            "The model does not hold everywhere: on all runs the parameter lies outside the range and on 26.5 % of the runs \
             the twist is large, so that the numbers are those of a model outside its range."
        );
        assert!(sentence(&[flag("b", range, 999)]).contains("99.9 % of the runs"));
        assert_eq!(
            sentence(&[flag("b", range, 0)]),
            "No run leaves the range where the model holds, as far as its flags tell."
        );
        assert!(sentence(&[]).starts_with("Whether the model holds is not checked"));
        assert!(sentence(&[flag("odd-one", "", 1)]).contains("the flag odd one is raised"));
        let many: Vec<ValidityRecord> = (0..5).map(|_| flag("b", range, 1)).collect();
        assert!(sentence(&many[..4]).ends_with("and another flag is raised."), "{}", sentence(&many[..4]));
        assert!(sentence(&many).ends_with("and 2 more flags are raised."));
    }

    #[test]
    fn runs_that_failed_are_told() {
        assert_eq!(of_failures(0, 10, None), None);
        assert_eq!(of_failures(10, 10, None), None);
        assert!(of_failures(1, 10_000, None).unwrap().starts_with("1 of 10\u{202f}000 runs (less than 0.1 %) failed"));
    }
}
