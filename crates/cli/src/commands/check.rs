//! `apportion check`: the meaning of a study and its cost, without running it.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use apportion::model::{Output, RunContext};
use apportion::run::{Job, Pilot};
use apportion::space::Distribution;
use apportion::space::distribution::Parameter;
use apportion::study::Study;
use apportion_files::ModelKind;
use apportion_report::{significant, table, two_digits, with_unit};

use super::check_plan::plan;
use super::output::default_folder;
use super::run::journal_path;
use super::stop::on_signal;
use super::{DesignChanges, StudyArguments, counted, print, say};

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    design: DesignChanges,
    /// Folder for the results of a run [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn check(arguments: &Arguments) -> anyhow::Result<()> {
    let study = arguments.study.load_any(&arguments.design.overrides())?;
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(study.name()));
    let mut pilot = None;
    if !study.subject().is_external() {
        let model = study.model();
        let context = RunContext::new(Some(on_signal()), say);
        let job = Job { design: study.design(), space: study.space(), model: model.as_ref() };
        pilot = Some(Pilot::new(job, &context)?);
    }
    print(&format!(
        "{}{}{}{}\nwill be written to {}: the page {}.html, tables, charts\n",
        subject(&study),
        factors(&study),
        plan(&study, &arguments.study.study, pilot.as_ref()),
        past_runs(&study, &folder),
        folder.display(),
        study.name()
    ))?;
    match pilot.filter(|pilot| pilot.failed == pilot.runs) {
        None => Ok(()),
        Some(Pilot { runs: number, reason, .. }) => {
            let (number, reason) = (counted(number, "run"), reason.unwrap_or_default());
            Err(anyhow!("every one of the first runs failed ({number}): {reason}"))
        }
    }
}

fn subject(study: &Study) -> String {
    let model_name = study.subject().name();
    let after_colon = |text: &str| format!(": {text}");
    let title = study.title().map(after_colon).unwrap_or_default();
    let about = ModelKind::from_name(model_name).map(|kind| after_colon(kind.description)).unwrap_or_default();
    let mut text = format!("study {}{title}\nmodel {model_name}{about}\n", study.name());
    if model_name == ModelKind::COMMAND.name {
        let files = study.subject().files();
        let names = files.iter().filter_map(|file| Some(file.file_name()?.to_string_lossy()));
        let names = names.collect::<Vec<_>>().join(", ");
        let names = if names.is_empty() { "none" } else { &names };
        text.push_str(&format!("files that a journal depends on: {names}\n"));
    }
    for (name, value) in study.settings() {
        match value.as_object() {
            Some(table) => table.iter().for_each(|(key, value)| text.push_str(&format!("  {name}.{key} = {value}\n"))),
            None => text.push_str(&format!("  {name} = {}\n", shortened(&value))),
        }
    }
    let model = study.model();
    // A series is listed at its first value.
    let output = |(place, output): (usize, &Output)| {
        let series = model.series().iter().find(|series| series.places().contains(&place));
        match series {
            Some(series) if series.first == place => {
                let (values, axis) = (series.places().len(), series.axis.label());
                Some(format!("{} [{}] ({values} values along {axis})", series.name, output.unit))
            }
            Some(_) => None,
            None => Some(format!("{} [{}]", output.name, output.unit)),
        }
    };
    let outputs: Vec<String> = model.outputs().iter().enumerate().filter_map(output).collect();
    text.push_str(&format!("outputs: {}\n", outputs.join(", ")));
    let constants = study.constants().into_iter();
    let constants: Vec<String> =
        constants.map(|(name, value, unit)| format!("{name} = {}", with_unit(value, &unit))).collect();
    if !constants.is_empty() {
        text.push_str(&format!("fixed: {}\n", constants.join(", ")));
    }
    text.push('\n');
    text
}

/// A value as it is written in a study file, a long list by its beginning and its length.
fn shortened(value: &serde_json::Value) -> String {
    const SHOWN: usize = 12;
    match value.as_array() {
        Some(list) if list.len() > SHOWN => {
            let entries: Vec<String> = list.iter().take(SHOWN).map(ToString::to_string).collect();
            format!("[{}, ... {} in all]", entries.join(", "), list.len())
        }
        _ => value.to_string(),
    }
}

fn factors(study: &Study) -> String {
    let mut table = table(
        &["factor", "distribution", "mean", "sd", "5 %", "median", "95 %", "nominal", "unit", "group"],
        &[0, 1, 8, 9],
    );
    let mut below = String::new();
    for factor in study.space().factors() {
        let law = factor.distribution();
        let quantile = |u| if law.is_noise() { "-".to_owned() } else { factor.in_words(law.quantile(u), significant) };
        // The positions of categories in their list have no mean.
        let is_place = matches!(law, Distribution::Categorical(c) if law.name() == "categorical" && c.are_places());
        let moment = |value| if is_place || law.is_noise() { "-".to_owned() } else { significant(value) };
        if let Distribution::Categorical(categories) = law {
            let shares: Vec<String> = categories
                .categories()
                .map(|(label, _, share)| format!("{label} {} %", significant(100.0 * share)))
                .collect();
            below.push_str(&format!("{}: {}\n", factor.name, shares.join(", ")));
        }
        let is_truncated = law.parameters().iter().any(|(_, value)| matches!(value, Parameter::Bounds(..)));
        if factor.determined || is_truncated {
            // With all their digits.
            let parameters = law.parameters().into_iter().filter_map(|(name, value)| match value {
                Parameter::Number(number) => Some(format!("{name} = {number}")),
                Parameter::Bounds(min, max) => Some(format!("{name} = [{min}, {max}]")),
                _ => None,
            });
            let parameters = parameters.collect::<Vec<_>>().join(", ");
            below.push_str(&format!("{}: {} with {parameters}\n", factor.name, law.name()));
        }
        table.add_row([
            factor.name.clone(),
            law.name().to_owned(),
            moment(law.mean()),
            moment(law.sd()),
            quantile(0.05),
            quantile(0.5),
            quantile(0.95),
            factor.in_words(factor.nominal, significant),
            factor.unit().to_string(),
            factor.group.clone().unwrap_or_default(),
        ]);
    }
    format!("{table}\n{below}")
}

/// The lines on the journal in the folder of the results.
fn past_runs(study: &Study, folder: &Path) -> String {
    let path = journal_path(folder, study.name(), None);
    let total = study.design().rows();
    let megabytes = total as f64 * study.model().outputs().len() as f64 * 8e-6;
    let (size, path_text) = (two_digits(megabytes.max(0.01)), path.display());
    let when = if study.model().is_slow() { "" } else { ", if the run takes longer than 10 s" };
    let mut text = format!("disk: about {size} MB for the journal {path_text}{when}\n");
    if path.exists() {
        text.push_str(&match study.runner().journal(&path).recorded_runs() {
            Ok(rows) => format!("already saved: {} of {total} runs, which are not repeated\n", rows.min(total)),
            Err(error) => format!("already saved: no usable runs: {error}\n"),
        });
    }
    text
}
