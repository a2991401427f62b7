//! All figures: all exist, all can be drawn, and their captions agree with their data.

use std::collections::HashSet;
use std::sync::LazyLock;

use apportion_afm::contact::Pair;
use apportion_afm::{ContactTheory, Scene};
use apportion_report::chart::{ChartWidth, Mark, Shape, png};

use super::*;
use crate::reproduce::studies;

/// The figures of the issue that need no study.
const COMPUTED: [&str; 24] = [
    "CHK fig. 5",
    "CHK fig. 6",
    "CHK fig. 7",
    "CHK fig. 8",
    "CHK fig. 9",
    "CHK fig. 11",
    "CHK fig. 12",
    "CHK fig. 13",
    "CHK fig. 14",
    "LG fig. 2a",
    "LG fig. 2b",
    "LG fig. 2c",
    "LG fig. 2d",
    "LG fig. 3a",
    "LG fig. 3b",
    "LG fig. 3c",
    "LG fig. 3d",
    "TS04 fig. 8",
    "TS04 fig. 9",
    "TS04 fig. 10",
    "TS04 fig. 11",
    "TS04 fig. 12",
    "TS04 fig. 12, contact angle",
    "TS04 fig. 13",
];
const OF_STUDIES: [&str; 6] = ["CHK fig. 10", "CHK fig. 15", "CHK fig. 16", "LG fig. 4a", "LG fig. 4b", "LG fig. 4c"];

static QUICK: LazyLock<Vec<PaperFigure>> = LazyLock::new(|| figures(&[], Effort::Quick).unwrap());

fn figure(stem: &str) -> &'static PaperFigure {
    QUICK.iter().find(|figure| figure.stem == stem).unwrap()
}

/// Header and rows of a figure's data; NaN for an empty cell.
fn data(stem: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut reader = csv::Reader::from_reader(figure(stem).csv.as_bytes());
    let header = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let number = |cell: &str| cell.parse().unwrap_or(f64::NAN);
    (header, reader.records().map(|row| row.unwrap().iter().map(number).collect()).collect())
}

fn reproduced() -> Vec<Reproduced> {
    let studies = studies(&["design.base_samples=64".to_owned()]).unwrap();
    let run = |(group, friction, study): (_, _, apportion::Study)| {
        let result = study.run().unwrap();
        Reproduced { friction, group, result }
    };
    studies.into_iter().map(run).collect()
}

fn drawn_soundly(figure: &PaperFigure) {
    for width in [ChartWidth::Wide, ChartWidth::Narrow] {
        let svg = figure.chart.svg_at(width);
        assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{}", figure.stem);
        assert!(png(&svg).is_ok(), "{}", figure.stem);
    }
    let caption = &figure.chart.caption;
    assert!(caption.ends_with('.') && !caption.contains("NaN"), "{}: {caption}", figure.stem);
    assert!(caption.matches(". ").count() == 0, "one sentence: {caption}");
}

#[test]
fn every_figure_occurs_once_and_in_order() {
    let labels: Vec<&str> = QUICK.iter().map(|figure| figure.label.as_str()).collect();
    assert_eq!(labels, COMPUTED);
    let all = figures(&reproduced(), Effort::Quick).unwrap();
    let stems: Vec<&str> = all.iter().map(|figure| figure.stem).collect();
    assert!(stems.iter().eq(papers().figures.iter().map(|figure| &figure.stem)), "{stems:?}");
    assert_eq!(stems.iter().collect::<HashSet<_>>().len(), stems.len());
    let labels: Vec<&str> = all.iter().map(|figure| figure.label.as_str()).collect();
    assert!(COMPUTED.iter().chain(&OF_STUDIES).all(|label| labels.contains(label)));
    assert_eq!(labels.iter().filter(|label| **label == "All friction models").count(), 3);
    for figure in &all {
        drawn_soundly(figure);
    }
    let dimensional = all.iter().find(|figure| figure.stem == "lg-4a").unwrap();
    let caption = &dimensional.chart.caption;
    assert!(caption.contains("thickness") && caption.contains("76 %"), "{caption}");
    let environmental = &all.iter().find(|figure| figure.stem == "lg-4b").unwrap().chart.caption;
    assert!(environmental.contains("74 %") && environmental.contains("26 %"), "{environmental}");
    assert_eq!(dimensional.csv.lines().count(), 5);
}

