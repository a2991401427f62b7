//! Factors that depend on each other, through the program: what it prints and what it refuses.

use crate::common::{Folder, study_path, succeed, text};
use crate::messages::messages;

#[test]
fn the_program_describes_dependent_factors() {
    let folder = Folder::new();
    let study = study_path("portfolio");
    let out = folder.path("out");
    let printed = succeed(&["run", text(&study), "--base-samples", "1024", "--out", text(&out)]);
    messages!().add_printed("run", &printed);
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(out.join("portfolio.json")).unwrap()).unwrap();
    assert_eq!(json["study"]["dependences"][1]["correlation"][0][1], -0.3);
    let x1 = &json["outputs"][0]["indices"][0];
    assert!(x1["shapley"]["estimate"].as_f64().unwrap() > 0.3 && x1["dependent"]["full_total"]["low"].is_number());
    assert!(json["outputs"][0]["sum_first_order"].is_null() && x1["share_total"].is_null());
    // The same bits on one thread, and from the points in a file.
    let again = folder.path("again");
    succeed(&["run", text(&study), "--base-samples", "1024", "--threads", "1", "--out", text(&again)]);
    let outputs = |path: &std::path::Path| -> serde_json::Value {
        let json: serde_json::Value =
            serde_json::from_slice(&std::fs::read(path.join("portfolio.json")).unwrap()).unwrap();
        json["outputs"].clone()
    };
    assert_eq!(outputs(&out), outputs(&again));
}

#[test]
fn options_for_independent_factors_are_refused_with_alternatives() {
    let study = text(&study_path("portfolio")).to_owned();
    let mut messages = messages!();
    for change in [
        "analysis.second_order=true",
        "analysis.surrogate=\"on\"",
        "analysis.shapley=1",
        "dependence=[{factors=[\"x1\",\"x2\"]}]",
        "dependence=[{factors=[\"x1\",\"x9\"], correlation=0.5}]",
        "dependence=[{factors=[\"x1\",\"x2\",\"x3\"], correlation=-0.9}]",
        "dependence=[{factors=[\"x1\",\"x2\"], correlation=1.5}]",
        "dependence=[{factors=[\"x1\",\"x2\"], correlation=0.5, measure=\"rank\"}]",
        "dependence=[{factors=[\"x1\",\"x2\"], correlation=\"much\"}]",
    ] {
        messages.refused_as(change, &["check", &study, "--set", change]);
    }
    messages.refused(&["screen", &study]);
    messages.refused(&["trade", &study, "--quick"]);
}

#[test]
fn joint_measurements_and_matrices_state_the_same() {
    let folder = Folder::new();
    let rows: String = (0..200).map(|k| format!("{},{}\n", k, (k * 7 % 200) + 3 * k)).collect();
    folder.with("joint.csv", format!("x1,x2\n{rows}"));
    let model = "model = \"expression\"\noutputs.y = \"x1 + x2\"\ndesign.base_samples = 256\n";
    let factors = "[[factor]]\nname = \"x1\"\n[[factor]]\nname = \"x2\"\n";
    let factors =
        factors.replace('\n', "\nmin = 0\nmax = 1\n").replace("[[factor]]\nmin = 0\nmax = 1\n", "[[factor]]\n");
    let study = folder.with(
        "study.toml",
        format!("{model}{factors}[[dependence]]\nfactors = [\"x1\", \"x2\"]\nfile = \"joint.csv\"\n"),
    );
    let mut messages = messages!();
    messages.add_printed("joint", &succeed(&["run", text(&study), "--out", text(&folder.path("out"))]));
    for wrong in [
        "measurements = [[1, 2], [3]]",
        "measurements = [[1, 2], [3, 1]]",
        "measurements = [[1, 2]]\nfile = \"joint.csv\"",
        "file = \"joint.csv\"\ncorrelation = 0.5",
        "file = \"joint.csv\"\ncopula = \"kernel\"",
    ] {
        let study =
            folder.with("wrong.toml", format!("{model}{factors}[[dependence]]\nfactors = [\"x1\", \"x2\"]\n{wrong}\n"));
        messages.refused_as(wrong, &["check", text(&study)]);
    }
}

/// Groups, subsets, a dummy factor and all outputs together have no Shapley effects, and their lines are as long as the others.
#[test]
fn other_requests_for_dependent_factors_have_their_lines() {
    let folder = Folder::new();
    let factor = |name: &str, group: &str| format!("[[factor]]\nname = \"{name}\"\nmin = 0\nmax = 1\n{group}\n");
    let factors = [factor("a", "group = \"g\""), factor("b", "group = \"g\""), factor("c", "")].concat();
    let asked = "subsets = [[\"a\", \"c\"]]\ndummy = true\naggregate = true\nestimators = [\"jansen\", \"azzini\"]\n";
    let study = format!(
        "model = \"expression\"\n[outputs]\ny = \"a + b*c\"\nz = \"c\"\n[design]\nbase_samples = 256\n\
         [analysis]\n{asked}{factors}[[dependence]]\nfactors = [\"a\", \"b\"]\ncorrelation = 0.5\n"
    );
    for shapley in ["true", "false"] {
        let out = folder.path(shapley);
        let path = folder.with("study.toml", &study);
        succeed(&["run", text(&path), "--set", &format!("analysis.shapley={shapley}"), "--out", text(&out)]);
        let lines = std::fs::read_to_string(out.join("study.csv")).unwrap();
        let commas = |line: &str| line.matches(',').count();
        let first = commas(lines.lines().next().unwrap());
        assert!(lines.lines().all(|line| commas(line) == first), "{lines}");
        for kind in [",factor,", ",group,", ",subset,", ",dummy,", ",aggregate,"] {
            assert!(lines.contains(kind), "{kind}: {lines}");
        }
        // The same page from the result only.
        let again = folder.path(&format!("again-{shapley}"));
        succeed(&["report", text(&out.join("study.json")), "--out", text(&again)]);
        let page = |of: &std::path::Path| std::fs::read_to_string(of.join("study.html")).unwrap();
        assert_eq!(page(&out), page(&again));
    }
}
