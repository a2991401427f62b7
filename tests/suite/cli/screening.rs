//! Screenings and sweeps through the program: files, formats, bad input.

use std::collections::BTreeSet;
use std::path::Path;

use apportion::result::json;
use apportion::screening::Reading;
use apportion_report::screening::ScreeningFile;
use apportion_report::sweep::SweepFile;

use crate::common::{Folder, all_files, apportion, stderr, study_path, succeed, text};
use crate::messages::messages;

fn read(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).unwrap()
}

fn screened(study: &str, more: &[&str]) -> (tempfile::TempDir, ScreeningFile, String) {
    let folder = tempfile::tempdir().unwrap();
    let study = study_path(study);
    let table = succeed(&[&["screen", text(&study), "--out", text(folder.path())], more].concat());
    let name = study.file_stem().unwrap().to_str().unwrap();
    let file = serde_json::from_str(&read(folder.path(), &format!("{name}-screen.json"))).unwrap();
    (folder, file, table)
}

fn swept(study: &str, more: &[&str]) -> (tempfile::TempDir, SweepFile, String) {
    let folder = tempfile::tempdir().unwrap();
    let study = study_path(study);
    let table = succeed(&[&["sweep", text(&study), "--out", text(folder.path())], more].concat());
    let name = study.file_stem().unwrap().to_str().unwrap();
    let file = serde_json::from_str(&read(folder.path(), &format!("{name}-sweep.json"))).unwrap();
    (folder, file, table)
}

#[test]
fn a_screening_finds_what_the_indices_find() {
    let (folder, file, table) = screened("coulomb-general", &[]);
    messages!().add_printed("screen", &table);
    assert_eq!((file.format.as_str(), file.version), ("apportion-screening", 1));
    assert_eq!(json(&file), read(folder.path(), "coulomb-general-screen.json"));
    assert_eq!((file.provenance.model_runs, file.provenance.trajectories), (32 * 9, 32));
    let factors = &file.outputs[0].factors;
    let by = |name: &str| factors.iter().find(|factor| factor.factor == name).unwrap();
    // The order of the total indices: thickness, length, width, elastic modulus; height and velocity have none.
    let first: BTreeSet<usize> = ["thickness", "length", "width"].iter().map(|name| by(name).rank).collect();
    assert_eq!((first, by("elastic_modulus").rank), (BTreeSet::from([1, 2, 3]), 4));
    for name in ["height", "velocity"] {
        let mu_star = by(name).mu_star.unwrap();
        assert_eq!((mu_star.estimate, by(name).could_be_fixed, by(name).reading), (0.0, Some(true), None));
    }
    assert_eq!(by("thickness").could_be_fixed, Some(false));
    assert!(by("length").mu.unwrap().estimate < 0.0);
    let charts = ["-bars.png", "-bars.svg", ".png", ".svg"].map(|end| format!("charts/coulomb-general-screen{end}"));
    let others = ["csv", "html", "json"].map(|ending| format!("coulomb-general-screen.{ending}"));
    assert_eq!(all_files(folder.path()), charts.into_iter().chain(others).collect::<BTreeSet<_>>());
    let csv = read(folder.path(), "coulomb-general-screen.csv");
    assert_eq!(csv.lines().count(), 1 + 8);
    assert!(csv.starts_with("output,unit,factor,rank,mu_star,mu_star_low,mu_star_high,mu,"));
}

#[test]
fn ishigami_is_read_as_what_it_is() {
    let (_folder, file, _) = screened("ishigami", &["--trajectories", "512"]);
    let factors = &file.outputs[0].factors;
    assert!(factors.iter().all(|factor| factor.reading == Some(Reading::NonLinearOrInteracting)));
    // By symmetry the effects of x2 and x3 have mean 0.
    for factor in &factors[1..] {
        let mu = factor.mu.unwrap();
        assert!(mu.estimate.abs() < 0.1 * factor.mu_star.unwrap().estimate, "{mu:?}");
    }
}

#[test]
fn designs_seeds_and_threads_do_what_they_say() {
    let csv = |more: &[&str]| read(screened("soft-cantilever", more).0.path(), "soft-cantilever-screen.csv");
    let plain = csv(&["--threads", "1"]);
    assert_eq!(plain, csv(&["--threads", "3"]));
    assert_eq!(plain, csv(&["--seed", "1"]), "the study's own seed");
    assert_ne!(plain, csv(&["--seed", "2"]));
    assert_ne!(plain, csv(&["--set", "design.sampler=random"]));
    let walk = csv(&["--design", "trajectory"]);
    assert_ne!(walk, plain);
    assert_eq!(walk, csv(&["--design", "trajectory", "--levels", "4", "--threads", "2"]));
    assert_ne!(walk, csv(&["--design", "trajectory", "--levels", "6"]));
    let (folder, file, _) = screened("soft-cantilever", &["--trajectories", "10"]);
    assert_eq!((file.provenance.trajectories, file.provenance.parts), (10, 5));
    assert_eq!(all_files(folder.path()).len(), 3 + 2 * 4);
    messages!().add("notes", &file.notes.join("\n"));
}