#[test]
fn a_second_time_gives_the_same() {
    let again = figures(&[], Effort::Quick).unwrap();
    for (one, other) in again.iter().zip(QUICK.iter()) {
        assert!(one.csv == other.csv && one.chart.svg() == other.chart.svg(), "{}", one.stem);
    }
}

/// Under LuGre friction F_cr is c E w t^3 L^-2; Coulomb friction also has the shear term tau pi a^2.
#[test]
fn sweeps_follow_the_exact_laws() {
    let (header, rows) = data("lg-2b");
    assert_eq!(header, ["width_um", "lugre_nN", "lugre_quasi_static_nN"]);
    assert_eq!(rows.len(), 41);
    assert_eq!((rows[0][0], rows[40][0]), (5.0, 80.0));
    let power = |stem, exponent: f64| {
        let (_, rows) = data(stem);
        for row in &rows {
            let law = libm::pow(row[0] / rows[0][0], exponent);
            // LuGre friction at this velocity is a constant share of F_Z, except for sigma2 V, which is 1e-14 N: 1e-6 of
            // the least force here.
            assert!((row[1] / rows[0][1] / law - 1.0).abs() < 2e-6, "{stem} at {}", row[0]);
        }
    };
    power("lg-2b", 1.0);
    power("lg-2c", 3.0);
    power("lg-2a", -2.0);
    power("lg-3b", 1.0);
    let (_, coulomb) = data("chk-8");
    for row in &coulomb {
        let scene = Scene { thickness: row[0] * 1e-6, ..Scene::default() };
        let &Scene { length, width, thickness, elastic_modulus, preload_angle, static_friction, .. } = &scene;
        let normal = elastic_modulus * width * thickness.powi(3) * libm::sin(preload_angle) / (4.0 * length * length);
        let contact = ContactTheory::Jkr.contact(&Pair::substrate(&scene), normal).unwrap();
        let held = static_friction * normal + scene.shear_strength * std::f64::consts::PI * contact.radius.powi(2);
        assert!((row[1] * 1e-9 / libm::hypot(normal, held) - 1.0).abs() < 1e-12, "rounding only");
    }
}

#[test]
fn captions_describe_the_data() {
    let caption = |stem| figure(stem).chart.caption.as_str();
    // (2.5/0.25)^3 = 1000, and half of the way of t^3 lies at 2.5 (1.001/2)^(1/3) = 1.985 um.
    let thickness = caption("lg-2c");
    assert!(thickness.contains("1.98 µm") || thickness.contains("1.99 µm"), "{thickness}");
    let (_, rows) = data("chk-6");
    let ends = [rows[0][1], rows[40][1]].map(apportion_report::format::three_digits);
    assert!(caption("chk-6").contains(&format!("from {} to {} nN", ends[0], ends[1])), "{}", caption("chk-6"));
    let stems = ["lg-2b", "lg-2c", "lg-2d", "lg-3c", "chk-6", "chk-11", "chk-12", "chk-14", "ts04-11"];
    let captions = stems.map(|stem| format!("{stem}: {}", caption(stem)));
    insta::assert_snapshot!(captions.join("\n"));
}

#[test]
fn data_have_a_row_for_every_point_drawn() {
    for figure in QUICK.iter() {
        let points = |mark: &Mark| if let Shape::Line(points) = &mark.shape { points.len() } else { 0 };
        let longest = figure.chart.panels.iter().flat_map(|panel| &panel.marks).map(points).max();
        let rows = figure.csv.lines().count() - 1;
        assert!(rows >= longest.unwrap_or(0), "{}: {rows} rows", figure.stem);
        let header = figure.csv.lines().next().unwrap();
        let cells = header.split(',').count();
        assert!(figure.csv.lines().all(|line| line.split(',').count() == cells), "{}", figure.stem);
    }
}
