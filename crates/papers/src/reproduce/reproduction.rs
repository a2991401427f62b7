//! All that a reproduction computes.

use super::claims::Claim;
use super::figures::PaperFigure;
use super::percentages::Percentages;
use super::studies::{Effort, Reproduced};
use crate::scene::SceneStory;

/// A reproduction that has taken place.
#[derive(Debug, Clone, Default)]
pub struct Reproduction {
    /// How much was computed.
    pub effort: Effort,
    /// The nine studies, group by group.
    pub studies: Vec<Reproduced>,
    /// The figures of the papers, unless left out.
    pub figures: Vec<PaperFigure>,
    /// The animated scene, unless figures were left out.
    pub animation: Option<SceneStory>,
    /// The claims with their verdicts, unless left out.
    pub claims: Vec<Claim>,
    /// Our shares and the printed percentages, unless claims were left out.
    pub percentages: Vec<Percentages>,
}
