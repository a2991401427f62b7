//! The verdicts on the claims: a table, and a sentence with their counts.

use apportion_report::document::{Cell, Link, Mark, OnPhone, Part, Table};

use super::figures::anchor;
use crate::reproduce::claims::{Claim, Verdict};
use crate::reproduce::figures::PaperFigure;

/// Returns the number of a claim, with a letter if it has several parts: `17a`.
fn part(claims: &[Claim], claim: &Claim) -> String {
    let parts: Vec<&Claim> = claims.iter().filter(|other| other.number == claim.number).collect();
    let place = parts.iter().position(|other| std::ptr::eq(*other, claim)).filter(|_| parts.len() > 1);
    format!("{}{}", claim.number, place.map_or("", |place| ["a", "b", "c", "d"][place]))
}

/// Builds the table of verdicts, a line or two each; the CSV file has all of every claim.
pub(super) fn table(claims: &[Claim]) -> Part {
    let caption = "Each claim of the papers, and our answer, as the paper shows it (at its figure's scene, with its \
                   constants) and over the whole ranges of the general study.";
    let rows = Table::from_rows(caption, claims)
        .text("", |claim| part(claims, claim))
        .value("number", |claim| claim.number as u64)
        .file("source", |claim| claim.source)
        .text("claim", |claim| format!("{} ({})", claim.statement, claim.source))
        .value("statement", |claim| claim.statement)
        .text("as the paper shows it", |claim| verdict_cell(&claim.verdict))
        .named("verdict")
        .file("own", |claim| if let Verdict::Contradicted { by } = &claim.verdict { by } else { "" })
        .text("over the whole ranges", |claim| &claim.range)
        .named("range")
        .file("finding", |claim| &claim.finding)
        .file("setting", |claim| &claim.setting)
        .file("figures", |claim| claim.figures.join(" "));
    Table { on_phone: OnPhone::Stack, file: "claims.csv".to_owned(), ..rows.into() }.into()
}

fn verdict_cell(verdict: &Verdict) -> Cell {
    let (mark, note) = match verdict {
        Verdict::Reproduced => (Mark::Good, String::new()),
        Verdict::NotReproduced => (Mark::Mixed, String::new()),
        Verdict::Contradicted { by } => (Mark::Bad, format!("by the paper's own {by}")),
    };
    Cell { note, ..Cell::marked(verdict.word(), mark) }
}

/// Lists our results for every claim, their setting, and their figures on the page.
pub(super) fn details(claims: &[Claim], figures: &[PaperFigure]) -> Part {
    let rows = Table::from_rows("Basis of the verdicts.", claims)
        .text("claim", |claim| {
            let shown = claim.figures.iter().filter_map(|stem| figures.iter().find(|figure| figure.stem == *stem));
            let links = shown.map(|figure| Link::new(&figure.label, format!("#{}", anchor(figure.stem)))).collect();
            Cell { links, ..Cell::from(part(claims, claim)) }
        })
        .text("our values, and their setting", |claim| Cell {
            note: claim.setting.clone(),
            ..Cell::from(&claim.finding)
        });
    let summary = "Our values for every claim, and their settings".to_owned();
    let table = Table { on_phone: OnPhone::Stack, ..rows.into() };
    Part::OnPage(vec![Part::Details { summary, parts: vec![table.into()] }])
}

/// Counts the verdicts:
/// `Of 25 answers to the papers' 20 claims, 14 are reproduced, 8 are not, and 3 are contradicted ...`.
pub(super) fn sentence(claims: &[Claim]) -> Option<String> {
    let [reproduced, not_reproduced, contradicted] = ["reproduced", "not reproduced", "contradicted"]
        .map(|word| claims.iter().filter(|claim| claim.verdict.word() == word).count());
    Some(format!(
        "Of {} answers to the papers' {} claims, {reproduced} are reproduced, {not_reproduced} are not reproduced, and \
         {contradicted} are contradicted by the same paper.",
        claims.len(),
        claims.last()?.number
    ))
}
