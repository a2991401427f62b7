//! The verdicts on the claims: a table, and a sentence that counts them.

use super::figures::{anchor, label};
use crate::reproduce::claims::{Claim, Verdict};
use crate::reproduce::figures::PaperFigure;
use apportion::report::csv::Field;
use apportion::report::document::{Cell, Column, Link, Mark, OnPhone, Part, Table};

/// The word and the look of a verdict.
fn badge(verdict: &Verdict) -> Cell {
    let mark = match verdict {
        Verdict::Reproduced => Mark::Good,
        Verdict::NotReproduced => Mark::Mixed,
        Verdict::Contradicted { .. } => Mark::Bad,
    };
    Cell::marked(verdict.word(), mark)
}

/// The table of verdicts, a line or two each; all of every claim as CSV.
pub(super) fn table(claims: &[Claim]) -> Table {
    let row = |claim: &Claim| -> Vec<Cell> {
        let own = claim.verdict.own();
        let note = if own.is_empty() { String::new() } else { format!("by the paper's own {own}") };
        vec![
            claim.number.to_string().into(),
            claim.source.into(),
            Cell::valued(format!("{} ({})", claim.statement, claim.source), claim.statement.into()),
            Cell { note, ..badge(&claim.verdict) },
            own.into(),
            (&claim.range).into(),
            (&claim.finding).into(),
            (&claim.setting).into(),
            claim.figures.join(" ").into(),
        ]
    };
    let caption = "Each claim of the papers, and our answer, as the paper shows it (at its figure's scene, with its \
                   constants) and over the whole ranges of the general study.";
    let in_file = |name: &str| Column::in_file(Field::new(name));
    let printed = |heading: &str, name: &str| Column::text(heading).named(Field::new(name));
    let columns = [
        printed("", "number"),
        in_file("source"),
        printed("claim", "statement"),
        printed("as the paper shows it", "verdict"),
        in_file("own"),
        printed("over the whole ranges", "range"),
        in_file("finding"),
        in_file("setting"),
        in_file("figures"),
    ];
    let table = Table::new(caption, columns).with_rows(claims.iter().map(row));
    Table { on_phone: OnPhone::Stack, file: "claims.csv".to_owned(), ..table }
}

/// Our figures for every claim, the setting they hold in, and the figures of the page that show it.
pub(super) fn details(claims: &[Claim], figures: &[PaperFigure]) -> Part {
    let row = |claim: &Claim| {
        let shown = claim.figures.iter().filter_map(|stem| Some((label(figures, stem)?, anchor(stem))));
        let links = shown.map(|(label, anchor)| Link::new(label, format!("#{anchor}")));
        vec![
            Cell { links: links.collect(), ..Cell::from(claim.number.to_string()) },
            Cell { note: claim.setting.clone(), ..Cell::from(&claim.finding) },
        ]
    };
    let columns = Column::list(2, &["claim", "our figures, and the setting they hold in"]);
    let table = Table::new("What the verdicts rest on.", columns).with_rows(claims.iter().map(row));
    let table = Table { on_phone: OnPhone::Stack, ..table };
    Part::Details {
        summary: "Our figures for every claim, and the settings they hold in".to_owned(),
        parts: vec![Part::Table(table)],
    }
}

/// `Of 25 answers to the papers' 20 claims, 14 are reproduced, 8 are not, and 3 are contradicted ...`.
pub(super) fn sentence(claims: &[Claim]) -> String {
    let count = |word: &str| claims.iter().filter(|claim| claim.verdict.word() == word).count();
    format!(
        "Of {} answers to the papers' {} claims, {} are reproduced, {} are not reproduced, and {} are contradicted by the \
         same paper.",
        claims.len(),
        claims.last().map_or(0, |claim| claim.number),
        count("reproduced"),
        count("not reproduced"),
        count("contradicted")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn claims_are_read_back_from_their_file() {
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
        let text = table(&[claim.clone(), Claim { verdict: Verdict::NotReproduced, ..claim }]).csv();
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
    }
}
