//! The schemas accept the files that the program reads and writes, and refuse those that it refuses.

use std::path::PathBuf;

use jsonschema::Validator;
use serde_json::{Value, json};

use crate::common::{FAMILIES, analysed, apportion, stderr, stdout, study_path};

fn validator(kind: &str) -> Validator {
    let output = apportion(&["schema", kind]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let schema: Value = serde_json::from_str(&stdout(&output)).unwrap();
    jsonschema::draft7::meta::validate(&schema).unwrap();
    jsonschema::draft7::new(&schema).unwrap()
}

fn complaints(validator: &Validator, value: &Value) -> Vec<String> {
    validator.iter_errors(value).map(|error| format!("{}: {error}", error.instance_path())).collect()
}

/// A study file as the JSON that a schema is about.
fn study(text: &str) -> Value {
    serde_json::to_value(toml::from_str::<toml::Table>(text).unwrap()).unwrap()
}

#[test]
fn every_study_of_the_repository_fits_the_schema() {
    let validator = validator("study");
    let folder = study_path("any").parent().unwrap().to_owned();
    let entries = |folder: PathBuf| std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut seen = 0;
    let inner = entries(folder.clone()).filter(|path| path.is_dir()).flat_map(entries);
    for path in entries(folder).chain(inner) {
        if path.extension().is_some_and(|ending| ending == "toml") {
            let value = study(&std::fs::read_to_string(&path).unwrap());
            assert_eq!(complaints(&validator, &value), Vec::<String>::new(), "{}", path.display());
            seen += 1;
        }
    }
    assert!(seen > 10, "{seen} studies");
}

#[test]
fn a_study_of_all_families_fits_the_schema() {
    let validator = validator("study");
    // JSON has no infinity.
    let text = FAMILIES.replace("inf]", "1e9]").replace("[-inf", "[-1e9");
    assert_eq!(complaints(&validator, &study(&text)), Vec::<String>::new());
    for wrong in
        ["truncate = [1]", "quantiles = [1, 2]", "components = []", "components = [{ name = \"x\" }]", "df = \"x\""]
    {
        let value = study(&format!("[factors.x]\n{wrong}"));
        assert_ne!(complaints(&validator, &value), Vec::<String>::new(), "{wrong}");
    }
}

#[test]
fn new_studies_of_all_models_fit_the_schema() {
    let (validator, folder) = (validator("study"), tempfile::tempdir().unwrap());
    for model in apportion_files::ModelKind::all() {
        let path = folder.path().join(format!("{}.toml", model.name));
        let output = apportion(&["new", path.to_str().unwrap(), "--model", model.name]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let value = study(&std::fs::read_to_string(&path).unwrap());
        assert_eq!(complaints(&validator, &value), Vec::<String>::new(), "{}", model.name);
    }
}

/// The schema refuses the keys and names that the program refuses.
#[test]
fn wrong_keys_names_and_types_are_refused() {
    let validator = validator("study");
    for wrong in [
        "model = \"ishigam\"",
        "titel = \"x\"",
        "outputs = []",
        "[design]\nsampler = \"halton\"",
        "[design]\nbase_samples = -1",
        "[design]\nbase_samples = \"many\"",
        "accuracy = 0",
        "[design]\ntarget = 0.1",
        "[analysis]\nthreshold = 2",
        "[analysis]\nestimators = [\"jansn\"]",
        "[analysis]\nsubsets = [\"x1\"]",
        "[analysis]\nresamples = 1",
        "[afm]\nfriction = \"dry\"",
        "[afm]\nlength = 225",
        "[afm]\nlenght = \"225 um\"",
        "[function]\na = \"1\"",
        "[factor]\nmin = 1\nmax = 2",
        "[factor.length]\nmin = 1",
        "factors = [\"length\"]",
        "[factors.length]\nmim = 1",
        "[[factor]]\nmin = 1",
        "[[factor]]\nname = \"length\"\ndistribution = \"gauss\"",
        "[[factor]]\nname = \"length\"\nminimum = 1",
        "[[factor]]\nname = \"length\"\nmin = \"1\"",
    ] {
        assert!(!validator.is_valid(&study(wrong)), "{wrong}");
        let path = std::path::Path::new("wrong.toml");
        assert!(apportion_files::parse_study(wrong, path, &[]).is_err(), "{wrong}");
    }
}

/// Editors show a sentence for every key.
#[test]
fn every_key_of_a_study_is_described() {
    let schema: Value = serde_json::from_str(&stdout(&apportion(&["schema", "study"]))).unwrap();
    let tables = schema["definitions"].as_object().unwrap().values().chain([&schema]);
    let mut seen = 0;
    for (key, property) in tables.filter_map(|table| table["properties"].as_object()).flatten() {
        assert!(property["description"].as_str().is_some_and(|text| text.len() > 10), "{key}: {property}");
        seen += 1;
    }
    assert!(seen > 40, "{seen} keys");
}

#[test]
fn results_fit_the_schema() {
    let validator = validator("result");
    let more = "analysis.subsets=[['x1','x2']]";
    for (name, overrides) in [
        (
            "ishigami-second-order",
            vec!["design.base_samples=256", "analysis.estimators=['jansen']", "analysis.dummy=true", more],
        ),
        (
            "lugre-dimensional",
            vec![
                "design.base_samples=64",
                "afm.fidelity=auto",
                "outputs=['critical_force','critical_time']",
                "analysis.aggregate=true",
            ],
        ),
        ("sobol-g-target", vec!["design.max_runs=4096"]),
        ("coulomb-general", vec!["design.base_samples=64"]),
    ] {
        let result = analysed(name, &overrides);
        let value: Value = serde_json::from_str(&result.json()).unwrap();
        assert_eq!(complaints(&validator, &value), Vec::<String>::new(), "{name}");
        for (pointer, wrong) in [
            ("/format", json!("apportion-sweep")),
            ("/version", json!(2)),
            ("/outputs/0/indices/0/total", json!("large")),
            ("/provenance/seed", json!(-1)),
            ("/factors", json!(null)),
        ] {
            let mut changed = value.clone();
            *changed.pointer_mut(pointer).unwrap() = wrong;
            assert!(!validator.is_valid(&changed), "{pointer}");
        }
    }
}

/// Editors know every form that is read.
#[test]
fn the_forms_of_factors_and_outputs_fit_the_schema() {
    let validator = validator("study");
    for form in [
        "[factors]\na = { min = 0, max = 1 }",
        "[[factor]]\nname = \"a\"\nmin = 0\nmax = 1",
        "outputs.y = \"x1\"",
        "outputs = [\"y\"]",
    ] {
        assert_eq!(complaints(&validator, &study(form)), Vec::<String>::new(), "{form}");
    }
    for form in ["factors.a = { mim = 0 }", "factors.a = 3", "[factor]\nmin = 1", "outputs = \"y\""] {
        assert!(!validator.is_valid(&study(form)), "{form}");
    }
}
