//! The papers reproduced: their studies, figures, claims and percentages.
//!
//! [`document()`] builds the page, its files and the text for a terminal of a [`Reproduction`].

pub mod claims;
mod document;
pub mod figures;
mod order;
mod papers;
pub mod percentages;
mod reproduction;
mod shares;
mod studies;
mod words;

pub use document::document;
pub use papers::published;
pub use reproduction::Reproduction;
pub use studies::{Effort, FRICTIONS, Friction, GROUPS, QUICK, Reproduced, StudyGroup, general_study, studies};
