//! The page of the reproduction: verdicts, figures, readings, tables and provenance in one file.

mod answers;
mod cells;
mod provenance;
mod readings;
mod typeset;
mod verdicts;

use super::Reproduction;
use super::figures::{ANIMATION_STEM, PaperFigure};
use apportion::report::page::{Link, OnPhone, Page, PageFigure, PageTable, Part, Section};
pub(super) use readings::charts as reading_charts;

/// The page about `reproduction`; what was not asked for is left out.
pub fn page(reproduction: &Reproduction) -> Page {
    let sections = [
        answers_section(reproduction),
        claims_section(reproduction),
        figures_section(reproduction, ("All", "overview", "Shares under every friction model")),
        figures_section(reproduction, ("CHK", "chk", "Figures of CHK: Coulomb and Hurtado-Kim friction")),
        figures_section(reproduction, ("LG", "lg", "Figures of LG: LuGre friction")),
        figures_section(reproduction, ("TS04", "ts04", "Figures of TS04: a push in time")),
        readings::section(reproduction),
        shares_section(reproduction),
        Some(provenance_section(reproduction)),
    ];
    Page {
        kicker: "Reproduction of three papers".to_owned(),
        title: "Which factor decides the force that pushes a nanoparticle?".to_owned(),
        lead: lead(reproduction),
        sections: sections.into_iter().flatten().collect(),
        footer: format!("Made by apportion {}.", env!("CARGO_PKG_VERSION")),
    }
}

fn lead(reproduction: &Reproduction) -> Vec<String> {
    let mut lead: Vec<String> = answers::paragraph(&reproduction.studies).into_iter().collect();
    if !reproduction.claims.is_empty() {
        lead.push(verdicts::sentence(&reproduction.claims));
    }
    lead.extend(readings::paragraph(reproduction));
    lead
}

fn section(id: &str, title: &str, parts: Vec<Part>) -> Section {
    Section { id: id.to_owned(), title: title.to_owned(), parts }
}

fn header(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

fn link(text: &str, to: &str) -> Link {
    Link { text: text.to_owned(), to: to.to_owned() }
}

fn answers_section(reproduction: &Reproduction) -> Option<Section> {
    if reproduction.studies.is_empty() {
        return None;
    }
    let table = Part::Table(answers::table(&reproduction.studies));
    Some(section("answers", "Which factor matters most", vec![table]))
}

fn claims_section(reproduction: &Reproduction) -> Option<Section> {
    if reproduction.claims.is_empty() {
        return None;
    }
    let parts = vec![
        verdicts::table(&reproduction.claims),
        verdicts::details(&reproduction.claims, &reproduction.figures),
        Part::Links(vec![link("verdicts as CSV", "claims.csv"), link("as JSON", "claims.json")]),
    ];
    Some(section("claims", "Are the papers right?", parts))
}

/// The figures whose labels begin with `prefix`.
fn figures_section(reproduction: &Reproduction, (prefix, id, title): (&str, &str, &str)) -> Option<Section> {
    let figures: Vec<&PaperFigure> =
        reproduction.figures.iter().filter(|figure| figure.label.starts_with(prefix)).collect();
    let mut parts: Vec<Part> = Vec::new();
    for figure in &figures {
        parts.push(Part::Figure(Box::new(page_figure(figure))));
        if let Some(animation) = reproduction.animation.as_ref().filter(|_| figure.stem == "ts04-14") {
            // A frame's links start from this page, one folder above the animation's own.
            let own = format!("href=\"{ANIMATION_STEM}");
            let html = animation.html.replace(&own, &format!("href=\"figures/{ANIMATION_STEM}"));
            parts.push(Part::Frame { title: "TS04 fig. 14 as an animation".to_owned(), html });
            let file = |ending: &str| format!("figures/{ANIMATION_STEM}.{ending}");
            parts.push(Part::Links(vec![
                link("the animation as a page of its own", &file("html")),
                link("every state as CSV", &file("csv")),
                link("as JSON", &file("json")),
            ]));
        }
    }
    (!figures.is_empty()).then(|| section(id, title, parts))
}

fn page_figure(figure: &PaperFigure) -> PageFigure {
    let file = |ending: &str| link(&ending.to_uppercase(), &format!("figures/{}.{ending}", figure.stem));
    PageFigure {
        id: figure.stem.to_owned(),
        label: figure.label.to_owned(),
        beside: match figure.label.split_once(" fig") {
            Some((paper, _)) => format!("{paper} shows: {}", figure.theirs),
            None => figure.theirs.to_owned(),
        },
        chart: figure.chart.clone(),
        links: ["svg", "png", "csv"].map(file).to_vec(),
    }
}

fn shares_section(reproduction: &Reproduction) -> Option<Section> {
    let studies = &reproduction.studies;
    if studies.is_empty() {
        return None;
    }
    let table = PageTable {
        caption: "First-order and total indices of every study with their 95 % intervals, their shares, and the \
                  percentages that LG prints."
            .to_owned(),
        header: header(&["study", "friction", "factor", "S_1", "S_T", "share of S_1", "share of S_T", "published"]),
        numeric: vec![3, 4, 5, 6, 7],
        on_phone: OnPhone::Scroll,
        rows: answers::all_shares(studies),
    };
    let mut parts = vec![Part::Table(table)];
    let results = studies.iter().map(|study| {
        let name = format!("{}-{}", study.friction.key, study.group.key);
        link(&name, &format!("{name}.json"))
    });
    parts.push(Part::Links([link("all shares as CSV", "shares.csv")].into_iter().chain(results).collect()));
    parts.extend(answers::validity(studies));
    let cautions = answers::cautions(studies);
    if !cautions.is_empty() {
        parts.push(Part::List(cautions));
    }
    Some(section("shares", "All indices and shares", parts))
}

fn provenance_section(reproduction: &Reproduction) -> Section {
    section("provenance", "How this page was made", vec![provenance::table(reproduction)])
}
