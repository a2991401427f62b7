//! `model = "command"`: the user's own program, its outputs, and how it receives rows.

mod runs;

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;
use std::time::Duration;

use apportion::space::Space;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};

use super::analysis::seconds;
use super::at::{At, ListOrTable};
use super::context::{Context, Fault, Reach, choice_if_said, folder, refuse_outside_of_run, resolve, wrong};
use super::error::Problem;
use super::key_schemas::names;
use super::outputs::own_outputs;
use super::sections::Outputs;
use super::subjects::CommandSubject;
use crate::{CommandOutput, CommandSettings, Form, Pick, Program, Protocol, Source};

pub(super) fn no_program() -> Problem {
    Problem::missing("program", "command = [\"python3\", \"my_model.py\"]")
}

/// Returns the program with its settings, and notes on keys without effect.
pub(super) fn subject(
    context: &Context<'_>,
    key: Option<&At<CommandKey>>,
    outputs: Option<&At<Outputs>>,
    space: &Space,
) -> Result<(CommandSubject, Vec<String>), Fault> {
    let Some(key) = key else { return Err(context.fault(0..0, no_program())) };
    let unsaid = CommandSection::default();
    let (section, program) = match key.get_ref() {
        ListOrTable::List(program) => (&unsaid, program.as_slice()),
        ListOrTable::Table(section) => {
            (section.as_ref(), section.program.as_ref().map_or(&[][..], |program| program.get_ref().as_slice()))
        }
    };
    if program.first().is_none_or(|name| name.get_ref().trim().is_empty()) {
        let span = program.first().map_or_else(|| key.span(), At::span);
        return Err(context.fault(span, no_program()));
    }
    let arguments: Vec<String> = program.iter().map(|argument| argument.get_ref().clone()).collect();
    let directory = match &section.directory {
        None => folder(context),
        Some(typed) => existing(context, section, typed, "directory")?,
    };
    let environment: Vec<(String, String)> = section.env.clone().into_iter().collect();
    let all = own_outputs(context, outputs)?;
    for Pick { source, .. } in all.outputs.iter().filter_map(|output| output.pick.as_ref()) {
        if let Source::File(file) = source {
            let place = outputs.map_or(0..0, At::span);
            refuse_outside_of_run(context, place, file, reach(section))?;
        }
    }
    let (form, notes) = match &section.template {
        None => {
            let protocol = protocol(context, section, all.first_pick.as_ref())?;
            refuse_number(context, key, protocol, space, &all.outputs)?;
            (Form::KeptAlive(protocol), Vec::new())
        }
        Some(template) => {
            let (form, notes) = runs::form(context, section, template, space)?;
            runs::refuse_without_pick(context, key, &all.outputs)?;
            (Form::PerRun(form), notes)
        }
    };
    let protocol = if let Form::KeptAlive(protocol) = &form { Some(protocol.name()) } else { None };
    let input = if let Form::PerRun(form) = &form { Some(&form.input) } else { None };
    let mut stated = vec![
        ("program", json!(arguments)),
        ("directory", json!(section.directory)),
        ("env", json!(section.env)),
        ("protocol", json!(protocol)),
        ("template", json!(section.template)),
        ("input", json!(input)),
        ("files", json!(section.files)),
        ("depends_on", json!(section.depends_on)),
        ("outputs", Value::Object(all.stated)),
    ];
    stated.retain(|(_, value)| !matches!(value, Value::Null) && *value != json!([]) && *value != json!({}));
    let depends_on =
        section.depends_on.iter().map(|typed| existing(context, section, typed, "file")).collect::<Result<_, _>>()?;
    let timeout = section.timeout.as_ref().map(|typed| seconds(context, "timeout", typed)).transpose()?;
    let settings = CommandSettings {
        program: Program { arguments, directory, environment },
        form,
        asked: (0..all.outputs.len()).collect(),
        outputs: all.outputs,
        series: all.series,
        workers: whole(context, "workers", section.workers.as_ref(), 1..=1024)?.map(|number| number as usize),
        timeout: timeout.map(|seconds| Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)),
        retries: whole(context, "retries", section.retries.as_ref(), 0..=100)?.map_or(1, |number| number as u32),
    };
    Ok((CommandSubject { settings, stated, depends_on }, notes))
}

/// Returns how far the paths of the study may lead.
fn reach(section: &CommandSection) -> Reach {
    let is_free = section.files_outside.as_ref().is_some_and(|allowed| *allowed.get_ref());
    if is_free { Reach::Anywhere } else { Reach::Inside }
}

