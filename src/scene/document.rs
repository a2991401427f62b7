//! A scene, and the diagram of its modes, as documents.

use super::{ModeDiagram, SceneStory, mode_diagram_chart, player_page, scene_charts, scene_csv, scene_json};
use apportion::report::csv::{Csv, Field};
use apportion::report::document::{DataFile, Document, Figure, Part, Section, Table, Value};
use apportion::report::format::{minus, with_unit};

/// The document of a scene of the study called `study`.
pub fn scene_document(story: &SceneStory, study: &str) -> Document {
    let name = format!("{study}-scene");
    let mut sections = Vec::new();
    if !story.samples.is_empty() {
        let frame = Part::Frame { title: "The scene as an animation".to_owned(), html: player_page(story) };
        sections.push(Section::new("animation", "The scene", vec![frame]));
    }
    let charts = scene_charts(story).into_iter().enumerate().map(|(place, (stem, chart))| {
        Part::from(Figure::new(place + 1, chart, format!("{study}-{stem}"), format!("{name}.csv")))
    });
    sections.push(Section::new("charts", "Charts", charts.collect()));
    if !story.setting.is_empty() {
        let table = Part::Table(Table::pairs("Every constant of the scene.", story.setting.iter().cloned()));
        let details = Part::Details { summary: "Every constant of the scene".to_owned(), parts: vec![table] };
        sections.push(Section::new("setting", "Setting", vec![Part::OnPage(vec![details])]));
    }
    Document {
        name: name.clone(),
        kicker: "A scene in time".to_owned(),
        title: story.title.clone(),
        lead: [Some(story.outcome()), numbers(story)].into_iter().flatten().collect(),
        sections,
        footer: format!("Made by apportion {}.", env!("CARGO_PKG_VERSION")),
        files: vec![
            DataFile::new(format!("{name}.json"), scene_json(story)),
            DataFile::new(format!("{name}.csv"), scene_csv(story)),
        ],
        ..Document::default()
    }
}

/// Forces at the slip, and how far the particle has come in the end.
fn numbers(story: &SceneStory) -> Option<String> {
    let critical = &story.critical;
    let value = |x: f64, unit: &str| minus(&with_unit(x, unit));
    let force = |newtons: f64| value(newtons * 1e9, "nN");
    let text = format!(
        "The critical tip force is {} (lateral {}, normal {}), reached after {}",
        force(critical.critical_force),
        force(critical.lateral_force),
        force(critical.normal_force),
        value(story.critical_time, "s")
    );
    let end = story.samples.last()?;
    let moved = value(end.relative * 1e9, "nm");
    Some(format!("{text}; after {} the particle has moved {moved} relative to the substrate.", value(end.time, "s")))
}

/// The document of the modes of motion in the study called `study`, whose title is `title`.
pub fn mode_document(diagram: &ModeDiagram, study: &str, title: &str) -> Document {
    let name = format!("{study}-modes");
    let chart = mode_diagram_chart(diagram);
    let of_mode = |mode: &str| Field::new(format!("{mode}_N"));
    let fields = diagram.forces.iter().map(|line| of_mode(&line.mode));
    let mut csv = Csv::new([Field::new("angle_rad")].into_iter().chain(fields));
    for (row, angle) in diagram.angle.iter().enumerate() {
        let forces = diagram.forces.iter().map(|line| Value::from(line.force[row]));
        csv.row([Value::from(*angle)].into_iter().chain(forces));
    }
    let (lead, data) = (vec![chart.caption().to_owned()], format!("{name}.csv"));
    let figure = Figure::new(1, chart, &name, &data);
    Document {
        name,
        kicker: "Modes of motion".to_owned(),
        title: title.to_owned(),
        lead,
        sections: vec![Section::new("diagram", "Mode diagram", vec![figure.into()])],
        footer: format!("Made by apportion {}.", env!("CARGO_PKG_VERSION")),
        files: vec![DataFile::new(data, csv.text())],
        ..Document::default()
    }
}

#[cfg(test)]
mod tests {
    use super::super::nominal_story;
    use super::*;

    #[test]
    fn a_scene_has_a_page() {
        let mut story = nominal_story();
        let document = scene_document(&story, "s");
        assert!(document.lead[1].contains("lateral") && document.html().contains("srcdoc="));
        story.samples.clear();
        assert_eq!(scene_document(&story, "s").lead.len(), 1);
    }
}
