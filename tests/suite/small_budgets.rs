//! Small budgets: random points as a table for `given-data`.

use apportion_report::given::GivenFile;

use crate::common::{Folder, succeed, text};
use crate::messages::messages;

const STUDY: &str = "model = \"expression\"\noutputs.y = \"a + 2 * b + a * b\"\n[factors.a]\nmin = -1\nmax = 1\n\
                     [factors.b]\nmin = -100\nmax = 100\nunit = \"cm\"\n";

/// Formulas are in SI, so b is between -1 and 1: the parts of y have the variances 1/3, 4/3 and 1/9.
#[test]
fn random_points_of_a_study_give_its_indices() {
    let folder = Folder::new();
    let study = folder.with("s.toml", STUDY);
    let (rows, table) = (folder.path("rows.csv"), folder.path("table.csv"));
    succeed(&["sample", text(&study), "--random", "61", "-o", text(&rows)]);
    succeed(&["evaluate", text(&study), text(&rows), "--with-points", "-o", text(&table)]);
    let (points, both) = (std::fs::read_to_string(&rows).unwrap(), std::fs::read_to_string(&table).unwrap());
    assert_eq!((points.lines().count(), both.lines().next()), (62, Some("a,b,y")));
    for (point, line) in points.lines().zip(both.lines()) {
        assert!(line.starts_with(&format!("{point},")), "{point} in {line}");
    }
    let out = folder.path("out");
    let study = text(&study);
    succeed(&["given-data", text(&table), "--outputs", "y", "--study", study, "--out", text(&out)]);
    let result: GivenFile = serde_json::from_slice(&std::fs::read(out.join("table.json")).unwrap()).unwrap();
    let found = result.outputs[0].surrogate.as_ref().unwrap();
    let all = 1.0 / 3.0 + 4.0 / 3.0 + 1.0 / 9.0;
    for (index, [first, total]) in found.indices.iter().zip([[1.0 / 3.0, 4.0 / 9.0], [4.0 / 3.0, 13.0 / 9.0]]) {
        // The surrogate has these polynomials.
        assert!((index.first_order.estimate - first / all).abs() < 1e-9, "{index:?}");
        assert!((index.total.estimate - total / all).abs() < 1e-9, "{index:?}");
    }
}

#[test]
fn random_points_follow_from_the_seed_and_are_no_design() {
    let folder = Folder::new();
    let study = folder.with("s.toml", STUDY);
    let written = |name: &str, more: &[&str]| {
        let path = folder.path(name);
        succeed(&[&["sample", text(&study), "-o", text(&path)], more].concat());
        std::fs::read(path).unwrap()
    };
    let design = written("a.csv", &[]);
    assert!(folder.path("a.csv.manifest.json").exists());
    let random = written("a.csv", &["--random", "100"]);
    assert!(!folder.path("a.csv.manifest.json").exists(), "the manifest of points that are gone");
    assert_ne!(design, random);
    assert_eq!(random, written("b.csv", &["--random", "100"]));
    let longer = written("c.csv", &["--random", "101"]);
    assert!(longer.starts_with(&random) && longer.len() > random.len());
    assert_ne!(random, written("d.csv", &["--random", "100", "--seed", "1"]));
    assert_eq!(written("e.csv", &["--random", "1"]).split(|byte| *byte == b'\n').count(), 3);
    let mut messages = messages!();
    for wrong in [&["--random", "0"][..], &["--random", "5", "--base-samples", "64"], &["--random", "-1"]] {
        messages.refused(&[&["sample", text(&study)], wrong].concat());
    }
    messages.refused(&["run", text(&study), "--runs", "20"]);
}

/// Dependent factors are drawn together.
#[test]
fn random_points_of_dependent_factors_depend() {
    let folder = Folder::new();
    let dependence = "[[dependence]]\nfactors = [\"a\", \"b\"]\ncorrelation = 0.9\n";
    let study = folder.with("s.toml", format!("{STUDY}{dependence}"));
    let rows = folder.path("rows.csv");
    succeed(&["sample", text(&study), "--random", "2000", "-o", text(&rows)]);
    let content = std::fs::read_to_string(rows).unwrap();
    let pairs = content.lines().skip(1).map(|line| line.split_once(',').unwrap());
    let pairs: Vec<(f64, f64)> = pairs.map(|(a, b)| (a.parse().unwrap(), b.parse::<f64>().unwrap() / 100.0)).collect();
    // Of uniform factors on (-1, 1), whose variance is 1/3; the standard error is .005.
    let product: f64 = pairs.iter().map(|(a, b)| 3.0 * a * b).sum::<f64>() / 2000.0;
    assert!((product - 0.9).abs() < 0.03, "{product}");
}
