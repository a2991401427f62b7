//! A scene, and the diagram of its modes, as documents.

use apportion_report::document::{Document, Figure, Part, Report, Section, Table};
use apportion_report::format::{minus, with_unit};

use super::{ModeDiagram, SceneStory, mode_diagram_chart, player_page, scene_charts, scene_json, scene_table};

/// Builds the document of a scene of the study `study`.
pub fn scene_document(story: &SceneStory, study: &str) -> Document {
    let frame = || Part::Frame { title: "The scene as an animation".to_owned(), html: player_page(story) };
    let animation = (!story.samples.is_empty()).then(frame);
    let charts = scene_charts(story).map(|(stem, chart)| Figure::unnumbered(chart, format!("{study}-{stem}")).into());
    let setting = (!story.setting.is_empty()).then(|| {
        let table = Part::Table(Table::pairs("Every constant of the scene.", story.setting.iter().cloned()));
        Part::OnPage(vec![Part::Details { summary: "Every constant of the scene".to_owned(), parts: vec![table] }])
    });
    Report {
        name: format!("{study}-scene"),
        kicker: "A scene in time",
        title: story.title.clone(),
        lead: [Some(story.outcome()), numbers(story)].into_iter().flatten().collect(),
        then: vec![
            Section::new("animation", "The scene", animation.into_iter().collect()),
            Section::new("charts", "Charts", charts.to_vec()),
            Section::new("setting", "Setting", setting.into_iter().collect()),
        ],
        json: scene_json(story),
        csv: Some(scene_table(story)),
        ..Report::default()
    }
    .document()
}

/// States the forces at the slip, and the final position of the particle.
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

/// Builds the document of the modes of motion in the study `study`, whose title is `title`.
pub fn mode_document(diagram: &ModeDiagram, study: &str, title: &str) -> Document {
    let (name, chart) = (format!("{study}-modes"), mode_diagram_chart(diagram));
    let mut csv = Table::from_rows("", 0..diagram.angle.len()).file("angle_rad", |row| diagram.angle[row]);
    for line in &diagram.forces {
        csv = csv.file(format!("{}_N", line.mode), |row| line.force[row]);
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
