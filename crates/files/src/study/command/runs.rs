//! A program that runs once for each row: its template, and the files of a run's directory.

use std::path::{Component, Path, PathBuf};

use apportion::space::Space;
use apportion::study::did_you_mean;
use apportion_base::files::read_text;
use apportion_base::names::nearest;

use super::{At, CommandKey, CommandSection, Context, Fault, existing, reach};
use crate::study::context::{resolve, wrong};
use crate::study::error::Problem;
use crate::{CommandOutput, InputTemplate, PerRun, TemplateProblem};

/// Names of files that the engine writes in the directory of a run.
const TAKEN: [&str; 3] = ["stdout.txt", "stderr.txt", "factors.csv"];

/// Returns the form, and notes on factors that the template does not use.
pub(super) fn form(
    context: &Context<'_>,
    section: &CommandSection,
    template: &At<String>,
    space: &Space,
) -> Result<(PerRun, Vec<String>), Fault> {
    if let Some(protocol) = &section.protocol {
        let expected = "used only without `template`, for a program that is kept alive";
        return Err(context.fault(protocol.span(), wrong("protocol", expected, "with it".to_owned())));
    }
    let template_file = resolve(context, template, reach(section))?;
    let file_name = template_file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let input = section.input.as_ref().map_or(file_name, |input| input.get_ref().clone());
    let span = || section.input.as_ref().map_or_else(|| template.span(), At::span);
    refuse_place("input", &input).map_err(|problem| context.fault(span(), problem))?;
    let read = context.at(template, read_template(&template_file, space))?;
    let unused = space.factors().iter().enumerate().filter(|(number, _)| !read.uses(*number));
    let notes = unused.map(|(_, factor)| format!("factor `{}` is not in the template", factor.name)).collect();
    let files = files(context, section, &input)?;
    let keep = section.keep.as_ref().map(|keep| resolve(context, keep, reach(section))).transpose()?;
    Ok((PerRun { template_file, template: read, input, files, keep }, notes))
}

/// Refuses an output that does not say where its number is after a run.
pub(super) fn refuse_without_pick(
    context: &Context<'_>,
    key: &At<CommandKey>,
    outputs: &[CommandOutput],
) -> Result<(), Fault> {
    let Some(output) = outputs.iter().find(|output| output.pick.is_none()) else { return Ok(()) };
    let expected = "a table that locates the number, as in { file = \"out.txt\", regex = \"force = (\\\\S+)\" }, \
                    { file = \"out.csv\", column = \"y\" } or { file = \"out.json\", pointer = \"/result/y\" }";
    context.refuse(key, &format!("outputs.{}", output.name), expected, "only a unit, with `template`".to_owned())
}

fn read_template(path: &Path, space: &Space) -> Result<InputTemplate, Problem> {
    let text = read_text(path).map_err(|error| {
        let help = "it must be text in UTF-8; its path is relative to the study";
        Problem::with_help(format!("{}: cannot read the template: {error}", path.display()), help)
    })?;
    let names = || space.factors().iter().map(|factor| factor.name.as_str());
    InputTemplate::parse(&text, &|name| names().position(|known| known == name)).map_err(|error| {
        let near = match &error.problem {
            TemplateProblem::Unknown(name) => nearest(name, names()),
            TemplateProblem::Open => None,
        };
        let place = format!("{}:{}:{}", path.display(), error.line, error.column);
        let names = names().collect::<Vec<_>>().join(", ");
        let help = format!("factors: {names}; write `{{{{{{{{` for two literal braces");
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

fn files(context: &Context<'_>, section: &CommandSection, input: &str) -> Result<Vec<PathBuf>, Fault> {
    let mut paths: Vec<PathBuf> = Vec::with_capacity(section.files.len());
    for typed in &section.files {
        let path = existing(context, section, typed, "file")?;
        let fault = |problem| context.fault(typed.span(), problem);
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        refuse_place("files", &name).map_err(fault)?;
        if name == input || paths.iter().any(|other| other.file_name() == path.file_name()) {
            return Err(fault(Problem::Repeated { what: "file of a run's directory", name }));
        }
        paths.push(path);
    }
    Ok(paths)
}
