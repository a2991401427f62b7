//! TS04 figure 14, the animation: on paper a film strip, on screen a page that moves.

use super::history::story;
use super::{FiguresError, PaperFigure};
use crate::scene::{PageParts, SceneStory, film_strip, scene_csv, scene_json, scene_page};
use apportion::afm::FrictionLaw;
use apportion::report::chart::Chart;

/// Name of the animation's files without extension.
pub const ANIMATION_STEM: &str = "ts04-14-animation";

/// The moving version of TS04 figure 14, with its data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Animation {
    /// A whole page that needs nothing else; it links to its data as `ts04-14-animation.csv` and `.json`.
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
/// [`FiguresError`] if the scene has no answer, or the page cannot be rendered.
///
/// # Example
/// ```
/// let animation = apportion::reproduce::figures::animation()?;
/// assert!(animation.html.contains("ts04-14-animation.csv"));
/// # Ok::<(), apportion::reproduce::figures::FiguresError>(())
/// ```
pub fn animation() -> Result<Animation, FiguresError> {
    let story = story(FrictionLaw::Coulomb, |_| ())?;
    let (csv_file, json_file) = (format!("{ANIMATION_STEM}.csv"), format!("{ANIMATION_STEM}.json"));
    let parts = PageParts { charts: &[], csv_file: &csv_file, json_file: &json_file };
    Ok(Animation { html: scene_page(&story, parts)?, csv: scene_csv(&story), json: scene_json(&story) })
}

/// The film strip of the same scene.
pub(super) fn film() -> Result<PaperFigure, FiguresError> {
    let story = story(FrictionLaw::Coulomb, |_| ())?;
    let film = film_strip(&story);
    Ok(PaperFigure {
        stem: "ts04-14",
        label: "TS04 fig. 14",
        theirs: "An animation of the tip pushing the particle over the substrate.",
        chart: Chart::Picture(film.picture),
        csv: scene_csv(&SceneStory { samples: film.frames, ..story }),
    })
}
