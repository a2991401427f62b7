//! The figures of the papers as they stand on the page: small, what is alike together.

use super::beside_charts;
use crate::reproduce::Reproduction;
use crate::reproduce::figures::{ANIMATION_STEM, PaperFigure};
use apportion::report::chart::{Chart, Panel, Shape};
use apportion::report::document::{Figure, Link, Part, Section};
use apportion::report::listed;

/// Figures of both papers that the chart of all friction models stands for, by its stem.
const SHOWN_TOGETHER: [(&str, [&str; 2]); 3] =
    [("dimensional", ["chk-10", "lg-4a"]), ("environmental", ["chk-15", "lg-4b"]), ("general", ["chk-16", "lg-4c"])];

/// Curves that are level, which share a figure, by its stem.
const LEVEL: [(&str, [&str; 2]); 2] = [("chk-9-11", ["chk-9", "chk-11"]), ("lg-2d-3c", ["lg-2d", "lg-3c"])];

/// What the captions of all sweeps have in common.
const RUNGS: &str = "The curves of CHK and LG are those of the closed formulas. Where a caption says nothing of it, the quasi-static \
                     rung, which solves the equilibrium with exact geometry, differs by less than 0.01 %.";

/// The anchor on the page of the figure with a stem.
pub(super) fn anchor(stem: &str) -> &str {
    let shared = SHOWN_TOGETHER.iter().chain(&LEVEL).find(|(_, members)| members.contains(&stem));
    shared.map_or(stem, |(stem, _)| stem)
}

/// The figure that shows the one with a stem.
pub(super) fn label<'a>(figures: &'a [PaperFigure], stem: &str) -> Option<&'a str> {
    figures.iter().find(|figure| figure.stem == stem).map(|figure| figure.label)
}

/// The sections of figures: the shares, then each paper.
pub(super) fn sections(reproduction: &Reproduction) -> Vec<Section> {
    let figures = &reproduction.figures;
    let of = |prefix: &str| -> Vec<&PaperFigure> {
        let shown = |figure: &&PaperFigure| {
            let is_shown_elsewhere = SHOWN_TOGETHER.iter().any(|(_, members)| members.contains(&figure.stem));
            figure.label.starts_with(prefix) && !is_shown_elsewhere
        };
        figures.iter().filter(shown).collect()
    };
    let shares = of("All").into_iter().map(|figure| shown_together(figure, figures).into());
    let sections = [
        ("overview", "Shares under every friction model", shares.collect()),
        ("chk", "Figures of CHK: Coulomb and Hurtado-Kim friction", sweeps(&of("CHK"), Some(RUNGS))),
        ("lg", "Figures of LG: LuGre friction", sweeps(&of("LG"), None)),
        ("ts04", "Figures of TS04: a push in time", in_time(reproduction, &of("TS04"))),
    ];
    sections
        .into_iter()
        .filter(|(.., parts)| !parts.is_empty())
        .map(|(id, title, parts)| Section::new(id, title, parts))
        .collect()
}

/// The figures that are files alone, since another stands for them on the page.
pub(super) fn files(figures: &[PaperFigure]) -> Vec<Figure> {
    figures.iter().filter(|figure| anchor(figure.stem) != figure.stem).map(alone).collect()
}

/// A figure of a paper by itself.
fn alone(figure: &PaperFigure) -> Figure {
    Figure {
        id: figure.stem.to_owned(),
        label: figure.label.to_owned(),
        title: None,
        beside: match figure.label.split_once(" fig") {
            Some(_) => theirs(figure),
            None => figure.theirs.to_owned(),
        },
        chart: figure.chart.clone(),
        stem: figure.stem.to_owned(),
        data: beside_charts(figure.stem, "csv"),
    }
}

/// What a paper shows, with its name.
fn theirs(figure: &PaperFigure) -> String {
    let paper = figure.label.split(' ').next().unwrap_or_default();
    format!("{paper} shows: {}", figure.theirs)
}

