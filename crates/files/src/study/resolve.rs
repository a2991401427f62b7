//! Conversion of a study file to a study: every check of a study file, once.

use std::ops::Range;
use std::sync::Arc;

use apportion::StudyBuilder;
use apportion::design::DesignError;
use apportion::study::{BuildError, Study, StudySource};
use apportion_base::names::file_part;
use toml::de::DeTable;

use super::at::At;
use super::context::{Context, Fault, unknown_name};
use super::error::Problem;
use super::models::{TABLES, table_of};
use super::parse::study_file;
use super::reading::Reading;
use super::{analysis, dependence, factors, fidelity};
use crate::ModelKind;

/// Returns the study of the text of `context`, and notes on keys without effect and the tables that it names.
pub(super) fn study(context: Context) -> Result<(Study, StudySource), Fault> {
    let file = study_file(&context)?;
    let kind = model_kind(&context, file.model.as_ref())?;
    let reading = Reading { context, file, kind };
    refuse_tables_of_others(&reading)?;
    let Reading { context, file, .. } = &reading;
    let table = table_of(kind);
    let space = factors::space(context, &(table.inputs)(&reading)?, &file.factor)?;
    let (subject, notes) = (table.subject)(&reading, &space)?;
    let subject = analysis::repeated(&reading, subject, &space)?;
    let name = match &file.name {
        Some(name) => name.get_ref().clone(),
        None => context.path.file_stem().map_or_else(|| "study".to_owned(), |stem| file_part(&stem.to_string_lossy())),
    };
    let mut builder = StudyBuilder::new(&name, Arc::clone(&subject));
    analysis::apply_tables(&reading, &space, &mut builder)?;
    builder.title = file.title.as_ref().map(|title| title.get_ref().clone());
    builder.factors = space.factors().iter().cloned().map(Ok).collect();
    builder.dependences = dependence::dependences(&reading, &space)?;
    builder.low_fidelities = fidelity::low_fidelity_models(&reading, &*subject, study)?;
    match builder.checked() {
        Ok(study) => Ok((study, StudySource { notes, measured: context.measured.take(), ..StudySource::default() })),
        Err(error) => Err(context.fault(place(&reading, &error), Problem::Build(error))),
    }
}

/// Returns the position in the file that `error` is about.
fn place(reading: &Reading, error: &BuildError) -> Range<usize> {
    let keys: &[&str] = match error {
        BuildError::Wrong { key, .. } => &[key],
        BuildError::Design(DesignError::NoReplicates) => &["replicates"],
        BuildError::Design(DesignError::TooManyPairs { .. }) => &["second_order"],
        BuildError::Design(_) => &["base_samples", "runs", "replicates"],
        BuildError::Dependence(_) => &["dependence"],
        BuildError::LowFidelity { .. } | BuildError::Repeated { what: "cheaper model", .. } => &["low"],
        BuildError::Name { name, .. } | BuildError::Repeated { name, .. } => return place_of_name(reading, name),
        _ => &[],
    };
    let Ok(root) = DeTable::parse(&reading.context.text) else { return 0..0 };
    let root = root.get_ref();
    let mut tables = vec![root];
    tables.extend(["design", "analysis", "fidelity"].iter().filter_map(|table| root.get(*table)?.get_ref().as_table()));
    let value = keys.iter().find_map(|key| tables.iter().find_map(|table| table.get(*key)));
    value.map_or(0..0, toml::Spanned::span)
}

/// Returns the position of a refused name: the last one of a factor, or else the first occurrence.
fn place_of_name(reading: &Reading, name: &str) -> Range<usize> {
    for factor in reading.file.factor.iter().rev().map(At::get_ref) {
        if let Some(typed) = factor.group.iter().chain([&factor.name]).find(|typed| typed.get_ref() == name) {
            return typed.span();
        }
    }
    // Escaped names are not found.
    reading.context.text.find(name).map_or(0..0, |start| start..start + name.len())
}

fn model_kind(context: &Context, model: Option<&At<String>>) -> Result<ModelKind, Fault> {
    let Some(model) = model else { return Ok(ModelKind::DEFAULT) };
    ModelKind::from_name(model.get_ref()).ok_or_else(|| {
        let name = model.get_ref();
        let problem = match name.contains(['.', '/', '\\']) {
            true => Problem::with_help(
                format!("unknown model `{name}`: a program of your own is a `command`"),
                "write model = \"command\" and command = [\"python3\", \"my_model.py\"]",
            ),
            false => unknown_name("model", name, ModelKind::all().iter().map(|kind| kind.name)),
        };
        context.fault(model.span(), problem)
    })
}

/// Refuses tables of other models: `[afm]`, `[function]`, `[expression]` and `command` belong to one kind each.
fn refuse_tables_of_others(Reading { context, file, kind }: &Reading) -> Result<(), Fault> {
    for table in TABLES.iter().filter(|table| table.name != kind.table) {
        let Some(span) = (table.span)(file) else { continue };
        let owner = match table.name {
            "function" => "a function that has parameters".to_owned(),
            name => format!("model = {name:?}"),
        };
        let (name, default) = (table.name, if file.model.is_none() { " by default" } else { "" });
        let right = format!("[{name}] belongs to {owner}, and the model of this study is {:?}{default}", kind.name);
        return Err(context.fault(span, Problem::misplaced(name, &right)));
    }
    Ok(())
}
