//! `apportion compare`: two results side by side.

use std::path::PathBuf;

use apportion::result::read_result;
use apportion_base::names::{file_part, refused_name};
use apportion_report::comparison::{NamedResult, compare_results, comparison_document};

use super::output::{OutputArguments, deliver};
use crate::failure::bad_input;

#[derive(clap::Args)]
pub struct Arguments {
    /// The result of a run (NAME.json)
    #[arg(value_name = "A.json")]
    a: PathBuf,
    /// The result of another run
    #[arg(value_name = "B.json")]
    b: PathBuf,
    /// Name of A in tables and charts [default: its study, or the part in which the file names differ]
    #[arg(long, value_name = "TEXT")]
    label_a: Option<String>,
    /// Name of B in tables and charts
    #[arg(long, value_name = "TEXT")]
    label_b: Option<String>,
    #[command(flatten)]
    output: OutputArguments,
}

pub fn compare(arguments: &Arguments) -> anyhow::Result<()> {
    let (a, b) = (read_result(&arguments.a)?, read_result(&arguments.b)?);
    let [name_a, name_b] = distinct_names([(&a.study.name, &arguments.a), (&b.study.name, &arguments.b)]);
    for label in [&arguments.label_a, &arguments.label_b].into_iter().flatten() {
        if let Some(expected) = refused_name(label) {
            return Err(bad_input(format!("--label-a, --label-b: expected {expected}")));
        }
    }
    let label_a = arguments.label_a.as_deref().unwrap_or(&name_a);
    let label_b = arguments.label_b.as_deref().unwrap_or(&name_b);
    let files = [&arguments.a, &arguments.b].map(|path| path.display().to_string());
    let a = NamedResult { result: &a, label: label_a, file: &files[0] };
    let b = NamedResult { result: &b, label: label_b, file: &files[1] };
    let file =
        compare_results(&a, &b).map_err(|error| bad_input(format!("A is {}, B is {}: {error}", files[0], files[1])))?;
    let name = format!("{}-vs-{}", file_part(&name_a), file_part(&name_b));
    let artefacts = arguments.output.artefacts(&name, vec![arguments.a.clone(), arguments.b.clone()]);
    deliver(&artefacts, &comparison_document(&file, &name))
}

/// Two names that are not the same: the studies', the files', their folders', or else A and B.
fn distinct_names(sides: [(&String, &PathBuf); 2]) -> [String; 2] {
    let candidates = [
        sides.map(|(study, _)| Some(study.clone())),
        sides.map(|(_, path)| Some(path.file_stem()?.to_string_lossy().into_owned())),
        sides.map(|(_, path)| Some(path.canonicalize().ok()?.parent()?.file_name()?.to_string_lossy().into_owned())),
    ];
    let distinct = candidates.into_iter().find_map(|names| match names {
        [Some(a), Some(b)] if a != b && !a.is_empty() && !b.is_empty() => Some([a, b]),
        _ => None,
    });
    distinct.unwrap_or_else(|| ["A".to_owned(), "B".to_owned()])
}
