//! Changes to the text of a study file, `--set KEY=VALUE`.

use apportion_files::{StudyError, edited};

const STUDY: &str = "outputs = ['y'] # kept\n[afm]\nfriction = \"coulomb\"\n[[factor]]\nname = \"length\"\nmin = 1\n";

/// The text after a change, or what is wrong with the change.
fn changed(study: &str, change: &str) -> Result<String, String> {
    edited(study, &[change.to_owned()]).map_err(|error| match error {
        StudyError::Override { text, problem } if text == change => problem,
        other => panic!("{other}"),
    })
}

fn applied(change: &str) -> Result<String, String> {
    changed(STUDY, change)
}

#[test]
fn values_are_replaced_in_place_and_new_ones_added() {
    assert_eq!(applied("afm.friction=hk"), Ok(STUDY.replace("\"coulomb\"", "\"hk\"")));
    assert_eq!(applied("factor.length.min=2.5"), Ok(STUDY.replace("min = 1", "min = 2.5")));
    assert!(applied("design.base_samples = 64").unwrap().contains("[design]\nbase_samples = 64"));
    assert!(applied("outputs=[\"a\", \"b\"]").unwrap().contains("[\"a\", \"b\"]"));
    assert!(applied("afm.preload_angle=0.5 deg").unwrap().contains("preload_angle = \"0.5 deg\""));
}

#[test]
fn a_factor_is_replaced_or_fixed() {
    let replaced = applied("factor.length={ distribution = 'normal', mean = 3, name = 'no' }").unwrap();
    assert!(replaced.ends_with("[[factor]]\nname = \"length\"\ndistribution = 'normal'\nmean = 3\n"), "{replaced}");
    let fixed = applied("factor.length=450 um").unwrap();
    assert_eq!(fixed, "outputs = ['y'] # kept\n[afm]\nfriction = \"coulomb\"\nlength = \"450 um\"\n");
    let table = "model = \"expression\"\n[factors]\na = { min = 1 }\nb = { min = 2 }\n";
    let fixed = changed(table, "factor.a=0.5").unwrap();
    assert!(fixed.contains("[expression.constants]\na = 0.5"), "{fixed}");
    assert!(!fixed.contains("min = 1") && fixed.contains('b'), "{fixed}");
}

#[test]
fn only_one_key_sets_the_length_of_a_run() {
    let text = "accuracy = 0.1\n[design]\nmax_runs = 9\n";
    let applied = |change: &str| changed(text, change).unwrap();
    assert_eq!(applied("design.runs=300"), "[design]\nruns = 300\n");
    assert_eq!(applied("accuracy=0.2"), text.replace("0.1", "0.2"));
}

#[test]
fn invalid_overrides_are_named() {
    // 30,000 parts used to take more than a minute.
    let long = format!("{}=1", ["a"; 30_000].join("."));
    let mut messages =
        ["=3", "afm.friction.x=3", "factor.width=1", &long].map(|text| applied(text).unwrap_err()).to_vec();
    for (study, change) in
        [("outputs.y = 'x1'\n", "outputs=['y']"), ("model = 'ishigami'\n[factors.x1]\nmin = 0\n", "factor.x1=0.5")]
    {
        messages.push(changed(study, change).unwrap_err());
    }
    insta::assert_snapshot!(messages.join("\n"));
}
