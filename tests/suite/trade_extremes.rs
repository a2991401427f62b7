//! The map of extremes: no study has a number that is wrong without a word.

use std::path::{Path, PathBuf};

use apportion::Study;
use apportion::trade::extremes::{Extremes, ExtremesFile, ExtremesJob, ExtremesSettings, Kind, Outcome, extremes};

use crate::common::{all_files, apportion, stderr, study_path, succeed, text};

/// Every study of this repository.
fn studies() -> Vec<PathBuf> {
    let entries = |folder: &Path| -> Vec<PathBuf> {
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
    };
    let folder = study_path("any").parent().unwrap().to_owned();
    let (folders, files): (Vec<PathBuf>, Vec<PathBuf>) = entries(&folder).into_iter().partition(|path| path.is_dir());
    let inner = folders.iter().flat_map(|folder| entries(folder));
    let mut all: Vec<PathBuf> = files.into_iter().chain(inner).collect();
    all.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    all.sort();
    all
}

/// Few enough steps that a hopeless march far outside of any laboratory ends soon.
const STEPS: &str = "afm.step_budget=20000";

fn loaded(path: &Path) -> Study {
    let text = std::fs::read_to_string(path).unwrap();
    let changes = if text.contains("[afm]") { vec![STEPS.to_owned()] } else { Vec::new() };
    Study::load(path, &changes).unwrap()
}

fn map_of(study: &Study, settings: ExtremesSettings) -> Extremes {
    extremes(&ExtremesJob { settings, ..ExtremesJob::new(study) }).unwrap()
}

#[track_caller]
fn assert_no_fourth_colour(name: &str, map: &Extremes) {
    let wrong: Vec<_> = map.reasons.iter().filter(|reason| reason.outcome == Outcome::Wrong).collect();
    assert!(wrong.is_empty() && map.counts().wrong == 0, "{name}: {wrong:#?}");
    // Who refuses or flags says why.
    assert!(map.reasons.iter().all(|reason| reason.reason.len() > 10), "{name}: {:#?}", map.reasons);
    let said: u64 = map.reasons.iter().map(|reason| reason.count).sum();
    assert_eq!(said + map.counts().right, map.counts().total(), "{name}");
}

#[test]
fn no_study_has_a_fourth_colour() {
    let mut seen = 0;
    for path in studies() {
        let study = loaded(&path);
        // The program refuses to map dependent factors.
        if !study.space().dependences().is_empty() {
            continue;
        }
        let own = ExtremesSettings::of(&study);
        let settings = ExtremesSettings { points: own.points / 6, max_runs: own.max_runs.min(1 << 9), ..own };
        let map = match extremes(&ExtremesJob { settings, ..ExtremesJob::new(&study) }) {
            Ok(map) => map,
            // Not every machine has numpy.
            Err(error) if error.to_string().contains("numpy") => continue,
            Err(error) => panic!("{}: {error}", study.name()),
        };
        assert_no_fourth_colour(study.name(), &map);
        let at = |kind: Kind| map.kinds.iter().find(|(other, _)| *other == kind).map_or(0, |(_, tally)| tally.total());
        assert!(Kind::ALL.iter().all(|kind| at(*kind) > 0), "{}: {:?}", study.name(), map.kinds);
        // Most of what is near the bounds has an answer, and long designs are planned, not run.
        let sides = map.kinds.iter().find(|(kind, _)| *kind == Kind::Sides).unwrap().1;
        assert!(sides.refused * 2 <= sides.total(), "{}: {sides:?}", study.name());
        assert!(map.reasons.iter().any(|reason| reason.kind == Kind::Length && reason.reason.contains("max_runs")));
        seen += 1;
    }
    assert!(seen > 20, "{seen} studies");
}

#[test]
fn other_seeds_find_nothing_either() {
    for name in ["lugre-general", "coulomb-general", "hk-environmental", "soft-cantilever", "cantilever-formula"] {
        let study = loaded(&study_path(name));
        for seed in 1..=2 {
            let settings = ExtremesSettings { points: 150, max_runs: 512, seed };
            assert_no_fourth_colour(name, &map_of(&study, settings));
        }
    }
}

