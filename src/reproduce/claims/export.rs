//! Claims for programs.

use serde::Serialize;

use super::{Claim, ClaimsError};
use apportion::report::csv::{Csv, fields};
use apportion::report::document::Value;

/// The claims as CSV, a line each: number, source, statement, verdict in a word, where it holds in part or what of the
/// paper's own contradicts it, finding, setting, figures (separated by spaces).
pub fn claims_csv(claims: &[Claim]) -> String {
    let names = ["number", "source", "statement", "verdict", "where", "finding", "setting", "figures"];
    let mut csv = Csv::new(fields(&names, &[]));
    for claim in claims {
        let texts =
            [claim.verdict.word(), claim.verdict.place(), &claim.finding, &claim.setting, &claim.figures.join(" ")];
        let begin: [Value; 3] = [(claim.number as u64).into(), claim.source.into(), claim.statement.into()];
        csv.row(begin.into_iter().chain(texts.map(Value::from)));
    }
    csv.text()
}

#[derive(Serialize)]
struct ClaimsFile<'a> {
    format: &'static str,
    version: u32,
    claims: &'a [Claim],
}

/// The claims as JSON: `format` (`apportion-claims`), `version`, `claims`, each with the fields of [`Claim`], its verdict
/// as `verdict` (`reproduced`, `partly`, `not-reproduced`, `contradicts`) with `range` or `own` where it has one.
///
/// # Errors
/// [`ClaimsError::Format`] if it cannot be written, which memory does not refuse.
pub fn claims_json(claims: &[Claim]) -> Result<String, ClaimsError> {
    let file = ClaimsFile { format: "apportion-claims", version: 1, claims };
    let mut text = serde_json::to_string_pretty(&file).map_err(|error| ClaimsError::Format(error.to_string()))?;
    text.push('\n');
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::claims::Verdict;

    fn sample() -> Vec<Claim> {
        let range = "\"here\", not there".to_owned();
        let claim = Claim {
            number: 3,
            source: "TS04 fig. 11",
            statement: "A statement, with a comma.",
            verdict: Verdict::Partly { range },
            finding: "Two\nlines.".into(),
            setting: "S".into(),
            figures: &["ts04-11", "chk-5"],
        };
        vec![claim.clone(), Claim { verdict: Verdict::NotReproduced, ..claim }]
    }

    #[test]
    fn what_is_written_is_read_back() {
        let text = claims_csv(&sample());
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        assert_eq!(rows.len(), 2);
        let first: Vec<&str> = rows[0].iter().collect();
        assert_eq!(first[..3], ["3", "TS04 fig. 11", "A statement, with a comma."]);
        assert_eq!(first[3..], ["partly", "\"here\", not there", "Two\nlines.", "S", "ts04-11 chk-5"]);
        assert_eq!((&rows[1][3], &rows[1][4]), ("not reproduced", ""));

        let json: serde_json::Value = serde_json::from_str(&claims_json(&sample()).unwrap()).unwrap();
        assert_eq!(json["format"], "apportion-claims");
        assert_eq!(json["claims"][0]["verdict"], "partly");
        assert_eq!(json["claims"][0]["range"], "\"here\", not there");
        assert_eq!(json["claims"][1]["verdict"], "not-reproduced");
        assert!(json["claims"][1].get("range").is_none());
    }
}
