//! The numbers of every study at the extremes of its inputs: right, flagged, refused, never silently wrong, see
//! `docs/background/extremes.md`.

mod afm_second;
mod formulas;
mod judge;
mod map;
mod placement;
mod points;
mod precise;

use std::path::{Path, PathBuf};

use apportion::Study;
use judge::{Reference, extremes};
use map::{Extremes, Outcome};

use crate::common::study_path;
use crate::messages::messages;

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

/// A small number of steps, so that hopeless integrations of extreme scenes end soon.
const STEPS: &str = "afm.step_budget=20000";

fn loaded(path: &Path) -> Study {
    let text = std::fs::read_to_string(path).unwrap();
    let changes = if text.contains("[afm]") { vec![STEPS.to_owned()] } else { Vec::new() };
    apportion_files::load_study(path, &changes).unwrap()
}

fn map_of(study: &Study, points: u64, seed: u64) -> Extremes {
    extremes(study, points, seed).unwrap()
}

#[track_caller]
fn assert_nothing_is_silently_wrong(name: &str, map: &Extremes) {
    let wrong: Vec<_> = map.reasons.iter().filter(|reason| reason.outcome == Outcome::Wrong).collect();
    assert!(wrong.is_empty() && map.counts.wrong == 0, "{name}: {wrong:#?}");
    // Every flag and every refusal has a reason.
    assert!(map.reasons.iter().all(|reason| reason.reason.len() > 10), "{name}: {:#?}", map.reasons);
    let explained: u64 = map.reasons.iter().map(|reason| reason.count).sum();
    assert_eq!(explained + map.counts.right, map.counts.total(), "{name}");
}

#[test]
fn no_study_is_silently_wrong() {
    let mut seen = 0;
    for path in studies() {
        let study = loaded(&path);
        if !study.space().dependences().is_empty() {
            continue;
        }
        let points = if study.model().concurrency().is_some() { 3 } else { 12 };
        let map = match extremes(&study, points, study.design().settings().seed) {
            Ok(map) => map,
            // Not every machine has numpy.
            Err(error) if error.contains("numpy") => continue,
            Err(error) => panic!("{}: {error}", study.name()),
        };
        assert_nothing_is_silently_wrong(study.name(), &map);
        assert!(map.kinds.iter().all(|(_, tally)| tally.total() > 0), "{}: {:?}", study.name(), map.kinds);
        seen += 1;
    }
    assert!(seen > 20, "{seen} studies");
}

#[test]
fn other_seeds_find_no_wrong_numbers() {
    for name in ["lugre-general", "coulomb-general", "hk-environmental", "soft-cantilever", "cantilever-formula"] {
        let study = loaded(&study_path(name));
        for seed in 1..=2 {
            assert_nothing_is_silently_wrong(name, &map_of(&study, 150, seed));
        }
    }
}

/// A formula of which doubles keep no digit is flagged.
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
    let study = apportion_files::parse_study(source, Path::new("lost.toml"), &[]).unwrap();
    let map = map_of(&study, 100, 0);
    assert_nothing_is_silently_wrong("lost", &map);
    assert!(map.counts.right > 100, "{:?}", map.counts);
    let has = |outcome: Outcome, output: &str| {
        map.reasons.iter().any(|reason| reason.outcome == outcome && reason.output == output)
    };
    assert!(has(Outcome::Flagged, "difference") && has(Outcome::Refused, "ratio"), "{:#?}", map.reasons);
    let reasons = map.reasons.iter().map(|of| format!("{} {:?}: {}", of.output, of.outcome, of.reason));
    messages!().add("the reasons", &reasons.collect::<Vec<_>>().join("\n"));
}

#[test]
fn numbers_of_a_model_in_code_are_flagged_and_not_called_right() {
    let source = apportion::function_model("y", |x| x[0] * 2.0);
    let study = Study::builder("code", source)
        .factor("x", apportion::Distribution::uniform(0.0, 1.0).unwrap())
        .base_samples(64)
        .build()
        .unwrap();
    let map = map_of(&study, 50, 0);
    assert!(map.counts.right == 0 && map.counts.flagged > 0, "{:?}", map.counts);
    assert!(map.second_calculation.is_none());
}

/// A number may differ by what is stated, and is right within the tolerance only.
#[test]
fn a_number_agrees_within_what_is_stated() {
    let reference = Reference { value: 2.0, stated: Some(0.1), tolerance: 1e-3, floor: 1e-6, covered: "" };
    assert_eq!(reference.agrees(2.001), Some(true));
    assert_eq!(reference.agrees(2.05), Some(false));
    assert_eq!(reference.agrees(2.2), None);
    let certain = Reference { stated: Some(0.0), ..reference };
    assert_eq!(certain.agrees(2.000_001), Some(true));
    assert_eq!(certain.agrees(2.000_01), None);
    assert_eq!(Reference { stated: None, ..reference }.agrees(2.2), Some(false));
    assert_eq!(Reference { value: f64::INFINITY, ..reference }.agrees(1e300), None);
    assert_eq!(Reference { value: 1e-323, stated: Some(0.0), ..reference }.agrees(0.0), Some(true));
}

/// A model with every outcome but a wrong number: flags, refusals and error estimates.
#[test]
fn every_outcome_has_its_case() {
    let map = map_of(&loaded(&study_path("lugre-environmental-viscous")), 40, 0);
    let of = |outcome| map.reasons.iter().filter(move |reason| reason.outcome == outcome).map(|reason| &*reason.reason);
    assert!(of(Outcome::FlaggedConfirmed).all(|reason| reason.starts_with("flags of the model: ")));
    assert!(of(Outcome::Refused).all(|reason| !reason.contains("flags of the model")));
    assert!(of(Outcome::Flagged).any(|reason| reason.starts_with("flags of the model: ")));
    let counts = [Outcome::Right, Outcome::FlaggedConfirmed, Outcome::Flagged, Outcome::Refused];
    assert!(counts.iter().all(|outcome| map.counts.count(*outcome) > 0), "{:?}", map.counts);
}
