//! Every computed figure of the papers, drawn from our results.
//!
//! [`figures`] draws all of them, each with its data; [`coulomb`] returns the animated one. The sweeps use
//! the ranges of the papers' studies and the defaults for everything else; the histories are those of the nominal
//! scene. Only the papers' statements are entered by hand: captions are computed from the drawn data.

mod history;
mod modes;
mod sweep;

use apportion_afm::Failure;
use apportion_report::chart::Chart;
pub use history::{ANIMATION_STEM, DURATION, PRINTED_SHEAR_MODULUS, coulomb};
use rayon::prelude::*;

use super::papers::papers;
use super::shares;
use super::studies::{Effort, Reproduced, general_study};

/// One figure of the papers, from our results.
#[derive(Clone, Debug, PartialEq)]
pub struct PaperFigure {
    /// Name of its files without extension, and its anchor on the page, such as `chk-6`.
    pub stem: &'static str,
    /// Its label, such as `CHK fig. 6`.
    pub label: String,
    /// The content of the paper's figure, in a short statement.
    pub theirs: &'static str,
    /// Our chart.
    pub chart: Chart,
    /// Our data.
    pub csv: String,
}

/// Draws every figure, in the order of the papers: CHK, LG, TS04, then each group of studies with all friction models
/// side by side. The charts of shares use `studies`; a group of which no study was run is omitted. The result is the
/// same on every run and any number of threads.
///
/// # Errors
/// [`Failure`] if a scene has no solution.
pub fn figures(studies: &[Reproduced], effort: Effort) -> Result<Vec<PaperFigure>, Failure> {
    let general = general_study();
    let figures = papers().figures.par_iter().filter_map(|figure| {
        let stem = figure.stem;
        let chart = match (figure.factor, figure.shares) {
            (Some(factor), _) => Some(Ok(sweep::chart(figure, factor, general.space(), effort))),
            (None, Some(group)) => shares::chart(group, stem, studies).map(Ok),
            (None, None) => SCENES.iter().find(|(scene, _)| *scene == stem).map(|(_, draw)| draw()),
        }?;
        Some(chart.map(|(chart, csv)| PaperFigure { stem, label: label(stem), theirs: figure.shows, chart, csv }))
    });
    figures.collect()
}

/// Returns the path of a file next to those of the chart `stem`.
pub(super) fn chart_file(stem: &str, ending: &str) -> String {
    format!("charts/{stem}.{ending}")
}

/// A function that draws a figure of the nominal scene, with its data as CSV.
type Draw = fn() -> Result<(Chart, String), Failure>;

/// The figures of the nominal scene by their stems.
const SCENES: [(&str, Draw); 8] = [
    ("chk-5", history::two_laws),
    ("ts04-8", history::forces_in_time),
    ("ts04-9", history::tip_force),
    ("ts04-10", history::displacement),
    ("ts04-11", history::coefficients),
    ("ts04-12", modes::against_force_angle),
    ("ts04-12-contact-angle", modes::against_contact_angle),
    ("ts04-13", history::contact_areas),
];

/// Returns the papers' label of the figure with a stem: `CHK fig. 6`, `TS04 fig. 12, contact angle`.
fn label(stem: &str) -> String {
    let Some((paper, figure)) = stem.split_once('-') else { return "All friction models".to_owned() };
    let figure = figure.replacen('-', ", ", 1).replace('-', " ");
    format!("{} fig. {figure}", paper.to_uppercase())
}
