//! `apportion new`: writes a new study file.

use std::path::PathBuf;

use apportion_files::{ModelKind, NEW_PROGRAM, Problem, TemplateRequest, new_program, template};
use apportion_report::{prepare_outputs, write_atomically};

use super::models::find_model;
use super::{counted, quoted, say};
use crate::failure::bad_input;

#[derive(clap::Args)]
#[command(after_help = "Example: apportion new my-study.toml --factors thickness,velocity --outputs critical_force")]
pub struct Arguments {
    /// The study file to write (TOML)
    study: PathBuf,
    /// The model: afm, expression, command (your own program), or a function of `apportion models`
    #[arg(long, value_name = "NAME", default_value = "afm")]
    model: String,
    /// Inputs that become factors, separated by commas [default: the main ones; for a function all]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    factors: Vec<String>,
    /// Outputs, separated by commas [default: the main one]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    outputs: Vec<String>,
    /// Title of the study
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Overwrite an existing file
    #[arg(long)]
    force: bool,
}

pub fn new(arguments: &Arguments) -> anyhow::Result<()> {
    let path = &arguments.study;
    let model = find_model(&arguments.model)?;
    for (option, names) in [("--factors", &arguments.factors), ("--outputs", &arguments.outputs)] {
        if names.iter().any(|name| name.trim().is_empty()) {
            return Err(bad_input(format!("{option}: a name is empty: expected names separated by commas")));
        }
    }
    let request = TemplateRequest {
        model,
        title: arguments.title.clone(),
        factors: arguments.factors.clone(),
        outputs: arguments.outputs.clone(),
    };
    let text = template(&request).map_err(|problem| {
        let option = match problem {
            Problem::UnknownName { what: "output", .. } | Problem::Repeated { what: "output", .. } => "--outputs",
            _ => "--factors",
        };
        let help = problem.help().map(|help| format!("\n{help}")).unwrap_or_default();
        bad_input(format!("{option}: {problem} (model {}){help}", model.name))
    })?;
    let study = apportion_files::parse_study(&text, path, &[])?;
    prepare_outputs(&[], std::slice::from_ref(path), arguments.force)?;
    write_atomically(path, text.as_bytes())?;
    let (factors, runs) = (study.space().factors().len(), study.design().rows());
    say(&format!("wrote {}: {}, {runs} runs", path.display(), counted(factors as u64, "factor")));
    if let Some(program) = new_program(&request) {
        // An existing program may be somebody's work.
        let path = path.with_file_name(NEW_PROGRAM);
        if path.exists() {
            say(&format!("{} exists already and is not changed", path.display()));
        } else {
            write_atomically(&path, program.as_bytes())?;
            say(&format!("wrote {}: the model, a sum for you to replace", path.display()));
        }
    }
    let step = if model == ModelKind::EXTERNAL { "sample" } else { "run" };
    say(&format!(
        "next: edit it, then `apportion check {0}` and `apportion {step} {0}`",
        quoted(&path.display().to_string())
    ));
    Ok(())
}
