//! A program that runs once for each row: its template, and the files of a run's directory.

use std::path::{Component, Path, PathBuf};

use apportion::space::Space;
use apportion_base::files::read_text;
use apportion_base::names::did_you_mean;
use apportion_base::names::nearest;

use super::{existing, path_scope};
use crate::command::TemplateProblem;
use crate::study::at::At;
use crate::study::context::{Context, Fault, resolve, wrong};
use crate::study::error::Problem;
use crate::study::sections::CommandSection;
use crate::{CommandOutput, InputTemplate, PerRun};

/// Names of files that the engine writes in the directory of a run.
const TAKEN: [&str; 3] = ["stdout.txt", "stderr.txt", "factors.csv"];

/// Returns the form, and notes on factors that the template does not use.
pub(super) fn form(
    context: &Context,
    section: &CommandSection,
    template: &At<String>,
    space: &Space,
) -> Result<(PerRun, Vec<String>), Fault> {
    if let Some(protocol) = &section.protocol {
        let expected = "used only without `template`, for a program that is kept alive";
        return Err(context.fault(protocol.span(), wrong("protocol", expected, "with it")));
    }
    let template_file = resolve(context, template, path_scope(section))?;
    let input = section.input.as_ref().map_or_else(|| name_of(&template_file), |input| input.get_ref().clone());
    context.at(section.input.as_ref().unwrap_or(template), refuse_place("input", &input))?;
    let read = context.at(template, read_template(&template_file, space))?;
    let unused = space.factors().iter().enumerate().filter(|(number, _)| !read.uses(*number));
    let notes = unused.map(|(_, factor)| format!("factor `{}` is not in the template", factor.name)).collect();
    let files = files(context, section, &input)?;
    let keep = section.keep.as_ref().map(|keep| resolve(context, keep, path_scope(section))).transpose()?;
    Ok((PerRun { template_file, template: read, input, files, keep }, notes))
}

/// Refuses an output that does not say where its number is after a run.
pub(super) fn refuse_without_pick(
    context: &Context,
    key: &At<CommandSection>,
    outputs: &[CommandOutput],
) -> Result<(), Fault> {
    let Some(output) = outputs.iter().find(|output| output.pick.is_none()) else { return Ok(()) };
    let expected = "a table that locates the number, as in { file = \"out.txt\", regex = \"force = (\\\\S+)\" }, \
                    { file = \"out.csv\", column = \"y\" } or { file = \"out.json\", pointer = \"/result/y\" }";
    context.refuse(key, &format!("outputs.{}", output.name), expected, "only a unit, with `template`")
}

fn read_template(path: &Path, space: &Space) -> Result<InputTemplate, Problem> {
    let text = read_text(path).map_err(|error| {
        let help = "it must be text in UTF-8; its path is relative to the study";
        Problem::with_help(format!("{}: cannot read the template: {error}", path.display()), help)
    })?;
    let names: Vec<&str> = space.factors().iter().map(|factor| factor.name.as_str()).collect();
    InputTemplate::parse(&text, &|name| names.iter().position(|factor| *factor == name)).map_err(|error| {
        let near = match &error.problem {
            TemplateProblem::Unknown(name) => nearest(name, names.iter().copied()),
            TemplateProblem::Open => None,
        };
        let place = format!("{}:{}:{}", path.display(), error.line, error.column);
        let help = format!("factors: {}; write `{{{{{{{{` for two literal braces", names.join(", "));
        Problem::with_help(format!("{place}: {error}{}", did_you_mean(&near)), help)
    })
}

/// Refuses a file name that leads out of the directory of a run.
fn refuse_place(key: &str, name: &str) -> Result<(), Problem> {
    let mut parts = Path::new(name).components();
    let is_name = matches!((parts.next(), parts.next()), (Some(Component::Normal(_)), None));
    if !is_name || name.contains('\0') {
        return Err(wrong(key, "the name of a file, without a folder", format!("{name:?}")));
    }
    if TAKEN.contains(&name) {
        return Err(wrong(key, "another name: the directory of a run already has this file", format!("{name:?}")));
    }
    Ok(())
}

fn files(context: &Context, section: &CommandSection, input: &str) -> Result<Vec<PathBuf>, Fault> {
    let mut paths: Vec<PathBuf> = Vec::with_capacity(section.files.len());
    for typed in &section.files {
        let path = existing(context, section, typed, "file")?;
        let name = name_of(&path);
        context.at(typed, refuse_place("files", &name))?;
        if name == input || paths.iter().any(|other| other.file_name() == path.file_name()) {
            return Err(context.fault(typed.span(), Problem::Repeated { what: "file of a run's directory", name }));
        }
        paths.push(path);
    }
    Ok(paths)
}

fn name_of(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}