#[test]
fn failed_runs_are_reported_with_their_factors() {
    let more = ["--design", "trajectory", "--set", "outputs=['critical_force', 'critical_time']"];
    let (_folder, file, table) = screened("coulomb-environmental", &more);
    messages!().add_printed("failed runs", &table);
    let [force, time] = &file.outputs[..] else { panic!("two outputs") };
    assert!(force.failures.is_empty() && force.factors.iter().all(|factor| factor.dropped == 0));
    // The grid begins at velocity 0, where the particle never slips.
    assert!(time.factors.iter().all(|factor| factor.dropped > 0 && factor.effects + factor.dropped == 32));
    assert_eq!(time.failures[0].runs, file.provenance.failed_runs);
    assert_eq!(time.failures[0].first_inputs["velocity"], 0.0);
}

#[test]
fn a_model_outside_is_screened_in_three_steps() {
    let folder = Folder::new();
    let study = study_path("soft-cantilever");
    let out = folder.path("out");
    for (design, more) in [("radial", &[][..]), ("trajectory", &["--set", "design.seed=7"])] {
        let points = folder.path("points.csv");
        let sample = ["sample", text(&study), "--screening", design, "--trajectories", "12", "-o", text(&points)];
        succeed(&[&sample[..], more].concat());
        let outputs = folder.path(&format!("{design}.csv"));
        succeed(&["evaluate", text(&study), text(&points), "-o", text(&outputs)]);
        succeed(&["analyze", text(&outputs), "--design", text(&points), "--out", text(&out), "--force"]);
        let (_folder, here, _) =
            screened("soft-cantilever", &[&["--design", design, "--trajectories", "12"], more].concat());
        let file: ScreeningFile = serde_json::from_str(&read(&out, "soft-cantilever-screen.json")).unwrap();
        // The outputs were written in nN: the last bits differ.
        for (a, b) in file.outputs[0].factors.iter().zip(&here.outputs[0].factors) {
            let [a_mu, b_mu] = [a, b].map(|factor| factor.mu_star.unwrap());
            assert_eq!((&a.factor, a.rank, a.effects, a.reading), (&b.factor, b.rank, b.effects, b.reading));
            assert!((a_mu.estimate - b_mu.estimate).abs() <= 1e-12 * b_mu.estimate, "{design}: {a_mu:?} {b_mu:?}");
            assert!(
                (a_mu.interval.unwrap().high / b_mu.interval.unwrap().high - 1.0).abs() < 1e-9 || b_mu.estimate == 0.0
            );
        }
        assert_eq!(file.provenance.model_runs, here.provenance.model_runs);
    }
    let lines = read(&folder.path(""), "trajectory.csv");
    let short = folder.with("short.csv", lines.lines().take(9).collect::<Vec<_>>().join("\n"));
    let mut messages = messages!();
    let points = folder.path("points.csv");
    messages.refused(&["analyze", text(&short), "--design", text(&points), "--out", text(&out)]);
    messages.refused(&["sample", text(&study), "--screening", "--trajectories", "2"]);
}

#[test]
fn a_sweep_shows_curves_and_ranges() {
    let (folder, file, table) = swept("coulomb-general", &["--points", "11"]);
    assert_eq!((file.format.as_str(), file.version), ("apportion-sweep", 2));
    assert_eq!(json(&file), read(folder.path(), "coulomb-general-sweep.json"));
    assert_eq!(file.sweeps.len(), 8);
    let thickness = &file.sweeps[2];
    assert_eq!((thickness.values[0], thickness.values[10], thickness.values.len()), (0.25, 2.5, 11));
    // F is proportional to the stiffness, E w t^3 / (4 L^2 ..), except for the load on the contact: tenfold width, nearly tenfold force.
    let ends = |name: &str| {
        let sweep = file.sweeps.iter().find(|sweep| sweep.factor == name).unwrap();
        let y = &sweep.outputs[0];
        (libm::log(y.values[10].unwrap() / y.values[0].unwrap()), libm::log(sweep.values[10] / sweep.values[0]))
    };
    for (name, power) in [("width", 1.0), ("elastic_modulus", 1.0), ("thickness", 3.0), ("length", -2.0)] {
        let (force, factor) = ends(name);
        assert!((force / factor - power).abs() < 0.1, "{name}: {}", force / factor);
    }
    assert_eq!(all_files(folder.path()).len(), 3 + 2 * (8 + 1));
    assert_eq!(read(folder.path(), "coulomb-general-sweep.csv").lines().count(), 1 + 8 * 11);
    assert!(table.contains("631.3 nN"), "{table}");
    messages!().add_printed("sweep", &table);
}

