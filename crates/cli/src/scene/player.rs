//! The animation of a scene as a self-contained page.

use apportion_report::chart::Colour;
use askama::Template;
use serde_json::Value;

use super::SceneStory;
use super::charts::{LATERAL, NORMAL, SUBSTRATE};
use super::columns::scene_value;
use super::view::View;

/// The parts of the page's script; each uses the ones before it.
const SCRIPT: [&str; 4] = [
    include_str!("../../templates/scene/story.js"),
    include_str!("../../templates/scene/draw.js"),
    include_str!("../../templates/scene/pictures.js"),
    include_str!("../../templates/scene/player.js"),
];

/// The template escapes every text; values inserted unescaped (`safe`) come from this program: style, script, data made
/// by [`script_json`].
#[derive(Template)]
#[template(path = "scene/player.html")]
struct Player<'a> {
    story: &'a SceneStory,
    outcome: String,
    exaggeration: String,
    colours: [(&'static str, &'static str); 5],
    style: &'static str,
    script: [&'static str; 4],
    data: String,
    view: String,
    version: &'static str,
}

/// Builds the animation as a page of HTML: probe, particle and contacts next to the growing force curve, moved by a
/// slider, the keyboard or automatically. It loads nothing and works without a network; inside the frame of another
/// page it omits its title.
pub fn player_page(story: &SceneStory) -> String {
    let view = View::new(story);
    let page = Player {
        story,
        outcome: unbroken(&story.outcome()),
        exaggeration: view.sentence(),
        colours: [
            ("push", story.colour.hex()),
            ("lateral", LATERAL.hex()),
            ("normal", NORMAL.hex()),
            ("substrate", SUBSTRATE.hex()),
            ("slip", Colour::Series(1).hex()),
        ],
        style: include_str!("../../templates/scene/player.css"),
        script: SCRIPT,
        data: script_json(&scene_value(story)),
        view: script_json(&view.value()),
        version: env!("CARGO_PKG_VERSION"),
    };
    page.render().expect("texts and numbers, into memory")
}

/// Joins numbers to their units in a sentence by no-break spaces.
fn unbroken(sentence: &str) -> String {
    sentence.replace(" nN", "\u{a0}nN").replace(" s,", "\u{a0}s,")
}

/// Formats JSON for a script element: no text in it can end the element or open a comment.
fn script_json(value: &Value) -> String {
    let text = value.to_string();
    text.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}

#[cfg(test)]
mod tests {
    use super::super::nominal_story;
    use super::*;

    #[test]
    fn the_page_needs_no_other_files() {
        let page = player_page(&nominal_story());
        let own = page.replace("http://www.w3.org/2000/svg", "");
        for outside in ["http:", "https:", "src=", "@import", "url(", "//cdn", "fetch("] {
            assert!(!own.contains(outside), "{outside}");
        }
        assert!(page.contains("The particle slips after 0.131\u{a0}s, at a tip force of 631\u{a0}nN."));
        assert!(page.contains("exaggerated 200 times"));
        assert!(page.contains("--push:#00527f"));
    }

    #[test]
    fn texts_cannot_break_out() {
        let mut story = nominal_story();
        let evil = "</script><script>alert('&\"')</script><!--";
        story.title = evil.to_owned();
        let page = player_page(&story);
        assert!(!page.contains("</script><script>alert"));
        assert!(!page.contains("<!--"));
        assert_eq!(page.matches("</script>").count(), 3);
        let (_, rest) = page.split_once("id=\"scene-data\">").unwrap();
        let data: Value = serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap();
        assert_eq!(data["title"], evil);
    }
}
