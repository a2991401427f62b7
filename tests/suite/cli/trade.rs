//! `apportion trade`: comparison of settings.

use apportion_cli::trade::{Comparison, Measured};

use crate::common::{Folder, all_files, study_path, succeed, text};
use crate::messages::messages;

fn compared(study: &std::path::Path, out: &std::path::Path, more: &[&str]) -> Comparison {
    let arguments = ["trade", text(study), "--seconds", "4", "--seeds", "1", "--out", text(out)];
    succeed(&[&arguments[..], more].concat());
    let name = study.file_stem().unwrap().to_str().unwrap();
    serde_json::from_str(&std::fs::read_to_string(out.join(format!("{name}-trade.json"))).unwrap()).unwrap()
}

/// The front and the advice follow from the times and errors of the file.
#[track_caller]
fn assert_chosen(file: &Comparison) {
    let truth = file.truth.error.unwrap_or(f64::INFINITY);
    // Differences below the error of the reference count as equal.
    let error = |of: &Measured| of.error.map_or(f64::INFINITY, |error| error.max(truth));
    for (place, of) in file.settings.iter().enumerate() {
        let is_quicker = |(other, than): (usize, &Measured)| (than.seconds, other) < (of.seconds, place);
        let mut quicker = file.settings.iter().enumerate().filter(|one| is_quicker(*one));
        let is_best = error(of).is_finite() && quicker.all(|(_, than)| error(than) > error(of));
        assert_eq!(of.is_on_front, is_best, "{of:?}");
    }
    for advice in &file.advice {
        let reaches = |error: Option<f64>| error.is_some_and(|error| error + truth <= advice.accuracy);
        let on_front = file.settings.iter().filter(|of| of.is_on_front && reaches(of.error));
        let quickest = on_front.min_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let is_own = |of: &Measured| of.curve == file.own || of.curve == format!("{}, surrogates", file.own);
        // The study's own counts as equal to what is quicker and better by less than the noise.
        let is_alike = |of: &Measured, best: &Measured| of.seconds <= best.usual_seconds && reaches(of.least_error);
        let own = quickest
            .filter(|best| !is_own(best))
            .and_then(|best| file.settings.iter().find(|of| is_own(of) && is_alike(of, best)));
        assert_eq!(advice.setting.map(|place| &file.settings[place]), own.or(quickest), "{}", advice.accuracy);
    }
}

#[test]
fn a_function_with_exact_indices_is_compared_with_these() {
    let folder = Folder::new();
    let out = folder.path("out");
    let file = compared(&study_path("ishigami"), &out, &[]);
    assert_eq!((file.truth.error, file.truth.runs), (Some(0.0), 0));
    let curve = |name: &str| file.settings.iter().filter(|of| of.curve == name).collect::<Vec<_>>();
    let (plain, fitted) = (curve("the model"), curve("the model, surrogates"));
    assert!(plain.len() >= 2 && !fitted.is_empty() && !curve("random").is_empty());
    // 16 base samples do not determine the indices of Ishigami's function, a thousand do.
    assert!(plain[0].error.unwrap() > 0.1 && plain[0].runs == 16 * 5);
    let cheapest = file.advice[0].setting.unwrap();
    assert!(file.settings[cheapest].error.unwrap() <= 0.1);
    assert_chosen(&file);
    // The lines are those of a study.
    let study = format!("model = \"ishigami\"\n{}", file.settings[cheapest].lines);
    let study = apportion_files::parse_study(&study, std::path::Path::new("pasted.toml"), &[]).unwrap();
    assert_eq!(study.design().settings().base_samples, file.settings[cheapest].base_samples);
    let files = all_files(&out);
    for name in ["ishigami-trade.html", "ishigami-trade.csv", "charts/ishigami-trade.svg"] {
        assert!(files.contains(name), "{files:?}");
    }
}

#[test]
fn the_rungs_of_a_ladder_are_compared_with_the_finest() {
    let folder = Folder::new();
    let file = compared(&study_path("lugre-environmental"), &folder.path("out"), &["--charts", "none"]);
    assert!(file.truth.error.unwrap() > 0.0, "{:?}", file.truth);
    assert!(file.truth.words.contains("1e-9"), "{}", file.truth.words);
    assert_chosen(&file);
    let (march, long) = ("fixed-step, step 1e-5 s", "dynamic, tolerance 1e-3");
    for rung in ["closed-form", "quasi-static", "fixed-step", march, long, "dynamic"] {
        assert!(file.settings.iter().any(|of| of.curve == rung && of.error.is_some()), "{rung}");
    }
    let marched = file.settings.iter().find(|of| of.curve == march).unwrap();
    assert!(marched.lines.contains("fidelity = \"fixed-step\"\nstep = \"1e-5 s\""), "{}", marched.lines);
    let pasted = file.settings.iter().find(|of| of.curve == "dynamic, tolerance 1e-3").unwrap();
    assert!(pasted.lines.contains("fidelity = \"dynamic\"\ntolerance = 1e-3"), "{}", pasted.lines);
}

#[test]
fn options_that_contradict_each_other_are_refused() {
    let study = study_path("ishigami");
    let mut messages = messages!();
    for more in [&["--quick", "--seconds", "3"][..], &["--seconds", "0"]] {
        messages.refused(&[&["trade", text(&study)], more].concat());
    }
}
