//! What `simulate` writes of a scene: tables, charts, and the animation.

use std::collections::BTreeMap;

use apportion_afm::history::{History, history};
use apportion_afm::{FrictionLaw, Options, Scene};
use resvg::usvg::roxmltree::Document;
use serde_json::Value;

use crate::common::{Folder, contents, study_path, succeed, text};

/// The charts of a scene in time, in the order of their captions here.
const CHARTS: [&str; 4] = ["forces", "positions", "contacts", "pushing"];

/// The files of the nominal scene with these arguments, as text.
fn simulated(arguments: &[&str]) -> BTreeMap<String, String> {
    let folder = Folder::new();
    let (study, out) = (study_path("coulomb-general"), folder.path("out"));
    let usual = ["simulate", text(&study), "--out", text(&out), "--charts", "svg"];
    succeed(&[&usual[..], arguments].concat());
    contents(&out).into_iter().map(|(name, bytes)| (name, String::from_utf8(bytes).unwrap())).collect()
}

/// The scene of the study for 0.4 s: here, and as the physics has it.
fn nominal() -> (BTreeMap<String, String>, History) {
    let options = Options { friction: FrictionLaw::Coulomb, ..Options::default() };
    (simulated(&["--duration", "0.4 s"]), history(&Scene::default(), &options, 0.4).unwrap())
}

/// A chart, and what it says of itself.
fn chart<'a>(files: &'a BTreeMap<String, String>, stem: &str) -> (&'a str, String) {
    let svg = &files[&format!("charts/coulomb-general-{stem}.svg")];
    let document = Document::parse(svg).unwrap();
    let description = document.descendants().find(|node| node.has_tag_name("desc")).unwrap().text().unwrap();
    assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{stem}");
    (svg, description.split(" horizontal axis ").next().unwrap().to_owned())
}

/// The page of the animation, which is framed by that of the scene.
fn animation(files: &BTreeMap<String, String>) -> String {
    let (_, rest) = files["coulomb-general-scene.html"].split_once("srcdoc=\"").unwrap();
    let escaped = [("&#60;", "<"), ("&#62;", ">"), ("&#34;", "\""), ("&#39;", "'"), ("&#38;", "&")];
    let page = rest.split_once('"').unwrap().0.to_owned();
    escaped.iter().fold(page, |page, (from, to)| page.replace(from, to))
}

/// Header and rows of the table of a scene.
fn table(files: &BTreeMap<String, String>, name: &str) -> (csv::StringRecord, Vec<csv::StringRecord>) {
    let mut reader = csv::Reader::from_reader(files[name].as_bytes());
    (reader.headers().unwrap().clone(), reader.records().map(Result::unwrap).collect())
}

#[test]
fn csv_reads_back_to_the_same_bits() {
    let (files, History { samples, .. }) = nominal();
    let (header, rows) = table(&files, "coulomb-general-scene.csv");
    assert_eq!((&header[0], &header[1], &header[18]), ("time_s", "lateral_force_nN", "spin"));
    assert_eq!((header.len(), rows.len()), (19, samples.len()));
    for (row, sample) in rows.iter().zip(&samples) {
        assert_eq!(row[0].parse::<f64>().unwrap(), sample.time);
        assert_eq!(row[10].parse::<f64>().unwrap(), 1e9 * sample.relative);
        assert_eq!(row[13].parse::<f64>().unwrap(), 1e9 * sample.tip_contact.unwrap().radius);
        assert_eq!(row[15].parse::<bool>().unwrap(), !sample.sticking);
    }
}

#[test]
fn json_reads_back_to_the_same_bits() {
    let (files, History { samples, critical }) = nominal();
    let value: Value = serde_json::from_str(&files["coulomb-general-scene.json"]).unwrap();
    assert_eq!(value["critical"]["time_s"].as_f64(), critical.critical_time.ok());
    assert_eq!(value["critical"]["critical_force_nN"].as_f64(), Some(1e9 * critical.critical_force));
    assert_eq!(value["geometry"]["height_nm"].as_f64(), Some(1e9 * Scene::default().height));
    let twist = value["samples"]["twist_rad"].as_array().unwrap();
    let read: Vec<f64> = twist.iter().map(|number| number.as_f64().unwrap()).collect();
    assert_eq!(read, samples.iter().map(|sample| sample.twist).collect::<Vec<_>>());
    // The columns are those of the table, and described.
    let (header, _) = table(&files, "coulomb-general-scene.csv");
    assert!(header.iter().eq(value["samples"].as_object().unwrap().keys()), "{header:?}");
    let documentation = include_str!("../../../docs/reference/other-formats.md");
    for name in &header {
        assert!(documentation.contains(&format!("`{name}`")), "{name}");
    }
}

#[test]
fn charts_are_sound_and_mark_the_slip() {
    let (files, _) = nominal();
    for stem in CHARTS {
        let (svg, _) = chart(&files, &format!("scene-{stem}"));
        let document = Document::parse(svg).unwrap();
        assert!(document.descendants().any(|node| node.text() == Some("slip at 0.131 s")), "{stem}");
    }
}

