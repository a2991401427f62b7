//! The verdicts on the claims: a table, and a sentence that counts them.

use super::figures::{anchor, label};
use super::typeset::typeset;
use crate::reproduce::claims::{Claim, Verdict};
use crate::reproduce::figures::PaperFigure;
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

/// The table of verdicts, a line or two each.
pub(super) fn table(claims: &[Claim]) -> Part {
    let row = |claim: &Claim| {
        let own = claim.verdict.own();
        let own = if own.is_empty() { String::new() } else { format!("by the paper's own {own}") };
        vec![
            claim.number.to_string().into(),
            format!("{} ({})", typeset(claim.statement), claim.source).into(),
            Cell { note: typeset(&own), ..badge(&claim.verdict) },
            typeset(&claim.range).into(),
        ]
    };
    let caption = "Each claim of the papers, and our answer, as the paper shows it (at its figure's scene, with its \
                   constants) and over the whole ranges of the general study.";
    let table = Table::new(caption, Column::list(4, &["", "claim", "as the paper shows it", "over the whole ranges"]));
    Part::Table(Table { on_phone: OnPhone::Stack, ..table.with_rows(claims.iter().map(row)) })
}

/// Our figures for every claim, the setting they hold in, and the figures of the page that show it.
pub(super) fn details(claims: &[Claim], figures: &[PaperFigure]) -> Part {
    let row = |claim: &Claim| {
        let shown = claim.figures.iter().filter_map(|stem| Some((label(figures, stem)?, anchor(stem))));
        let links = shown.map(|(label, anchor)| Link::new(label, format!("#{anchor}")));
        vec![
            Cell { links: links.collect(), ..Cell::from(claim.number.to_string()) },
            Cell { note: typeset(&claim.setting), ..Cell::from(typeset(&claim.finding)) },
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
