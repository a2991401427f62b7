//! The figures of the papers: all exist, all can be drawn, and their captions agree with their data.

use apportion_afm::contact::Pair;
use apportion_afm::{ContactTheory, Scene};
use resvg::usvg::roxmltree::Document;

use super::QUICK;

/// The labels of the figures on the page: those of shares under all friction models, then paper by paper.
const LABELS: [&str; 27] = [
    "CHK fig. 16, LG fig. 4c",
    "CHK fig. 10, LG fig. 4a",
    "CHK fig. 15, LG fig. 4b",
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

/// The figures of shares, each a file of its own.
const OF_STUDIES: [&str; 9] =
    ["chk-10", "chk-15", "chk-16", "lg-4a", "lg-4b", "lg-4c", "dimensional", "environmental", "general"];

/// The names of the files of all figures.
fn stems() -> Vec<&'static str> {
    let names = QUICK.files.keys().filter_map(|name| name.strip_prefix("charts/")?.strip_suffix(".svg"));
    names.collect()
}

fn svg(stem: &str) -> &'static str {
    QUICK.text(&format!("charts/{stem}.svg"))
}

/// The caption of a figure, with which its description for readers of the screen begins.
fn caption(stem: &str) -> String {
    let document = Document::parse(svg(stem)).unwrap();
    let described = document.descendants().find(|node| node.has_tag_name("desc")).unwrap().text().unwrap();
    let before_axes = described.split(" horizontal axis ").next().unwrap();
    before_axes.split(" S_1: ").next().unwrap().to_owned()
}

/// Header and rows of a figure's data; NaN for an empty cell.
fn data(stem: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut reader = csv::Reader::from_reader(QUICK.text(&format!("charts/{stem}.csv")).as_bytes());
    let header = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let number = |cell: &str| cell.parse().unwrap_or(f64::NAN);
    (header, reader.records().map(|row| row.unwrap().iter().map(number).collect()).collect())
}

#[test]
fn every_figure_occurs_once_and_in_order() {
    let page = QUICK.text("index.html");
    let labels = page.split("<b>").skip(1).filter_map(|rest| rest.split_once(".</b>")).map(|(label, _)| label);
    assert_eq!(labels.filter(|label| label.contains(" fig. ")).collect::<Vec<_>>(), LABELS);
    assert_eq!(stems().len(), LABELS.len() - 3 + OF_STUDIES.len());
    assert!(OF_STUDIES.iter().all(|stem| stems().contains(stem)));
    // In both widths.
    for drawn in page.split("<svg").skip(1) {
        let drawn = drawn.split("</svg>").next().unwrap();
        assert!(!drawn.contains("NaN") && !drawn.contains("inf\""), "{drawn}");
    }
    for stem in stems() {
        assert!(!svg(stem).contains("NaN") && !svg(stem).contains("inf\""), "{stem}");
        assert!(QUICK.files[&format!("charts/{stem}.png")].starts_with(b"\x89PNG"), "{stem}");
        let caption = caption(stem);
        assert!(caption.ends_with('.') && !caption.contains("NaN"), "{stem}: {caption}");
        assert!(caption.matches(". ").count() == 0, "one sentence: {caption}");
    }
    let dimensional = caption("lg-4a");
    assert!(dimensional.contains("thickness") && dimensional.contains("76 %"), "{dimensional}");
    let environmental = caption("lg-4b");
    assert!(environmental.contains("74 %") && environmental.contains("26 %"), "{environmental}");
    assert_eq!(data("lg-4a").1.len(), 4);
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

/// The first position at which the line through the points of two columns has the value `level`.
fn crossing(points: &[(f64, f64)], level: f64) -> f64 {
    let pair = points.windows(2).find(|pair| (pair[0].1 - level) * (pair[1].1 - level) <= 0.0).unwrap();
    let ((xa, a), (xb, b)) = (pair[0], pair[1]);
    xa + (xb - xa) * (level - a) / (b - a)
}

/// Rising and falling, half of the way, straight and level lines, and where two lines meet: from the data of every sweep.
#[test]
fn curves_are_described_by_their_course() {
    let three = apportion_report::format::three_digits;
    let (mut halves, mut crossings, mut straight, mut level) = (0, 0, 0, 0);
    for stem in stems() {
        let (header, rows) = data(stem);
        let (is_sweep, caption) = (header.get(1).is_some_and(|name| name.ends_with("_nN")), caption(stem));
        if !is_sweep || !caption.contains(", the critical force ") {
            continue;
        }
        let column = |place: usize| -> Vec<(f64, f64)> { rows.iter().map(|row| (row[0], row[place])).collect() };
        let of_papers = |name: &&String| !name.contains("quasi_static") && !name.contains("fixed_step");
        for (place, name) in header.iter().enumerate().skip(1).filter(|(_, name)| of_papers(name)) {
            let points = column(place);
            let ((x0, first), (x1, last)) = (points[0], points[points.len() - 1]);
            let verb = if last > first { "rises" } else { "falls" };
            if (last / first - 1.0).abs() < 1e-6 {
                assert!(caption.contains(&format!("stays at {} nN", three(first))), "{stem} {name}: {caption}");
                level += 1;
                continue;
            }
            let said = format!("{verb} from {} to {} nN", three(first), three(last));
            let (_, course) = caption.split_once(&said).unwrap_or_else(|| panic!("{stem} {name}: {said}: {caption}"));
            let chord = |x: f64| first + (last - first) * (x - x0) / (x1 - x0);
            let bend = points.iter().map(|(x, y)| ((y - chord(*x)) / (last - first)).abs()).fold(0.0, f64::max);
            let course = course.split(')').next().unwrap();
            if bend < 1e-6 {
                assert!(course.ends_with("(in a straight line"), "{stem} {name}: {course}");
                straight += 1;
            } else if bend < 0.02 {
                let within = format!("to within {} % of the change", three(100.0 * bend));
                assert!(course.ends_with(&within), "{stem} {name}: {course}");
                straight += 1;
            } else {
                let half = format!("(half of the way by {} ", three(crossing(&points, 0.5 * (first + last))));
                assert!(course.contains(&half), "{stem} {name}: {course}, {half}");
                halves += 1;
            }
        }
        if let Some((_, rest)) = caption.split_once("; the two are equal at ") {
            let gap: Vec<(f64, f64)> = rows.iter().map(|row| (row[0], row[1] - row[2])).collect();
            assert!(rest.starts_with(&format!("{} ", three(crossing(&gap, 0.0)))), "{stem}: {rest}");
            crossings += 1;
        }
    }
    assert!(halves > 5 && crossings > 1 && straight > 3 && level > 3, "{halves} {crossings} {straight} {level}");
}

#[test]
fn data_have_a_row_for_every_point_drawn() {
    for stem in stems().into_iter().filter(|stem| !OF_STUDIES.contains(stem)) {
        let document = Document::parse(svg(stem)).unwrap();
        let paths = document.descendants().filter_map(|node| node.attribute("d"));
        let longest = paths.map(|path| path.matches(['M', 'L']).count()).max();
        let rows = data(stem).1.len();
        assert!(longest.is_some_and(|points| points > 1 && rows >= points), "{stem}: {rows} rows");
    }
}
