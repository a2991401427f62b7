//! Every figure that the papers draw from computation, drawn from ours.
//!
//! [`figures`] makes them all, each with the data behind it; [`animation`] makes the page of the moving one. The sweeps
//! take the ranges of the papers' studies and leave everything else at the defaults; the histories are those of the
//! nominal scene. Nothing here is typed in but what the papers say: captions are computed from what is drawn.

mod animation;
mod curve;
mod edge;
mod history;
mod modes;
mod shares;
mod sweep;
mod sweep_list;
mod table;
#[cfg(test)]
mod tests;

use thiserror::Error;

pub use animation::{ANIMATION_STEM, Animation, animation};

use super::{Effort, Reproduced};
use apportion::afm::Failure;
use apportion::report::chart::Chart;
use apportion::study::StudyError;
use apportion::sweep::SweepError;

/// One figure of the papers, from our computation.
#[derive(Clone, Debug, PartialEq)]
pub struct PaperFigure {
    /// Name of its files without extension, and its anchor on the page, such as `chk-6`.
    pub stem: &'static str,
    /// What it is called, such as `CHK fig. 6`.
    pub label: &'static str,
    /// What the paper's figure shows, in a short statement.
    pub theirs: &'static str,
    /// Ours.
    pub chart: Chart,
    /// Our data.
    pub csv: String,
}

/// Why the figures cannot be made. At the defaults of the papers none of this happens.
#[derive(Debug, Error)]
pub enum FiguresError {
    /// A scene has no answer.
    #[error("a scene of the papers' figures has no answer: {0}")]
    Scene(#[from] Failure),
    /// The study that gives the ranges cannot be read.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A factor cannot be swept.
    #[error(transparent)]
    Sweep(#[from] SweepError),
    /// The model has no such input.
    #[error("the nanoparticle model has no parameter `{name}`")]
    NoParameter {
        /// Its name.
        name: &'static str,
    },
}

/// The stems of all figures, in the order of the papers: CHK, LG, TS04, then the friction models side by side.
const ORDER: [&str; 33] = [
    "chk-5",
    "chk-6",
    "chk-7",
    "chk-8",
    "chk-9",
    "chk-10",
    "chk-11",
    "chk-12",
    "chk-13",
    "chk-14",
    "chk-15",
    "chk-16",
    "lg-2a",
    "lg-2b",
    "lg-2c",
    "lg-2d",
    "lg-3a",
    "lg-3b",
    "lg-3c",
    "lg-3d",
    "lg-4a",
    "lg-4b",
    "lg-4c",
    "ts04-8",
    "ts04-9",
    "ts04-10",
    "ts04-11",
    "ts04-12",
    "ts04-12-contact-angle",
    "ts04-13",
    "dimensional",
    "environmental",
    "general",
];

/// Every figure, in the order of the papers: CHK, LG, TS04, then each group of studies with all friction models side by
/// side. The charts of shares are made of `studies`; those of a group of which none was run are left out. The same on
/// every run and any number of threads.
///
/// # Errors
/// [`FiguresError`] if a scene has no answer.
///
/// # Example
/// ```
/// use apportion::reproduce::Effort;
/// use apportion::reproduce::figures::figures;
///
/// let figures = figures(&[], Effort::Quick)?;
/// let width = figures.iter().find(|figure| figure.label == "CHK fig. 7").unwrap();
/// assert!(width.csv.starts_with("width_um,coulomb_nN,hk_nN"));
/// assert!(width.chart.caption().contains("in a straight line"));
/// # Ok::<(), apportion::reproduce::figures::FiguresError>(())
/// ```
pub fn figures(studies: &[Reproduced], effort: Effort) -> Result<Vec<PaperFigure>, FiguresError> {
    let mut figures = sweep::sweeps(effort)?;
    figures.extend(history::histories()?);
    figures.extend(modes::modes(effort)?);
    figures.extend(shares::shares(studies));
    figures.sort_by_key(|figure| ORDER.iter().position(|stem| *stem == figure.stem));
    Ok(figures)
}
