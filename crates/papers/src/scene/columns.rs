//! The story as a table: CSV for spreadsheets, JSON for programs.

use apportion_report::document::Table;
use serde_json::{Map, Value, json};

use super::story::{NANO, SceneSample, SceneStory};

/// A column of numbers: its name with unit, the factor from SI to that unit, and a function for its value in SI.
type Column = (&'static str, f64, fn(&SceneSample) -> f64);

/// The numbers of a sample, in the order of the files.
const COLUMNS: [Column; 15] = [
    ("time_s", 1.0, |s| s.time),
    ("lateral_force_nN", NANO, |s| s.lateral_force),
    ("normal_force_nN", NANO, |s| s.normal_force),
    ("tip_force_nN", NANO, |s| s.tip_force),
    ("force_angle_rad", 1.0, |s| s.force_angle),
    ("twist_rad", 1.0, |s| s.twist),
    ("base_lateral_nm", NANO, |s| s.lateral_deflection),
    ("deflection_nm", NANO, |s| s.normal_deflection),
    ("substrate_position_nm", NANO, |s| s.substrate),
    ("particle_position_nm", NANO, |s| s.particle),
    ("relative_position_nm", NANO, |s| s.relative),
    ("substrate_contact_radius_nm", NANO, |s| s.substrate_contact.radius),
    ("substrate_indentation_nm", NANO, |s| s.substrate_contact.indentation),
    ("tip_contact_radius_nm", NANO, |s| s.tip_contact_radius()),
    ("tip_indentation_nm", NANO, |s| s.tip_indentation()),
];

/// The name of a flag and a function for its value.
type Flag = (&'static str, fn(&SceneSample) -> bool);

/// The flags of a sample, after its numbers.
const FLAGS: [Flag; 4] =
    [("slipping", |s| !s.sticking), ("tip_slip", |s| s.tip_slip), ("rolling", |s| s.rolling), ("spin", |s| s.spin)];

/// Returns the number in the column `name`, in its unit.
pub fn scene_number(name: &str, sample: &SceneSample) -> f64 {
    let (_, factor, read) = COLUMNS.iter().find(|column| column.0 == name).expect("a column of scenes");
    factor * read(sample)
}

/// Returns the samples as a table for CSV: names with units, then a row per sample, flags as `true` and `false`. The
/// columns described in `docs/reference/other-formats.md`.
pub fn scene_table(story: &SceneStory) -> Table {
    let numbers = COLUMNS.iter().fold(Table::from_rows("", &story.samples), |rows, (name, factor, read)| {
        rows.file(*name, |sample| factor * read(sample))
    });
    FLAGS.iter().fold(numbers, |rows, (name, read)| rows.file(*name, read)).into()
}

/// Formats the story as JSON, format `apportion-scene`, version 1: see `docs/reference/other-formats.md`. The samples are columns
/// of the same names, units and digits as in [`scene_table`].
pub fn scene_json(story: &SceneStory) -> String {
    format!("{:#}\n", scene_value(story))
}

/// Returns the story as a JSON value. A number that is not finite is `null`.
pub(super) fn scene_value(story: &SceneStory) -> Value {
    let setting: Vec<Value> =
        story.setting.iter().map(|(label, value)| json!({ "label": label, "value": value })).collect();
    let numbers = COLUMNS.iter().map(|(name, factor, read)| {
        let values: Vec<f64> = story.samples.iter().map(|sample| factor * read(sample)).collect();
        ((*name).to_owned(), json!(values))
    });
    let flags = FLAGS.iter().map(|(name, read)| {
        let values: Vec<bool> = story.samples.iter().map(read).collect();
        ((*name).to_owned(), json!(values))
    });
    let samples: Map<String, Value> = numbers.chain(flags).collect();
    let (scene, critical) = (&story.scene, &story.critical);
    json!({
        "format": "apportion-scene",
        "version": 1,
        "title": story.title,
        "setting": setting,
        "geometry": {
            "particle_radius_nm": NANO * scene.particle_radius,
            "tip_radius_nm": NANO * scene.tip_radius,
            "height_nm": NANO * scene.height,
            "contact_angle_rad": scene.contact_angle,
            "length_nm": NANO * scene.length,
            "width_nm": NANO * scene.width,
            "thickness_nm": NANO * scene.thickness,
        },
        "critical": {
            "time_s": story.critical_time,
            "critical_force_nN": NANO * critical.critical_force,
            "lateral_force_nN": NANO * critical.lateral_force,
            "normal_force_nN": NANO * critical.normal_force,
        },
        "samples": samples,
    })
}
