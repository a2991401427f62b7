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
mod story;

use apportion_report::document::{Document, Figure, Part, Report, Section, Table};
use apportion_report::format::{minus, with_unit};
pub use charts::law_colour;
pub use columns::{scene_json, scene_number, scene_table};
pub use mode_diagram::{ModeDiagram, ModeLine, mode_axis, mode_diagram_chart};
pub use player::player_page;
pub use story::{NANO, SceneSample, SceneStory};

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
    let [critical_force, lateral, normal] = [critical.critical_force, critical.lateral_force, critical.normal_force]
        .map(|newtons| minus(&with_unit(newtons * 1e9, "nN")));
    format!(
        "The critical tip force is {critical_force} (lateral {lateral}, normal {normal}), reached after {}; after {} the \
         particle has moved {} relative to the substrate.",
        minus(&with_unit(story.critical_time, "s")),
        minus(&with_unit(end.time, "s")),
        minus(&with_unit(end.relative * 1e9, "nm"))
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
