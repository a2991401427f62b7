//! The animation of a scene as a self-contained page, with its magnification: motions of nanometres next to bodies of
//! micrometres would be invisible.

use apportion_report::chart::Colour;
use askama::Template;
use serde_json::{Value, json};

use super::charts::{LATERAL, NORMAL, SUBSTRATE};
use super::columns::scene_value;
use super::story::{SceneSample, SceneStory};

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
        view: script_json(&json!({ "probe_factor": view.probe, "travel_factor": view.travel })),
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

/// The factors by which displacements are drawn larger (above 1) or smaller (below 1) than the bodies.
#[derive(Clone, Copy)]
struct View {
    /// Twist and lateral displacement in the picture of the probe.
    probe: f64,
    /// Travel of particle and substrate in the picture of the particle.
    travel: f64,
}

impl View {
    /// Chooses factors with which the probe leans by at most 0.25 rad (or a quarter of its height) and the particle
    /// moves at most 0.8 of its radius.
    fn new(story: &SceneStory) -> Self {
        const READS: [fn(&SceneSample) -> f64; 4] =
            [|s| s.twist, |s| s.lateral_deflection, |s| s.particle, |s| s.substrate];
        let [twist, deflection, particle, substrate] = READS.map(|read| {
            let sizes = story.samples.iter().map(|sample| read(sample).abs()).filter(|size| size.is_finite());
            sizes.fold(0.0, f64::max)
        });
        let lean = twist.max(deflection / story.scene.height);
        let travel = if particle > 0.0 { particle } else { substrate };
        Self { probe: round_below(0.25 / lean), travel: round_below(0.8 * story.scene.particle_radius / travel) }
    }

    /// States the factors in a sentence.
    fn sentence(self) -> String {
        format!(
            "Bodies are drawn to scale in each picture; twist and displacements of the probe are {}, the travel of particle \
             and substrate is {}.",
            factor(self.probe),
            factor(self.travel)
        )
    }
}

fn factor(factor: f64) -> String {
    if factor == 1.0 {
        return "to scale".to_owned();
    }
    let (verb, times) = if factor > 1.0 { ("exaggerated", factor) } else { ("reduced", (1.0 / factor).round()) };
    if times < 1e6 { format!("{verb} {times} times") } else { format!("{verb} {times:e} times") }
}

/// Returns the largest of 1, 2, 5, 10, 20, ... (or their inverses) not above `limit`; 1 if the limit is not positive.
fn round_below(limit: f64) -> f64 {
    // Beyond these powers nothing is visible, and products with coordinates could overflow.
    let decade = libm::log10(limit).floor();
    if !(-100.0..=100.0).contains(&decade) {
        return 1.0;
    }
    // 1, 2 and 5, or one over 5, 2 and 1 of the next decade: both have round inverses.
    let power = 10f64.powi(decade as i32);
    let step = [5.0, 2.0].into_iter().find(|step| step * power <= limit).unwrap_or(1.0);
    step * power
}
