//! Claims for programs.

use serde::Serialize;

use super::{Claim, ClaimsError};
use apportion::report::csv::{Csv, fields};
use apportion::report::document::Value;

/// The claims as CSV, a line each: number, source, statement, verdict in a word, what of the paper's own contradicts it,
/// where it holds over the whole ranges, finding, setting, figures (separated by spaces).
pub fn claims_csv(claims: &[Claim]) -> String {
    let names = ["number", "source", "statement", "verdict", "own", "range", "finding", "setting", "figures"];
    let mut csv = Csv::new(fields(&names, &[]));
    for claim in claims {
        let figures = claim.figures.join(" ");
        let (verdict, range) = (&claim.verdict, &claim.range);
        let texts = [verdict.word(), verdict.own(), range, &claim.finding, &claim.setting, &figures];
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
/// as `verdict` (`reproduced`, `not-reproduced`, `contradicted`, with `own`).
///
/// # Errors
/// [`ClaimsError::Format`] if it cannot be written, which memory does not refuse.
pub fn claims_json(claims: &[Claim]) -> Result<String, ClaimsError> {
    let file = ClaimsFile { format: "apportion-claims", version: 2, claims };
    let mut text = serde_json::to_string_pretty(&file).map_err(|error| ClaimsError::Format(error.to_string()))?;
    text.push('\n');
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::claims::Verdict;

    fn sample() -> Vec<Claim> {
        let own = "\"here\", not there".to_owned();
        let claim = Claim {
            number: 3,
            source: "TS04 fig. 11",
            statement: "A statement, with a comma.",
            verdict: Verdict::Contradicted { own },
            range: "all of the box".into(),
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
        assert_eq!(
            first[3..],
            ["contradicted", "\"here\", not there", "all of the box", "Two\nlines.", "S", "ts04-11 chk-5"]
        );
        assert_eq!((&rows[1][3], &rows[1][4]), ("not reproduced", ""));

        let json: serde_json::Value = serde_json::from_str(&claims_json(&sample()).unwrap()).unwrap();
        assert_eq!(json["format"], "apportion-claims");
        assert_eq!(json["claims"][0]["verdict"], "contradicted");
        assert_eq!(json["claims"][0]["own"], "\"here\", not there");
        assert_eq!(json["claims"][1]["verdict"], "not-reproduced");
        assert!(json["claims"][1].get("own").is_none());
    }
}
