//! Requests and their answers.

use std::path::Path;

use apportion::Study;
use apportion::result::StudyResult;
use apportion_files::{ModelKind, StudyError, edited};
use apportion_report::document::{DataFile, symbols};
use apportion_report::{Subject, output_document, run_document};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

/// What a page can ask of a study: its `text`, with `changes` as those of the program's `--set`.
#[derive(Debug, Deserialize)]
pub struct Request {
    /// What is wanted of it.
    #[serde(flatten)]
    pub wanted: Wanted,
    /// A study file.
    pub text: String,
    /// Changes to it, in order.
    #[serde(default)]
    pub changes: Vec<String>,
}

/// What is wanted.
#[derive(Debug, Deserialize)]
#[serde(tag = "wanted", rename_all = "kebab-case")]
pub enum Wanted {
    /// The factors, choices and outputs of the study.
    Description,
    /// The text with the changes made.
    Text,
    /// A run: its lead and these sections of its document, with one output alone.
    Run {
        /// Anchors of sections.
        sections: Vec<String>,
        /// The output; the first one if none is named.
        #[serde(default)]
        output: Option<String>,
    },
    /// A run: its files for programs, and its charts as SVG.
    Files,
}

/// An answer, or why there is none.
#[derive(Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Answer {
    /// What was asked for.
    Done(Value),
    /// What is wrong with the study, in words for people.
    Refused(String),
}

/// The answer to a request, both as JSON.
pub fn answer(request: &[u8]) -> String {
    let answer = serde_json::from_slice::<Request>(request).map_err(|error| error.to_string());
    let answer = match answer.and_then(|request| request.answer()) {
        Ok(value) => Answer::Done(value),
        Err(words) => Answer::Refused(words),
    };
    // Serialisation fails on maps without text keys only, of which there is none.
    serde_json::to_string(&answer).unwrap_or_default()
}

impl Request {
    fn answer(&self) -> Result<Value, String> {
        match &self.wanted {
            Wanted::Text => edited(&self.text, &self.changes).map(Value::from).map_err(|error| in_words(&error)),
            Wanted::Description => self.study().map(|study| description(&study)),
            Wanted::Run { sections, output } => {
                let result = self.result()?;
                Ok(view(&result, Subject::find(&result, output.as_deref()), sections))
            }
            Wanted::Files => {
                let document = run_document(&self.result()?);
                let files = document.data_files();
                let files = files.iter().map(|file| {
                    let DataFile { name, text } = &**file;
                    (name.clone(), Value::from(text.as_str()))
                });
                let charts = document
                    .figures()
                    .into_iter()
                    .map(|figure| (format!("{}.svg", figure.stem), Value::from(figure.chart.svg())));
                Ok(Value::Object(files.chain(charts).collect()))
            }
        }
    }

    fn study(&self) -> Result<Study, String> {
        let study = apportion_files::parse_study(&self.text, Path::new("study.toml"), &self.changes);
        study.map_err(|error| in_words(&error))
    }

    fn result(&self) -> Result<StudyResult, String> {
        let study = self.study()?;
        study.run().map_err(|error| error.to_string())
    }
}

/// What is wrong, without its place in a file: who reads it has a page of fields.
fn in_words(error: &StudyError) -> String {
    match error {
        StudyError::Unreadable { .. } => error.to_string(),
        StudyError::Override { problem, .. } => problem.to_string(),
        StudyError::Invalid(diagnostic) => diagnostic.problem.to_string(),
    }
}

/// What is shown of a result: its lead and some sections as HTML, and the indices for those who read numbers.
fn view(result: &StudyResult, subject: Option<Subject<'_>>, sections: &[String]) -> Value {
    let ids: Vec<&str> = sections.iter().map(String::as_str).collect();
    let document = output_document(result, subject).excerpt(&ids);
    let section = |id: &String| {
        let html = document.section_html(id)?;
        let title = document.sections.iter().find(|section| section.id == *id).map(|section| symbols(&section.title));
        Some(json!({ "id": id, "title": title, "html": html }))
    };
    let sections: Vec<Value> = sections.iter().filter_map(section).collect();
    json!({
        "lead": document.lead.iter().map(|text| symbols(text)).collect::<Vec<_>>(),
        "plain_lead": document.lead,
        "sections": sections,
        "percentages": percentages(subject),
        "runs": result.provenance.model_runs,
        "base_samples": result.provenance.base_samples,
    })
}

/// Of a series, or an output, by factor: 100 S_T as far as it is known.
fn percentages(subject: Option<Subject<'_>>) -> Value {
    let percent = |x: f64| json!({ "total": x.is_finite().then_some(100.0 * x) });
    let entries = match subject {
        Some(Subject::Series(series)) => {
            let indices = series.indices.iter().flatten();
            indices.map(|index| (index.name.clone(), percent(index.effect.total.estimate))).collect()
        }
        Some(Subject::Output(output)) => {
            let indices = output.indices.iter().flatten();
            indices.map(|index| (index.name.clone(), percent(index.effect.total.estimate))).collect()
        }
        None => Map::new(),
    };
    Value::Object(entries)
}

/// What a page needs to offer a study for changes.
fn description(study: &Study) -> Value {
    let setup = study.setup();
    let kind = ModelKind::from_name(&setup.model);
    let inputs = kind.map(ModelKind::inputs).unwrap_or_default();
    let can_fix = matches!(setup.model.as_str(), "afm" | "expression");
    let is_dependent =
        |name: &String| study.space().dependences().iter().any(|dependence| dependence.factors().contains(name));
    let factors = setup.factors.iter().zip(study.space().factors()).map(|(setup, factor)| {
        let input = inputs.iter().find(|input| input.name == setup.name);
        let reported = |u: f64| factor.distribution().quantile(u);
        json!({
            "name": setup.name,
            "unit": setup.unit,
            "group": factor.group,
            "distribution": setup.distribution,
            "nominal": setup.nominal,
            "low": reported(0.005),
            "high": reported(0.995),
            "description": input.map(|input| &input.description),
            "can_fix": can_fix && !is_dependent(&factor.name),
            "symbol": input.map(|input| symbols(&input.symbol)),
        })
    });
    let choices = kind.map(ModelKind::choices).unwrap_or_default();
    let choices = choices.iter().filter_map(|choice| {
        let value = setup.settings.get(choice.key)?;
        (choice.values.len() > 1).then(|| json!({ "name": choice.key, "values": choice.values, "value": value }))
    });
    let model = study.model();
    // A series is one, at the place of its first value.
    let outputs = model.outputs().iter().enumerate().filter_map(|(place, output)| {
        let series = model.series().iter().find(|series| series.places().contains(&place));
        let is_shown = series.is_none_or(|series| series.first == place);
        let name = series.map_or(&*output.name, |series| &series.name);
        is_shown.then(|| json!({ "name": name, "unit": output.unit.to_string() }))
    });
    let all = kind.map(ModelKind::outputs).unwrap_or_default();
    let all = all.iter().map(|output| json!({ "name": output.name, "unit": output.unit.to_string() }));
    json!({
        "title": setup.title,
        "name": setup.name,
        "model": setup.model,
        "factors": factors.collect::<Vec<_>>(),
        "choices": choices.collect::<Vec<_>>(),
        "outputs": outputs.collect::<Vec<_>>(),
        "all_outputs": all.collect::<Vec<_>>(),
        "base_samples": study.design().settings().base_samples,
        "version": env!("CARGO_PKG_VERSION"),
    })
}