#[test]
fn a_factor_asked_for_has_its_gaps() {
    let more = ["--factor", "velocity", "--points", "5", "--set", "outputs=['critical_time']", "--set"];
    let more = [&more[..], &["factor.velocity.min=0"]].concat();
    let (folder, file, table) = swept("coulomb-general", &more);
    let [velocity] = &file.sweeps[..] else { panic!("one sweep") };
    let time = &velocity.outputs[0];
    assert!(time.values[0].is_none() && time.values[1].is_some());
    assert_eq!(time.gaps.len(), 1);
    let mut messages = messages!();
    messages.add("the reason", &time.gaps[0].reason);
    messages.add_printed("sweep", &table);
    let csv = read(folder.path(), "coulomb-general-sweep.csv");
    assert_eq!(csv.lines().count(), 1 + 5);
    assert!(csv.contains("\nvelocity,nm/s,0,critical_time,s,,"), "{csv}");
}

#[test]
fn bad_requests_are_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let study = study_path("coulomb-general");
    let (out, mut messages) = (folder.path().join("out"), messages!());
    for (command, more) in [
        ("screen", &["--trajectories", "3"][..]),
        ("screen", &["--trajectories", "18446744073709551615"]),
        ("screen", &["--design", "trajectory", "--levels", "5"]),
        ("screen", &["--levels", "4"]),
        ("screen", &["--design", "star"]),
        ("screen", &["--seed", "-1"]),
        ("screen", &["--set", "factor.length.max=100"]),
        ("sweep", &["--factor", "thicknes"]),
        ("sweep", &["--points", "1"]),
        ("sweep", &["--factor", "length", "--factor", "length"]),
    ] {
        messages.refused(&[&[command, text(&study), "--out", text(&out)], more].concat());
        assert!(!out.exists(), "{command} {more:?}");
    }
}

#[test]
fn targets_are_checked_before_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let study = study_path("ishigami");
    for (command, blocked) in [("screen", "charts/ishigami-screen-bars.png"), ("sweep", "charts/ishigami-sweep-x2.svg")]
    {
        let out = folder.path().join(command);
        std::fs::create_dir_all(out.join(blocked)).unwrap();
        let output = apportion(&[command, text(&study), "--out", text(&out)]);
        assert_eq!(output.status.code(), Some(1));
        assert!(stderr(&output).contains(blocked), "{}", stderr(&output));
    }
}

#[test]
fn codes_for_missing_values_are_warned_of() {
    let folder = Folder::new();
    let study = folder.with(
        "s.toml",
        "model = \"expression\"\nfactors = { a = { min = 0, max = 1 }, b = { min = 0, max = 1 } }\n\
         outputs.y = \"if(a > 0.94, -9999, a + b)\"\n",
    );
    for (command, end) in [("screen", "screen"), ("sweep", "sweep")] {
        let out = folder.path(command);
        let said = succeed(&[command, text(&study), "--out", text(&out), "--charts", "none"]);
        let file: serde_json::Value = serde_json::from_str(&read(&out, &format!("s-{end}.json"))).unwrap();
        let warnings = if command == "screen" { &file["outputs"][0]["warnings"] } else { &file["warnings"] };
        assert!(warnings.to_string().contains("-9999"), "{command}: {file}");
        assert!(said.contains("-9999.0"), "{command}: {said}");
    }
}

#[test]
fn groups_step_at_once_and_constants_never() {
    let folder = Folder::new();
    let study = folder.with(
        "groups.toml",
        "model = \"expression\"\noutputs.y = \"a + 2*b + c*b\"\n[analysis]\nindices_of = \"groups\"\n[factors]\n\
         a = { min = 0, max = 1 }\nb = { min = 0, max = 1, group = \"g\" }\n\
         c = { distribution = \"constant\", value = 3, group = \"g\" }\nd = { distribution = \"constant\", value = 3 }\n",
    );
    let (_, file, _) = screened(text(&study).trim_end_matches(".toml"), &["--trajectories", "64", "--charts", "svg"]);
    assert_eq!(file.provenance.model_runs, 64 * 3);
    let [a, g] = &file.outputs[0].factors[..] else { panic!("{:?}", file.outputs[0].factors) };
    assert_eq!((&*a.factor, &*g.factor), ("a", "g"));
    let sizes = [a, g].map(|factor| factor.mu_star.unwrap().estimate);
    assert!((sizes[0] - 1.0).abs() < 1e-12 && (sizes[1] - 5.0).abs() < 1e-11, "{sizes:?}");
}
