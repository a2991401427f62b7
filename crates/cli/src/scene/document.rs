//! A scene, and the diagram of its modes, as documents.

use apportion_report::document::{Document, Figure, Part, Report, Section, Table};
use apportion_report::format::{minus, with_unit};

use super::{ModeDiagram, SceneStory, mode_diagram_chart, player_page, scene_charts, scene_json, scene_table};

/// Builds the document of a scene of the study `study`.
pub fn scene_document(story: &SceneStory, study: &str) -> Document {
    let animation = Part::Frame { title: "The scene as an animation".to_owned(), html: player_page(story) };
    let charts = scene_charts(story).map(|(stem, chart)| Figure::unnumbered(chart, format!("{study}-{stem}")).into());
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
        lead: vec![chart.caption().to_owned()],
        then: vec![Section::new("diagram", "Mode diagram", vec![Figure::unnumbered(chart, &name).into()])],
        csv: Some(csv.into()),
        name,
        ..Report::default()
    }
    .document()
}
