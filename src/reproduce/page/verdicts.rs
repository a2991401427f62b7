//! The verdicts on the claims: a table, and a sentence that counts them.

use super::cells::plain;
use crate::report::page::{Cell, Link, Mark, PageTable, Part};
use crate::reproduce::claims::{Claim, Verdict};
use crate::reproduce::figures::PaperFigure;

/// The word and the look of a verdict.
fn badge(verdict: &Verdict) -> Cell {
    let mark = match verdict {
        Verdict::Reproduced => Mark::Good,
        Verdict::Partly { .. } => Mark::Mixed,
        Verdict::NotReproduced | Verdict::Contradicts { .. } => Mark::Bad,
    };
    Cell::marked(verdict.word(), mark)
}

/// What the verdict adds to its word.
fn detail(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Reproduced | Verdict::NotReproduced => String::new(),
        Verdict::Partly { range } => format!("Holds {range}. "),
        Verdict::Contradicts { own } => format!("Contradicts the paper's own {own}. "),
    }
}

/// The table of verdicts; figures that are on the page are linked.
pub(super) fn table(claims: &[Claim], figures: &[PaperFigure]) -> Part {
    let row = |claim: &Claim| {
        let shown = claim.figures.iter().filter_map(|stem| figures.iter().find(|figure| figure.stem == *stem));
        let links = shown.map(|figure| Link { text: figure.label.to_owned(), to: format!("#{}", figure.stem) });
        vec![
            plain(claim.number.to_string()),
            Cell { note: claim.source.to_owned(), ..plain(claim.statement) },
            badge(&claim.verdict),
            Cell {
                note: claim.setting.clone(),
                links: links.collect(),
                ..plain(format!("{}{}", detail(&claim.verdict), claim.finding))
            },
        ]
    };
    Part::Table(PageTable {
        caption: "Each claim of the papers, and what our computation answers. Every verdict is computed from the \
                  figures beside it."
            .to_owned(),
        header: ["", "claim", "verdict", "our figures, and the setting they hold in"].map(str::to_owned).to_vec(),
        numeric: Vec::new(),
        sentences: true,
        rows: claims.iter().map(row).collect(),
    })
}

/// `Of 20 claims, 12 are reproduced, 4 hold in part, ...`.
pub(super) fn sentence(claims: &[Claim]) -> String {
    let count = |test: fn(&Verdict) -> bool| claims.iter().filter(|claim| test(&claim.verdict)).count();
    let parts = [
        (count(|v| *v == Verdict::Reproduced), "reproduced"),
        (count(|v| matches!(v, Verdict::Partly { .. })), "reproduced in part"),
        (count(|v| *v == Verdict::NotReproduced), "not reproduced"),
        (count(|v| matches!(v, Verdict::Contradicts { .. })), "in contradiction with what the papers themselves give"),
    ];
    let said: Vec<String> = parts.iter().filter(|(n, _)| *n > 0).map(|(n, words)| format!("{n} {words}")).collect();
    format!("Of the papers' {} claims, ours are {}.", claims.len(), super::answers::listed(&said))
}
