use std::path::Path;

use super::*;
use crate::model::KnownAnswer;
use crate::study::Study;
use crate::study::file::models::template;

fn studied(request: &TemplateRequest) -> Study {
    let text = template(request).unwrap_or_else(|problem| panic!("{request:?}: {problem}"));
    let study = Study::parse(&text, Path::new("new.toml"), &[]);
    let study = study.unwrap_or_else(|error| panic!("{request:?}: {error}\n{text}"));
    assert!(study.notes.is_empty(), "{:?}", study.notes);
    study
}

fn request(model: ModelKind) -> TemplateRequest {
    TemplateRequest { model, title: None, factors: Vec::new(), outputs: Vec::new() }
}

#[test]
fn every_model_has_a_study_to_begin_with() {
    for model in ModelKind::all() {
        let study = studied(&request(model));
        assert_eq!(study.subject.name(), model.name);
        assert!(!study.space.factors().is_empty());
    }
}

#[test]
fn every_input_can_be_a_factor_and_every_output_asked_for() {
    for model in ModelKind::all() {
        let outputs: Vec<String> = model.outputs().iter().map(|output| output.name.to_string()).collect();
        for input in model.inputs() {
            let study = studied(&TemplateRequest {
                factors: vec![input.name.clone()],
                outputs: outputs.clone(),
                title: Some("a \"quoted\" \\ title\nof two lines".to_owned()),
                ..request(model)
            });
            assert_eq!(study.space.factors()[0].name, input.name);
            let model = study.model();
            let values: usize = model.series().iter().map(|series| series.places().len()).sum();
            assert_eq!(model.outputs().len() - values + model.series().len(), outputs.len());
            assert_eq!(study.title.as_deref(), Some("a \"quoted\" \\ title\nof two lines"));
        }
    }
}

/// What the comments say of choices and parameters is true: without its comments a study means the same.
#[test]
fn choices_and_parameters_are_those_in_force() {
    let plain =
        Study::parse("[[factor]]\nname = \"length\"\nmin = 1\nmax = 2\nunit = \"um\"", Path::new("plain.toml"), &[]);
    assert_eq!(studied(&request(ModelKind::AFM)).settings(), plain.unwrap().settings());
    for model in KnownAnswer::all().map(ModelKind::from_known) {
        let text = template(&request(model)).unwrap();
        let told = text.lines().skip_while(|line| *line != "[function]").take_while(|line| !line.is_empty());
        let said: String = told.map(|line| line.trim_start_matches("# ").to_owned() + "\n").collect();
        // A list says how many inputs there are; `dimension` beside it is refused.
        let lines = said.lines().filter(|line| !(line.starts_with("dimension") && said.contains(" = [")));
        let said: Vec<&str> = lines.collect();
        let text = format!("model = \"{}\"\n{}", model.name, said.join("\n"));
        let study = Study::parse(&text, Path::new("said.toml"), &[]);
        let study = study.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(study.settings(), studied(&request(model)).settings());
        assert_eq!(study.constants(), studied(&request(model)).constants());
    }
}

#[test]
fn unknown_and_repeated_names_are_refused() {
    let with = |factors: &[&str], outputs: &[&str]| {
        let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        template(&TemplateRequest { factors: owned(factors), outputs: owned(outputs), ..request(ModelKind::AFM) })
    };
    assert_eq!(with(&["lenght"], &[]).unwrap_err().to_string(), "unknown factor `lenght`: did you mean `length`?");
    assert!(matches!(with(&["length", "length"], &[]), Err(Problem::Repeated { what: "factor", .. })));
    assert!(matches!(with(&[], &["force"]), Err(Problem::UnknownName { what: "output", .. })));
}

#[test]
fn names_are_written_as_toml_has_them() {
    for model in [ModelKind::EXPRESSION, ModelKind::COMMAND, ModelKind::EXTERNAL] {
        let outputs = ["y 1", "\"y\"", "\u{3bc}"].map(str::to_owned).to_vec();
        let study = studied(&TemplateRequest { outputs: outputs.clone(), ..request(model) });
        let found: Vec<String> = study.model().outputs().iter().map(|output| output.name.to_string()).collect();
        assert_eq!(found, outputs, "{model:?}");
        assert_eq!(study.title, None, "what the model is says nothing of the study");
    }
    let titled = TemplateRequest { title: Some("A \"title\"".to_owned()), ..request(ModelKind::COMMAND) };
    assert_eq!(studied(&titled).title.as_deref(), Some("A \"title\""));
}

#[test]
fn a_range_behind_a_name_asks_for_a_series() {
    for model in [ModelKind::COMMAND, ModelKind::EXTERNAL] {
        let outputs = ["peak", "infected[0..60]"].map(str::to_owned).to_vec();
        let request = TemplateRequest { outputs, ..request(model) };
        let study = studied(&request);
        let model = study.model();
        let series = model.series();
        assert_eq!((series.len(), series[0].name.as_str(), series[0].places()), (1, "infected", 1..61));
        let program = new_program(&request).unwrap();
        assert!(program.is_none_or(|program| program.contains("print(number, y, *[y for index in range(60)], sep")));
    }
}
