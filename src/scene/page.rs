//! The page of a scene: one file with the animation, the charts and the settings, needing nothing else.

use askama::Template;
use serde_json::Value;
use thiserror::Error;

use super::charts::{LATERAL, NORMAL, SUBSTRATE};
use super::columns::scene_value;
use super::view::View;
use super::{SceneChart, SceneStory};
use apportion::report::chart::{ChartError, ChartWidth, Role};

/// The parts of the page's script, each using those before it.
const SCRIPT: [&str; 4] = [
    include_str!("../../templates/scene/story.js"),
    include_str!("../../templates/scene/draw.js"),
    include_str!("../../templates/scene/pictures.js"),
    include_str!("../../templates/scene/player.js"),
];

/// Why a page could not be made.
#[derive(Debug, Error)]
pub enum PageError {
    /// The template cannot be rendered.
    #[error("cannot make the page: {0}")]
    Template(#[from] askama::Error),
    /// A chart cannot be drawn.
    #[error("cannot make the page: {0}")]
    Chart(#[from] ChartError),
}

/// What a page shows beside the story itself.
#[derive(Clone, Copy, Debug)]
pub struct PageParts<'a> {
    /// The charts to set below the animation.
    pub charts: &'a [SceneChart],
    /// Where the page finds [`scene_csv`](super::scene_csv)'s file, such as `scene.csv` beside it.
    pub csv_file: &'a str,
    /// Where it finds [`scene_json`](super::scene_json)'s file.
    pub json_file: &'a str,
}

/// A chart as it stands on the page.
struct PageChart {
    stem: &'static str,
    wide: String,
    narrow: String,
}

/// The template escapes every text; what it takes as it is (`safe`) comes from this program: style, script, data made
/// by [`script_json`] and charts, which escape their own texts.
#[derive(Template)]
#[template(path = "scene/page.html")]
struct Page<'a> {
    story: &'a SceneStory,
    parts: PageParts<'a>,
    charts: Vec<PageChart>,
    outcome: String,
    exaggeration: String,
    colours: [(&'static str, &'static str); 5],
    style: &'static str,
    script: [&'static str; 4],
    data: String,
    view: String,
    version: &'static str,
}

/// The page as HTML: an animation of probe, particle and contacts beside the growing force curve, moved by a slider,
/// the keyboard or on its own; the charts; the settings. It loads nothing from anywhere and works without a network.
///
/// # Errors
/// [`PageError`] if a chart cannot be drawn or the template cannot be rendered.
pub fn scene_page(story: &SceneStory, parts: PageParts<'_>) -> Result<String, PageError> {
    let view = View::of(story);
    let chart = |chart: &SceneChart| {
        let (wide, narrow) = (chart.chart.svg_at(ChartWidth::Wide)?, chart.chart.svg_at(ChartWidth::Narrow)?);
        Ok(PageChart { stem: chart.stem, wide, narrow })
    };
    let page = Page {
        story,
        parts,
        charts: parts.charts.iter().map(chart).collect::<Result<_, ChartError>>()?,
        outcome: unbroken(&story.outcome()),
        exaggeration: view.sentence(),
        colours: [
            ("push", story.friction_role.colour()),
            ("lateral", LATERAL.colour()),
            ("normal", NORMAL.colour()),
            ("substrate", SUBSTRATE.colour()),
            ("slip", Role::Other(0).colour()),
        ],
        style: include_str!("../../templates/scene/page.css"),
        script: SCRIPT,
        data: script_json(&scene_value(story)),
        view: script_json(&view.value()),
        version: env!("CARGO_PKG_VERSION"),
    };
    Ok(page.render()?)
}

/// A sentence in which numbers stay on one line with their units.
fn unbroken(sentence: &str) -> String {
    sentence.replace(" nN", "\u{a0}nN").replace(" s,", "\u{a0}s,")
}

/// JSON that may stand in a script element: no text in it can end the element or open a comment.
fn script_json(value: &Value) -> String {
    let text = value.to_string();
    text.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}

#[cfg(test)]
mod tests {
    use super::super::{fixture, scene_charts};
    use super::*;

    fn page(story: &SceneStory) -> String {
        let charts = scene_charts(story);
        scene_page(story, PageParts { charts: &charts, csv_file: "scene.csv", json_file: "scene.json" }).unwrap()
    }

    /// The JSON of a script element.
    fn embedded(page: &str, id: &str) -> Value {
        let (_, rest) = page.split_once(&format!("id=\"{id}\">")).unwrap();
        serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
    }

    #[test]
    fn the_page_needs_nothing_else() {
        let page = page(&fixture::story());
        let own = page.replace("http://www.w3.org/2000/svg", "");
        for outside in ["http:", "https:", "src=", "@import", "url(", "//cdn", "fetch("] {
            assert!(!own.contains(outside), "{outside}");
        }
        assert!(page.contains("href=\"scene.csv\"") && page.contains("href=\"scene.json\""));
        // Each of the five charts for a page column and for a phone, one of which is shown.
        assert_eq!(page.matches("<svg xmlns").count(), 2 * 5);
        assert_eq!(page.matches("<desc>").count(), 2 * 5);
        assert_eq!(page.matches("viewBox=\"0 0 720 ").count(), 5);
        let narrow = page.split("<div class=\"narrow\">").skip(1).filter(|part| part.contains("viewBox=\"0 0 360 "));
        assert_eq!(narrow.count(), 5);
        assert!(page.contains("The particle slips after 0.131\u{a0}s, at a tip force of 631\u{a0}nN."));
        assert!(page.contains("exaggerated 200 times"));
        assert!(page.contains("--push:#0072b2"));
    }

    #[test]
    fn texts_cannot_break_out() {
        let mut story = fixture::story();
        let evil = "</script><script>alert('&\"')</script><!--";
        story.title = evil.to_owned();
        story.setting = vec![(evil.to_owned(), evil.to_owned())];
        let page = page(&story);
        assert!(!page.contains("</script><script>alert"));
        assert!(!page.contains("<!--"));
        assert_eq!(page.matches("</script>").count(), 3);
        assert_eq!(embedded(&page, "scene-data")["title"], evil);
    }

    #[test]
    fn the_data_are_those_of_the_file() {
        let story = fixture::story();
        let page = page(&story);
        let file: Value = serde_json::from_str(&super::super::scene_json(&story)).unwrap();
        assert_eq!(embedded(&page, "scene-data"), file);
        assert_eq!(embedded(&page, "scene-view")["probe_factor"], 200.0);
    }

    #[test]
    fn degenerate_stories_have_pages() {
        let whole = fixture::story();
        for count in 0..3 {
            let mut story = whole.clone();
            story.samples.truncate(count);
            story.critical.time = None;
            story.geometry.particle_radius = f64::NAN;
            let page = page(&story);
            assert!(!page.contains("NaN"), "{count}");
            assert_eq!(page.contains("id=\"player\""), count > 0);
        }
    }
}
