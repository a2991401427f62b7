//! TS04 figure 14, the animation: a page that moves.

use super::history::story;
use crate::reproduce::ReproduceError;
use crate::scene::{player_page, scene_json, scene_table};
use apportion::afm::FrictionLaw;

/// Name of the animation's files without extension.
pub const ANIMATION_STEM: &str = "ts04-14-animation";

/// The moving version of TS04 figure 14, with its data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Animation {
    /// A whole page that needs nothing else.
    pub html: String,
    /// Every state.
    pub csv: String,
    /// The same, with setting and geometry, in the format `apportion-scene`.
    pub json: String,
}

/// The nominal scene under Coulomb friction as a page with an animation. Its charts are among the
/// [`figures`](super::figures).
///
/// # Errors
/// [`ReproduceError`] if the scene has no answer, or the page cannot be rendered.
pub fn animation() -> Result<Animation, ReproduceError> {
    let story = story(FrictionLaw::Coulomb, |_| ())?;
    Ok(Animation { html: player_page(&story), csv: scene_table(&story).csv(), json: scene_json(&story) })
}