/// The chart of all friction models with the labels of the figures that it stands for.
fn shown_together(figure: &PaperFigure, figures: &[PaperFigure]) -> Figure {
    let members = SHOWN_TOGETHER.iter().find(|(stem, _)| *stem == figure.stem).map(|(_, members)| members);
    let members: Vec<&PaperFigure> =
        members.into_iter().flatten().filter_map(|stem| figures.iter().find(|other| other.stem == *stem)).collect();
    let labels: Vec<&str> = members.iter().map(|member| member.label).collect();
    let beside: Vec<String> = members.iter().map(|member| theirs(member)).collect();
    Figure { label: labels.join(", "), beside: beside.join(" "), ..alone(figure) }
}

/// A text, then sweeps and histories, two side by side; those that are level share a figure at the end.
fn sweeps(figures: &[&PaperFigure], before: Option<&str>) -> Vec<Part> {
    let mut small = Vec::new();
    let mut links = Vec::new();
    for figure in figures.iter().filter(|figure| anchor(figure.stem) == figure.stem) {
        small.push(alone(figure));
    }
    for (stem, members) in LEVEL {
        let members: Vec<&PaperFigure> =
            members.iter().filter_map(|stem| figures.iter().copied().find(|other| other.stem == *stem)).collect();
        if !members.is_empty() {
            links.extend(
                members
                    .iter()
                    .map(|member| Link::new(format!("{} as CSV", member.label), beside_charts(member.stem, "csv"))),
            );
            small.push(level(stem, &members));
        }
    }
    if small.is_empty() {
        return Vec::new();
    }
    let before = before.map(|text| Part::Text(text.to_owned()));
    before.into_iter().chain([Part::Gallery(small), Part::Links(links)]).collect()
}

/// Level curves as panels side by side on one vertical axis.
fn level(stem: &str, members: &[&PaperFigure]) -> Figure {
    let small = |panel: &Panel, label: &str| {
        let mut panel = panel.clone().titled(label);
        for mark in &mut panel.marks {
            // There is no room for its value, which the figures by themselves have.
            if let Shape::Rule(_, name) = &mut mark.shape {
                name.truncate(name.find(':').unwrap_or(name.len()));
            }
        }
        panel
    };
    let panels =
        members.iter().flat_map(|member| member.chart.all_panels().iter().map(|panel| small(panel, member.label)));
    let captions: Vec<&str> = members.iter().map(|member| member.chart.caption()).collect();
    let against = |member: &&PaperFigure| {
        let title = member.chart.title();
        title.split_once(" against ").map_or(title, |(_, factor)| factor).to_owned()
    };
    let factors: Vec<String> = members.iter().map(against).collect();
    let title = format!("Critical force against {}", listed(&factors));
    let labels: Vec<&str> = members.iter().map(|member| member.label).collect();
    let beside: Vec<String> = members.iter().map(|member| theirs(member)).collect();
    Figure {
        id: stem.to_owned(),
        label: labels.join(", "),
        title: None,
        beside: beside.join(" "),
        chart: Chart::new(title, captions.join(" ")).panels(panels).side_by_side(),
        stem: stem.to_owned(),
        data: String::new(),
    }
}

/// The push in time, with its animation.
fn in_time(reproduction: &Reproduction, figures: &[&PaperFigure]) -> Vec<Part> {
    if figures.is_empty() {
        return Vec::new();
    }
    let mut parts = vec![Part::Gallery(figures.iter().map(|figure| alone(figure)).collect())];
    if let Some(animation) = &reproduction.animation {
        let html = animation.html.clone();
        let frame = Part::Frame { title: "TS04 fig. 14 as an animation".to_owned(), html };
        let file = |ending: &str| beside_charts(ANIMATION_STEM, ending);
        let links = Part::Links(vec![
            Link::new("the animation as a page of its own", file("html")),
            Link::new("every state as CSV", file("csv")),
            Link::new("as JSON", file("json")),
        ]);
        parts.push(Part::Details {
            summary: "The scene in motion as an animation".to_owned(),
            parts: vec![frame, links],
        });
    }
    parts
}
