//! The document of the reproduction: verdicts, figures, percentages, tables and provenance.

mod answers;
mod constants;
mod figures;
mod provenance;
mod verdicts;

use super::claims::claims_json;
use super::figures::ANIMATION_STEM;
use super::percentages::{self, percentages_csv};
use super::shares::shares_table;
use super::{ReproduceError, Reproduced, Reproduction};
use apportion::report::document::{DataFile, Document, Part, Section, Table};

/// The document about `reproduction`; what was not asked for is left out. But for the times in the results, its files are
/// the same for every run of the same version.
///
/// # Errors
/// [`ReproduceError`] if the claims cannot be written.
pub fn document(reproduction: &Reproduction) -> Result<Document, ReproduceError> {
    let before = [answers_section(reproduction), claims_section(reproduction)];
    let after = [
        percentages_section(reproduction),
        shares_section(reproduction),
        Some(constants::section()),
        Some(provenance_section(reproduction)),
    ];
    let figures = figures::sections(reproduction).into_iter().map(Some);
    Ok(Document {
        name: "index".to_owned(),
        kicker: "Reproduction of three papers".to_owned(),
        title: "Which factor decides the force that pushes a nanoparticle?".to_owned(),
        lead: lead(reproduction),
        sections: before.into_iter().chain(figures).chain(after).flatten().collect(),
        footer: format!("Made by apportion {}.", env!("CARGO_PKG_VERSION")),
        charts: figures::files(&reproduction.figures),
        files: files(reproduction)?,
    })
}

/// The files for programs: results, claims and percentages, and the numbers of every figure. Two tables of the page are
/// files too: the claims and the shares.
fn files(reproduction: &Reproduction) -> Result<Vec<DataFile>, ReproduceError> {
    let mut files = Vec::new();
    let mut add = |name: String, text: String| files.push(DataFile { name, text });
    for study in &reproduction.studies {
        add(format!("{}-{}.json", study.friction.key, study.group.key), study.result.json());
    }
    if !reproduction.claims.is_empty() {
        add("claims.json".to_owned(), claims_json(&reproduction.claims)?);
    }
    if !reproduction.percentages.is_empty() {
        add("percentages.csv".to_owned(), percentages_csv(&reproduction.percentages));
    }
    if let Some(animation) = &reproduction.animation {
        for (ending, text) in [("html", &animation.html), ("csv", &animation.csv), ("json", &animation.json)] {
            add(beside_charts(ANIMATION_STEM, ending), text.clone());
        }
    }
    for figure in &reproduction.figures {
        add(beside_charts(figure.stem, "csv"), figure.csv.clone());
    }
    Ok(files)
}

/// A file beside those of the chart called `stem`.
fn beside_charts(stem: &str, ending: &str) -> String {
    format!("charts/{stem}.{ending}")
}

/// The papers in full, before their initials are used.
const PAPERS: &str = "The papers are TS04: A. Tafazzoli and M. Sitti (2004), “Dynamic behavior and simulation of nanoparticles sliding \
                      during nanoprobe-based positioning”, ASME IMECE; CHK: “Sensitivity Analysis of Coulomb and HK Friction \
                      Models in 2D AFM-Based Nano-Manipulation: Sobol Method”, whose authors are not printed in our copy; and LG: \
                      M. H. Korayem, M. Taheri and Z. Rastegar, “Sobol method application in sensitivity analysis of LuGre \
                      friction model during 2D manipulation”, Scientia Iranica, Transactions B (accepted 4 November 2013).";

fn lead(reproduction: &Reproduction) -> Vec<String> {
    let mut lead: Vec<String> = answers::paragraph(&reproduction.studies).into_iter().collect();
    lead.push(PAPERS.to_owned());
    if !reproduction.claims.is_empty() {
        lead.push(verdicts::sentence(&reproduction.claims));
    }
    lead
}

fn answers_section(reproduction: &Reproduction) -> Option<Section> {
    let table = || Part::Table(answers::table(&reproduction.studies));
    (!reproduction.studies.is_empty()).then(|| Section::new("answers", "Which factor matters most", vec![table()]))
}

fn claims_section(reproduction: &Reproduction) -> Option<Section> {
    if reproduction.claims.is_empty() {
        return None;
    }
    let details = verdicts::details(&reproduction.claims, &reproduction.figures);
    let parts = vec![verdicts::table(&reproduction.claims).into(), Part::OnPage(vec![details])];
    Some(Section::new("claims", "Are the papers right?", parts))
}

fn percentages_section(reproduction: &Reproduction) -> Option<Section> {
    let rows = &reproduction.percentages;
    if rows.is_empty() {
        return None;
    }
    let parts = vec![Part::List(percentages::summary(rows)), Part::Table(percentages::table(rows))];
    Some(Section::new("percentages", "The percentages that LG prints", parts))
}

fn shares_section(reproduction: &Reproduction) -> Option<Section> {
    let studies = &reproduction.studies;
    if studies.is_empty() {
        return None;
    }
    let table = shares_table(&studies.iter().collect::<Vec<&Reproduced>>());
    let table = Table { file: "shares.csv".to_owned(), ..table };
    let mut parts = vec![Part::Details {
        summary: "The indices and shares of every study".to_owned(),
        parts: vec![Part::Table(table)],
    }];
    parts.extend(answers::validity(studies).map(|table| Part::Details {
        summary: "How many runs lie outside the range of a theory".to_owned(),
        parts: vec![table],
    }));
    let cautions = answers::cautions(studies);
    if !cautions.is_empty() {
        parts.push(Part::List(cautions));
    }
    Some(Section::new("shares", "All indices and shares", parts))
}

fn provenance_section(reproduction: &Reproduction) -> Section {
    Section::new("provenance", "How this page was made", vec![Part::OnPage(vec![provenance::table(reproduction)])])
}