/// With the slip, and before it.
#[test]
fn captions_are_computed() {
    let of = |duration| {
        let files = simulated(&["--duration", duration]);
        CHARTS.map(|stem| chart(&files, &format!("scene-{stem}")).1)
    };
    insta::assert_snapshot!([of("0.4 s"), of("0.09843 s")].concat().join("\n"));
}

/// A force that starts no motion is an empty cell and a gap.
#[test]
fn the_diagram_is_drawn_with_a_caption() {
    let files = simulated(&["--mode-diagram"]);
    let (header, rows) = table(&files, "coulomb-general-modes.csv");
    let (_, caption) = chart(&files, "modes");
    // The row of the scene's own angle, which the grid of half degrees does not have.
    let degrees = |row: &csv::StringRecord| row[0].parse::<f64>().unwrap().to_degrees();
    let own = rows.iter().find(|row| (2.0 * degrees(row) - (2.0 * degrees(row)).round()).abs() > 1e-9).unwrap();
    let mut modes: Vec<(f64, &str)> =
        (1..header.len()).filter_map(|place| Some((own[place].parse().ok()?, &header[place]))).collect();
    modes.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(modes.len() < header.len() - 1, "{own:?}");
    let three = apportion_report::format::three_digits;
    let said: Vec<String> = modes
        .iter()
        .map(|(force, mode)| format!("{} at {} nN", mode.trim_end_matches("_N"), three(1e9 * force)))
        .collect();
    let (angle, slip) = (three(degrees(own)), said.last().unwrap().replace("slide at ", ""));
    assert_eq!(caption, format!("At {angle}° set in: {}; the scene slips at {angle}° and {slip}.", said.join(", ")));
}

#[test]
fn the_animation_needs_no_other_files() {
    let (files, _) = nominal();
    let page = animation(&files);
    let own = page.replace("http://www.w3.org/2000/svg", "");
    for outside in ["http:", "https:", "src=", "@import", "url(", "//cdn", "fetch("] {
        assert!(!own.contains(outside), "{outside}");
    }
    assert!(page.contains("The particle slips after 0.131\u{a0}s, at a tip force of 631\u{a0}nN."));
    assert!(page.contains("exaggerated 200 times") && page.contains("exaggerated 2 times"));
    assert!(page.contains("--push:#00527f"));
}

#[test]
fn texts_cannot_break_out_of_the_animation() {
    let evil = "</script><script>alert('&')</script><!--";
    let page = animation(&simulated(&["--set", &format!("title=\"{evil}\"")]));
    assert!(!page.contains("</script><script>alert"));
    assert!(!page.contains("<!--"));
    assert_eq!(page.matches("</script>").count(), 3);
    let (_, rest) = page.split_once("id=\"scene-data\">").unwrap();
    let data: Value = serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap();
    assert_eq!(data["title"], evil);
}

/// The largest of 1, 2, 5, 10, ... and of their inverses with which the probe leans by at most 0.25, and the particle moves
/// by at most 0.8 of its radius.
#[test]
fn magnifications_are_round_and_below_their_limit() {
    let factor = |words: &str| match words.split(' ').collect::<Vec<_>>()[..] {
        ["to", "scale"] => 1.0,
        ["exaggerated", times, "times"] => times.parse::<f64>().unwrap(),
        ["reduced", times, "times"] => 1.0 / times.parse::<f64>().unwrap(),
        _ => panic!("{words}"),
    };
    let mut found = Vec::new();
    for (duration, change) in [
        ("0.4 s", "design.seed=1"),
        ("0.4 s", "factor.velocity.nominal=1"),
        ("0.3 ms", "design.seed=1"),
        ("60 s", "afm.static_friction=40"),
        ("100 s", "afm.shear_modulus=\"0.1 GPa\""),
    ] {
        let files = simulated(&["--duration", duration, "--set", change]);
        let (header, rows) = table(&files, "coulomb-general-scene.csv");
        let largest = |name: &str| {
            let place = header.iter().position(|column| column == name).unwrap();
            rows.iter().map(|row| row[place].parse::<f64>().unwrap().abs()).fold(0.0, f64::max)
        };
        let Scene { height, particle_radius, .. } = Scene::default();
        let lean = f64::max(largest("twist_rad"), largest("base_lateral_nm") / (1e9 * height));
        let limits = [0.25 / lean, 0.8e9 * particle_radius / largest("particle_position_nm")];
        let page = animation(&files);
        let (_, said) = page.split_once("displacements of the probe are ").unwrap();
        let (probe, rest) = said.split_once(", the travel of particle and substrate is ").unwrap();
        let travel = rest.split_once(".").unwrap().0;
        for (words, limit) in [probe, travel].into_iter().zip(limits) {
            let factor = factor(words);
            // 1e-9: rounding of an inverse.
            assert!(factor <= limit * (1.0 + 1e-9) && limit < 2.5 * factor * (1.0 + 1e-9), "{words}, {limit}");
            let digits = format!("{factor:.6e}");
            assert!(["1.000000", "2.000000", "5.000000"].contains(&digits.split('e').next().unwrap()), "{words}");
            found.push(factor);
        }
    }
    assert!(found.iter().any(|factor| *factor < 1.0) && found.iter().any(|factor| *factor > 1000.0), "{found:?}");
}
