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
        Verdict::Partly { .. } => Mark::Mixed,
        Verdict::NotReproduced | Verdict::Contradicts { .. } => Mark::Bad,
    };
    Cell::marked(verdict.word(), mark)
}

/// The table of verdicts, a line or two each.
pub(super) fn table(claims: &[Claim]) -> Part {
    let row = |claim: &Claim| {
        let place = match &claim.verdict {
            Verdict::Contradicts { own } => format!("the paper's own {own}"),
            other => other.place().to_owned(),
        };
        vec![
            claim.number.to_string().into(),
            format!("{} ({})", typeset(claim.statement), claim.source).into(),
            Cell { note: typeset(&place), ..badge(&claim.verdict) },
        ]
    };
    let caption = "Each claim of the papers, and our answer: computed, not typed in.";
    let table = Table::new(caption, Column::list(3, &["", "claim", "verdict, and where"]));
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

/// `The papers make 20 claims, some of two parts; of 24 answers 9 are reproduced, 10 partly so, ...`.
pub(super) fn sentence(claims: &[Claim]) -> String {
    let count = |test: fn(&Verdict) -> bool| claims.iter().filter(|claim| test(&claim.verdict)).count();
    let parts = [
        (count(|v| *v == Verdict::Reproduced), "are reproduced"),
        (count(|v| matches!(v, Verdict::Partly { .. })), "partly so"),
        (count(|v| *v == Verdict::NotReproduced), "not reproduced"),
        (count(|v| matches!(v, Verdict::Contradicts { .. })), "contradicted by what the papers themselves give"),
    ];
    let said: Vec<String> = parts.iter().filter(|(n, _)| *n > 0).map(|(n, words)| format!("{n} {words}")).collect();
    format!(
        "The papers make {} claims, some of two parts; of {} answers {}.",
        claims.last().map_or(0, |claim| claim.number),
        claims.len(),
        apportion::report::listed(&said)
    )
}
