//! A scene in time: its document with an animation, its charts, CSV and JSON.
//!
//! A [`SceneStory`] is plain data in SI, from any source. The exporters draw the figures of Tafazzoli & Sitti 2004 (8,
//! 9, 10, 12, 13 and, moving, 14). A number that is not finite is an empty cell in CSV, `null` in JSON and a gap in a
//! chart.

pub(crate) mod charts;
mod columns;
pub(crate) mod mode_diagram;
mod player;
pub mod simulation;

use std::ops::Deref;

use apportion_afm::history::Sample;
use apportion_afm::{Critical, Scene};
use apportion_report::chart::Colour;
use apportion_report::document::{Document, Figure, Part, Report, Section, Table};
use apportion_report::format::{self, minus, with_unit};
pub use charts::law_colour;
pub use columns::{scene_json, scene_number, scene_table};
pub use mode_diagram::{ModeDiagram, ModeLine, mode_axis, mode_diagram_chart};
pub use player::player_page;

/// Factor from SI to nN and nm.
pub const NANO: f64 = 1e9;

/// One scene, from the start of the push through sticking and slipping.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneStory {
    /// Headline.
    pub title: String,
    /// The choices, as label and value with unit, such as ("friction", "coulomb"): the page's table of settings.
    pub setting: Vec<(String, String)>,
    /// The scene, whose lengths are drawn to scale.
    pub scene: Scene,
    /// The forces at which the particle slips.
    pub critical: Critical,
    /// The time of the slip (s).
    pub critical_time: f64,
    /// The colour of the pushing force: that of the friction law, see [`law_colour`].
    pub colour: Colour,
    /// The states in the order of time, from 0 on, unevenly spaced; at the slip there are two.
    pub samples: Vec<SceneSample>,
}

/// The state at one time, with the other possible motions of the particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneSample {
    /// The state. Positions are along the motion of the substrate, relative to the start.
    pub state: Sample,
    /// Whether the tip would slip on the particle (a diagnostic).
    pub tip_slip: bool,
    /// Whether the particle would roll (a diagnostic).
    pub rolling: bool,
    /// Whether the particle would spin about the vertical (a diagnostic).
    pub spin: bool,
}

impl Deref for SceneSample {
    type Target = Sample;

    fn deref(&self) -> &Sample {
        &self.state
    }
}

impl SceneSample {
    /// Returns the contact radius at the tip (m); NaN if the contact is pulled apart.
    pub fn tip_contact_radius(&self) -> f64 {
        self.tip_contact.map_or(f64::NAN, |contact| contact.radius)
    }

    /// Returns the indentation at the tip (m); NaN if the contact is pulled apart.
    pub fn tip_indentation(&self) -> f64 {
        self.tip_contact.map_or(f64::NAN, |contact| contact.indentation)
    }
}

impl SceneStory {
    /// Returns the first sample.
    pub fn start(&self) -> &SceneSample {
        &self.samples[0]
    }

    /// Returns the last sample.
    pub fn end(&self) -> &SceneSample {
        &self.samples[self.samples.len() - 1]
    }

    /// Returns the last sample that sticks: that of the slip, if the samples reach it.
    fn held(&self) -> &SceneSample {
        self.samples.iter().rfind(|sample| sample.sticking).unwrap_or(self.start())
    }

    /// Returns the critical time if the samples reach it: otherwise it cannot be drawn.
    fn slip(&self) -> Option<f64> {
        (self.critical_time <= self.end().time).then_some(self.critical_time)
    }

    /// States the outcome in one sentence.
    fn outcome(&self) -> String {
        let at = format::force(self.critical.critical_force);
        let time = format::time(self.critical_time);
        match self.slip() {
            Some(_) => format!("The particle slips after {time}, at a tip force of {at}."),
            None => format!("The particle slips at {time}, outside the time shown, at a tip force of {at}."),
        }
    }
}

/// Builds the document of a scene of the study `study`.
pub fn scene_document(story: &SceneStory, study: &str) -> Document {
    let animation = Part::Frame { title: "The scene as an animation".to_owned(), html: player_page(story) };
    let charts = [
        (charts::forces(story), "forces"),
        (charts::pushing(story), "pushing"),
        (charts::positions(story), "positions"),
        (charts::contacts(story), "contacts"),
    ];
    let charts = charts.map(|(chart, stem)| Figure::unnumbered(chart, format!("{study}-scene-{stem}")).into());
    let table = Part::Table(Table::pairs("Every constant of the scene.", story.setting.iter().cloned()));
    let setting = Part::Details { summary: "Every constant of the scene".to_owned(), parts: vec![table] };
    Report {
        name: format!("{study}-scene"),
        kicker: "A scene in time",
        title: story.title.clone(),
        lead: vec![story.outcome(), numbers(story)],
        then: vec![
            Section::new("animation", "The scene", vec![animation]),
            Section::new("charts", "Charts", charts.to_vec()),
            Section::new("setting", "Setting", vec![Part::OnPage(vec![setting])]),
        ],
        json: scene_json(story),
        csv: Some(scene_table(story)),
        ..Report::default()
    }
    .document()
}

/// States the forces at the slip, and the final position of the particle.
fn numbers(story: &SceneStory) -> String {
    let (critical, end) = (&story.critical, story.end());
    let value = |x: f64, unit: &str| minus(&with_unit(x, unit));
    let force = |newtons: f64| value(newtons * 1e9, "nN");
    format!(
        "The critical tip force is {} (lateral {}, normal {}), reached after {}; after {} the particle has moved {} \
         relative to the substrate.",
        force(critical.critical_force),
        force(critical.lateral_force),
        force(critical.normal_force),
        value(story.critical_time, "s"),
        value(end.time, "s"),
        value(end.relative * 1e9, "nm")
    )
}

/// Builds the document of the modes of motion in the study `study`, whose title is `title`.
pub fn mode_document(diagram: &ModeDiagram, study: &str, title: &str) -> Document {
    let (name, chart) = (format!("{study}-modes"), mode_diagram_chart(diagram));
    let mut csv = Table::from_rows("", 0..diagram.angle.len()).file("angle_rad", |row| diagram.angle[row]);
    for line in &diagram.forces {
        csv = csv.file(format!("{}_N", line.name), |row| line.force[row]);
    }
    Report {
        kicker: "Modes of motion",
        title: title.to_owned(),
        lead: vec![chart.caption.clone()],
        then: vec![Section::new("diagram", "Mode diagram", vec![Figure::unnumbered(chart, &name).into()])],
        csv: Some(csv.into()),
        name,
        ..Report::default()
    }
    .document()
}
