//! `model = "command"`: the user's own program, its outputs, and how it receives rows.

mod runs;

use std::ops::{Range, RangeInclusive};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use apportion::space::Space;
use serde_json::{Value, json};

use super::at::At;
use super::context::{Context, Fault, PathScope, folder, optional_choice, refuse_outside_of_run, resolve, wrong};
use super::error::Problem;
use super::outputs::stated_outputs;
use super::reading::{Configured, Reading};
use super::sections::CommandSection;
use super::subjects::CommandSubject;
use super::units::seconds;
use crate::{CommandOutput, CommandSettings, Form, Pick, Program, Protocol, Source};

pub(super) fn no_program() -> Problem {
    Problem::missing("program", "command = [\"python3\", \"my_model.py\"]")
}

/// Returns the program with its settings, and notes on keys without effect.
pub(super) fn subject(reading: &Reading, space: &Space) -> Configured {
    let Reading { context, file, .. } = reading;
    let Some(key) = &file.command else { return Err(context.fault(0..0, no_program())) };
    let section = key.get_ref();
    let program = section.program.as_ref().map_or(&[][..], |program| program.get_ref());
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
    let all = stated_outputs(reading)?;
    for Pick { source, .. } in all.outputs.iter().filter_map(|output| output.pick.as_ref()) {
        if let Source::File(name) = source {
            let place = file.outputs.as_ref().map_or(0..0, At::span);
            refuse_outside_of_run(context, place, name, path_scope(section))?;
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
        requested: (0..all.outputs.len()).collect(),
        outputs: all.outputs,
        series: all.series,
        workers: number_within(context, "workers", section.workers.as_ref(), 1..=1024)?.map(|number| number as usize),
        timeout: timeout.map(|seconds| Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)),
        retries: number_within(context, "retries", section.retries.as_ref(), 0..=100)?
            .map_or(1, |number| number as u32),
    };
    Ok((Arc::new(CommandSubject { settings, stated, depends_on }), notes))
}

/// Returns how far the paths of the study may lead.
fn path_scope(section: &CommandSection) -> PathScope {
    let is_free = section.files_outside.as_ref().is_some_and(|allowed| *allowed.get_ref());
    if is_free { PathScope::Anywhere } else { PathScope::StudyFolder }
}

/// Returns the typed path of an existing `file` or `directory`.
fn existing(context: &Context, section: &CommandSection, typed: &At<String>, what: &str) -> Result<PathBuf, Fault> {
    let path = resolve(context, typed, path_scope(section))?;
    let exists = if what == "file" { path.is_file() } else { path.is_dir() };
    if exists {
        return Ok(path);
    }
    let problem = format!("{}: there is no such {what}", path.display());
    let help = format!("the path must be that of a {what}, relative to the study");
    Err(context.fault(typed.span(), Problem::with_help(problem, help)))
}

/// Returns the protocol of a program that is kept alive; keys of the other form are refused.
fn protocol(context: &Context, section: &CommandSection, first_pick: Option<&Range<usize>>) -> Result<Protocol, Fault> {
    const RUNS: &str = "used only with `template`, for a program that runs once for each row";
    let spans = [
        ("input", section.input.as_ref().map(At::span)),
        ("files", section.files.first().map(At::span)),
        ("keep", section.keep.as_ref().map(At::span)),
        ("regex, column, pointer, file, match", first_pick.cloned()),
    ];
    if let Some((key, span)) = spans.into_iter().find_map(|(key, span)| Some((key, span?))) {
        return Err(context.fault(span, wrong(key, RUNS, "without it")));
    }
    Ok(optional_choice(context, &section.protocol, "protocol")?.unwrap_or(Protocol::Csv))
}

/// Refuses a factor, or an output of JSON, with the name of the row number.
fn refuse_number(
    context: &Context,
    key: &At<CommandSection>,
    protocol: Protocol,
    space: &Space,
    outputs: &[CommandOutput],
) -> Result<(), Fault> {
    let is_factor = space.factors().iter().any(|factor| factor.name == "id");
    let is_output = protocol == Protocol::JsonLines && outputs.iter().any(|output| output.name == "id");
    let what = if is_factor { "factor" } else { "output" };
    if is_factor || is_output {
        let expected = "different from `id`, which is the number of the row";
        return context.refuse(key, &format!("name of the {what}"), expected, "`id`");
    }
    Ok(())
}

fn number_within(
    context: &Context,
    key: &str,
    typed: Option<&At<u64>>,
    range: RangeInclusive<u64>,
) -> Result<Option<u64>, Fault> {
    let Some(typed) = typed else { return Ok(None) };
    if range.contains(typed.get_ref()) {
        return Ok(Some(*typed.get_ref()));
    }
    let expected = format!("a whole number from {} to {}", range.start(), range.end());
    context.refuse(typed, key, &expected, typed.get_ref())
}