/// Returns the typed path of an existing `file` or `directory`.
fn existing(context: &Context<'_>, section: &CommandSection, typed: &At<String>, what: &str) -> Result<PathBuf, Fault> {
    let path = resolve(context, typed, reach(section))?;
    let is_there = if what == "file" { path.is_file() } else { path.is_dir() };
    if is_there {
        return Ok(path);
    }
    let problem = format!("{}: there is no such {what}", path.display());
    let help = format!("the path must be that of a {what}, relative to the study");
    Err(context.fault(typed.span(), Problem::with_help(problem, help)))
}

/// Returns the protocol of a program that is kept alive; keys of the other form are refused.
fn protocol(
    context: &Context<'_>,
    section: &CommandSection,
    first_pick: Option<&Range<usize>>,
) -> Result<Protocol, Fault> {
    const RUNS: &str = "used only with `template`, for a program that runs once for each row";
    let spans = [
        ("input", section.input.as_ref().map(At::span)),
        ("files", section.files.first().map(At::span)),
        ("keep", section.keep.as_ref().map(At::span)),
        ("regex, column, pointer, file, match", first_pick.cloned()),
    ];
    if let Some((key, span)) = spans.into_iter().find_map(|(key, span)| Some((key, span?))) {
        return Err(context.fault(span, wrong(key, RUNS, "without it".to_owned())));
    }
    Ok(choice_if_said(context, &section.protocol, "protocol")?.unwrap_or(Protocol::Csv))
}

/// Refuses a factor, or an output of JSON, with the name of the row number.
fn refuse_number(
    context: &Context<'_>,
    key: &At<CommandKey>,
    protocol: Protocol,
    space: &Space,
    outputs: &[CommandOutput],
) -> Result<(), Fault> {
    let is_factor = space.factors().iter().any(|factor| factor.name == "id");
    let is_output = protocol == Protocol::JsonLines && outputs.iter().any(|output| output.name == "id");
    let what = if is_factor { "factor" } else { "output" };
    if is_factor || is_output {
        let expected = "different from `id`, which is the number of the row";
        return context.refuse(key, &format!("name of the {what}"), expected, "`id`".to_owned());
    }
    Ok(())
}

fn whole(
    context: &Context<'_>,
    key: &str,
    typed: Option<&At<u64>>,
    range: std::ops::RangeInclusive<u64>,
) -> Result<Option<u64>, Fault> {
    let Some(typed) = typed else { return Ok(None) };
    if range.contains(typed.get_ref()) {
        return Ok(Some(*typed.get_ref()));
    }
    let expected = format!("a whole number from {} to {}", range.start(), range.end());
    context.refuse(typed, key, &expected, typed.get_ref().to_string())
}

/// The program alone, or a table.
pub type CommandKey = ListOrTable<Box<CommandSection>>;

/// A program of your own as the model.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table [command]")]
pub struct CommandSection {
    /// The program and its arguments; no shell reads them.
    #[schemars(length(min = 1))]
    pub program: Option<At<Vec<At<String>>>>,
    /// The format of rows and answers of a program that is kept alive.
    #[schemars(extend("enum" = names(&Protocol::ALL, Protocol::name), "default" = "csv"))]
    pub protocol: Option<At<String>>,
    /// Number of processes at the same time; by default the number of cores.
    #[schemars(range(min = 1, max = 1024))]
    pub workers: Option<At<u64>>,
    /// Time limit for a row, as in "60 s"; by default none.
    pub timeout: Option<At<String>>,
    /// How often a row is retried after the program crashed, hung or printed an invalid answer; once by default.
    #[schemars(range(max = 100))]
    pub retries: Option<At<u64>>,
    /// Working directory of the program, relative to the study; by default the folder of the study.
    pub directory: Option<At<String>>,
    /// Environment variables that are set for the program.
    #[serde(default)]
    pub env: BTreeMap<String, String>,
    /// Other files that its answers depend on, such as data, relative to the study: recorded answers from before a change of these
    /// files are not reused. The program and files among its arguments are included; list what they import.
    #[serde(default)]
    pub depends_on: Vec<At<String>>,
    /// Template of an input file, in which {{name}} stands for the value of a factor: the program then runs once for each
    /// row, in its own directory.
    pub template: Option<At<String>>,
    /// Name of the input file in the directory of a run; by default that of the template.
    pub input: Option<At<String>>,
    /// Files that are copied to the directory of each run, relative to the study.
    #[serde(default)]
    pub files: Vec<At<String>>,
    /// Whether paths in this table may lead outside the study's folder.
    pub files_outside: Option<At<bool>>,
    /// Folder that keeps the directories of runs, relative to the study; by default each is removed after its run.
    pub keep: Option<At<String>>,
}