#[test]
fn the_map_is_the_same_in_every_bit_on_any_threads() {
    let study = Study::load(&study_path("hk-general"), &[]).unwrap();
    let settings = ExtremesSettings { points: 60, max_runs: 512, seed: 5 };
    let on = |threads| extremes(&ExtremesJob { settings, threads, ..ExtremesJob::new(&study) }).unwrap();
    // Values that are not numbers are none here, so that maps that are alike are equal.
    assert_eq!(on(1), on(3));
}

/// A number that is wrong is found: a formula of which doubles keep no digit is flagged, and one whose error is larger than
/// rounding can be would be wrong.
#[test]
fn cancellation_and_underflow_are_flagged() {
    let source = r#"
        model = "expression"
        outputs.difference = "(x + 1e9) - 1e9"
        outputs.ratio = "x^2*1e-300/(x*1e-300)"
        outputs.plain = "x*y + 1"
        [[factor]]
        name = "x"
        min = 1e-3
        max = 1
        [[factor]]
        name = "y"
        min = 1
        max = 2
    "#;
    let study = Study::parse(source, Path::new("lost.toml"), &[]).unwrap();
    let map = map_of(&study, ExtremesSettings { points: 100, max_runs: 512, seed: 0 });
    assert_no_fourth_colour("lost", &map);
    let flagged = |output: &str| {
        let of_model = map.reasons.iter().filter(|reason| !reason.example.inputs.is_empty());
        let mut digits =
            of_model.filter(|reason| reason.outcome == Outcome::Flagged && reason.reason.contains("rounding"));
        digits.any(|reason| reason.example.output == output)
    };
    assert!(flagged("difference"), "{:#?}", map.reasons);
    let refused = map.reasons.iter().any(|reason| reason.outcome == Outcome::Refused && reason.reason.contains("NaN"));
    assert!(refused, "{:#?}", map.reasons);
}

#[test]
fn a_code_model_that_is_off_by_itself_is_not_called_right() {
    let source = apportion::function_model("y", |x| x[0] * 2.0);
    let study = Study::builder("code", source)
        .factor("x", apportion::Distribution::uniform(0.0, 1.0).unwrap())
        .base_samples(64)
        .build()
        .unwrap();
    let map = map_of(&study, ExtremesSettings { points: 50, max_runs: 512, seed: 0 });
    let of_model = map.kinds.iter().filter(|(kind, _)| *kind <= Kind::Together);
    assert!(of_model.clone().all(|(_, tally)| tally.right == 0 && tally.flagged > 0), "{:?}", map.kinds);
    assert!(map.second.is_err());
}

#[test]
fn the_command_writes_a_page_a_file_and_points_that_can_be_evaluated() {
    let folder = tempfile::tempdir().unwrap();
    let study = study_path("flood");
    let out = text(folder.path());
    let table = succeed(&["trade", text(&study), "--extremes", "--cells", "100", "--out", out, "--charts", "svg"]);
    assert!(table.contains("none is wrong without a word"), "{table}");
    let names = all_files(folder.path());
    for name in ["flood-extremes.html", "flood-extremes.json", "flood-extremes.csv", "charts/flood-extremes-above.svg"]
    {
        assert!(names.contains(name), "{name} is not among {names:?}");
    }
    let json = std::fs::read_to_string(folder.path().join("flood-extremes.json")).unwrap();
    let file: ExtremesFile = serde_json::from_str(&json).unwrap();
    assert_eq!((file.format.as_str(), file.version, file.counts.wrong), ("apportion-extremes", 1, 0));
    let total: u64 = file.kinds.iter().map(|kind| kind.counts.right).sum();
    assert_eq!(total, file.counts.right);
    assert_eq!(file.grids[0].cells.len(), 8);
    let points = folder.path().join("flood-extremes-points.csv");
    let outputs = folder.path().join("again.csv");
    succeed(&["evaluate", text(&study), text(&points), "-o", text(&outputs)]);
    let lines = std::fs::read_to_string(&outputs).unwrap().lines().count();
    assert_eq!(lines, 1 + file.reasons.iter().filter(|reason| !reason.inputs.is_empty()).count());
}

#[test]
fn options_of_the_map_need_the_map() {
    let output = apportion(&["trade", text(&study_path("flood")), "--cells", "5"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--extremes"), "{}", stderr(&output));
}
