//! `apportion new`: writes a new study file.

use std::path::PathBuf;

use apportion_base::files::read_text;
use apportion_files::{ModelKind, NEW_PROGRAM, Problem, TemplateRequest, new_program, problem_factors, template};
use apportion_report::{prepare_outputs, write_atomically};
use clap::builder::ArgPredicate::IsPresent;

use super::models::find_model;
use super::{counted, quoted, say};
use crate::failure::{OfFile, bad_input};

#[derive(clap::Args)]
#[command(after_help = "Example: apportion new my-study.toml --factors thickness,velocity --outputs critical_force")]
pub struct Arguments {
    /// The study file to write (TOML)
    study: PathBuf,
    /// The model: afm, expression, command (your own program), or a function of `apportion models`
    #[arg(long, value_name = "NAME", default_value = "afm", default_value_if("problem", IsPresent, "external"))]
    model: String,
    /// A problem definition with the factors: SALib's parameter file, its problem as JSON, or a CSV table of names and bounds
    #[arg(long, value_name = "FILE", conflicts_with = "factors")]
    problem: Option<PathBuf>,
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
    let mut request = TemplateRequest {
        model,
        title: arguments.title.clone(),
        factors: arguments.factors.clone(),
        tables: Vec::new(),
        outputs: arguments.outputs.clone(),
    };
    if let Some(file) = &arguments.problem {
        if !model.is_users_own() {
            return Err(bad_input("--problem: add --model expression or command, not a model with inputs of its own"));
        }
        let text = read_text(file).map_err(|error| format!("cannot read the problem: {error}")).in_file(file)?;
        (request.factors, request.tables) = problem_factors(&text).in_file(file)?.into_iter().unzip();
    }
    let text = template(&request).map_err(|problem| {
        let option = match problem {
            Problem::UnknownName { what: "output", .. } | Problem::Repeated { what: "output", .. } => "--outputs",
            _ if arguments.problem.is_some() => "--problem",
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
