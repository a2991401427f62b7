//! The figures of the papers on the page: small, similar ones together.

use apportion_report::document::{Figure, Link, Part, Section};

use crate::reproduce::figures::{ANIMATION_STEM, PaperFigure, chart_file};
use crate::reproduce::papers::papers;
use crate::reproduce::reproduction::Reproduction;
use crate::reproduce::studies::GROUPS;
use crate::scene::{SceneStory, player_page};

/// The common sentences of the captions of all sweeps.
const RUNGS: &str = "The curves of CHK and LG are those of the closed formulas. Unless a caption states otherwise, the quasi-static \
                     rung, which solves the equilibrium with exact geometry, differs by less than 0.01 %.";

/// Returns the anchor of the figure with a stem: those of shares are in the chart of all friction models.
pub(super) fn anchor(stem: &str) -> &str {
    let figure = papers().figures.iter().find(|figure| figure.stem == stem);
    figure.and_then(|figure| figure.shares).unwrap_or(stem)
}

/// Builds the section of the indices under every friction model: of all factors together, then of each group.
pub(super) fn overview(figures: &[PaperFigure]) -> Section {
    let groups = [GROUPS[2], GROUPS[0], GROUPS[1]];
    let together = groups.iter().filter_map(|group| shown_together(figures, group.key));
    Section::new("overview", "Indices under every friction model", together.map(Part::from).collect())
}

/// Builds a section of figures for each paper.
pub(super) fn sections(reproduction: &Reproduction) -> Vec<Section> {
    let figures = &reproduction.figures;
    if figures.is_empty() {
        return Vec::new();
    }
    let rungs = Part::OnPage(vec![Part::Text(RUNGS.to_owned())]);
    let in_time = [gallery(figures, "TS04")].into_iter().chain(reproduction.animation.as_ref().map(moving)).collect();
    vec![
        Section::new("chk", "Figures of CHK: Coulomb and Hurtado-Kim friction", vec![rungs, gallery(figures, "CHK")]),
        Section::new("lg", "Figures of LG: LuGre friction", vec![gallery(figures, "LG")]),
        Section::new("ts04", "Figures of TS04: a push in time", in_time),
    ]
}

/// Shows the figures of a paper, without those that another figure includes.
fn gallery(figures: &[PaperFigure], paper: &str) -> Part {
    let of_paper = figures.iter().filter(|figure| figure.label.starts_with(paper));
    Part::Gallery(of_paper.filter(|figure| anchor(figure.stem) == figure.stem).map(alone).collect())
}

/// Returns the figures that are only files, since another one shows them on the page.
pub(super) fn files(figures: &[PaperFigure]) -> Vec<Figure> {
    figures.iter().filter(|figure| anchor(figure.stem) != figure.stem).map(alone).collect()
}

/// Creates a figure of a paper by itself.
fn alone(figure: &PaperFigure) -> Figure {
    Figure {
        id: figure.stem.to_owned(),
        label: figure.label.clone(),
        title: None,
        comparison_note: match figure.label.split_once(" fig") {
            Some(_) => theirs(figure),
            None => figure.theirs.to_owned(),
        },
        chart: figure.chart.clone(),
        stem: figure.stem.to_owned(),
        data: chart_file(figure.stem, "csv"),
    }
}

/// Says what a paper shows, with its name.
fn theirs(figure: &PaperFigure) -> String {
    let paper = figure.label.split(' ').next().unwrap_or_default();
    format!("{paper} shows: {}", figure.theirs)
}

/// Draws all friction models in a group of studies, with the labels of the figures that the chart includes.
fn shown_together(figures: &[PaperFigure], group: &str) -> Option<Figure> {
    let figure = figures.iter().find(|figure| figure.stem == group)?;
    let (mut labels, mut statements) = (Vec::new(), Vec::new());
    for member in figures.iter().filter(|other| other.stem != group && anchor(other.stem) == group) {
        labels.push(member.label.as_str());
        statements.push(theirs(member));
    }
    Some(Figure { label: labels.join(", "), comparison_note: statements.join(" "), ..alone(figure) })
}

/// Embeds the animation of the push.
fn moving(story: &SceneStory) -> Part {
    let html = player_page(story);
    let frame = Part::Frame { title: "TS04 fig. 14 as an animation".to_owned(), html };
    let links = Part::Links(vec![
        Link::new("the animation as a separate page", chart_file(ANIMATION_STEM, "html")),
        Link::new("every state as CSV", chart_file(ANIMATION_STEM, "csv")),
        Link::new("as JSON", chart_file(ANIMATION_STEM, "json")),
    ]);
    Part::Details { summary: "The scene in motion as an animation".to_owned(), parts: vec![frame, links] }
}
